"""Vertices at one place made one, and faces that then have no area or stand there twice removed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from lamella.base.arrays import Floats, Integers
from lamella.base.vectors import diagonal
from lamella.surface.from_mesh.edges import find_edges

OF_SIZE = 1e-4
"""Border vertices closer than this part of the mesh's size, a millimetre at 10 m, are welded: no surface means so
narrow a slit, and programs leave seams open by about their own tolerance (0.001 of the unit drawn in)."""

MERGE_OF_EDGE = 0.02
"""... but never further apart than this part of the border edges there, lest a fine mesh be crumpled."""


@dataclass(frozen=True)
class Merged:
    """A mesh whose vertices at one place are one.

    Attributes
    ----------
    points : (n, 3)
        The first vertex of each cluster keeps its place; the order is that of the file.
    faces : (m, 3) int
    equal : int
        Vertices that went into one at the very same place.
    welded : int
        Vertices that went into one nearby.
    gap : float
        Largest distance between two that were welded, m.
    """

    points: Floats
    faces: Integers
    equal: int
    welded: int
    gap: float


def merge_vertices(points: Floats, faces: Integers) -> Merged:
    """Make vertices at one place one, and drop those that no face uses.

    Vertices apart are welded only on borders, where a mesh comes open: runs of border edges smaller than the tolerance
    are contracted (the pole of a sphere drawn once for every meridian), then border vertices within the tolerance are
    joined (seams) unless short edges join them already, then what has become a pinhole is closed. Inside, welding
    blindly would fold the mesh; slivers are removed with care later.
    """
    points, faces = drop_unused(points, faces)
    count = len(points)
    edges = np.linalg.norm(points[faces] - points[np.roll(faces, -1, axis=1)], axis=2)
    long_enough = edges[edges > 0]
    median = float(np.median(long_enough)) if len(long_enough) else 0.0
    most = OF_SIZE * diagonal(points)
    # Vertices equal to the last bit first: an .stl has six of each, and pairs of them all would be many.
    target = _equal_rows(points)
    points, faces = drop_unused(points, target[faces])
    equal, gap = count - len(points), 0.0
    for pairs_of in (_of_points, _of_seams, _of_points):
        pairs = pairs_of(points, faces, most, median)
        if len(pairs):
            gap = max(gap, float(np.linalg.norm(points[pairs[:, 0]] - points[pairs[:, 1]], axis=1).max()))
            cluster = _clusters(pairs, len(points))
            _, first = np.unique(cluster, return_index=True)
            points, faces = drop_unused(points, first[cluster][faces])
    return Merged(points, faces, equal, count - equal - len(points), gap)


def _border(faces: Integers) -> Integers:
    """Ends of border edges, (b, 2)."""
    edges = find_edges(drop_repeated(drop_collapsed(faces)))
    return np.asarray(edges.ends[edges.border])


def _of_points(points: Floats, faces: Integers, most: float, median: float) -> Integers:
    """Ends of border edges that are, with their neighbours, smaller than the tolerance: poles and pinholes.

    A finely divided rim has short edges too, but they lead on.
    """
    tolerance = min(most, MERGE_OF_EDGE * median)
    ends = _border(faces)
    ends = ends[np.flatnonzero(np.linalg.norm(points[ends[:, 1]] - points[ends[:, 0]], axis=1) < tolerance)]
    if not len(ends):
        return ends
    cluster = _clusters(ends, len(points))
    low, high = np.full((cluster.max() + 1, 3), np.inf), np.full((cluster.max() + 1, 3), -np.inf)
    for side in ends.T:
        np.minimum.at(low, cluster[side], points[side])
        np.maximum.at(high, cluster[side], points[side])
    chosen = cluster[ends[:, 0]]
    return np.asarray(ends[np.linalg.norm(high[chosen] - low[chosen], axis=1) < tolerance])


def _of_seams(points: Floats, faces: Integers, most: float, median: float) -> Integers:
    """Border vertices nearer to one another than what their border edges mean."""
    ends = _border(faces)
    if not len(ends):
        return ends
    lengths = np.linalg.norm(points[ends[:, 1]] - points[ends[:, 0]], axis=1)
    reach = np.zeros(len(points))
    np.maximum.at(reach, ends.ravel(), np.repeat(lengths, 2))
    reach = np.minimum(most, MERGE_OF_EDGE * reach)
    border = np.unique(ends)
    pairs = border[cKDTree(points[border]).query_pairs(float(reach.max()), output_type="ndarray")]
    apart = np.linalg.norm(points[pairs[:, 0]] - points[pairs[:, 1]], axis=1)
    pairs = pairs[apart <= reach[pairs].min(axis=1)]
    edges = find_edges(drop_repeated(drop_collapsed(faces)))
    short = edges.lengths(points) < 2 * reach[edges.ends].max(axis=1)
    joined = _clusters(edges.ends[short], len(points))
    return np.asarray(pairs[joined[pairs[:, 0]] != joined[pairs[:, 1]]])


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
