"""Darboux curvatures of a polyline on a surface, from its points and the surface's normals there."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lamella.base.arrays import Floats


class PolylineDarboux(NamedTuple):
    """kn, kg, tg (1/m) and arc length s (m) at the points, (k,) each."""

    kn: Floats
    kg: Floats
    tg: Floats
    s: Floats


def polyline_darboux(points: Floats, normals: Floats) -> PolylineDarboux:
    """Darboux curvatures by differences of second order: n' = -kn t - tg u, t' = kg u + kn n, u = n x t.

    Parameters
    ----------
    points : (k, 3)
        In order, m, k >= 3.
    normals : (k, 3)
        Unit surface normals.
    """
    s = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    t = np.gradient(points, s, axis=0, edge_order=2)
    t -= np.einsum("kc,kc->k", t, normals)[:, None] * normals
    t /= np.linalg.norm(t, axis=1)[:, None]
    u = np.cross(normals, t)
    turning, bending = np.gradient(normals, s, axis=0, edge_order=2), np.gradient(t, s, axis=0, edge_order=2)
    kn, tg = -np.einsum("kc,kc->k", turning, t), -np.einsum("kc,kc->k", turning, u)
    return PolylineDarboux(kn, np.einsum("kc,kc->k", bending, u), tg, s)
