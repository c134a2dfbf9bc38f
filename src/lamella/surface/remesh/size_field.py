"""Wanted size of the elements over a surface, smoothly graded."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from lamella.base.arrays import Floats
from lamella.base.ties import SIZE_BITS, grid_of, rounded, shortened
from lamella.base.vectors import diagonal

# growth of the wanted size with the distance; steeper grading costs the elements' shape
GRADING = 0.3
# neighbours that a size is handed on to
SIZE_NEIGHBOURS = 12


class SizeField:
    """Wanted edge lengths: the smallest of the given ones, each growing with the distance from its point.

    Parameters
    ----------
    points : (n, 3)
        m.
    sizes : (n,)
        Wanted edge length there, m.
    most : float
        Largest size anywhere, m.
    """

    def __init__(self, points: Floats, sizes: Floats, most: float = np.inf) -> None:
        self._grid = grid_of(max(diagonal(points), float(sizes.max())))
        points, sizes = rounded(points, self._grid), shortened(sizes, SIZE_BITS)
        self._tree = cKDTree(points)
        n = len(points)
        distance, near = self._tree.query(points, k=min(SIZE_NEIGHBOURS, n))
        distance, near = distance.reshape(n, -1), near.reshape(n, -1)
        # the least of size_j + grading distance(i, j) is a shortest path from one node tied to all points
        rows = np.concatenate([np.full(n, n), np.repeat(np.arange(n), near.shape[1])])
        columns = np.concatenate([np.arange(n), near.ravel()])
        weights = np.concatenate([np.minimum(sizes, most), GRADING * distance.ravel()])
        keep = weights > 0
        graph = csr_matrix((weights[keep], (rows[keep], columns[keep])), (n + 1, n + 1))
        self._sizes = dijkstra(graph, directed=False, indices=n)[:n]
        self._most = most

    def __call__(self, points: Floats) -> Floats:
        """Wanted edge length at points (k, 3), m, (k,)."""
        distance, near = self._tree.query(rounded(points, self._grid))
        size = self._sizes[near]
        # a size holds for the whole element it was asked for
        return np.asarray(np.minimum(size + GRADING * np.maximum(distance - 0.6 * size, 0), self._most))

    def scaled(self, factor: float) -> SizeField:
        """The field with all sizes times a factor."""
        return SizeField(np.asarray(self._tree.data), self._sizes * factor, self._most * factor)
