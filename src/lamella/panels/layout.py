"""Which polygons of a net's nodes become panels.

On the diagonals a panel is laid around every node that is no corner: each face gives it the triangle between that node
and its two neighbours. In the middle of a net these are four triangles, and the panel is a quad whose sides are
principal directions; at a rim they are fewer, and around a singular node that is no corner they are more. What faces at
the rim have beyond their triangles is a panel of its own.
"""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Booleans, Integers
from lamella.network.faces import LARGE_FACE_CORNERS_MAX
from lamella.network.network import Network
from lamella.panels.polygons import Polygons

MOST_AROUND = 2 * LARGE_FACE_CORNERS_MAX
"""Faces around a node; far above the rays of any umbilic."""


def face_panels(network: Network) -> Polygons:
    """The faces themselves."""
    count = len(network.face_offsets) - 1
    return Polygons(network.face_offsets, network.face_nodes, np.full(count, -1), np.zeros(count, bool))


def diagonal_panels(network: Network, corners: Booleans) -> Polygons:
    """Panels around the nodes that are no corners, then what is left of faces.

    Parameters
    ----------
    network : Network
    corners : (n,) bool
        Nodes that are corners.
    """
    faces = face_panels(network)
    nodes, following = faces.nodes, faces.following()
    before = np.empty_like(following)
    before[following] = np.arange(len(following))
    ear = ~corners[nodes] & corners[nodes[before]] & corners[nodes[following]]
    # of a triangle one ear is all of it
    fans = _fans(nodes[ear], nodes[following[ear]], nodes[before[ear]], len(network.node_points))
    whole = np.isin(faces.owner, faces.owner[ear & (faces.sizes[faces.owner] == 3)])
    left = ~ear & ~whole
    count = np.bincount(faces.owner[left], minlength=len(faces))
    kept = left & (count[faces.owner] > 2)
    sizes = count[count > 2]
    rest = Polygons(np.r_[0, np.cumsum(sizes)], nodes[kept], np.full(len(sizes), -1), np.zeros(len(sizes), bool))
    return Polygons.joined([fans, rest])


def _fans(tips: Integers, firsts: Integers, seconds: Integers, nodes: int) -> Polygons:
    """Panels of triangles (tip, first, second), each followed by the one whose first corner is its second."""
    count = len(tips)
    by_first = np.argsort(tips * nodes + firsts, kind="stable")
    keys = (tips * nodes + firsts)[by_first]
    at = np.minimum(np.searchsorted(keys, tips * nodes + seconds), max(count - 1, 0))
    found = keys[at] == tips * nodes + seconds if count else np.zeros(0, bool)
    following = np.where(found, by_first[at] if count else at, -1)
    starts, around = _starts(following)
    length = np.zeros(len(starts), np.int64)
    walk = np.full((len(starts), MOST_AROUND), -1)
    walker = starts.copy()
    for step in range(MOST_AROUND):
        on = walker >= 0
        walk[on, step] = walker[on]
        length += on
        walker = np.where(on, following[walker], -1)
        walker[walker == starts] = -1
    ends = walk[np.arange(len(starts)), length - 1]
    # the tip, where the fan is open, the first corners, and the last second one
    table = np.where(walk >= 0, firsts[walk], -1)
    table = np.column_stack([np.where(around, -1, tips[starts]), table, np.where(around, -1, seconds[ends])])
    sizes = (table >= 0).sum(axis=1)
    order = np.argsort(tips[starts], kind="stable")
    table, sizes = table[order], sizes[order]
    return Polygons(np.r_[0, np.cumsum(sizes)], table[table >= 0], tips[starts][order], around[order])


def _starts(following: Integers) -> tuple[Integers, Booleans]:
    """The first item of each chain, and the least one of each ring, of items with followers (-1: none)."""
    count = len(following)
    has_before = np.zeros(count, bool)
    has_before[following[following >= 0]] = True
    least, walker = np.arange(count), np.arange(count)
    for _ in range(MOST_AROUND):
        walker = np.where(walker >= 0, following[walker], -1)
        least = np.where(walker >= 0, np.minimum(least, walker), least)
    ring = walker >= 0
    start = np.where(ring, least == np.arange(count), ~has_before)
    return np.flatnonzero(start), ring[start]
