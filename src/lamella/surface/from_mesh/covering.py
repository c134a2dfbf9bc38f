"""Faces of a mesh that lie on others: quads saved with their triangles, squares with both diagonals."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.surface.from_mesh.edges import find_edges

COVERINGS_MAX = 8
"""Corners of a face whose triangles are looked for: larger ones are outlines rather than faces."""


def covered_faces(points: Floats, sizes: Integers, corners: Integers) -> Booleans:
    """Which triangles lie on a larger face, all of their corners being corners of it, (f,).

    Parameters
    ----------
    points : (n, 3)
        Vertices at one place count as one.
    sizes : (f,) int
        Corners of each face.
    corners : (sum of sizes,) int
        Vertex indices, face after face.
    """
    covered = np.zeros(len(sizes), bool)
    triangle = np.flatnonzero(sizes == 3)
    larger = [size for size in np.unique(sizes).tolist() if 3 < size <= COVERINGS_MAX]
    if not len(triangle) or not larger:
        return covered
    _, one = np.unique(points, axis=0, return_inverse=True)
    corner = one.reshape(-1)[corners]
    begin = np.concatenate(([0], np.cumsum(sizes)))[:-1]
    parts = []
    for size in larger:
        loops = corner[begin[sizes == size, None] + np.arange(size)]
        parts.append(loops[:, list(combinations(range(size), 3))].reshape(-1, 3))
    own = corner[begin[triangle, None] + np.arange(3)]
    keys = _keys(np.concatenate([own, *parts]), len(points))
    covered[triangle] = np.isin(keys[: len(own)], keys[len(own) :])
    return covered


def second_diagonals(faces: Integers) -> Booleans:
    """Which triangles (m,) split a square along its other diagonal, both of its first halves standing earlier."""
    pairs = find_edges(faces).inner_pairs
    if not len(pairs):
        return np.zeros(len(faces), bool)
    count = int(faces.max()) + 1
    flat = faces.ravel()
    # a triangle's half edge k runs from corner k; the corner across is the one after next
    across = flat[pairs - pairs % 3 + (pairs + 2) % 3]
    ends = np.column_stack([flat[pairs[:, 0]], flat[pairs[:, 0] - pairs[:, 0] % 3 + (pairs[:, 0] + 1) % 3]])
    other = [np.column_stack([across, ends[:, k]]) for k in (0, 1)]
    keys = _keys(np.concatenate([faces, *other]), count)
    own, rest = keys[: len(faces)], keys[len(faces) :].reshape(2, -1)
    order = np.argsort(own, kind="stable")
    place = np.searchsorted(own[order], rest)
    found = order[np.minimum(place, len(order) - 1)]
    there = (own[found] == rest).all(axis=0) & (found.min(axis=0) > (pairs // 3).max(axis=1))
    covered = np.zeros(len(faces), bool)
    covered[found[:, there].ravel()] = True
    return covered


def _keys(triples: Integers, count: int) -> Integers:
    """One number for each set of three vertices of a mesh of `count`."""
    low, middle, high = np.sort(triples, axis=1).T
    _, pairs = np.unique(low * count + middle, return_inverse=True)
    # pairs are fewer than triples: no overflow, however many vertices
    return np.asarray(pairs.reshape(-1).astype(np.int64) * count + high)
