"""Directions of lines on any surface: those of a given normal curvature, and the principal ones.

By Euler's formula a line at the angle phi to the first principal direction has the normal curvature

    kn = k1 cos^2 phi + k2 sin^2 phi = H + |D| cos 2 phi,      |D| = (k1 - k2) / 2,

so that two directions +-phi have a given kn where k2 <= kn <= k1, and none elsewhere; kn = 0 are the asymptotic ones.
With the deviator D and a heading t as complex numbers (`lamella.surface.points`) this reads

    D t^2 = (kn - H) -+ i sqrt(|D|^2 - (kn - H)^2),             tg = -Im(D t^2),

the upper sign for family A, whose geodesic torsion is above 0. Principal lines have D t^2 = +-|D|.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Booleans, Complexes, Floats

# degrees; where families cross at less the net ends
CROSSING_ANGLE_MIN = 20.0
# of the curvature scale: where |D| is below it a point counts as umbilic
UMBILIC = 1e-3


@dataclass(frozen=True)
class LineField:
    """Two families of directions on a surface.

    Attributes
    ----------
    normal_curvature : float or None
        kn of both families, 1/m; None: the principal directions.
    scale : float
        Curvature scale of the surface, 1/m.
    """

    normal_curvature: float | None
    scale: float

    def heading(self, mean: Floats, deviator: Complexes, is_a: Booleans) -> Complexes:
        """Unit tangents as complex components, (n,), up to their sign; where there are none, of the nearest kn."""
        size = np.abs(deviator)
        sense = np.where(is_a, 1.0, -1.0)
        if self.normal_curvature is None:
            turned: Complexes = (sense * size).astype(np.complex128)
        else:
            excess = np.clip(self.normal_curvature - mean, -size, size)
            turned = excess - 1j * sense * np.sqrt(np.maximum(size**2 - excess**2, 0.0))
        square = turned * np.conj(deviator)
        return np.asarray(np.exp(0.5j * np.angle(square)))

    def margin(self, mean: Floats, deviator: Complexes) -> Floats:
        """Above 0 where the two families cross at `CROSSING_ANGLE_MIN` or more, 1/m, (n,)."""
        size = np.abs(deviator)
        bent = size - UMBILIC * self.scale
        if self.normal_curvature is None:
            return np.asarray(bent)
        wide = size * np.cos(np.radians(CROSSING_ANGLE_MIN)) - np.abs(self.normal_curvature - mean)
        return np.asarray(np.minimum(wide, bent))

    def is_real(self, mean: Floats, deviator: Complexes) -> Booleans:
        """Where there are such directions at all, (n,)."""
        if self.normal_curvature is None:
            return np.ones(len(mean), bool)
        return np.asarray(np.abs(self.normal_curvature - mean) <= np.abs(deviator))

    def crossing_sine(self, mean: Floats, deviator: Complexes) -> Floats:
        """Sine of the angle at which the two families cross, (n,)."""
        if self.normal_curvature is None:
            return np.ones(len(mean))
        size = np.maximum(np.abs(deviator), np.finfo(float).tiny)
        # the angle is 2 phi
        cosine = np.clip((self.normal_curvature - mean) / size, -1, 1)
        return np.asarray(np.sqrt(1 - cosine**2))
