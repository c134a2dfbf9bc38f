"""Quad meshes as half edges: stars in order, ways straight on, singular and boundary vertices, all in whole arrays.

Terminology
-----------
Half edge 4 f + c runs from corner c of face f to the next corner, the face to its left. Its twin runs back in the
neighbouring face. The star of a vertex are its neighbours in counter-clockwise order. A vertex is regular when it has
four neighbours, or three on the boundary (two in a corner); there polylines go straight on.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike
from scipy.sparse.csgraph import connected_components

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.errors import InputError
from lamella.base.result import Shown
from lamella.base.wording import counted

# an edge of this share of its length is none any more
COLLAPSED = 1e-3


@dataclass(frozen=True, eq=False, repr=False)
class QuadMesh(Shown):
    """Vertices and consistently oriented quads, see `quad_mesh`.

    Attributes
    ----------
    vertices : (n, 3)
        m.
    faces : (f, 4) int
    twin : (4 f,) int
        -1: boundary.

    Examples
    --------
    >>> import lamella
    >>> mesh = lamella.quad_mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2, 3]])
    >>> mesh.edges.tolist()
    [[0, 1], [1, 2], [2, 3], [3, 0]]
    """

    vertices: Floats
    faces: Integers
    twin: Integers

    def _line(self) -> str:
        return f"{counted(len(self.vertices), 'vertex', 'vertices')}, {counted(len(self.faces), 'face')}"

    @cached_property
    def tail(self) -> Integers:
        """Vertex where each half edge begins, (4 f,)."""
        return np.ascontiguousarray(self.faces.ravel())

    @cached_property
    def next(self) -> Integers:
        """Half edge that follows in the same face, (4 f,)."""
        half = np.arange(self.faces.size)
        return np.where(half % 4 == 3, half - 3, half + 1)

    @cached_property
    def head(self) -> Integers:
        """Vertex where each half edge ends, (4 f,)."""
        return np.asarray(self.tail[self.next])

    @cached_property
    def edges(self) -> Integers:
        """Each edge once, (e, 2)."""
        return np.column_stack([self.tail[self.forward], self.head[self.forward]])

    @cached_property
    def edge_of(self) -> Integers:
        """Which of `edges` each half edge is, (4 f,)."""
        number = np.cumsum(self.forward) - 1
        return np.where(self.forward, number, number[self.twin])

    @cached_property
    def forward(self) -> Booleans:
        """Whether each half edge runs as its edge in `edges` does, (4 f,)."""
        return np.asarray((self.twin < 0) | (np.arange(len(self.twin)) < self.twin))

    @cached_property
    def mean_edge(self) -> float:
        """Mean edge length, m."""
        a, b = self.vertices[self.edges].swapaxes(0, 1)
        return float(np.linalg.norm(b - a, axis=1).mean())

    @cached_property
    def face_count(self) -> Integers:
        """Faces at each vertex, (n,)."""
        return np.bincount(self.tail, minlength=len(self.vertices))

    @cached_property
    def on_boundary(self) -> Booleans:
        """Whether a vertex is on the boundary, (n,)."""
        flags = np.zeros(len(self.vertices), bool)
        rim = self.twin < 0
        flags[self.tail[rim]] = flags[self.head[rim]] = True
        return flags

    @cached_property
    def valence(self) -> Integers:
        """Neighbours of each vertex, (n,)."""
        return np.asarray(self.face_count + self.on_boundary)

    @cached_property
    def inner(self) -> Integers:
        """Regular vertices inside, in ascending order."""
        return np.flatnonzero(~self.on_boundary & (self.face_count == 4))

    @cached_property
    def singular(self) -> Integers:
        """Vertices inside with 3, 5, 6 or more neighbours."""
        return np.flatnonzero(~self.on_boundary & (self.face_count != 4) & (self.face_count > 0))

    def stars(self, vertices: Integers) -> Integers:
        """Neighbours in counter-clockwise order, (m, k), of inner vertices that all have k of them.

        On a regular vertex the first and third, and the second and fourth, are on one polyline.
        """
        return np.asarray(self.head[self.spokes(vertices)])

    def spokes(self, vertices: Integers) -> Integers:
        """Half edges from vertices to their `stars`."""
        count = self.face_count[vertices]
        assert not self.on_boundary[vertices].any()
        assert len(np.unique(count)) <= 1
        half = self._leaving[vertices]
        found = []
        for _ in range(int(count[0]) if len(count) else 4):
            found.append(half)
            half = self.twin[self._previous[half]]
        return np.stack(found, 1)

    @cached_property
    def families(self) -> Integers:
        """Family, 0 or 1, of each half edge: opposite sides of a quad belong to one, adjacent sides to both.

        Family 0 has the first half edge of each connected piece.

        Raises
        ------
        InputError
            There are no two families: around a vertex of odd valence they swap.
        """
        half = np.arange(len(self.twin))
        edge = np.where(self.twin >= 0, np.minimum(half, self.twin), half)
        # each edge as a member of either family; sides of a quad in turn change the family
        one, other = edge, edge[self.next]
        count = len(half)
        links = (np.concatenate([one, one + count]), np.concatenate([other + count, other]))
        graph = sp.coo_matrix((np.ones(2 * count, bool), links), (2 * count, 2 * count))
        _, label = connected_components(graph, directed=False)
        if (label[edge] == label[edge + count]).any():
            odd = self.singular[self.face_count[self.singular] % 2 == 1]
            where = (
                f"vertex {odd[0]} has {self.face_count[odd[0]]} neighbours" if len(odd) else "around a hole they swap"
            )
            raise InputError(
                f"the polylines do not form two families: {where}",
                "only a right angle is the same for both orders of the families: leave the angle at 90 degrees",
            )
        # the lesser label came first
        return np.asarray(label[edge] > label[edge + count], np.int64)

    @cached_property
    def _previous(self) -> Integers:
        half = np.arange(self.faces.size)
        return np.where(half % 4 == 0, half + 3, half - 1)

    @cached_property
    def _leaving(self) -> Integers:
        """Some half edge that leaves each vertex; -1: the vertex is in no face."""
        leaving = np.full(len(self.vertices), -1)
        leaving[self.tail[::-1]] = np.arange(len(self.tail))[::-1]
        return leaving

    @cached_property
    def straight(self) -> Integers:
        """Half edge straight on beyond the head of each; -1: the polyline ends there.

        The boundary is a polyline of its own, in the direction that has the mesh to its left; at a re-entrant corner
        with four neighbours polylines go on across it, in the one direction in which half edges exist.
        """
        across = self.twin[self.next]
        on = np.where(across >= 0, self.next[across], -1)
        count, rim = self.face_count[self.head], self.on_boundary[self.head]
        # along the boundary past two faces; across it in a re-entrant corner with four neighbours
        regular = np.where(rim, np.where(self.twin < 0, (count == 2) | (count == 3), count == 3), count == 4)
        return np.where(regular, on, -1)

    def runs(self, length: int) -> Integers:
        """All sequences of so many consecutive vertices of polylines, each once, (m, length)."""
        half = np.arange(len(self.twin))
        found = [self.tail, self.head]
        alive = np.ones(len(half), bool)
        for _ in range(length - 2):
            half = np.where(alive, self.straight[half], 0)
            alive &= half >= 0
            half = np.maximum(half, 0)
            found.append(self.head[half])
        runs = np.stack(found, 1)[alive]
        # most are seen from both ends: the first and the last edge tell which are the same
        count = len(self.vertices)
        ends = np.stack([runs[:, 0] * count + runs[:, 1], runs[:, -1] * count + runs[:, -2]])
        runs = np.where((ends[0] > ends[1])[:, None], runs[:, ::-1], runs)
        ends.sort(axis=0)
        order = np.lexsort(ends[::-1])
        new = np.concatenate([[True], (np.diff(ends[:, order]) != 0).any(0)])
        return np.asarray(runs[order[new[: len(order)]]])

    def at(self, vertices: Floats) -> QuadMesh:
        """The same mesh with its vertices elsewhere."""
        return QuadMesh(np.asarray(vertices, np.float64), self.faces, self.twin)


def collapsed(before: QuadMesh, after: QuadMesh) -> bool:
    """Whether an edge has lost its length on the way from one mesh to the same mesh elsewhere."""
    length = [np.linalg.norm(np.diff(m.vertices[before.edges], axis=1)[:, 0], axis=1) for m in (before, after)]
    return bool((length[1] < COLLAPSED * length[0]).any())


def quad_mesh(vertices: ArrayLike, faces: ArrayLike) -> QuadMesh:
    """Check a quad mesh and find its neighbours.

    Parameters
    ----------
    vertices : (n, 3)
        m.
    faces : (f, 4) int
        Vertex indices around each quad, neighbours in the same sense.

    Raises
    ------
    InputError
        Wrong shapes, coordinates that are no numbers, indices outside, a vertex twice in a quad, edges with more than
        two faces or with faces of opposite sense, fans that only touch in a vertex.

    Examples
    --------
    >>> import lamella
    >>> lamella.quad_mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2, 3]])
    QuadMesh(4 vertices, 1 face)
    """
    points = np.asarray(vertices, np.float64)
    quads = np.asarray(faces)
    if points.ndim != 2 or points.shape[1] != 3:
        raise InputError(f"vertices have shape {points.shape}", "(n, 3) is expected")
    if quads.ndim != 2 or quads.shape[1] != 4 or not len(quads) or not np.issubdtype(quads.dtype, np.integer):
        raise InputError(
            f"faces have shape {quads.shape} and type {quads.dtype}", "at least one quad is expected, (f, 4) integers"
        )
    quads = quads.astype(np.int64)
    if not np.isfinite(points).all():
        bad = int(np.flatnonzero(~np.isfinite(points).all(1))[0])
        raise InputError(f"vertex {bad} is {points[bad].tolist()}", "all coordinates have to be finite numbers")
    if quads.min() < 0 or quads.max() >= len(points):
        raise InputError(
            f"a face names vertex {quads.min() if quads.min() < 0 else quads.max()}",
            f"indices run from 0 to {len(points) - 1}",
        )
    ordered = np.sort(quads, axis=1)
    twice = np.flatnonzero((ordered[:, 1:] == ordered[:, :-1]).any(1))
    if len(twice):
        raise InputError(
            f"face {twice[0]} is {quads[twice[0]].tolist()}: a vertex comes twice",
            "the mesh has to consist of quads: subdivide triangles into quads (mid-edge) or leave them out",
        )
    tail, head = quads.ravel(), np.roll(quads, -1, axis=1).ravel()
    mesh = QuadMesh(points, quads, _twins(tail, head, len(points)))
    _check_fans(mesh)
    return mesh


def _twins(tail: Integers, head: Integers, count: int) -> Integers:
    """Half edge that runs back, for each; -1: none."""
    key = tail * count + head
    order = np.argsort(key, kind="stable")
    same = np.flatnonzero(np.diff(key[order]) == 0)
    if len(same):
        one, other = order[same[0]], order[same[0] + 1]
        raise InputError(
            f"faces {one // 4} and {other // 4} both run from vertex {tail[one]} to vertex {head[one]}",
            "faces need one sense throughout and at most two may share an edge: unify the normals, split the mesh",
        )
    back = head * count + tail
    place = np.minimum(np.searchsorted(key[order], back), len(order) - 1)
    return np.where(key[order][place] == back, order[place], -1)


def _check_fans(mesh: QuadMesh) -> None:
    """Refuse vertices at which faces do not form one fan or one ring."""
    rim = np.bincount(mesh.tail[mesh.twin < 0], minlength=len(mesh.vertices))
    torn = np.flatnonzero(rim > 1)
    if not len(torn):
        # rings that touch: walking round from one half edge misses some
        half, count = mesh._leaving.copy(), np.zeros(len(mesh.vertices), np.int64)
        closed = np.flatnonzero(~mesh.on_boundary & (mesh.face_count > 0))
        at, first = half[closed], half[closed]
        active = np.ones(len(closed), bool)
        while active.any():
            count[closed[active]] += 1
            at = np.where(active, mesh.twin[mesh._previous[at]], at)
            active &= at != first
        torn = closed[count[closed] != mesh.face_count[closed]]
    if len(torn):
        raise InputError(
            f"at vertex {torn[0]} faces touch that share no edge", "split the vertex: each fan of faces its own"
        )
