"""Where lamellas of a flat net cross that are not joined there."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from lamella.base.arrays import Floats, Integers


def crossings_beside_nodes(points: Floats, shared: Integers) -> tuple[Integers, Floats]:
    """Crossings of the segments of several lines in a plane, where the lines are not joined.

    Parameters
    ----------
    points : (s, 2, 2)
        Ends of the segments, m.
    shared : (s, 2) int
        Number of the node at each end of the part of the line that the segment is of: segments of parts with a node
        in common do not count, as they meet there.

    Returns
    -------
    pairs : (c, 2) int
        Segments that cross.
    places : (c, 2)
        m.
    """
    one, other = _near(points)
    joined = (shared[one][:, :, None] == shared[other][:, None, :]).any((1, 2))
    one, other = one[~joined], other[~joined]
    p, d = points[one, 0], points[one, 1] - points[one, 0]
    q, e = points[other, 0], points[other, 1] - points[other, 0]
    across = d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0]
    away = q - p
    with np.errstate(divide="ignore", invalid="ignore"):
        along = (away[:, 0] * e[:, 1] - away[:, 1] * e[:, 0]) / across
        beside = (away[:, 0] * d[:, 1] - away[:, 1] * d[:, 0]) / across
        cross = (along >= 0) & (along <= 1) & (beside >= 0) & (beside <= 1)
    pairs = np.stack((one[cross], other[cross]), 1)
    return pairs, np.asarray(p[cross] + along[cross, None] * d[cross])


def _near(points: Floats) -> tuple[Integers, Integers]:
    """Segments whose circumscribed circles meet."""
    middles = points.mean(1)
    half = 0.5 * float(np.linalg.norm(points[:, 1] - points[:, 0], axis=1).max(initial=0.0))
    pairs = cKDTree(middles).query_pairs(2 * half, output_type="ndarray")
    order = np.lexsort((pairs[:, 1], pairs[:, 0]))
    return pairs[order, 0], pairs[order, 1]
