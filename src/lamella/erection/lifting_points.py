"""Nodes that a net is lifted at: two, three or four around its centre of gravity."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.errors import InputError
from lamella.segments.lifting import lifting_nodes

BESSEL = 0.5594
"""Of half a bar's length: from its middle to where it is supported so that it keeps its length best (F. W. Bessel)."""
# of a distance over the net's extent: nodes that are as near but for that are alike
NEAR_DIGITS = 6


def lifting_points(nodes: Integers, points: Floats, centre: Floats, count: int) -> Integers:
    """Nodes to lift at.

    Two are on the longer axis of inertia in plan, four on both, each nearest to Bessel's share of the extent to either
    side of the centre of gravity; three are the largest triangle around it of which each carries a fifth or more.

    Parameters
    ----------
    nodes : (n,) int
        That may be lifted.
    points : (n, 3)
        Where they are, m; z up.
    centre : (3,)
        Of gravity, m.
    count : int
        2, 3 or 4.

    Returns
    -------
    (count,) int
        Empty where there are none.

    Raises
    ------
    InputError
        Another count.
    """
    if count not in (2, 3, 4):
        raise InputError(f"{count} lifting points", "they are 2, 3 or 4", "count")
    if count == 3:
        return np.sort(lifting_nodes(nodes, points, centre)[0])
    if len(nodes) < count:
        return nodes[:0]
    flat = points[:, :2] - centre[:2]
    longer, shorter = _axes(flat)
    goals = [side * BESSEL * float(np.abs(flat @ longer).max()) * longer for side in (1.0, -1.0)]
    if count == 4:
        goals += [side * BESSEL * float(np.abs(flat @ shorter).max()) * shorter for side in (1.0, -1.0)]
    size = float(np.linalg.norm(flat, axis=1).max())
    away = np.linalg.norm(flat - np.array(goals)[:, None], axis=2) / size
    found = np.unique(nodes[np.round(away, NEAR_DIGITS).argmin(1)])
    return found if len(found) == count else nodes[:0]


def _axes(flat: Floats) -> tuple[Floats, Floats]:
    """Directions of largest and smallest extent in plan; x and y where there is none."""
    spread = np.round(flat.T @ flat / np.trace(flat.T @ flat), NEAR_DIGITS)
    if abs(spread[0, 1]) < 1e-3 and abs(spread[0, 0] - spread[1, 1]) < 1e-3:
        return np.array([1.0, 0.0]), np.array([0.0, 1.0])
    angle = 0.5 * np.arctan2(2 * spread[0, 1], spread[0, 0] - spread[1, 1])
    return np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
