"""The circular cylinder: H = 1 / (2 R), lamellas are helices at 45 degrees."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import require_positive
from lamella.surface.closed_forms.revolution import Profile, SurfaceOfRevolution


class Cylinder(SurfaceOfRevolution):
    """r = R, z = R U; normal towards the axis.

    Parameters
    ----------
    radius : float
        R, m.
    height : (float, float)
        z0 < z1, m.

    Examples
    --------
    >>> import lamella
    >>> lamella.Cylinder(radius=2.0, height=(0.0, 3.0))
    Cylinder(mean curvature 0.25 1/m, 37.7 m2)
    """

    kind = "cylinder"

    def __init__(self, radius: float, height: tuple[float, float]) -> None:
        require_positive(radius=radius)
        self.radius = radius
        self.mean_curvature = 1 / (2 * radius)
        self.flux = radius / 2
        self.outline = self.between(*height)

    def parameter_at_height(self, z: float) -> float:
        return z / self.radius

    def radius_at(self, u: Floats) -> Floats:
        return np.full_like(u, self.radius)

    def profile(self, u: Floats) -> Profile:
        full = np.full_like(u, self.radius)
        return Profile(full, self.radius * u, np.zeros_like(u), full)
