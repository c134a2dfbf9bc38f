"""The densest lattice of equal flat shapes: at which steps copies of one shape stand clear of each other.

A shape is drawn on a grid, with every cell whose middle is within half the gap, and half a cell's diagonal, of it:
where two such drawings share no cell the shapes are a gap apart or more. The steps at which they do are those where
the drawing's autocorrelation is 0 (no-fit polygons on a raster: J. A. Bennell, J. F. Oliveira, The geometry of nesting
problems: a tutorial, European Journal of Operational Research 184 (2008) 397). Of all pairs of steps at the border of
these, with all small sums free too, the one with the least area of its cell is the densest lattice.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers

GRID = 96
"""Cells along the longer side of a shape."""
SUMS = 3
"""Multiples of either step that are looked at."""


@dataclass(frozen=True, eq=False)
class Lattice:
    """Two steps of a lattice.

    Attributes
    ----------
    steps : (2, 2)
        Rows, m.
    """

    steps: Floats

    @property
    def area(self) -> float:
        """Of its cell: what one shape takes with what is lost around it, m2."""
        (a, b), (c, d) = self.steps.tolist()
        return float(abs(a * d - b * c))

    def points(self, width: float, height: float) -> Floats:
        """All its points from (0, 0) to (width, height), by x and then y, (n, 2), m."""
        # multiples that may lie there
        corners = np.array([[0.0, 0.0], [width, 0.0], [0.0, height], [width, height]])
        low, high = (f(corners @ np.linalg.inv(self.steps), axis=0) for f in (np.min, np.max))
        first, last = np.floor(low).astype(np.int64), np.ceil(high).astype(np.int64)
        i, j = np.meshgrid(np.arange(first[0], last[0] + 1), np.arange(first[1], last[1] + 1), indexing="ij")
        found = np.column_stack([i.ravel(), j.ravel()]) @ self.steps
        # a point on an edge is within it, whatever the last bits say
        there = np.round(found, 9)
        found = there[((there >= 0) & (there <= [width + 1e-9, height + 1e-9])).all(axis=1)]
        return np.asarray(found[np.lexsort((found[:, 1], found[:, 0]))])


def densest_lattice(outline: Floats, gap: float) -> Lattice:
    """The lattice of copies of a shape with a gap between them that takes least area.

    Parameters
    ----------
    outline : (n, 2)
        Corners of the shape, m; holes count as filled.
    gap : float
        m.
    """
    cell = float(np.ptp(outline, axis=0).max()) / GRID
    hits = _hits(_drawn(outline, gap, cell))
    middle = np.array(hits.shape) // 2
    border = _border(hits)
    steps = np.argwhere(border) - middle
    # a step and its opposite are one
    steps = steps[(steps[:, 0] > 0) | ((steps[:, 0] == 0) & (steps[:, 1] > 0))]
    first, second = (one.ravel() for one in np.triu_indices(len(steps), 1))
    area = np.abs(steps[first, 0] * steps[second, 1] - steps[first, 1] * steps[second, 0])
    order = np.argsort(area, kind="stable")
    order = order[area[order] > 0]
    for some in np.array_split(order, max(len(order) // 4096, 1)):
        free = _all_free(hits, steps[first[some]], steps[second[some]], middle)
        if free.any():
            best = some[int(np.argmax(free))]
            return Lattice(cell * np.stack([steps[first[best]], steps[second[best]]]).astype(float))
    # bounding boxes side by side are always free
    size = np.ptp(outline, axis=0) + gap
    return Lattice(np.diag(size))


def _drawn(outline: Floats, gap: float, cell: float) -> Booleans:
    """Cells of a grid that are within half a gap of a shape."""
    reach = gap / 2 + cell / np.sqrt(2)
    low, high = outline.min(axis=0) - reach, outline.max(axis=0) + reach
    number = np.ceil((high - low) / cell).astype(np.int64) + 1
    x, y = (low[k] + cell * np.arange(number[k]) for k in (0, 1))
    begin = outline if not np.array_equal(outline[0], outline[-1]) else outline[:-1]
    end = np.roll(begin, -1, axis=0)
    points = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    inside = np.zeros(len(points), bool)
    nearest = np.full(len(points), np.inf)
    for a, b in zip(begin, end, strict=True):
        along = b - a
        share = np.clip((points - a) @ along / max(float(along @ along), 1e-30), 0.0, 1.0)
        nearest = np.minimum(nearest, ((points - a - share[:, None] * along) ** 2).sum(axis=1))
        if a[1] != b[1]:
            crosses = (a[1] > points[:, 1]) != (b[1] > points[:, 1])
            inside ^= crosses & (points[:, 0] < a[0] + (points[:, 1] - a[1]) / along[1] * along[0])
    return np.asarray((inside | (nearest <= (reach * (1 + 1e-9)) ** 2)).reshape(tuple(number)))


def _hits(drawn: Booleans) -> Booleans:
    """Steps at which a drawing and its copy share a cell; no step is in the middle."""
    shape = tuple(2 * n + 1 for n in drawn.shape)
    spectrum = np.fft.rfft2(drawn.astype(float), shape)
    shared = np.fft.irfft2(np.abs(spectrum) ** 2, shape)
    return np.asarray(np.fft.fftshift(shared) > 0.5)


def _border(hits: Booleans) -> Booleans:
    """Free steps next to those that hit."""
    beside = np.zeros(hits.shape, bool)
    beside[1:] |= hits[:-1]
    beside[:-1] |= hits[1:]
    beside[:, 1:] |= hits[:, :-1]
    beside[:, :-1] |= hits[:, 1:]
    return np.asarray(beside & np.logical_not(hits))


def _all_free(hits: Booleans, first: Integers, second: Integers, middle: Integers) -> Booleans:
    """Pairs of steps (p, 2) of which no small sum hits, (p,)."""
    free = np.ones(len(first), bool)
    for i in range(SUMS + 1):
        for j in range(-SUMS, SUMS + 1):
            if (i, j) <= (0, 0):
                continue
            at = i * first + j * second + middle
            within: Booleans = np.all((at >= 0) & (at < hits.shape), axis=1)
            at = np.where(within[:, None], at, 0)
            free &= ~(within & hits[at[:, 0], at[:, 1]])
    return free
