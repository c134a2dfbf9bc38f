"""The perspective camera of pictures."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats


@dataclass(frozen=True)
class Camera:
    """A perspective camera that looks at a point.

    Attributes
    ----------
    target : (3,)
        m.
    right, up, back : (3,)
        Orthonormal; `back` points from the target to the eye.
    distance : float
        From target to eye, m.
    """

    target: Floats
    right: Floats
    up: Floats
    back: Floats
    distance: float

    @classmethod
    def around(cls, points: Floats, azimuth: float, elevation: float) -> Camera:
        """A camera for points (n, 3), seen from azimuth and elevation in degrees."""
        a, e = np.radians((azimuth, elevation))
        back = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
        right = np.array([-np.sin(a), np.cos(a), 0.0])
        low, high = points.min(0), points.max(0)
        # three diameters away: depth can be read and proportions still hold
        return cls((low + high) / 2, right, np.cross(back, right), back, 3 * float(np.linalg.norm(high - low)))

    def project(self, points: Floats) -> tuple[Floats, Floats]:
        """Picture coordinates (..., 2) and distances from the eye (...) of points (..., 3), m."""
        local = points - self.target
        away = self.distance - local @ self.back
        flat = np.stack((local @ self.right, local @ self.up), axis=-1)
        return flat * (self.distance / away)[..., None], away
