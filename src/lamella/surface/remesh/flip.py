"""Exchange diagonals of pairs of faces of a mesh that is being remeshed."""

from __future__ import annotations

import numpy as np

from lamella.base.ties import MARGIN, nearest_whole
from lamella.base.vectors import dots
from lamella.surface.remesh.draft import BEND, DRAFT_SHAPE, EAR, Draft, narrow
from lamella.surface.remesh.topology import area_vectors, corner_angles, disjoint, shape, unit


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
    area, normals = draft.face_normals()
    edges = np.flatnonzero(topology.inner)
    half = topology.halves[edges]
    first, second = half[:, 0] // 3, half[:, 1] // 3
    a, b = topology.ends[edges].T
    c, d = topology.apexes[edges].T
    turn = np.bincount(draft.faces.ravel(), angles.ravel(), len(draft.points))
    boundary, valence = draft.boundary, topology.valence
    tip = [boundary[v] & (valence[v] == n) & (turn[v] < EAR) for v, n in ((a, 3), (b, 3), (c, 2), (d, 2))]
    makes_ear, spoils_ear = tip[0] | tip[1], tip[2] | tip[3]
    flat = area[first] + area[second]
    worst = shape(draft.points[draft.faces], area, normals)
    before = np.minimum(worst[first], worst[second])
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
    normal = unit(np.where((before[some] < 0)[:, None], (normals[first] + normals[second])[some], flat[some]))
    after = np.full(some.size, np.inf)
    for triangle in ((a, d, c), (d, b, c)):
        corners = draft.points[np.column_stack([v[some] for v in triangle])]
        after = np.minimum(after, shape(corners, area_vectors(corners), normal))
    if by_valence:
        keep = after > np.minimum(DRAFT_SHAPE, before[some]) + MARGIN
    else:
        keep = (after > 0.05 * np.maximum(before[some], 0)) & ((gain[some] > MARGIN) | (after > before[some] + MARGIN))
        keep = np.where(before[some] < 0.05, after > before[some] + MARGIN, keep)
    keep = np.where(makes_ear[some], after > 0.1, keep)
    some = some[keep]
    touched = np.column_stack([a, b, c, d] if by_valence else [first, second])[some]
    some = some[disjoint(touched, -nearest_whole(10 * gain[some]), max(len(draft.faces), len(draft.points)))]
    # Two flips far apart in faces can still ask for the same new edge.
    key = np.minimum(c[some], d[some]) * topology.vertices + np.maximum(c[some], d[some])
    some = some[np.sort(np.unique(key, return_index=True)[1])]
    faces = draft.faces.copy()
    faces[first[some]] = np.column_stack([a[some], d[some], c[some]])
    faces[second[some]] = np.column_stack([d[some], b[some], c[some]])
    draft.faces = faces
    return int(some.size)
