"""The flat strip: developed points, outlines with slots, areas and extents, all in closed form.

A strip's centre line is developed to a straight line or to a circle of curvature kappa (1/m, > 0 where it
bends towards +n). A point of the strip is told by its station s along the centre line and its height z
towards +n (m). The drawing's origin is the centre line's point at station ``origin``, x points along the
strip there and y towards +n.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]


def develop(stations: ArrayLike, heights: ArrayLike, curvature: float, origin: float) -> Floats:
    """Points of the flat strip in the plane.

    Equal to ``((1/k - z) sin k(s - o), 1/k - (1/k - z) cos k(s - o))``, written so that it neither divides
    by nor cancels against a small curvature.

    Parameters
    ----------
    stations, heights : array_like
        s and z, m, of shapes that broadcast together.
    curvature : float
        Of the centre line, 1/m.
    origin : float
        Station of the drawing's origin, m.

    Returns
    -------
    (..., 2) array
        x, y in m.
    """
    s, z = np.broadcast_arrays(np.asarray(stations, float) - origin, np.asarray(heights, float))
    half = 0.5 * curvature * s
    chord = s * np.sinc(half / np.pi)
    x = chord * np.cos(half) - z * np.sin(2 * half)
    y = chord * np.sin(half) + z * np.cos(2 * half)
    return np.stack((x, y), axis=-1)


def edge_station(across: float, height: float, curvature: float) -> float:
    """Station from a slot's axis, m, of the edge at ``height`` where it is ``across`` away from the axis."""
    if curvature == 0.0:
        return across
    return float(np.arcsin(curvature * across / (1 - curvature * height)) / curvature)


def outline(
    start: float,
    end: float,
    height: float,
    curvature: float,
    slots: Floats,
    slot_width: float,
    from_above: bool,
) -> Floats:
    """Closed counter-clockwise outline of a strip, its slots as notches.

    A slot's sides are parallel to its axis, which is perpendicular to the centre line; its foot touches the
    centre line. The first vertex is the start's corner on the -n side, the last one that on the +n side.

    Parameters
    ----------
    start, end : float
        Stations of the ends, m.
    height : float
        Of the strip, m.
    curvature : float
        1/m.
    slots : (k,)
        Ascending stations of the slots' axes, m.
    slot_width : float
        m.
    from_above : bool
        Whether slots begin at the +n edge.

    Returns
    -------
    (v, 3) array
        x, y in m and the bulge (tangent of a quarter of the arc's angle) of the segment to the next vertex.
    """
    origin = 0.5 * (start + end)
    side = 0.5 * height if from_above else -0.5 * height
    plain = _chain(start, end, -side, curvature, slots[:0], slot_width, origin)
    notched = _chain(start, end, side, curvature, slots, slot_width, origin)
    below, above = (plain, notched) if from_above else (notched, plain)
    back = above[::-1].copy()
    back[:-1, 2], back[-1, 2] = -above[-2::-1, 2], 0.0
    return np.concatenate((below, back))


def _chain(start: float, end: float, z: float, curvature: float, slots: Floats, width: float, origin: float) -> Floats:
    """One edge from start to end with its notches, (v, 3) as in `outline`."""
    p = 0.5 * width
    scale = 1 - curvature * z
    q = z + curvature * p * p / (scale + np.sqrt(scale * scale - (curvature * p) ** 2))
    reach = edge_station(p, z, curvature)
    local = np.array([(-p, q), (-p, 0.0), (p, 0.0), (p, q)])
    angle = curvature * (slots - origin)
    along = np.stack((np.cos(angle), np.sin(angle)), axis=-1)
    across = np.stack((-along[:, 1], along[:, 0]), axis=-1)
    feet = develop(slots, 0.0, curvature, origin)
    notches = feet[:, None] + local[:, :1] * along[:, None] + local[:, 1:] * across[:, None]
    corners = develop([start, end], z, curvature, origin)
    result = np.zeros((4 * len(slots) + 2, 3))
    result[0, :2], result[-1, :2] = corners
    result[1:-1, :2] = notches.reshape(-1, 2)
    arcs = np.append(slots - reach, end) - np.append(start, slots + reach)
    result[:-1:4, 2] = np.tan(0.25 * curvature * arcs)
    return result


def outline_area(vertices: Floats) -> float:
    """Area in m2 of a closed outline of straight lines and arcs, (v, 3) as in `outline`; exact."""
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
