"""Smooth curves that were saved as polylines."""

from __future__ import annotations

from itertools import pairwise
from typing import Literal

import numpy as np
from scipy.spatial import cKDTree

from lamella.base.arrays import Booleans, Floats
from lamella.base.errors import InputError
from lamella.base.message import Message
from lamella.base.vectors import diagonal
from lamella.base.wording import counted
from lamella.surface.boundary.corners import CORNER_TURN, edge_lengths, find_corners, thinned, turning_angles
from lamella.surface.boundary.pieces import Pieces, lines, stack
from lamella.surface.boundary.scatter import smooth_scatter
from lamella.surface.boundary.splines import closed_spline, open_spline

LITTLE = 20.0
"""Degrees: a polygon of 18 corners turns by as much at each; polygons that are meant have fewer."""

SMOOTH_POINTS_MIN = 16
"""Vertices that turn a little, for a polyline to be a curve and not a polygon."""

STRAIGHT_PIECE = 1e-6
"""Radians; less is no turn."""

LONG = 5.0
"""Times both of its neighbours: such an edge is a straight side, and no step along a curve."""

SMOOTH_POINTS_MAX = 240
"""Vertices of a rim; with more, rounding of the file would show in the curvature between neighbours."""

SMOOTH_OFF = 1e-6
"""Of the size, or of the scatter if that is more: how far vertices that are left out may lie off the curve."""


def smooth_curve(
    points: Floats, interpolation: Literal["spline", "polyline"] | None, where: str
) -> tuple[Pieces, Message | None]:
    """The curve that a closed polyline of a file means, and a remark on it.

    Parameters
    ----------
    points : (n, 3)
        Vertices, m, the first not repeated, no two in a row at one place.
    interpolation : "spline", "polyline" or None
        As the project says. Where it says nothing a polyline is a curve if at least `SMOOTH_POINTS_MIN` of its
        vertices turn by less than `LITTLE`, and the others are corners.
    where : str
        Key for messages.
    """
    corner = find_corners(points, CORNER_TURN)
    turns = turning_angles(points)
    little = ~corner & (turns > STRAIGHT_PIECE)
    is_curve = np.count_nonzero(little) >= SMOOTH_POINTS_MIN and turns[~corner].max() < np.radians(LITTLE)
    if interpolation == "polyline" or (interpolation is None and not is_curve):
        return lines(points, closed=True), None
    if not is_curve:
        # few points of a curve, none of which is a corner where the project says spline
        corner = np.zeros(len(points), bool)
    pieces, off = _curve(points, corner, where)
    reported = f"the polyline of {counted(len(points), 'vertex', 'vertices')} is taken as a smooth curve"
    if corner.any():
        reported += f" with {counted(int(corner.sum()), 'corner')}"
    if off > 0:
        reported += f", which passes its vertices within {1000 * off:.2g} mm"
    if interpolation is None:
        reported += (
            f': they turn by {np.degrees(turns[~corner].max()):.2g} deg at most; write interpolation = "spline" '
            'to say so, or interpolation = "polyline" to keep every one of them as a corner'
        )
    return pieces, Message("polyline_smooth", reported)


def _curve(points: Floats, corner: Booleans, where: str) -> tuple[Pieces, float]:
    """A smooth curve through vertices, with corners, and how far it passes them, m."""
    size = diagonal(points)
    most = SMOOTH_POINTS_MAX
    while True:
        rows: Floats = np.column_stack((points, corner)).astype(np.float64)
        if len(points) > most:
            rows = thinned(rows, corner, float(edge_lengths(points).sum()) / most)
        kept, sharp = rows[:, :3], np.asarray(rows[:, 3] > 0)
        kept, scatter, _ = smooth_scatter(kept, sharp)
        pieces = through_points(kept, sharp | _side_ends(kept), where)
        off = _largest_distance(pieces, points)
        # what is rounding of the file is no reason for more of its vertices
        if off <= max(SMOOTH_OFF * size, 6 * scatter) or len(points) <= most:
            return pieces, off if off > 1e-9 * size else 0.0
        most *= 2


def _side_ends(points: Floats) -> Booleans:
    """Ends of straight sides among the steps of a curve."""
    step = edge_lengths(points)
    long = (step > LONG * np.roll(step, 1)) & (step > LONG * np.roll(step, -1))
    return np.asarray(long | np.roll(long, 1))


def through_points(points: Floats, corner: Booleans, where: str) -> Pieces:
    """Splines through the points of a closed polyline (k, 3), from corner to corner (k,).

    Raises
    ------
    InputError
        Points spaced too unevenly.
    """
    corners = np.flatnonzero(corner)
    if not len(corners):
        return closed_spline(points, where=where)
    points = np.roll(points, -corners[0], axis=0)
    cuts = np.append(corners - corners[0], len(points))
    closed = np.vstack([points, points[:1]])
    return stack([open_spline(closed[a : b + 1], where=where) for a, b in pairwise(cuts)])


def _largest_distance(pieces: Pieces, points: Floats) -> float:
    """Of points from a curve, m."""
    each = max(4, 4 * len(points) // pieces.count)
    piece = np.repeat(np.arange(pieces.count), each)
    s = np.tile((np.arange(each) + 0.5) / each, pieces.count)
    _, near = cKDTree(pieces.evaluate(piece, s)[0]).query(points)
    piece, s = piece[near], s[near]
    # Newton's steps to the foot point: squared, twice, from a quarter of a piece
    for _ in range(3):
        position, first, _ = pieces.evaluate(piece, s)
        s = np.clip(s + ((points - position) * first).sum(1) / (first**2).sum(1), 0.0, 1.0)
    return float(np.linalg.norm(points - pieces.evaluate(piece, s)[0], axis=1).max())


def vertices(pieces: Pieces, interpolation: str | None, where: str) -> Floats | None:
    """Vertices (n, 3) of a curve that is a closed polyline; None: it is none.

    Raises
    ------
    InputError
        `interpolation` is given for what is no polyline.
    """
    if pieces.degree == 1:
        return pieces.starts
    if interpolation is None:
        return None
    raise InputError(
        f'interpolation = "{interpolation}" goes with polylines, and this curve is exact as it is drawn',
        "leave interpolation out",
        where,
    )
