"""Straight lines of the plane of w, followed over a cut surface.

|dw| is a flat metric on the surface, with cone points at the umbilics: its shortest lines are straight in the plane of
w. They are followed over small flat triangles, on which w is taken as linear, from sheet to sheet of the cut.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lamella.base.arrays import Booleans, Complexes, Floats, Integers
from lamella.network.isothermic.isothermic import Isothermic
from lamella.surface.element.connectivity import Connectivity, connect
from lamella.surface.element.lagrange import EDGES, lagrange, local_faces

# small triangles along the edge of an element
WALK_PARTS = 3
# a straight line passes this many triangles at most, over the root of how many there are: what goes on has lost its way
WALK_LENGTH_MAX = 8


@dataclass(frozen=True)
class FlatTriangles:
    """A cut surface in small triangles of the plane of w, each on the sheet of its element.

    Attributes
    ----------
    iso : Isothermic
    grid : Connectivity
        Of the triangles; triangle t is number t % WALK_PARTS^2 of element t // WALK_PARTS^2.
    points : (g, 3)
        m.
    w : (t, 3) complex
        At the corners, sqrt(m).
    sign : (t, 3)
    shift : (t, 3) complex
        Through a local edge w goes over into sign w + shift.
    loop : (t, 3) int
        Boundary loop on which a local edge lies, -1: none.
    at_umbilic : (t,) bool
        Whether an umbilic is one of the corners.
    """

    iso: Isothermic
    grid: Connectivity
    points: Floats
    w: Complexes
    sign: Floats
    shift: Complexes
    loop: Integers
    at_umbilic: Booleans

    @classmethod
    def of(cls, iso: Isothermic) -> FlatTriangles:
        """Those of isothermic coordinates."""
        connectivity = iso.mesh.connectivity
        fine = connect(connectivity.faces, len(iso.mesh.loop), WALK_PARTS)
        faces = local_faces(WALK_PARTS)
        shapes = connectivity.basis.basis(fine.basis.nodes)
        points = np.empty((fine.node_count, 3))
        points[fine.elements] = np.einsum("gk,mkc->mgc", shapes, iso.mesh.nodes[connectivity.elements])
        w = (iso.value @ shapes.T)[:, faces].reshape(-1, 3)
        grid = connect(fine.elements[:, faces].reshape(-1, 3), fine.node_count, 1)
        on_edge = edges_of_element()
        outer = np.broadcast_to(on_edge >= 0, (len(connectivity.faces), *on_edge.shape)).reshape(-1, 3)
        through = np.where(outer, iso.across[:, on_edge].reshape(-1, 3), 0)
        signs = np.array([1.0, *(piece.sign for piece in iso.transitions)])
        shifts = np.array([0.0, *(piece.shift for piece in iso.transitions)], complex)
        number = np.abs(through)
        back = -signs[number] * shifts[number]
        rim = np.full(connectivity.faces.shape, -1)
        rim[connectivity.rim_elements, connectivity.rim_edges] = iso.mesh.loop[connectivity.rim_nodes[:, 0]]
        loop = np.where(outer, rim[:, on_edge].reshape(-1, 3), -1)
        inside = iso.mesh.umbilics[iso.mesh.umbilics >= 0]
        at_umbilic = np.asarray(np.isin(grid.faces, inside).any(1))
        return cls(iso, grid, points, w, signs[number], np.where(through < 0, back, shifts[number]), loop, at_umbilic)

    @property
    def most_steps(self) -> int:
        """Triangles that a straight line passes at most."""
        return int(WALK_LENGTH_MAX * np.sqrt(len(self.w))) + 100

    @cached_property
    def rim_places(self) -> tuple[Floats, Floats]:
        """Shares of their loop's length at which boundary edges begin, and which they span, from its start, (t, 3)."""
        begin, span = np.full(self.loop.shape, np.nan), np.full(self.loop.shape, np.nan)
        for number, start in enumerate(self.iso.mesh.rim_starts):
            triangle, edge = self.rim_chain(number)
            first = self.points[self.grid.faces[triangle, edge]]
            along = np.linalg.norm(np.roll(first, -1, 0) - first, axis=1)
            shares = along / along.sum()
            at = np.cumsum(shares) - shares
            nearest = int(np.linalg.norm(first - start, axis=1).argmin())
            begin[triangle, edge], span[triangle, edge] = (at - at[nearest]) % 1, shares
        return begin, span

    def small_edge(self, element: int, edge: int, local: Floats) -> tuple[tuple[int, int], float]:
        """Small triangle and its edge on an edge of an element at local coordinates (2,), and the share of its length.

        It runs as the element's edge does.
        """
        share = share_of_edge(local, edge) * WALK_PARTS
        part = int(np.clip(np.floor(share), 0, WALK_PARTS - 1))
        nodes = lagrange(WALK_PARTS).edge_nodes[edge]
        faces = local_faces(WALK_PARTS)
        one = (faces == nodes[part]) & (np.roll(faces, -1, 1) == nodes[part + 1])
        small, at = (int(part[0]) for part in np.nonzero(one))
        return (element * len(faces) + small, at), float(share - part)

    def inwards(self, triangle: Integers, edge: Integers, share: Floats) -> Complexes:
        """Unit directions of w at right angles to the rim, from shares of small edges on it, (n,)."""
        basis = self.iso.mesh.connectivity.basis
        small = lagrange(WALK_PARTS).nodes[local_faces(WALK_PARTS)]
        element, number = np.divmod(triangle, len(small))
        first, last = small[number, edge], small[number, (edge + 1) % 3]
        local, along = first + share[:, None] * (last - first), last - first
        x, y = ((self.iso.value[element] * basis.basis(local, *d)).sum(1) for d in ((1, 0), (0, 1)))
        slope = 1j * (x * along[:, 0] + y * along[:, 1])
        return np.asarray(slope / np.abs(slope))

    def rim_chain(self, loop: int) -> tuple[Integers, Integers]:
        """Boundary edges of a loop one after the other, from a vertex of the elements on, as triangles and edges."""
        triangle, edge = np.nonzero(self.loop == loop)
        first = self.grid.faces[triangle, edge]
        last = self.grid.faces[triangle, (edge + 1) % 3]
        after = dict(zip(first.tolist(), range(len(first)), strict=True))
        order = [int(first.argmin())]
        while len(order) < len(first):
            order.append(after[int(last[order[-1]])])
        return triangle[order], edge[order]


@dataclass(frozen=True)
class Heads:
    """Lines on their way.

    Attributes
    ----------
    line : (n,) int
        Which ones of those that set out.
    triangle, edge : (n,) int
        Where they are, and the local edge through which they came in.
    place, heading : (n,) complex
        w and direction there, on the triangle's sheet.
    sign, shift : (n,)
        w on the sheet where the line set out goes over into sign w + shift on this one.
    """

    line: Integers
    triangle: Integers
    edge: Integers
    place: Complexes
    heading: Complexes
    sign: Floats
    shift: Complexes

    @classmethod
    def out(cls, triangle: Integers, edge: Integers, place: Complexes, heading: Complexes) -> Heads:
        """Lines that set out, on the sheets of these triangles."""
        count = len(triangle)
        return cls(np.arange(count), triangle, edge, place, heading, np.ones(count), np.zeros(count, complex))

    def __getitem__(self, index: Booleans | Integers) -> Heads:
        return Heads(*(getattr(self, name)[index] for name in self.__dataclass_fields__))

    @property
    def set_out(self) -> Complexes:
        """The direction in which each line set out, (n,)."""
        return np.asarray(self.sign * self.heading)

    def at_start(self, w: Complexes) -> Complexes:
        """w of the sheets where the lines are, on those where they set out, (n,)."""
        return np.asarray((w - self.shift) * self.sign)

    def exits(self, flat: FlatTriangles) -> tuple[Integers, Floats, Complexes]:
        """Local edge through which each line leaves its triangle, share of the edge's length, and w there."""
        w = flat.w[self.triangle]
        rows = np.arange(len(w))
        apex = w[rows, (self.edge + 2) % 3]
        left = cross(self.heading, apex - self.place) > 0
        edge = np.where(left, self.edge + 1, self.edge + 2) % 3
        first, last = w[rows, edge], w[rows, (edge + 1) % 3]
        across = cross(self.heading, last - first)
        share = cross(self.heading, self.place - first) / np.where(across == 0, np.inf, across)
        share = np.clip(share, 0.0, 1.0)
        return edge, share, first + share * (last - first)

    def through(self, flat: FlatTriangles, edge: Integers, place: Complexes) -> Heads:
        """The lines in the next triangles, through edges at places."""
        at = self.triangle, edge
        sign, shift = flat.sign[at], flat.shift[at]
        return Heads(
            self.line,
            flat.grid.neighbours[at],
            flat.grid.neighbour_edges[at],
            sign * place + shift,
            sign * self.heading,
            sign * self.sign,
            sign * self.shift + shift,
        )


def edges_of_element() -> Integers:
    """Edge of its element on which each edge of each small triangle lies, -1: none, (WALK_PARTS^2, 3)."""
    faces = local_faces(WALK_PARTS)
    result = np.full((len(faces), 3), -1)
    for edge, nodes in enumerate(lagrange(WALK_PARTS).edge_nodes):
        there = np.isin(faces, nodes)
        for local, (a, b) in enumerate(EDGES):
            result[there[:, a] & there[:, b], local] = edge
    return result


def share_of_edge(local: Floats, edge: int) -> float:
    """Share of an element's local edge at local coordinates (2,) on it."""
    return float((local[0], local[1], 1 - local[1])[edge])


def cross(one: Complexes, other: Complexes) -> Floats:
    """Two-dimensional cross product of complex numbers."""
    return np.asarray(one.real * other.imag - one.imag * other.real)
