"""Exchange diagonals of pairs of faces of a mesh that is being remeshed."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.ties import MARGIN, nearest_whole
from lamella.base.vectors import dots
from lamella.surface.remesh.draft import BEND, BRIDGE, DRAFT_SHAPE, EAR, Draft, narrow
from lamella.surface.remesh.kernel import kernel
from lamella.surface.remesh.topology import Topology, area_vectors, corner_angles, disjoint, shape, unit


def flip(draft: Draft, by_valence: bool, bridges: bool = False) -> int:
    """Exchange diagonals of pairs of faces; returns how many.

    Parameters
    ----------
    draft : Draft
        Changed in place.
    by_valence : bool
        Flip towards six edges at a vertex, where the shapes allow it, instead of towards Delaunay triangles.
    bridges : bool
        Allow new edges between any two boundary vertices.
    """
    topology = draft.topology()
    angles = corner_angles(draft.points[draft.faces])
    edges, gain = (_allowed_fast if kernel() else _allowed)(draft, topology, angles, by_valence, bridges)
    first, second = topology.sides[edges].T
    a, b = topology.ends[edges].T
    c, d = topology.apexes[edges].T
    touched = np.column_stack([a, b, c, d] if by_valence else [first, second])
    some = np.flatnonzero(disjoint(touched, -nearest_whole(10 * gain), max(len(draft.faces), len(draft.points))))
    # Two flips far apart in faces can still ask for the same new edge.
    key = np.minimum(c[some], d[some]) * topology.vertices + np.maximum(c[some], d[some])
    some = some[np.sort(np.unique(key, return_index=True)[1])]
    if not some.size:
        return 0
    faces = draft.faces.copy()
    faces[first[some]] = np.column_stack([a[some], d[some], c[some]])
    faces[second[some]] = np.column_stack([d[some], b[some], c[some]])
    draft.faces = faces
    return int(some.size)


def _allowed_fast(
    draft: Draft, topology: Topology, angles: Floats, by_valence: bool, bridges: bool
) -> tuple[Integers, Floats]:
    """`_allowed` by the compiled kernel."""
    fast = kernel()
    assert fast is not None
    turn = np.bincount(draft.faces.ravel(), angles.ravel(), len(draft.points))
    edges, gains = np.empty(len(topology.ends), np.int64), np.empty(len(topology.ends))
    limits = np.array([np.pi, MARGIN, BEND, DRAFT_SHAPE, EAR, BRIDGE, 0.5 + MARGIN])
    mesh = draft.points, draft.faces, draft.size, draft.boundary
    joined = topology.valence, topology.keys, topology.ends, topology.halves
    given = *mesh, *joined, angles, turn, *draft.face_shapes(), by_valence, bridges, limits
    count = fast.call("flips", len(draft.points), len(edges), *given, edges, gains)
    return edges[:count], gains[:count]


def _allowed(
    draft: Draft, topology: Topology, angles: Floats, by_valence: bool, bridges: bool
) -> tuple[Integers, Floats]:
    """Edges that may be flipped for the better, and how much is gained by each (edges, or radians)."""
    area, normals, shapes = draft.face_shapes()
    edges = np.flatnonzero(topology.inner)
    half = topology.halves[edges]
    first, second = half[:, 0] // 3, half[:, 1] // 3
    a, b = topology.ends[edges].T
    c, d = topology.apexes[edges].T
    turn = np.bincount(draft.faces.ravel(), angles.ravel(), len(draft.points))
    boundary, valence = draft.boundary, topology.valence
    tip = [boundary[v] & (valence[v] == n) & (turn[v] < EAR) for v, n in ((a, 3), (b, 3), (c, 2), (d, 2))]
    makes_ear, spoils_ear = tip[0] | tip[1], tip[2] | tip[3]
    before = np.minimum(shapes[first], shapes[second])
    if by_valence:
        goal = np.where(boundary, np.maximum(nearest_whole(turn / (np.pi / 3)), 1) + 1, 6)
        off = valence - goal
        gain = 2.0 * (off[a] + off[b] - off[c] - off[d] - 2)
        wanted = gain > 0
    else:
        opposite = angles.ravel()[half - half % 3 + (half + 2) % 3].sum(axis=1)
        gain = opposite - np.pi
        wanted = (gain > MARGIN) | (before < 0.05)
    wanted |= makes_ear
    wanted &= ~spoils_ear
    bridge = wanted & boundary[c] & boundary[d] & ~makes_ear
    wanted[bridge] = bridges | narrow(draft, c[bridge], d[bridge])
    wanted &= (dots(normals[first], normals[second]) > BEND) | (before < 0)
    some = np.flatnonzero(wanted)
    some = some[topology.find(c[some], d[some]) < 0]
    first, second, before = first[some], second[some], before[some]
    normal = unit(np.where((before < 0)[:, None], normals[first] + normals[second], area[first] + area[second]))
    after = np.full(some.size, np.inf)
    for triangle in ((a, d, c), (d, b, c)):
        corners = draft.points[np.column_stack([v[some] for v in triangle])]
        after = np.minimum(after, shape(corners, area_vectors(corners), normal))
    if by_valence:
        keep = after > np.minimum(DRAFT_SHAPE, before) + MARGIN
    else:
        keep = (after > 0.05 * np.maximum(before, 0)) & ((gain[some] > MARGIN) | (after > before + MARGIN))
        keep = np.where(before < 0.05, after > before + MARGIN, keep)
    keep = np.where(makes_ear[some], after > 0.1, keep)
    return edges[some[keep]], gain[some[keep]]
