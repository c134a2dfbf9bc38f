"""Circles, arcs and ellipses as rational quadratic pieces, exactly."""

from __future__ import annotations

import math

import numpy as np

from lamella.base.arrays import Floats
from lamella.surface.boundary.pieces import Pieces, lines

_WIDEST = math.pi / 2
"""A piece of more than half a turn has no rational quadratic of positive weights; quarters are well conditioned."""

STRAIGHT_ARC = 1e-10
"""Of its chord: an arc of less height is a straight line. Programs write such bulges for straight sides."""


def ellipse_arc(center: Floats, major: Floats, minor: Floats, start: float, sweep: float) -> Pieces:
    """The curve center + cos(a) major + sin(a) minor for a from start to start + sweep.

    Parameters
    ----------
    center, major, minor : (3,)
        m.
    start, sweep : float
        Radians; sweep not 0, at most a full turn either way. A full turn is closed to the last bit.
    """
    n = max(1, math.ceil(abs(sweep) / _WIDEST - 1e-12))
    angles = start + sweep * np.arange(n + 1) / n
    half = sweep / n / 2
    middle = (angles[:-1] + angles[1:]) / 2
    ends = center + np.cos(angles)[:, None] * major + np.sin(angles)[:, None] * minor
    if abs(sweep) >= 2 * math.pi:
        ends[-1] = ends[0]
    w = math.cos(half)
    controls = np.ones((n, 3, 4))
    controls[:, 0, :3], controls[:, 2, :3] = ends[:-1], ends[1:]
    controls[:, 1, :3] = w * center + np.cos(middle)[:, None] * major + np.sin(middle)[:, None] * minor
    controls[:, 1, 3] = w
    return Pieces(controls)


def circle(center: Floats, radius: float, normal: Floats) -> Pieces:
    """A circle, counter-clockwise seen from the tip of its normal (3,); it begins towards +x where it can."""
    z = normal / np.linalg.norm(normal)
    side = np.array([1.0, 0.0, 0.0]) if abs(z[0]) < 0.9 else np.array([0.0, 1.0, 0.0])
    x = side - (side @ z) * z
    x /= np.linalg.norm(x)
    return ellipse_arc(center, radius * x, radius * np.cross(z, x), 0.0, 2 * math.pi)


def bulge_arc(start: Floats, end: Floats, bulge: float, normal: Floats) -> Pieces:
    """Arc between two points; bulge is the tangent of a quarter of its sweep, positive counter-clockwise.

    Built from the chord and not from the centre, which lies far off for flat arcs.

    Parameters
    ----------
    start, end : (3,)
        Different points, m.
    bulge : float
        0: a straight line, of degree 1; so is what leaves its chord by less than `STRAIGHT_ARC` of it.
    normal : (3,)
        Unit normal of the arc's plane.
    """
    if abs(bulge) < 2 * STRAIGHT_ARC:
        return lines(np.array([start, end]), closed=False)
    chord = end - start
    right = np.cross(chord, normal)
    middle = (start + end) / 2
    sweep = 4 * math.atan(bulge)
    if abs(sweep) > _WIDEST:
        top = middle + bulge / 2 * right
        half = math.tan(sweep / 8)
        halves = (bulge_arc(start, top, half, normal), bulge_arc(top, end, half, normal))
        return Pieces(np.concatenate([part.controls for part in halves]))
    w = math.cos(sweep / 2)
    controls = np.ones((1, 3, 4))
    controls[0, 0, :3], controls[0, 2, :3] = start, end
    controls[0, 1, :3] = w * middle + math.sin(sweep / 2) / 2 * right
    controls[0, 1, 3] = w
    return Pieces(controls)


def arc_through(start: Floats, middle: Floats, end: Floats) -> Pieces | None:
    """Arc from start through middle to end, each (3,) in m; None when they lie on a line."""
    first, second = middle - start, end - middle
    across = np.cross(first, second)
    turn = math.atan2(float(np.linalg.norm(across)), float(first @ second))
    if not 1e-9 < turn < math.pi - 1e-9:
        return None
    # the angle at the middle point stands on the rest of the circle, so the sweep is twice the turn there
    return bulge_arc(start, end, math.tan(turn / 2), across / np.linalg.norm(across))
