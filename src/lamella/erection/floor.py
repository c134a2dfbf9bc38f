"""The rectangle on the floor that a flat net takes."""

from __future__ import annotations

import numpy as np
from scipy.spatial import ConvexHull

from lamella.base.arrays import Floats

# of areas and sides, as shares, and of angles in radians: less is alike, so that rounding chooses nothing
ALIKE_SIDES = 1e-6


def floor_rectangle(points: Floats, along: Floats) -> Floats:
    """Directions of the sides of the smallest rectangle around points, the longer first.

    One of its sides lies on an edge of the convex hull (H. Freeman, R. Shapira, Communications of the ACM 18 (1975)
    409). Of several as small, and of equal sides, the one nearest to a given direction counts.

    Parameters
    ----------
    points : (n, 2)
        Not all on a line, m.
    along : (2,)

    Returns
    -------
    (2, 2)
        Rows: unit vectors, the second to the left of the first.
    """
    corners = points[ConvexHull(points).vertices]
    edges = np.roll(corners, -1, axis=0) - corners
    start = np.arctan2(along[1], along[0])
    # sides are at right angles: angles from the given direction, -45 to 45 degrees
    turns = (np.arctan2(edges[:, 1], edges[:, 0]) - start + np.pi / 4) % (np.pi / 2) - np.pi / 4
    x = np.stack((np.cos(start + turns), np.sin(start + turns)), 1)
    y = np.stack((-x[:, 1], x[:, 0]), 1)
    sides = np.stack([np.ptp(corners @ axis.T, axis=0) for axis in (x, y)], 1)
    areas = sides.prod(1)
    smallest = np.flatnonzero(areas <= areas.min() * (1 + ALIKE_SIDES))
    # the nearest, and of a pair to either side the one to the left
    order = np.lexsort((-turns[smallest], np.round(np.abs(turns[smallest]) / ALIKE_SIDES)))
    best = smallest[order[0]]
    length, width = sides[best].tolist()
    if width > length * (1 + ALIKE_SIDES):
        return np.stack((y[best], -x[best]))
    return np.stack((x[best], y[best]))
