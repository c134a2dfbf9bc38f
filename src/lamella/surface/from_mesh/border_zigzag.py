"""Borders that go to and fro, like the edge of a picture made of squares."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import BSpline

from lamella.base.arrays import Floats

MEAN_TURN = np.radians(20.0)
TURN = np.radians(10.0)
"""Smaller turns are straight stretches between teeth."""

BORDER_ALTERNATING = 0.6
"""Part of the turns that are followed by one to the other side."""

OF_DEPTH = 0.75
"""A curve through the middle of the teeth is half their depth away; a little more is left for uneven ones."""

BORDER_VERTICES_MIN = 12
"""A loop with fewer vertices has no teeth, only corners."""


def signed_turns(points: Floats, normals: Floats) -> Floats:
    """Turning angles of a closed polyline (k, 3), radians, positive to the left about the normals (k, 3)."""
    after = np.roll(points, -1, axis=0) - points
    before = np.roll(after, 1, axis=0)
    cross = np.cross(before, after)
    size = np.arctan2(np.linalg.norm(cross, axis=1), np.einsum("ij,ij->i", before, after))
    return np.asarray(np.where(np.einsum("ij,ij->i", cross, normals) < 0, -size, size))


def is_zigzag(points: Floats, normals: Floats) -> bool:
    """Whether the turns of a closed polyline are large and alternate in sign."""
    if len(points) < BORDER_VERTICES_MIN:
        return False
    turns = signed_turns(points, normals)
    teeth = turns[np.abs(turns) > TURN]
    if len(teeth) < BORDER_VERTICES_MIN or np.abs(turns).mean() <= MEAN_TURN:
        return False
    return bool(np.mean(teeth * np.roll(teeth, -1) < 0) > BORDER_ALTERNATING)


def smooth_zigzag(points: Floats) -> tuple[Floats, float]:
    """Lay a closed cubic spline through a zigzag by least squares.

    The spline has as few spans as leave no vertex further away than `OF_DEPTH` of the deepest tooth.

    Returns
    -------
    points : (k, 3)
        On the spline, one for each vertex.
    move : float
        Largest distance of a vertex from its point, m.
    """
    before, after = np.roll(points, 1, axis=0), np.roll(points, -1, axis=0)
    depth = float(np.linalg.norm(points - (before + after) / 2, axis=1).max())
    guide = points
    # The teeth would lengthen the arc where they are: the parameter is taken along a smoothed copy.
    for _ in range(4):
        guide = (np.roll(guide, 1, axis=0) + 2 * guide + np.roll(guide, -1, axis=0)) / 4
    steps = np.linalg.norm(np.roll(guide, -1, axis=0) - guide, axis=1)
    along = np.concatenate(([0.0], np.cumsum(steps)[:-1])) / steps.sum()
    spans = max(4, min(8, len(points) // 4))
    while True:
        smooth = _closed_spline(points, along, spans)
        move = float(np.linalg.norm(smooth - points, axis=1).max())
        wider = max(spans + 1, spans * 5 // 4)
        if move <= OF_DEPTH * depth or 4 * wider > len(points):
            return smooth, move
        spans = wider


def _closed_spline(points: Floats, along: Floats, spans: int) -> Floats:
    """Values at parameters `along` (0 to 1) of the closed uniform cubic spline nearest to points, (k, 3)."""
    knots = np.arange(-3, spans + 4) / spans
    basis = BSpline.design_matrix(along, knots, 3).toarray()
    # Closed: the last three coefficients are the first three again.
    basis[:, :3] += basis[:, spans:]
    basis = basis[:, :spans]
    return np.asarray(basis @ np.linalg.lstsq(basis, points, rcond=None)[0])
