"""Slivers: edges too short, and triangles too thin, to say anything about the surface."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.surface.from_mesh.edges import Edges, face_normals, find_edges
from lamella.surface.from_mesh.merge import drop_collapsed

SLIVER_OF_EDGE = 1e-4
"""An edge shorter, or a triangle thinner, than this part of the median edge is a sliver.

Single precision places the vertices of a mesh of a hundred edges across to 1e-5 of an edge: the direction of such an
edge is wrong by some degrees, so it says nothing about the surface, while meshes graded on purpose span a factor of a
thousand at most. What is removed moves nothing by more than this either.
"""

SLIVER_ROUNDS = 60


def remove_slivers(points: Floats, faces: Integers) -> tuple[Integers, int, int]:
    """Collapse short edges and flip the long edges of flat triangles without changing the topology.

    An edge collapses if its ends have no common neighbours but the corners across it (the link condition: no hole
    closes, no two sheets grow together). A triangle whose one corner lies on its longest edge is joined with the
    triangle across that edge and split the other way; on the border it is dropped if its corner is an inner vertex.
    In each round, those that do not touch one another are treated at once.

    Parameters
    ----------
    points : (n, 3)
        m.
    faces : (m, 3) int
        Triangles with three different vertices.

    Returns
    -------
    faces : (k, 3) int
        Vertices that collapsed are no longer used.
    removed : int
        Edges collapsed and triangles flipped.
    left : int
        Slivers whose removal would change the topology.
    """
    if not len(faces):
        return faces, 0, 0
    limit = SLIVER_OF_EDGE * float(np.median(find_edges(faces).lengths(points)))
    removed = 0
    for _ in range(SLIVER_ROUNDS):
        if not len(faces) or not _thin(points, faces, limit).any():
            return faces, removed, 0
        edges = find_edges(faces)
        faces, done = _collapse(points, faces, edges, limit)
        if not done:
            faces, done = _flip(points, faces, edges, limit)
        if not done:
            break
        removed += done
    return faces, removed, int(np.count_nonzero(_thin(points, faces, limit))) if len(faces) else 0


def _heights(points: Floats, faces: Integers) -> Floats:
    """Shortest height of triangles, m; a triangle with a short edge is no higher than that edge."""
    sides = np.linalg.norm(points[faces] - points[np.roll(faces, -1, axis=1)], axis=2)
    doubled = np.linalg.norm(face_normals(points, faces), axis=1)
    return np.asarray(doubled / np.maximum(sides.max(axis=1), np.finfo(float).tiny))


def _thin(points: Floats, faces: Integers, limit: float) -> Booleans:
    return np.asarray(_heights(points, faces) < limit)


def _apart(rank: Integers, touched: Integers, vertices: int, edges: Edges | None = None) -> Booleans:
    """Candidates that rank first at all vertices they touch (and, with `edges`, at the neighbours of those).

    rank : (c,) different numbers, touched : (c, k) vertices.
    """
    best = np.full(vertices, np.iinfo(np.int64).max)
    np.minimum.at(best, touched.ravel(), np.repeat(rank, touched.shape[1]))
    if edges is not None:
        around = best.copy()
        np.minimum.at(around, edges.ends[:, 0], best[edges.ends[:, 1]])
        np.minimum.at(around, edges.ends[:, 1], best[edges.ends[:, 0]])
        best = around
    return np.asarray((best[touched] == rank[:, None]).all(axis=1))


def _collapse(points: Floats, faces: Integers, edges: Edges, limit: float) -> tuple[Integers, int]:
    lengths = edges.lengths(points)
    on_border = edges.border_vertices(len(points))
    both = on_border[edges.ends].all(axis=1)
    chosen = np.flatnonzero((lengths < limit) & (edges.count <= 2) & (edges.border | ~both))
    if not len(chosen):
        return faces, 0
    ends = edges.ends
    links = np.ones(2 * len(ends), dtype=np.int64)
    rows, columns = np.concatenate((ends[:, 0], ends[:, 1])), np.concatenate((ends[:, 1], ends[:, 0]))
    neighbours = csr_array((links, (rows, columns)), shape=(len(points), len(points)))
    common = (neighbours[ends[chosen, 0]] * neighbours[ends[chosen, 1]]).sum(axis=1)
    chosen = chosen[np.asarray(common).ravel() == edges.count[chosen]]
    rank = np.empty(len(chosen), dtype=np.int64)
    rank[np.argsort(lengths[chosen], kind="stable")] = np.arange(len(chosen))
    chosen = chosen[_apart(rank, ends[chosen], len(points), edges)]
    keep, lose = ends[chosen].T.copy()
    # The border keeps its place.
    swap = on_border[lose] & ~on_border[keep]
    keep[swap], lose[swap] = lose[swap], keep[swap]
    target = np.arange(len(points))
    target[lose] = keep
    return drop_collapsed(target[faces]), len(chosen)


def _flip(points: Floats, faces: Integers, edges: Edges, limit: float) -> tuple[Integers, int]:
    heights = _heights(points, faces)
    flat = np.flatnonzero(heights < limit)
    sides = np.linalg.norm(points[faces[flat]] - points[np.roll(faces[flat], -1, axis=1)], axis=2)
    longest = sides.argmax(axis=1)
    a, b, c = (faces[flat, (longest + k) % 3] for k in range(3))
    edge = edges.of_half[3 * flat + longest]
    others = [edges.of_half[3 * flat + (longest + k) % 3] for k in (1, 2)]
    border = edges.border
    inner = ~edges.border_vertices(len(points))[c]
    # A spike (two border edges) can go; a triangle with its corner on the border elsewhere holds two sides together.
    droppable = border[edge] & (inner | border[others[0]] | border[others[1]])
    first = edges.first[edge]
    other_half = np.where(
        edges.halves[first] == 3 * flat + longest,
        edges.halves[np.minimum(first + 1, len(edges.halves) - 1)],
        edges.halves[first],
    )
    across, corner = np.divmod(other_half, 3)
    d = faces[across, (corner + 2) % 3]
    new = np.stack((np.column_stack((a, d, c)), np.column_stack((d, b, c))), axis=1)
    better = np.minimum(*(_heights(points, new[:, k]) for k in range(2))) > np.minimum(heights[flat], heights[across])
    flippable = (edges.count[edge] == 2) & (c != d) & better & ~edges.join(c, d)
    rank = np.empty(len(flat), dtype=np.int64)
    rank[np.argsort(heights[flat], kind="stable")] = np.arange(len(flat))
    able = np.flatnonzero(droppable | flippable)
    if not len(able):
        return faces, 0
    d = np.where(droppable, c, d)
    won = able[_apart(rank[able], np.column_stack((a, b, c, d))[able], len(points))]
    flips, drops = won[flippable[won]], won[droppable[won]]
    faces = faces.copy()
    faces[flat[flips]], faces[across[flips]] = new[flips, 0], new[flips, 1]
    return np.delete(faces, flat[drops], axis=0), len(won)
