"""Curves shifted by waves along their length, exactly as smooth as they were.

The shift of a curve x(s) at the fraction t of its arc length is

    d(t) = a0 + sum over k of (a_k cos 2 pi k t + b_k sin 2 pi k t)

with vectors a, b. x + d is no rational curve, as t is no polynomial of s. Each piece is cut into short ones, and d
taken on them as the quintic with its value and first two derivatives by s at both ends: tangent and curvature of x + d
are met where pieces join, so that corners stay corners and smooth joints smooth, and between the error is of sixth
order in the length of the pieces (4e-9 of the amplitude for four waves).
"""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Booleans, Floats
from lamella.surface.boundary.curve import Loop
from lamella.surface.boundary.pieces import Pieces

WAVE_PARTS = 128
"""Least number of pieces a waved curve has."""


def wave_rows(t: Floats, waves: int) -> Floats:
    """1, cos 2 pi k t and sin 2 pi k t for k = 1 .. waves, (2 waves + 1, n)."""
    angle = 2 * np.pi * np.outer(np.arange(1, waves + 1), t)
    both = np.stack([np.cos(angle), np.sin(angle)], 1).reshape(2 * waves, len(t))
    return np.vstack([np.ones(len(t)), both])


def waved(loop: Loop, shifts: Floats) -> tuple[Pieces, Booleans]:
    """The pieces of a loop shifted by waves.

    Parameters
    ----------
    loop : Loop
    shifts : (2 k + 1, 3)
        a0, a_1, b_1, ..., a_k, b_k, m.

    Returns
    -------
    pieces : Pieces
        m.
    drawn : (m,) bool
        Which of them begin where a piece of the loop does.
    """
    course = loop.course
    ends = np.append(course.joints, course.length)
    counts = np.maximum(np.ceil(np.diff(ends) * (WAVE_PARTS / course.length)).astype(int), 1)
    piece = np.repeat(np.arange(course.pieces.count), counts)
    first = np.concatenate([[0], np.cumsum(counts)[:-1]])
    share = (np.arange(len(piece)) - first[piece]) / counts[piece]
    start = ends[piece] + share * np.diff(ends)[piece]
    # parameters of even parts of the arc; the very ends of pieces exactly
    low = np.where(share == 0, 0.0, course.locate(start)[1])
    high = np.append(low[1:], 0.0)
    high[np.append(first[1:], len(piece)) - 1] = 1.0
    short = course.pieces.cut(piece, low, high).transformed(1.0, course.origin)
    fractions = np.stack([start, np.append(start[1:], course.length)]) / course.length
    fields = [
        _jet(course.pieces.evaluate(piece, s)[1:], high - low, t, loop.length, shifts)
        for s, t in zip((low, high), fractions, strict=True)
    ]
    return short.shifted(_quintic(*fields)), share == 0


def _jet(
    derivatives: tuple[Floats, Floats], width: Floats, t: Floats, length: float, shifts: Floats
) -> tuple[Floats, Floats, Floats]:
    """d and its first two derivatives by the parameter of short pieces, (n, 3) each, m."""
    first, second = (d * width[:, None] ** (k + 1) for k, d in enumerate(derivatives))
    speed = np.linalg.norm(first, axis=1)
    # of t by the parameter
    slope = (speed / length)[:, None]
    bend = (np.einsum("nc,nc->n", first, second) / (speed * length))[:, None]
    waves = len(shifts) // 2
    turn = np.repeat(2 * np.pi * np.arange(1, waves + 1), 2)
    rows = wave_rows(t, waves)
    # of cos: -sin, of sin: cos
    crossed = (
        rows[1:].reshape(waves, 2, len(t))[:, ::-1].reshape(2 * waves, len(t)) * np.tile([-1.0, 1.0], waves)[:, None]
    )
    by_t = (turn[:, None] * crossed).T @ shifts[1:]
    by_tt = -((turn**2)[:, None] * rows[1:]).T @ shifts[1:]
    return rows.T @ shifts, slope * by_t, slope**2 * by_tt + bend * by_t


def _quintic(start: tuple[Floats, Floats, Floats], end: tuple[Floats, Floats, Floats]) -> Floats:
    """Bezier points (n, 6, 3) of the quintics with value and two derivatives at both ends."""
    (a, da, dda), (b, db, ddb) = start, end
    return np.stack(
        [a, a + da / 5, a + 2 / 5 * da + dda / 20, b - 2 / 5 * db + ddb / 20, b - db / 5, b],
        axis=1,
    )
