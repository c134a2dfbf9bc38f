"""Borders whose vertices scatter about a smooth curve: that curve, as rough as the scatter leaves open.

A spline through scattered vertices wiggles from one to the next. A scatter of s at edges of length h bends it by about
4 s / h^2, and the surface beside it with it: a millimetre at 0.25 m is 0.06/m, and no elements are small enough.
"""

from __future__ import annotations

from itertools import pairwise
from math import factorial

import numpy as np

from lamella.base.arrays import Booleans, Floats

SCATTER_POINTS_MIN = 12
"""A stretch with fewer vertices says too little of what is scatter and what is meant."""

SCATTER_MIN, SCATTER_MAX = 5e-5, 0.05
"""Of the mean edge: less bends a spline by less than a curvature that elements of the default tolerance resolve, more
is no scatter but a shape of few vertices."""

NO_SMOOTHER = 0.5
"""What a polynomial through eight neighbours misses, over what one through six does: about 1 for scatter, at most 0.3
for a smooth curve, even a hexagon's."""

SCATTER_ALTERNATING = -0.7
"""What is missed at neighbouring vertices, as a correlation: -0.89 for scatter, whose eighth differences turn from
vertex to vertex; -0.5 for a smooth curve of three vertices a wave, more for finer ones."""

SCATTER_ORDER = 3
"""Of the differences that are made small; those of second order would pull circles inwards."""


def smooth_scatter(points: Floats, corner: Booleans) -> tuple[Floats, float, float]:
    """Lay a smooth curve through the scattered vertices of a closed border; corners stay where they are.

    The curve has the least sum of (third differences)^2 that leaves the scatter, which is known from what local
    polynomials miss, between it and the vertices.

    Parameters
    ----------
    points : (k, 3)
        Vertices, m.
    corner : (k,) bool

    Returns
    -------
    points : (k, 3)
        The given ones where they do not scatter.
    scatter : float
        Largest root mean square distance of the vertices of a side from a smooth curve, m; 0 where nothing was done.
    move : float
        Largest move, m.
    """
    result = points.copy()
    scatter = 0.0
    ends = np.flatnonzero(corner)
    if not len(ends):
        result, scatter = _smooth(points, closed=True)
    for first, last in pairwise(np.append(ends, ends[:1] + len(points)).tolist()):
        rows = np.arange(first, last + 1) % len(points)
        side, off = _smooth(points[rows], closed=False)
        result[rows[1:-1]] = side[1:-1]
        scatter = max(scatter, off)
    return result, scatter, float(np.linalg.norm(result - points, axis=1).max())


def _smooth(points: Floats, *, closed: bool) -> tuple[Floats, float]:
    """One stretch and its scatter; the ends of an open one stay."""
    count = len(points)
    if count < SCATTER_POINTS_MIN:
        return points, 0.0
    following = np.roll(points, -1, axis=0) if closed else points[1:]
    steps = np.linalg.norm(following - points[: len(following)], axis=1)
    mean = float(steps.mean())
    (six, _), (eight, correlation) = (_residual(points, steps, reach, closed) for reach in (3, 4))
    if (
        not SCATTER_MIN * mean < eight < SCATTER_MAX * mean
        or eight < NO_SMOOTHER * six
        or correlation > SCATTER_ALTERNATING
    ):
        return points, 0.0
    operator = _differences(steps / mean, closed)
    free = np.arange(count) if closed else np.arange(1, count - 1)
    held = np.setdiff1d(np.arange(count), free)
    inner, outer = operator[:, free], operator[:, held]
    values, vectors = np.linalg.eigh(inner.T @ inner)
    values = np.maximum(values, 0)
    start, pull = vectors.T @ points[free], vectors.T @ (inner.T @ (outer @ points[held]))

    def relaxed(weight: float) -> tuple[Floats, float]:
        """The vertices at a weight of the differences, and the scatter these leave, m."""
        moved = vectors @ ((start - weight * pull) / (1 + weight * values)[:, None])
        left = float((weight * values / (1 + weight * values)).sum())
        return moved, float(np.sqrt(((moved - points[free]) ** 2).sum() / max(left, 1e-12)))

    low, high = -8.0, 8.0
    for _ in range(50):
        middle = (low + high) / 2
        if relaxed(10**middle)[1] > eight:
            high = middle
        else:
            low = middle
    result = points.copy()
    result[free] = relaxed(10**low)[0]
    return result, eight


def _residual(points: Floats, steps: Floats, reach: int, closed: bool) -> tuple[float, float]:
    """Scatter across the curve that the polynomials through `reach` neighbours on either side say, m.

    And the correlation of what they miss at neighbouring vertices. Were all coordinates off by s, a polynomial with
    weights w would miss a vertex by s sqrt(1 + sum(w^2)).
    """
    count = len(points)
    offsets = np.array([k for k in range(-reach, reach + 1) if k])
    along = np.concatenate([[0.0], np.cumsum(steps)])
    if closed:
        index = np.arange(count)[:, None] + offsets
        place = along[index % count] + along[-1] * (index // count)
        index, here = index % count, along[:count, None]
    else:
        index = np.arange(reach, count - reach)[:, None] + offsets
        place, here = along[index], along[reach : count - reach, None]
    place = place - here
    apart = place[:, None, :] - place[:, :, None]
    ratio = np.where(np.eye(2 * reach, dtype=bool), 1.0, place[:, None, :] / np.where(apart == 0, 1.0, apart))
    weights = ratio.prod(axis=2)
    middle = slice(None) if closed else slice(reach, count - reach)
    off = points[middle] - np.einsum("nk,nkc->nc", weights, points[index])
    chord = points[index[:, reach]] - points[index[:, reach - 1]]
    chord /= np.linalg.norm(chord, axis=1)[:, None]
    # along the curve a vertex may be where it likes; both directions across it count
    off -= (off * chord).sum(1)[:, None] * chord
    off /= np.sqrt(1 + (weights**2).sum(1))[:, None]
    square = float((off**2).sum())
    correlation = float((off[1:] * off[:-1]).sum()) / max(square, np.finfo(float).tiny)
    return float(np.sqrt(square / len(off))), correlation


def _differences(steps: Floats, closed: bool) -> Floats:
    """Matrix of the divided differences of third order of a stretch with given steps."""
    count = len(steps) if closed else len(steps) + 1
    rows = count if closed else count - SCATTER_ORDER
    along = np.concatenate([[0.0], np.cumsum(steps)])
    index = np.arange(rows)[:, None] + np.arange(SCATTER_ORDER + 1)
    place = along[index % count] + (along[-1] * (index // count) if closed else 0.0)
    apart = place[:, :, None] - place[:, None, :]
    apart[:, range(SCATTER_ORDER + 1), range(SCATTER_ORDER + 1)] = 1.0
    result = np.zeros((rows, count))
    np.put_along_axis(result, index % count, factorial(SCATTER_ORDER) / apart.prod(axis=2), axis=1)
    return result
