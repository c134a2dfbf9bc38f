"""Which triangle is seen at each pixel: a z-buffer in whole-array numpy, the same bits in every run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lamella.base.arrays import Floats, Integers

NO_TRIANGLE = -1
"""Where no triangle is seen."""

BATCH_PIXELS = 4_000_000
"""Pixels of triangles that are looked at together: some 200 MB."""

DEPTH_LEVELS = 2**31 - 1
"""Steps from the nearest to the farthest depth."""


@dataclass(frozen=True, eq=False)
class Seen:
    """What is seen.

    Attributes
    ----------
    triangle : (height, width) int
        Index of the triangle at the middle of each pixel; `NO_TRIANGLE` where there is none.
    depth : (height, width)
        Of it there; infinite where there is none.
    """

    triangle: Integers
    depth: Floats


def rasterise(corners: Floats, depth: Floats, width: int, height: int) -> Seen:
    """The nearest triangle at the middle of every pixel.

    Parameters
    ----------
    corners : (t, 3, 2)
        In pixels, x to the right and y down; the middle of the first pixel is (0.5, 0.5).
    depth : (t, 3)
        Smaller is nearer, and linear over the picture: -1 / distance of a perspective, the distance of a parallel view.
    width, height : int
    """
    best = np.full(width * height, np.iinfo(np.int64).max, np.int64)
    plane, solid = _depth_planes(corners, depth)
    corners = np.where(solid[:, None, None], corners, 0.0)
    low, high = (float(depth[solid].min()), float(depth[solid].max())) if solid.any() else (0.0, 0.0)
    scale = DEPTH_LEVELS / (high - low) if high > low else 1.0
    rows = _Rows.of(corners, solid, height)
    for first, last in _batches(rows.pixels(corners, width), BATCH_PIXELS):
        triangle, x, y = rows.spans(corners, width, first, last)
        level = (plane[triangle, 0] * (x + 0.5) + plane[triangle, 1] * (y + 0.5) + plane[triangle, 2] - low) * scale
        # of two at one depth the first
        key = (np.clip(level, 0, DEPTH_LEVELS).astype(np.int64) << 32) | triangle
        np.minimum.at(best, y * width + x, key)
    empty = best == np.iinfo(np.int64).max
    found = np.where(empty, NO_TRIANGLE, best & 0xFFFFFFFF)
    away = np.where(empty, np.inf, low + (best >> 32) / scale)
    return Seen(found.reshape(height, width), away.reshape(height, width))


def _depth_planes(corners: Floats, depth: Floats) -> tuple[Floats, NDArray[np.bool_]]:
    """Coefficients (t, 3) of the depth over the picture, and which triangles have an area there."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (c[:, 0] - a[:, 0]) * (b[:, 1] - a[:, 1])
    solid = np.isfinite(area) & (np.abs(area) > 0)
    over = np.divide(1.0, area, out=np.zeros(len(area)), where=solid)
    rise, rise2 = depth[:, 1] - depth[:, 0], depth[:, 2] - depth[:, 0]
    dx = (rise * (c[:, 1] - a[:, 1]) - rise2 * (b[:, 1] - a[:, 1])) * over
    dy = (rise2 * (b[:, 0] - a[:, 0]) - rise * (c[:, 0] - a[:, 0])) * over
    return np.stack([dx, dy, depth[:, 0] - dx * a[:, 0] - dy * a[:, 1]], axis=1), solid


@dataclass(frozen=True, eq=False)
class _Rows:
    """The rows of pixels that each triangle crosses, one after the other: their triangles and their numbers."""

    triangle: Integers
    row: Integers

    @classmethod
    def of(cls, corners: Floats, solid: NDArray[np.bool_], height: int) -> _Rows:
        first = np.clip(np.ceil(corners[:, :, 1].min(1) - 0.5), 0, height)
        last = np.clip(np.floor(corners[:, :, 1].max(1) - 0.5), -1, height - 1)
        counts = np.where(solid, np.maximum(last - first + 1, 0), 0).astype(np.int64)
        triangle = np.repeat(np.arange(len(corners)), counts)
        starts = np.repeat(np.cumsum(counts) - counts, counts)
        return cls(triangle, np.arange(len(triangle)) - starts + first.astype(np.int64)[triangle])

    def pixels(self, corners: Floats, width: int) -> Integers:
        """Number of pixels in each row, in pieces that fit into memory."""
        counts = np.zeros(len(self.row), np.int64)
        for begin in range(0, len(self.row), BATCH_PIXELS):
            some = slice(begin, begin + BATCH_PIXELS)
            first, last = self._ends(corners, width, some)
            counts[some] = np.maximum(last - first + 1, 0)
        return counts

    def spans(self, corners: Floats, width: int, begin: int, end: int) -> tuple[Integers, Integers, Integers]:
        """Triangle, column and row of every pixel of some rows."""
        some = slice(begin, end)
        first, last = self._ends(corners, width, some)
        counts = np.maximum(last - first + 1, 0)
        starts = np.repeat(np.cumsum(counts) - counts, counts)
        column = np.arange(len(starts)) - starts + np.repeat(first, counts)
        return np.repeat(self.triangle[some], counts), column, np.repeat(self.row[some], counts)

    def _ends(self, corners: Floats, width: int, some: slice) -> tuple[Integers, Integers]:
        """First and last column whose middle lies inside the triangle."""
        corner, y = corners[self.triangle[some]], self.row[some] + 0.5
        low, high = np.full(len(y), np.inf), np.full(len(y), -np.inf)
        for k in range(3):
            a, b = corner[:, k], corner[:, (k + 1) % 3]
            # from below upwards, so that two triangles find the same place on their common edge
            falls = (a[:, 1] > b[:, 1])[:, None]
            a, b = np.where(falls, b, a), np.where(falls, a, b)
            crossed = (a[:, 1] <= y) != (b[:, 1] <= y)
            share = np.divide(y - a[:, 1], b[:, 1] - a[:, 1], out=np.zeros(len(y)), where=crossed)
            x = a[:, 0] + share * (b[:, 0] - a[:, 0])
            low, high = np.where(crossed, np.minimum(low, x), low), np.where(crossed, np.maximum(high, x), high)
        # a pixel belongs to the triangle on its left where its middle lies on their common edge
        first = np.ceil(np.clip(low, -1.0, width + 1.0) - 0.5)
        last = np.ceil(np.clip(high, -1.0, width + 1.0) - 0.5) - 1
        return np.maximum(first, 0).astype(np.int64), np.minimum(last, width - 1).astype(np.int64)


def _batches(counts: Integers, limit: int) -> list[tuple[int, int]]:
    """Consecutive pieces of a list whose sums are about a limit."""
    if not len(counts):
        return []
    number = np.cumsum(counts) // limit
    cuts = np.flatnonzero(np.diff(number)) + 1
    return list(zip([0, *cuts.tolist()], [*cuts.tolist(), len(counts)], strict=True))
