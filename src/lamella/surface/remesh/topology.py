"""Edges, fans and shapes of the triangles of a mesh that is being remeshed, all in bulk."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.vectors import crosses, dots, lengths
from lamella.surface.remesh.kernel import kernel

NONE = -1
NO_MANIFOLD = "the triangles do not form an oriented manifold: an edge has three faces or two that disagree"


@dataclass(frozen=True)
class Topology:
    """Who touches whom.

    Half-edge 3 f + k of face f runs from its corner k to its corner k + 1; the corner k + 2 lies opposite.

    Attributes
    ----------
    faces : (m, 3) int
        Vertices of each face.
    vertices : int
        Number of vertices n.
    keys : (e,) int
        low * n + high of each edge, ascending.
    ends : (e, 2) int
        Vertices of each edge: start and end of its first half-edge.
    halves : (e, 2) int
        Half-edges of each edge; the second is -1 on the boundary.
    edge_of_half : (3 m,) int
        Edge of each half-edge.
    """

    faces: Integers
    vertices: int
    keys: Integers
    ends: Integers
    halves: Integers
    edge_of_half: Integers

    @property
    def inner(self) -> Booleans:
        """Edges with a face on either side, (e,)."""
        inner: Booleans = self.halves[:, 1] >= 0
        return inner

    @cached_property
    def apexes(self) -> Integers:
        """Vertices opposite to each edge, (e, 2); -1 where there is no face."""
        half = self.halves
        apex: Integers = self.faces.ravel()[half - half % 3 + (half + 2) % 3]
        apex[half[:, 1] < 0, 1] = NONE
        return apex

    @cached_property
    def sides(self) -> Integers:
        """Faces of each edge, (e, 2); a boundary edge repeats its only one."""
        side = self.halves // 3
        sides: Integers = np.where(side < 0, side[:, :1], side)
        return sides

    @cached_property
    def fans(self) -> tuple[Integers, Integers]:
        """Offsets (n + 1,) and, one vertex after the other, the half-edges that leave it (3 m,)."""
        return grouped(self.faces.ravel(), self.vertices)

    @cached_property
    def neighbours(self) -> tuple[Integers, Integers]:
        """Offsets (n + 1,) and, one vertex after the other, its neighbours (2 e,)."""
        offsets, order = grouped(self.ends.ravel(), self.vertices)
        return offsets, self.ends[:, ::-1].ravel()[order]

    @cached_property
    def valence(self) -> Integers:
        """Number of edges at each vertex, (n,)."""
        return np.bincount(self.ends.ravel(), minlength=self.vertices).astype(np.int64)

    def find(self, start: Integers, end: Integers) -> Integers:
        """Edges between pairs of vertices, -1 where there is none."""
        key = np.minimum(start, end) * self.vertices + np.maximum(start, end)
        place = np.minimum(np.searchsorted(self.keys, key), self.keys.size - 1)
        found: Integers = np.where(self.keys[place] == key, place, NONE)
        return found


def connect(faces: Integers, vertices: int) -> Topology:
    """The topology of consistently oriented faces.

    Raises
    ------
    ValueError
        If an edge has more than two faces, or two that run the same way along it.
    """
    fast = kernel()
    if fast:
        half = 3 * len(faces)
        keys, edge_of_half, order = np.empty((3, half), np.int64)
        ends, halves = np.empty((2, half, 2), np.int64)
        offsets = np.empty(vertices + 1, np.int64)
        count = fast.call("connect", len(faces), vertices, faces, keys, ends, halves, edge_of_half, offsets, order)
        if count < 0:
            raise ValueError(NO_MANIFOLD)
        return Topology(faces, vertices, keys[:count], ends[:count], halves[:count], edge_of_half)
    start, end = faces.ravel(), faces[:, [1, 2, 0]].ravel()
    key = np.minimum(start, end) * vertices + np.maximum(start, end)
    order = np.argsort(key, kind="stable")
    ordered = key[order]
    opens = np.empty(order.size, dtype=bool)
    opens[:1] = True
    np.not_equal(ordered[1:], ordered[:-1], out=opens[1:])
    first = np.flatnonzero(opens)
    times = np.diff(first, append=order.size)
    edge_of_half = np.empty(order.size, dtype=np.int64)
    edge_of_half[order] = np.cumsum(opens) - 1
    halves = np.full((first.size, 2), NONE)
    halves[:, 0] = order[first]
    double = times == 2
    halves[double, 1] = order[first[double] + 1]
    if times.max(initial=0) > 2 or np.any(start[halves[double, 0]] != end[halves[double, 1]]):
        raise ValueError(NO_MANIFOLD)
    ends = np.column_stack([start[halves[:, 0]], end[halves[:, 0]]])
    return Topology(faces, vertices, ordered[first], ends, halves, edge_of_half)


def grouped(owner: Integers, count: int) -> tuple[Integers, Integers]:
    """Offsets (count + 1,) and the places of `owner` sorted by owner."""
    fast = kernel()
    if fast:
        offsets, order = np.empty(count + 1, np.int64), np.empty(owner.size, np.int64)
        fast.call("grouped", owner.size, owner, count, offsets, order)
        return offsets, order
    offsets = np.zeros(count + 1, dtype=np.int64)
    np.cumsum(np.bincount(owner, minlength=count), out=offsets[1:])
    return offsets, np.argsort(owner, kind="stable")


def ragged(rows: tuple[Integers, Integers], which: Integers) -> tuple[Integers, Integers]:
    """Concatenate some rows of a ragged table: position in `which` of each item, and the items."""
    offsets, items = rows
    length = offsets[which + 1] - offsets[which]
    owner = np.repeat(np.arange(which.size), length)
    start = offsets[which] - (np.cumsum(length) - length)
    return owner, items[np.arange(owner.size) + start[owner]]


def disjoint(touched: Integers, rank: Floats | Integers, items: int, passes: int = 4) -> Booleans:
    """Candidates no two of which touch the same item, the better (lower) rank first.

    Parameters
    ----------
    touched : (k, w) int
        Items each candidate touches.
    rank : (k,)
        What to take first; equal ranks are broken by a scattered order, since a rank that grows along the mesh
        would let only one candidate in a row pass.
    items : int
        Number of items.
    passes : int
        Rounds of the selection; more find more of the possible candidates.
    """
    chosen = np.zeros(rank.size, dtype=bool)
    if rank.size == 0:
        return chosen
    place = np.empty(rank.size, dtype=np.int64)
    place[np.lexsort((scattered(rank.size), rank))] = np.arange(rank.size)
    fast = kernel()
    if fast:
        left, best = np.empty(rank.size, np.int64), np.empty(items, np.int64)
        used = np.empty(items, bool)
        fast.call("disjoint", *touched.shape, touched, place, items, passes, chosen, left, best, used)
        return chosen
    left = np.arange(rank.size)
    used = np.zeros(items, dtype=bool)
    for _ in range(passes):
        best = np.full(items, rank.size)
        for column in touched[left].T:
            np.minimum.at(best, column, place[left])
        wins = left[np.all(best[touched[left]] == place[left, None], axis=1)]
        chosen[wins] = True
        used[touched[wins]] = True
        left = left[~used[touched[left]].any(axis=1)]
        if left.size == 0:
            break
    return chosen


def scattered(count: int) -> Integers:
    """The numbers 0 to count - 1 multiplied into disorder, the same at every call."""
    return (np.arange(count, dtype=np.int64) * 2654435761) % 4294967291


def area_vectors(corners: Floats) -> Floats:
    """Normal times area (m^2) of triangles with corners (k, 3, 3)."""
    return 0.5 * crosses(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])


def unit(vectors: Floats) -> Floats:
    """Rows of length 1; a row of zeros stays."""
    length = lengths(vectors)[..., None]
    return vectors / np.where(length > 0, length, 1.0)


def shape(corners: Floats, area: Floats, normal: Floats) -> Floats:
    """Shape of triangles: 1 equilateral, 0 a line, negative when turned away from a normal.

    Parameters
    ----------
    corners : (k, 3, 3)
        Corners (m).
    area : (k, 3)
        Area vectors of the triangles (m^2).
    normal : (k, 3)
        Unit normals the triangles should have. One that leans by more than 60 degrees counts as turned away.
    """
    side = corners - corners[:, [1, 2, 0]]
    squares = dots(side, side).sum(1)
    facing = dots(area, normal)
    size = lengths(area)
    value: Floats = 4.0 * np.sqrt(3.0) * np.where(facing > 0.5 * size, size, np.minimum(facing, 0.0) - 0.01 * size)
    return value / np.where(squares > 0, squares, 1.0)


def corner_angles(corners: Floats) -> Floats:
    """Angles (rad) of triangles with corners (k, 3, 3), (k, 3)."""
    forward = corners[:, [1, 2, 0]] - corners
    backward = corners[:, [2, 0, 1]] - corners
    return np.arctan2(lengths(crosses(forward, backward)), dots(forward, backward))
