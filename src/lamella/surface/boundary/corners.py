"""Closed polylines that mean curves: their turns, their corners, and vertices that are too near one another."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Booleans, Floats

CORNER_TURN = 40.0
"""Degrees."""

ALWAYS_CORNER = 59.0
"""Degrees; a smooth loop with such turns would have six vertices or fewer, too few to be meant as a smooth one."""

SHARPER = 2.0
"""A corner turns more than this times what the curvature beside it suggests."""


def edge_lengths(points: Floats) -> Floats:
    """Length of the edge after each point of a closed polyline, m."""
    return np.asarray(np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1))


def turning_angles(points: Floats) -> Floats:
    """Angle between the edges before and after each point of a closed polyline, radians, 0 to pi, (k,)."""
    after = np.roll(points, -1, axis=0) - points
    before = np.roll(after, 1, axis=0)
    sine = np.linalg.norm(np.cross(before, after), axis=1)
    return np.asarray(np.arctan2(sine, np.einsum("ij,ij->i", before, after)))


def find_corners(points: Floats, corner_angle: float = CORNER_TURN) -> Booleans:
    """Corners of the curve that a closed polyline (k, 3) means, bool (k,).

    A corner turns by more than `corner_angle`, degrees, and by more than twice what the curvature on both sides of it
    suggests, so that a coarse circle has none; turns of 60 degrees and more are corners if `corner_angle` allows.
    """
    angle = turning_angles(points)
    step = edge_lengths(points)
    reach = (step + np.roll(step, 1)) / 2
    curvature = angle / reach
    limit = np.radians(corner_angle)
    corner = angle > max(limit, np.radians(ALWAYS_CORNER))
    # A corner says nothing about the curvature beside it: its neighbours are judged by their other sides.
    for _ in range(len(points)):
        sides = [np.roll(curvature, shift) for shift in (1, -1)]
        unknown = [np.roll(corner, shift) for shift in (1, -1)]
        known = np.sum(~np.array(unknown), axis=0)
        suggested = np.sum(np.where(unknown, 0.0, sides), axis=0) / np.maximum(known, 1) * reach
        found = corner | ((angle > limit) & (angle > SHARPER * suggested))
        if (found == corner).all():
            break
        corner = found
    return np.asarray(corner)


def thinned(rows: Floats, fixed: Booleans, limit: float) -> Floats:
    """Drop vertices until none is nearer than `limit` to the next: of two, the one that bends the curve less.

    Parameters
    ----------
    rows : (k, 3 or more)
        Points, and what goes with them.
    fixed : (k,) bool
        Vertices that stay.
    limit : float
        m.
    """
    while len(rows) > 4:
        points = rows[:, :3]
        step = edge_lengths(points)
        nearest = np.minimum(step, np.roll(step, 1))
        chord = np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0)
        length = np.maximum(np.linalg.norm(chord, axis=1), np.finfo(float).tiny)
        offset = np.linalg.norm(np.cross(points - np.roll(points, 1, axis=0), chord), axis=1) / length
        # Shortest edge first; the offset decides between its two ends.
        rank = np.where((nearest < limit) & ~fixed, nearest + 1e-3 * np.minimum(offset, limit), np.inf)
        # One of each neighbourhood at a time, so that no stretch vanishes whole.
        lowest = np.minimum(np.roll(rank, 1), np.roll(rank, -1))
        goes = np.isfinite(rank) & ((rank < lowest) | ((rank == lowest) & _first_of_ties(rank)))
        if not goes.any() or len(rows) - np.count_nonzero(goes) < 4:
            break
        rows, fixed = rows[~goes], fixed[~goes]
    return rows


def _first_of_ties(rank: Floats) -> Booleans:
    """Every other one of a run of equal ranks, so that neighbours do not wait for one another."""
    same = rank == np.roll(rank, 1)
    same[0] = False
    begin = np.flatnonzero(~same)
    position = np.arange(len(rank)) - np.repeat(begin, np.diff(begin, append=len(rank)))
    even = position % 2 == 0
    # Around the end of the loop the first one wins.
    even[-1] &= rank[-1] != rank[0]
    return np.asarray(even)
