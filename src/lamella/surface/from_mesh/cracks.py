"""T-junctions closed, and borders that nearly touch found."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from lamella.base.arrays import Floats, Integers
from lamella.surface.from_mesh.edges import find_edges
from lamella.surface.from_mesh.merge import drop_collapsed

CRACK_ON_EDGE = 1e-3
"""A border vertex within this part of a border edge's length from that edge lies on it."""

NEAR_EDGE = 0.02
"""Within this part of the edges there, two stretches of border leave a gap the mesh cannot mean."""

CRACK_ROUNDS = 20


def close_t_junctions(points: Floats, faces: Integers) -> tuple[Integers, int]:
    """Split faces at border vertices that lie on their border edges, where a finer mesh meets a coarser one.

    Returns
    -------
    faces : (k, 3) int
    closed : int
        Vertices on edges.
    """
    closed = 0
    for _ in range(CRACK_ROUNDS):
        edges = find_edges(faces)
        halves = edges.halves[edges.first[edges.border]]
        which, vertex, along, _ = near_border(points, faces, halves, CRACK_ON_EDGE)
        inside = (along > CRACK_ON_EDGE) & (along < 1 - CRACK_ON_EDGE)
        which, vertex, along = which[inside], vertex[inside], along[inside]
        face = halves[which] // 3
        opposite = faces[face, (halves[which] + 2) % 3]
        good = vertex != opposite
        # One edge of a face at a time; the others in the next round.
        first_of_face = np.full(len(faces), len(halves), dtype=np.int64)
        np.minimum.at(first_of_face, face[good], which[good])
        good &= first_of_face[face] == which
        if not good.any():
            break
        which, vertex, along = which[good], vertex[good], along[good]
        order = np.lexsort((along, which))
        which, vertex = which[order], vertex[order]
        closed += len(vertex)
        faces = _split_at(faces, halves, which, vertex)
    return faces, closed


def _split_at(faces: Integers, halves: Integers, which: Integers, vertex: Integers) -> Integers:
    """Replace the face of each half-edge `halves[which]` by a fan over the vertices along it, given in order."""
    split, begin, count = np.unique(which, return_index=True, return_counts=True)
    half = halves[split]
    face, corner = np.divmod(half, 3)
    a, b, top = (faces[face, (corner + k) % 3] for k in range(3))
    # Chain of each edge: a, its vertices, b.
    start = np.insert(vertex, begin, a)
    end = np.insert(vertex, begin + count, b)
    fans = np.column_stack((start, end, np.repeat(top, count + 1)))
    return drop_collapsed(np.concatenate((np.delete(faces, face, axis=0), fans)))


def near_border(
    points: Floats, faces: Integers, halves: Integers, ratio: float
) -> tuple[Integers, Integers, Floats, Floats]:
    """Border vertices near border edges they do not end.

    Parameters
    ----------
    points, faces
        The mesh.
    halves : (b,) int
        Border half-edges.
    ratio : float
        Largest distance, as a part of the edge's length.

    Returns
    -------
    which, vertex : (c,) int
        Position in `halves`, and vertex.
    along : (c,)
        Nearest point of the edge, 0 to 1.
    distance : (c,)
        m.
    """
    start, end = faces[halves // 3, halves % 3], faces[halves // 3, (halves + 1) % 3]
    candidates = np.unique(np.concatenate((start, end)))
    if not len(candidates):
        return candidates, candidates, np.zeros(0), np.zeros(0)
    middle, reach = (points[start] + points[end]) / 2, np.linalg.norm(points[end] - points[start], axis=1) / 2
    found = cKDTree(points[candidates]).query_ball_point(middle, reach * (1 + 2 * ratio), return_sorted=True)
    which = np.repeat(np.arange(len(halves)), [len(near) for near in found])
    vertex = candidates[np.concatenate([np.asarray(near, dtype=np.int64) for near in found])]
    other = (vertex != start[which]) & (vertex != end[which])
    which, vertex = which[other], vertex[other]
    origin, span = points[start[which]], points[end[which]] - points[start[which]]
    square = np.einsum("ij,ij->i", span, span)
    along = np.einsum("ij,ij->i", points[vertex] - origin, span) / square
    along = np.clip(along, 0, 1)
    distance = np.linalg.norm(points[vertex] - origin - along[:, None] * span, axis=1)
    near = distance <= ratio * np.sqrt(square)
    return which[near], vertex[near], along[near], distance[near]
