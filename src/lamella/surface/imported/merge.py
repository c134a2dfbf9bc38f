"""Vertices at one place made one, and faces that then have no area or stand there twice removed."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from lamella.surface.imported.edges import find_edges
from lamella.surface.imported.raw_mesh import Floats, Integers

OF_SIZE = 1e-6
"""Vertices closer than this part of the mesh's size are one: single precision and text of seven digits place a vertex
to about 1e-7 of the size."""

OF_EDGE = 1e-3
"""... but never more than this part of the median edge, lest a very fine mesh be crumpled."""


def merge_vertices(points: Floats, faces: Integers) -> tuple[Floats, Integers, int]:
    """Make vertices at one place one, and drop those that no face uses.

    Vertices that differ in their last digits are made one only on borders, where a mesh comes apart, and only if no
    short edges join them: inside, and along short edges, merging blindly would fold the mesh; slivers are removed with
    care later.

    Returns
    -------
    points, faces
        The first vertex of each cluster keeps its place; the order is that of the file.
    merged : int
        Vertices that went into another one.
    """
    points, faces = drop_unused(points, faces)
    count = len(points)
    edges = np.linalg.norm(points[faces] - points[np.roll(faces, -1, axis=1)], axis=2)
    long_enough = edges[edges > 0]
    tolerance = OF_SIZE * float(np.linalg.norm(np.ptp(points, axis=0)))
    if len(long_enough):
        tolerance = min(tolerance, OF_EDGE * float(np.median(long_enough)))
    # Vertices equal to the last bit first: an .stl has six of each, and pairs of them all would be many.
    target = _equal_rows(points)
    points, faces = drop_unused(points, target[faces])
    edges = find_edges(drop_repeated(drop_collapsed(faces)))
    border = np.flatnonzero(edges.border_vertices(len(points)))
    pairs = np.zeros((0, 2), dtype=np.int64)
    if len(border):
        pairs = border[cKDTree(points[border]).query_pairs(tolerance, output_type="ndarray")]
        joined = _clusters(edges.ends[edges.lengths(points) < 2 * tolerance], len(points))
        pairs = pairs[joined[pairs[:, 0]] != joined[pairs[:, 1]]]
    if len(pairs):
        cluster = _clusters(pairs, len(points))
        _, first = np.unique(cluster, return_index=True)
        points, faces = drop_unused(points, first[cluster][faces])
    return points, faces, count - len(points)


def _clusters(pairs: Integers, count: int) -> Integers:
    """Number of the connected cluster each of `count` vertices is in."""
    graph = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(count, count))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)


def _equal_rows(points: Floats) -> Integers:
    """For each point the first one equal to it, (n,)."""
    order = np.lexsort(points.T)
    sorted_points = points[order]
    new = np.concatenate(([True], (sorted_points[1:] != sorted_points[:-1]).any(axis=1)))
    target = np.empty(len(points), dtype=np.int64)
    # lexsort is stable: the first of a run is the lowest index.
    target[order] = order[np.flatnonzero(new)[np.cumsum(new) - 1]]
    return target


def drop_unused(points: Floats, faces: Integers) -> tuple[Floats, Integers]:
    """Keep the vertices that faces use, in their order."""
    used = np.zeros(len(points), dtype=bool)
    used[faces] = True
    number: Integers = np.cumsum(used) - 1
    return points[used], number[faces]


def drop_collapsed(faces: Integers) -> Integers:
    """Faces with three different vertices."""
    different: Integers = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
    return different


def drop_repeated(faces: Integers) -> Integers:
    """The first of all faces on the same three vertices, whichever way they are turned."""
    corners = np.sort(faces, axis=1)
    order = np.lexsort(corners.T)
    ranked = corners[order]
    new = np.concatenate(([True], (ranked[1:] != ranked[:-1]).any(axis=1)))[: len(order)]
    return faces[np.sort(order[new])]
