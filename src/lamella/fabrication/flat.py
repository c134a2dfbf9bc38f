"""Areas and extents of flat strips, in closed form."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from lamella.base.arrays import Floats

# straight parts of an arc in pictures
ARC_PARTS = 8


def outline_area(vertices: Floats) -> float:
    """Area in m2 of a closed outline of straight lines and arcs, (v, 3), see `lamella.fabrication.axis.outline`."""
    x, y, bulge = vertices.T
    next_x, next_y = np.roll(x, -1), np.roll(y, -1)
    square = (next_x - x) ** 2 + (next_y - y) ** 2
    angle = 4 * np.arctan(bulge)
    # theta - sin(theta) cancels for flat arcs, where the parabola's segment is exact to rounding
    flat = np.abs(bulge) < 1e-4
    safe = np.where(flat, 1.0, bulge)
    arcs = square * (1 + safe**2) ** 2 / (32 * safe**2) * (angle - np.sin(angle))
    segments = np.where(flat, square * bulge / 3, arcs)
    return float(0.5 * np.sum(x * next_y - next_x * y) + np.sum(segments))


def circle(diameter: float, centre: tuple[float, float] = (0.0, 0.0)) -> Floats:
    """Outline (2, 3) of a circle, m: two half circles."""
    x, y = centre
    return np.array([[x - diameter / 2, y, 1.0], [x + diameter / 2, y, 1.0]])


def outline_points(vertices: Floats, parts: int = ARC_PARTS) -> Floats:
    """Points (n, 2) of an outline, m, closed by its first one: its arcs in so many straight parts each."""
    corners = vertices[:, 0] + 1j * vertices[:, 1]
    half = 2 * np.arctan(vertices[:, 2])[:, None]
    share = np.arange(parts) / parts
    # the chord to a share of the arc, over the whole chord
    part = share * np.sinc(half * share / np.pi) / np.sinc(half / np.pi) * np.exp(1j * half * (share - 1))
    points = corners[:, None] + (np.roll(corners, -1) - corners)[:, None] * part
    kept = np.append(points[(half != 0) | (share == 0)], corners[0])
    return np.column_stack([kept.real, kept.imag])


def extents(lengths: ArrayLike, height: float, curvature: float) -> tuple[Floats, Floats]:
    """Size of a strip laid with its chord horizontal.

    Parameters
    ----------
    lengths : array_like
        Of the centre line, m; at most one turn.
    height : float
        m.
    curvature : float
        1/m.

    Returns
    -------
    half_width, rise : arrays
        Half the width, and how far the strip's tips reach beyond the centre line's middle towards the
        centre of curvature, m. On the other side it reaches half its height.
    """
    length = np.asarray(lengths, float)
    k = abs(curvature)
    half = 0.5 * k * length
    bounded = np.minimum(half, 0.5 * np.pi)
    arc = np.minimum(0.5 * length, 0.5 * np.pi / k) if k else 0.5 * length
    half_width = arc * np.sinc(bounded / np.pi) + 0.5 * height * np.sin(bounded)
    sagitta = 0.5 * length * np.sinc(0.5 * half / np.pi) * np.sin(0.5 * half)
    rise = sagitta + 0.5 * height * np.abs(np.cos(half))
    return np.asarray(half_width), np.asarray(rise)


def longest_fitting(width: float, depth: float, height: float, curvature: float, turn: float) -> float:
    """Length of the longest strip that fits a rectangle with its chord horizontal and turns at most ``turn``.

    Parameters
    ----------
    width, depth : float
        Of the rectangle, m.
    height : float
        Of the strip, m.
    curvature : float
        1/m.
    turn : float
        Largest angle of the strip's circle, rad.

    Returns
    -------
    float
        m; zero where the rectangle is not even as deep as the strip is high.
    """
    if height > depth or width <= 0:
        return 0.0
    low, high = 0.0, width if curvature == 0.0 else turn / abs(curvature)

    def fits(length: float) -> bool:
        half_width, rise = extents(length, height, curvature)
        return bool(2 * half_width <= width) and bool(rise + 0.5 * height <= depth)

    if fits(high):
        return high
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if fits(middle) else (low, middle)
    return low
