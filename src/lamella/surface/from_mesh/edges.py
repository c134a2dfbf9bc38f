"""Edges of a triangle mesh in bulk.

Half-edge h = 3 f + k goes from corner k of triangle f to corner k + 1.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers


@dataclass(frozen=True)
class Edges:
    """Undirected edges and the half-edges on them.

    Attributes
    ----------
    ends : (e, 2) int
        Vertices, the lower one first; edges are in lexical order.
    count : (e,) int
        Faces at each edge.
    halves : (3 m,) int
        Half-edges, edge after edge.
    first : (e,) int
        Where the half-edges of each edge begin in `halves`.
    of_half : (3 m,) int
        Edge of each half-edge.
    """

    ends: Integers
    count: Integers
    halves: Integers
    first: Integers
    of_half: Integers

    @property
    def border(self) -> Booleans:
        """Edges with one face, (e,)."""
        return np.asarray(self.count == 1)

    @property
    def inner_pairs(self) -> Integers:
        """The two half-edges of each edge with two faces, (i, 2)."""
        first = self.first[self.count == 2]
        return np.column_stack((self.halves[first], self.halves[first + 1]))

    def lengths(self, points: Floats) -> Floats:
        """Length of each edge, m, (e,)."""
        return np.asarray(np.linalg.norm(points[self.ends[:, 1]] - points[self.ends[:, 0]], axis=1))

    def border_vertices(self, vertices: int) -> Booleans:
        """Which of `vertices` vertices are on an edge with one face, (vertices,)."""
        on = np.zeros(vertices, dtype=bool)
        on[self.ends[self.border]] = True
        return on

    def join(self, one: Integers, two: Integers) -> Booleans:
        """Whether an edge joins vertices `one` and `two`, (k,) each."""
        if not len(self.ends) or not len(one):
            return np.zeros(len(one), dtype=bool)
        base = int(max(self.ends.max(), one.max(), two.max())) + 1
        keys = self.ends[:, 0] * base + self.ends[:, 1]
        requested = np.minimum(one, two) * base + np.maximum(one, two)
        where = np.minimum(np.searchsorted(keys, requested), len(keys) - 1)
        return np.asarray(keys[where] == requested)


def find_edges(faces: Integers) -> Edges:
    """Edges of triangles (m, 3)."""
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    low, high = np.minimum(start, end), np.maximum(start, end)
    keys = low * (int(faces.max(initial=0)) + 1) + high
    halves = np.argsort(keys, kind="stable")
    new = np.diff(keys[halves], prepend=-1) != 0
    first = np.flatnonzero(new)
    of_half = np.empty(len(keys), dtype=np.int64)
    of_half[halves] = np.cumsum(new) - 1
    ends = np.column_stack((low[halves[first]], high[halves[first]]))
    return Edges(ends, np.diff(first, append=len(keys)), halves, first, of_half)


def face_normals(points: Floats, faces: Integers) -> Floats:
    """Normals of triangles with twice their areas as lengths, m^2, (m, 3)."""
    a, b, c = (points[faces[:, k]] for k in range(3))
    return np.cross(b - a, c - a)


def vertex_normals(points: Floats, faces: Integers) -> Floats:
    """Unit normals at vertices, weighted with the areas of their faces, (n, 3); zero where there is no face."""
    weights = face_normals(points, faces)
    total = np.column_stack(
        [np.bincount(faces.ravel(), np.repeat(weights[:, axis], 3), len(points)) for axis in range(3)]
    )
    sizes = np.linalg.norm(total, axis=1, keepdims=True)
    return np.asarray(np.divide(total, sizes, out=np.zeros_like(total), where=sizes > 0))


def vertex_areas(points: Floats, faces: Integers) -> Floats:
    """A third of the area of the faces around each vertex, m^2, (n,)."""
    areas = np.linalg.norm(face_normals(points, faces), axis=1) / 2
    return np.asarray(np.bincount(faces.ravel(), np.repeat(areas / 3, 3), len(points)))
