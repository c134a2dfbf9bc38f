"""Polygons cut off at upright lines."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats


def between_uprights(ring: Floats, left: float, right: float) -> Floats:
    """What of a polygon (n, 2) lies between two upright lines, closed along them (Sutherland and Hodgman 1974)."""
    for sign, place in ((1.0, left), (-1.0, right)):
        ring = _right_of(ring, sign, place)
    return ring


def _right_of(ring: Floats, sign: float, place: float) -> Floats:
    if not len(ring):
        return ring
    away = sign * (ring[:, 0] - place)
    following, beyond = np.roll(ring, -1, axis=0), np.roll(away, -1)
    crosses = (away < 0) != (beyond < 0)
    share = np.where(crosses, away / np.where(crosses, away - beyond, 1.0), 0.0)
    meeting = ring + share[:, None] * (following - ring)
    both = np.stack([ring, meeting], axis=1)
    kept = np.stack([away >= 0, crosses], axis=1)
    return np.asarray(both[kept])
