"""Points laid on others as well as a rigid motion can."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats


def moved_onto(points: Floats, goal: Floats) -> Floats:
    """Distances (n,) of points (n, 3) from others after the best rotation and shift.

    By the singular value decomposition of the covariance (W. Kabsch, Acta Crystallographica A 32 (1976) 922).
    """
    p, q = points - points.mean(0), goal - goal.mean(0)
    u, _, v = np.linalg.svd(p.T @ q)
    flip = np.array([1.0, 1.0, np.sign(np.linalg.det(u @ v))])
    return np.asarray(np.linalg.norm(p @ (u * flip) @ v - q, axis=1))
