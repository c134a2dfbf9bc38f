"""The catenoid, the minimal surface of revolution."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import require_positive
from lamella.surface.closed_forms.revolution import Profile, SurfaceOfRevolution


class Catenoid(SurfaceOfRevolution):
    """r = c cosh U, z = c U; normal towards the axis at the neck (e_U x e_V), H = 0.

    Parameters
    ----------
    neck_radius : float
        c, m.
    height : (float, float)
        z0 < z1, m, z = 0 at the neck.

    Examples
    --------
    >>> import lamella
    >>> lamella.Catenoid(neck_radius=2.5, height=(-2.0, 3.0))
    Catenoid(mean curvature 0 1/m, 116.3 m2)
    """

    kind = "catenoid"
    mean_curvature = 0.0

    def __init__(self, neck_radius: float, height: tuple[float, float]) -> None:
        require_positive(neck_radius=neck_radius)
        self.neck_radius = self.flux = neck_radius
        self.outline = self.between(*height)

    def parameter_at_height(self, z: float) -> float:
        return z / self.neck_radius

    def radius_at(self, u: Floats) -> Floats:
        return np.asarray(self.neck_radius * np.cosh(u))

    def profile(self, u: Floats) -> Profile:
        c = self.neck_radius
        r = c * np.cosh(u)
        return Profile(r, c * u, c * np.sinh(u), np.full_like(u, c))
