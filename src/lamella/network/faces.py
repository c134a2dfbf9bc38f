"""Faces of a net from its edges and the directions in which they leave the nodes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.errors import InputError

# corners of a face that is written, and of one that is left out
MOST_SIDES, MOST_CORNERS = 6, 12
# radians
ALONG_RIM = 0.3


class Faces(NamedTuple):
    """Faces of a net.

    Attributes
    ----------
    offsets : (f + 1,) int
    nodes : (k,) int
        Counter-clockwise; those of face i from offsets[i] to offsets[i + 1].
    large : (l,) int
        A node of each face that is left out, since it has more than six corners: a cell around an umbilic that is no
        node, cut by the rim.
    """

    offsets: Integers
    nodes: Integers
    large: Integers


def trace_faces(
    normals: Floats,
    tails: Integers,
    heads: Integers,
    directions: Floats,
    rim: list[Integers],
    rim_directions: Floats,
    seam: Booleans | None = None,
) -> Faces:
    """Walk around the faces of a net embedded in a surface.

    At every node the edges are sorted by angle about the normal; a face is followed by taking, at the end of
    each half edge, the next one clockwise from the way back.

    Parameters
    ----------
    normals : (n, 3)
        Unit normals of the nodes.
    tails, heads : (h,) int
        Half edges, both directions of every edge listed.
    directions : (h, 3)
        Tangents of the half edges at their tails.
    rim : list of (k,) int
        Boundary nodes of each loop in order, the surface to the left.
    rim_directions : (n, 3)
        Direction of the rim at its nodes, forward along the loop (unused elsewhere).
    seam : (n,) bool, optional
        Nodes where an open net does not meet itself: no face across.

    Returns
    -------
    Faces
        What lies outside the rim is left out, and so are slivers between the rim and a single edge.
    """
    n = len(normals)
    forward_tail = np.concatenate([loop for loop in rim if len(loop) > 1] or [np.zeros(0, np.int64)])
    forward_head = np.concatenate([np.roll(loop, -1) for loop in rim if len(loop) > 1] or [np.zeros(0, np.int64)])
    # a lamella that runs along the rim is the rim's edge there
    doubled = np.isin(forward_tail * n + forward_head, tails * n + heads)
    free_tail, free_head = forward_tail[~doubled], forward_head[~doubled]

    reference = np.zeros((n, 3))
    reference[forward_tail] = rim_directions[forward_tail]
    inner = np.setdiff1d(np.arange(n), forward_tail)
    seen, first = np.unique(tails, return_index=True)
    reference[inner] = directions[first[np.searchsorted(seen, inner)]]
    sideways = np.cross(normals, reference)
    angle = np.arctan2(
        np.einsum("ij,ij->i", directions, sideways[tails]), np.einsum("ij,ij->i", directions, reference[tails])
    )
    # on the rim every edge lies to the left of the way forward, but for edges along it of nodes that are next to it
    angle = np.where(angle < -ALONG_RIM, angle + 2 * np.pi, angle)

    tail = np.r_[tails, free_tail, free_head]
    angle = np.r_[angle, np.full(len(free_tail), -1.0), np.full(len(free_tail), 7.0)]
    outside = np.zeros(len(tail), bool)
    outside[len(tails) + len(free_tail) :] = True
    # the back side of lamella edges that are the rim belongs to no face either
    outside[: len(tails)] = np.isin(heads * n + tails, forward_tail * n + forward_head)

    if seam is not None:
        outside |= seam[tail]
    order = np.lexsort((angle, tail))
    place = np.empty(len(order), np.int64)
    place[order] = np.arange(len(order))
    starts = np.searchsorted(tail[order], np.arange(n + 1))
    # twin of a half edge; free rim edges may double a lamella edge's end nodes, so they are paired by themselves
    lamella = np.arange(len(tails))
    by_forward = np.lexsort((heads, tails))
    by_backward = np.lexsort((tails, heads))
    twin = np.empty(len(tail), np.int64)
    twin[lamella[by_forward]] = lamella[by_backward]
    free = len(tails) + np.arange(len(free_tail))
    twin[free], twin[free + len(free_tail)] = free + len(free_tail), free
    at = place[twin]
    node = tail[twin]
    previous = np.where(at > starts[node], at - 1, starts[node + 1] - 1)
    following = order[previous]

    # the smallest half edge of a cycle, and its length, by walking all of them at once
    sides = np.zeros(len(tail), np.int64)
    smallest = np.arange(len(tail))
    crosses_rim = outside.copy()
    walker = np.arange(len(tail))
    for step in range(1, 3 * MOST_SIDES):
        walker = following[walker]
        sides[(sides == 0) & (walker == np.arange(len(tail)))] = step
        open_ = sides == 0
        smallest[open_] = np.minimum(smallest[open_], walker[open_])
        crosses_rim[open_] |= outside[walker[open_]]
    first_edge = np.flatnonzero((smallest == np.arange(len(tail))) & ~crosses_rim & (sides > 2))
    count = sides[first_edge]
    endless = bool(((sides == 0) & ~crosses_rim).any())
    if endless or (len(count) and count.max() > MOST_CORNERS):
        corners = "many" if endless else f"{count.max()}"
        raise InputError(
            f"the net is too coarse for this surface: a face between lamellas and rim has {corners} corners "
            f"(limit {MOST_CORNERS})",
            "raise cells (or lower spacing)",
            "cells",
        )
    large = tail[first_edge[count > MOST_SIDES]]
    first_edge, count = first_edge[count <= MOST_SIDES], count[count <= MOST_SIDES]
    offsets = np.r_[0, np.cumsum(count)]
    nodes = np.empty(offsets[-1], np.int64)
    walker = first_edge
    for step in range(MOST_SIDES):
        has = count > step
        nodes[offsets[:-1][has] + step] = tail[walker[has]]
        walker = following[walker]
    return Faces(offsets, nodes, large)
