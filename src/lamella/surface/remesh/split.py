"""Split long edges of a mesh that is being remeshed."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Booleans, Integers
from lamella.base.ties import nearest_whole
from lamella.surface.remesh.draft import BRIDGE, EAR, SPLIT_LENGTH, Draft, edge_lengths
from lamella.surface.remesh.topology import Topology, corner_angles, disjoint


def apply_splits(draft: Draft, topology: Topology, edges: Integers, first_new: int) -> None:
    """Split edges, no two of one face, at the vertices that follow `first_new`."""
    middle = np.arange(first_new, first_new + edges.size)
    faces = draft.faces
    halves = topology.halves[edges]
    there = halves >= 0
    half, middles = halves[there], np.broadcast_to(middle[:, None], halves.shape)[there]
    face, k = half // 3, half % 3
    tail = faces[face].copy()
    tail[np.arange(face.size), k] = middles
    faces = faces.copy()
    faces[face, (k + 1) % 3] = middles
    draft.faces = np.concatenate([faces, tail])


def split_long(draft: Draft, look_inside: bool, longest: float = SPLIT_LENGTH) -> int:
    """Halve inner edges that are longer than allowed and the longest of both their faces.

    Parameters
    ----------
    draft : Draft
        Changed in place.
    look_inside : bool
        Ask for the size in the middle of long edges also, which a coarse mesh needs to see a small size far from all
        its vertices.
    longest : float
        That is allowed, in units of the wanted length.

    Returns
    -------
    int
        Number of edges split.
    """
    topology = draft.topology()
    ends = topology.ends
    length = edge_lengths(draft.points, ends)
    wanted = draft.size[ends].mean(axis=1)
    if look_inside:
        long = length > wanted
        wanted[long] = np.minimum(wanted[long], draft.size_at(draft.points[ends[long]].mean(axis=1)))
    ratio = length / wanted
    bridges = topology.inner & draft.boundary[ends].all(axis=1) & (ratio > BRIDGE) & ~_closes_ear(draft, topology)
    # A bridge is too long whatever its length; the offset keeps the order among bridges.
    ratio = np.where(bridges, ratio + longest, ratio)
    edges = np.flatnonzero(topology.inner & (ratio > longest))
    edges = edges[disjoint(topology.sides[edges], -nearest_whole(100 * ratio[edges]), len(draft.faces), passes=1)]
    if edges.size:
        middle = draft.project(draft.points[ends[edges]].mean(axis=1))
        first = len(draft.points)
        draft.append(middle, np.full(edges.size, -1), np.full(edges.size, np.nan))
        apply_splits(draft, topology, edges, first)
    return int(edges.size)


def _closes_ear(draft: Draft, topology: Topology) -> Booleans:
    """Inner edges opposite to a sharp boundary corner that has no other inner edge, (e,)."""
    apex = topology.apexes
    turn = np.bincount(draft.faces.ravel(), corner_angles(draft.points[draft.faces]).ravel(), len(draft.points))
    ear = draft.boundary & (topology.valence == 2) & (turn < EAR)
    closes: Booleans = (ear[apex] & (apex >= 0)).any(axis=1)
    return closes
