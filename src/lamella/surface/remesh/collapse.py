"""Collapse short edges, and edges of thin faces, of a mesh that is being remeshed."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.ties import MARGIN, nearest_whole
from lamella.base.vectors import lengths
from lamella.surface.remesh.draft import BRIDGE, COLLAPSE_LENGTH, DRAFT_SHAPE, SPLIT_LENGTH, Draft, edge_lengths, narrow
from lamella.surface.remesh.kernel import kernel
from lamella.surface.remesh.topology import Topology, area_vectors, ragged, shape

APART_PASSES = 3  # rounds of the selection of collapses that do not touch


def collapse_short(draft: Draft) -> int:
    """Collapse inner edges that are shorter than allowed, and vertices with three neighbours; returns how many."""
    topology = draft.topology()
    ends, boundary, valence = topology.ends, draft.boundary, topology.valence
    ratio = edge_lengths(draft.points, ends) / draft.size[ends].mean(axis=1)
    three = (valence == 3) & ~boundary
    edges = np.flatnonzero(topology.inner & ((ratio < COLLAPSE_LENGTH) | three[ends].any(axis=1)))
    edges = edges[~boundary[ends[edges]].all(axis=1)]
    # The end that goes is inside; of two inner ones the one with three neighbours goes, and none of these moves the
    # other end.
    swap = boundary[ends[edges, 0]] | (three[ends[edges, 1]] & ~boundary[ends[edges, 1]])
    removed, kept = np.where(swap, ends[edges, 1], ends[edges, 0]), np.where(swap, ends[edges, 0], ends[edges, 1])
    slides = boundary[kept] | three[removed]
    target = np.where(slides[:, None], draft.points[kept], 0.5 * (draft.points[kept] + draft.points[removed]))
    allowed = link_condition(draft, topology, edges, removed, kept)
    edges, removed, kept, target = edges[allowed], removed[allowed], kept[allowed], target[allowed]
    new, old, longest = star_after(draft, topology, removed, kept, target)
    allowed = (new >= np.minimum(DRAFT_SHAPE, old) - MARGIN) & (new > 0) & (longest <= SPLIT_LENGTH)
    edges, removed, kept, target = edges[allowed], removed[allowed], kept[allowed], target[allowed]
    # Ranks in steps, or only a few of the many short edges of a graded mesh would be local extremes.
    rank = nearest_whole(4 * np.log2(np.maximum(ratio[edges], 1e-9)))
    chosen = apart(draft, topology, removed, kept, rank)
    removed, kept, target = removed[chosen], kept[chosen], target[chosen]
    if removed.size:
        inside = ~boundary[kept]
        draft.points[kept[inside]] = draft.project(target[inside])
        draft.size[kept[inside]] = draft.size_at(draft.points[kept[inside]])
        draft.merge(removed, kept)
    return int(removed.size)


def collapse_thin(draft: Draft, limit: float) -> int:
    """Collapse an inner edge at faces of a poor shape where that improves the worst of the star.

    Parameters
    ----------
    draft : Draft
        Changed in place.
    limit : float
        Shape below which a face is a reason to collapse one of its edges.

    Returns
    -------
    int
        Number of edges collapsed.
    """
    thin = np.flatnonzero(draft.face_shapes().shape < limit)
    if thin.size == 0:
        return 0
    topology = draft.topology()
    boundary = draft.boundary
    edges = np.unique(topology.edge_of_half[(3 * thin[:, None] + np.arange(3)).ravel()])
    edges = edges[topology.inner[edges]]
    pairs = topology.ends[edges]
    edges = np.concatenate([edges, edges])
    removed, kept = np.concatenate([pairs, pairs[:, ::-1]]).T
    allowed = ~boundary[removed] & link_condition(draft, topology, edges, removed, kept)
    removed, kept = removed[allowed], kept[allowed]
    new, old, longest = star_after(draft, topology, removed, kept, draft.points[kept])
    allowed = (new > np.maximum(old, 0.0) + 0.02) & (longest <= 1.1 * SPLIT_LENGTH)
    removed, kept, new = removed[allowed], kept[allowed], new[allowed]
    chosen = apart(draft, topology, removed, kept, -nearest_whole(new / MARGIN))
    if chosen.any():
        draft.merge(removed[chosen], kept[chosen])
    return int(chosen.sum())


def link_condition(draft: Draft, topology: Topology, edges: Integers, removed: Integers, kept: Integers) -> Booleans:
    """Whether a collapse keeps the surface a surface, and makes no long inner edge between boundary vertices."""
    allowed: Booleans
    fast = kernel()
    if fast:
        allowed = np.empty(edges.size, bool)
        given = draft.points, draft.size, draft.boundary, *topology.neighbours, draft.faces, topology.halves
        fast.call("link_condition", edges.size, *given, BRIDGE, edges, removed, kept, allowed)
        return allowed
    owner, near = ragged(topology.neighbours, removed)
    other = near != kept[owner]
    owner, near = owner[other], near[other]
    joined = topology.find(near, kept[owner]) >= 0
    common = np.bincount(owner[joined], minlength=edges.size)
    boundary = draft.boundary
    bridge = ~boundary[removed[owner]] & boundary[kept[owner]] & boundary[near] & ~joined
    bridge[bridge] = ~narrow(draft, kept[owner[bridge]], near[bridge])
    bridges = np.bincount(owner[bridge], minlength=edges.size)
    apex = topology.apexes[edges]
    least = np.where(boundary[apex], 3, 4)
    # Each vertex opposite to a collapsed edge loses one of its edges.
    enough = ((topology.valence[apex] >= least) | (apex < 0)).all(axis=1)
    inner = topology.inner[edges]
    allowed = (common == np.where(inner, 2, 1)) & (bridges == 0) & enough
    return allowed


def star_after(
    draft: Draft, topology: Topology, removed: Integers, kept: Integers, target: Floats
) -> tuple[Floats, Floats, Floats]:
    """Worst shape after and before collapses, and the longest edge after them in units of the size, each (k,)."""
    faces = draft.face_shapes()
    fast = kernel()
    if fast:
        new, old, longest = np.empty((3, removed.size))
        given = draft.points, draft.faces, draft.size, faces.normals, faces.shape, *topology.fans
        fast.call("star_after", removed.size, *given, removed, kept, target, new, old, longest)
        return new, old, longest
    owners, halves = zip(ragged(topology.fans, removed), ragged(topology.fans, kept), strict=True)
    owner, face = np.concatenate(owners), np.concatenate(halves) // 3
    triangle = draft.faces[face]
    goes = triangle == removed[owner][:, None]
    stays = triangle == kept[owner][:, None]
    old = np.full(removed.size, np.inf)
    np.minimum.at(old, owner, faces.shape[face])
    remains = ~(goes.any(axis=1) & stays.any(axis=1))
    owner, face, triangle, moved = owner[remains], face[remains], triangle[remains], (goes | stays)[remains]
    corners = np.where(moved[..., None], target[owner][:, None], draft.points[triangle])
    new = np.full(removed.size, np.inf)
    np.minimum.at(new, owner, shape(corners, area_vectors(corners), faces.normals[face]))
    spoke = corners - target[owner][:, None]
    reach = lengths(spoke) / (0.5 * (draft.size[triangle] + draft.size[kept[owner]][:, None]))
    longest = np.zeros(removed.size)
    np.maximum.at(longest, owner, reach.max(axis=1))
    return new, old, longest


def apart(draft: Draft, topology: Topology, removed: Integers, kept: Integers, rank: Floats) -> Booleans:
    """Collapses with no face in common, lower ranks first."""
    place = np.empty(rank.size, dtype=np.int64)
    place[np.lexsort((np.arange(rank.size) * 7919 % 104729, rank))] = np.arange(rank.size)
    chosen = np.zeros(rank.size, dtype=bool)
    fast = kernel()
    if fast:
        n, k = len(draft.points), rank.size
        left, at_vertex, around = (np.empty(count, np.int64) for count in (k, n, n))
        blocked = np.empty(n, bool)
        given = n, len(draft.faces), draft.faces, k, removed, kept, place, APART_PASSES
        fast.call("apart", *given, chosen, left, at_vertex, around, blocked)
        return chosen
    left = np.arange(rank.size)
    corner = draft.faces.ravel()
    for _ in range(APART_PASSES):
        at_vertex = np.full(len(draft.points), rank.size)
        np.minimum.at(at_vertex, removed[left], place[left])
        np.minimum.at(at_vertex, kept[left], place[left])
        at_face = at_vertex[draft.faces].min(axis=1)
        around = np.full(len(draft.points), rank.size)
        np.minimum.at(around, corner, np.repeat(at_face, 3))
        wins = left[(around[removed[left]] == place[left]) & (around[kept[left]] == place[left])]
        chosen[wins] = True
        taken = np.zeros(len(draft.points), dtype=bool)
        taken[removed[chosen]] = taken[kept[chosen]] = True
        used = taken[draft.faces].any(axis=1)
        blocked = np.zeros(len(draft.points), dtype=bool)
        blocked[corner[np.repeat(used, 3)]] = True
        left = left[~(blocked[removed[left]] | blocked[kept[left]])]
        if left.size == 0:
            break
    return chosen
