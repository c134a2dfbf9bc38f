"""Faces of a net from its edges and the directions in which they leave the nodes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.errors import InputError

# corners of a face that is written; one with more is left out, and with more than the second number refused
FACE_CORNERS_MAX, LARGE_FACE_CORNERS_MAX = 6, 12
# radians that an edge along the rim may leave a node beyond the rim's own direction
RIM_ANGLE_TOLERANCE = 0.3


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
    loops = [loop for loop in rim if len(loop) > 1]
    n, forward_tail = len(normals), np.concatenate(loops or [np.zeros(0, np.int64)])
    forward_head = np.concatenate([np.roll(loop, -1) for loop in loops] or [np.zeros(0, np.int64)])
    on_rim = np.zeros(n, bool)
    on_rim[forward_tail] = True
    # lamella edges from rim node to rim node, few of all
    along = np.flatnonzero(on_rim[tails] & on_rim[heads])
    # a lamella that runs along the rim is the rim's edge there
    doubled = np.isin(forward_tail * n + forward_head, tails[along] * n + heads[along])
    free_tail, free_head = forward_tail[~doubled], forward_head[~doubled]
    angle = _angles(normals, tails, directions, on_rim, rim_directions)

    tail = np.r_[tails, free_tail, free_head]
    angle = np.r_[angle, np.full(len(free_tail), -1.0), np.full(len(free_tail), 7.0)]
    outside = np.zeros(len(tail), bool)
    outside[len(tails) + len(free_tail) :] = True
    # the back side of lamella edges that are the rim belongs to no face either
    outside[along] = np.isin(heads[along] * n + tails[along], forward_tail * n + forward_head)
    if seam is not None:
        outside |= seam[tail]
    following = _following(tail, angle, _twins(tails, heads, len(free_tail)), n)
    first_edge, count = _cycles(following, outside)
    large = tail[first_edge[count > FACE_CORNERS_MAX]]
    some = count <= FACE_CORNERS_MAX
    return Faces(*_corners(following, tail, first_edge[some], count[some]), large)


def _angles(normals: Floats, tails: Integers, directions: Floats, on_rim: Booleans, rim_directions: Floats) -> Floats:
    """Angle of each half edge about its tail's normal, from the rim or from one edge there on, radians, (h,)."""
    first = np.zeros(len(normals), np.int64)
    first[tails[::-1]] = np.arange(len(tails))[::-1]
    reference = np.where(on_rim[:, None], rim_directions, directions[first])
    sideways = np.cross(normals, reference)
    angle = np.arctan2(
        np.einsum("ij,ij->i", directions, sideways[tails]), np.einsum("ij,ij->i", directions, reference[tails])
    )
    # on the rim every edge lies to the left of the way forward, but for edges along it of nodes that are next to it
    return np.asarray(np.where(angle < -RIM_ANGLE_TOLERANCE, angle + 2 * np.pi, angle))


def _twins(tails: Integers, heads: Integers, free: int) -> Integers:
    """The half edge that runs back along each: of the lamellas', then of so many free ones of the rim both ways.

    Free rim edges may double a lamella edge's end nodes, so they are paired by themselves.
    """
    lamella = np.arange(len(tails))
    twin = np.empty(len(tails) + 2 * free, np.int64)
    twin[lamella[np.lexsort((heads, tails))]] = lamella[np.lexsort((tails, heads))]
    forward = len(tails) + np.arange(free)
    twin[forward], twin[forward + free] = forward + free, forward
    return twin


def _following(tail: Integers, angle: Floats, twin: Integers, nodes: int) -> Integers:
    """The half edge after each one around its face: the next clockwise from the way back."""
    order = np.lexsort((angle, tail))
    place = np.empty(len(order), np.int64)
    place[order] = np.arange(len(order))
    starts = np.searchsorted(tail[order], np.arange(nodes + 1))
    at = place[twin]
    node = tail[twin]
    return order[np.where(at > starts[node], at - 1, starts[node + 1] - 1)]


def _cycles(following: Integers, outside: Booleans) -> tuple[Integers, Integers]:
    """The smallest half edge of each face and its number of corners, by walking around all of them at once."""
    edges = np.arange(len(following))
    sides, smallest, walker = np.zeros(len(following), np.int64), edges.copy(), edges
    crosses_rim = outside.copy()
    for step in range(1, 3 * FACE_CORNERS_MAX):
        walker = following[walker]
        sides[(sides == 0) & (walker == edges)] = step
        open_ = sides == 0
        smallest[open_] = np.minimum(smallest[open_], walker[open_])
        crosses_rim[open_] |= outside[walker[open_]]
    first_edge = np.flatnonzero((smallest == edges) & ~crosses_rim & (sides > 2))
    count = sides[first_edge]
    endless = bool(((sides == 0) & ~crosses_rim).any())
    if endless or (len(count) and count.max() > LARGE_FACE_CORNERS_MAX):
        corners = "many" if endless else f"{count.max()}"
        raise InputError(
            f"the net is too coarse for this surface: a face between lamellas and rim has {corners} corners "
            f"(limit {LARGE_FACE_CORNERS_MAX})",
            "raise cells (or lower spacing)",
            "cells",
        )
    return first_edge, count


def _corners(following: Integers, tail: Integers, first_edge: Integers, count: Integers) -> tuple[Integers, Integers]:
    """Offsets (f + 1,) and nodes of faces with so many corners, from a half edge of each."""
    offsets = np.r_[0, np.cumsum(count)]
    nodes = np.empty(offsets[-1], np.int64)
    walker = first_edge
    for step in range(FACE_CORNERS_MAX):
        has = count > step
        nodes[offsets[:-1][has] + step] = tail[walker[has]]
        walker = following[walker]
    return offsets, nodes
