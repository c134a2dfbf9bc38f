"""Isothermic coordinates on a surface of elements: one Poisson problem on a cut surface.

With the trace-free shape operator D as a complex number (`SurfacePoints.deviator`) the closed forms are
du + i dv = sqrt(D) dz, dz the tangent vector as a complex number. The root's sign is made consistent from element to
element; where that fails the surface is cut: from every umbilic of odd order to the boundary and between the rims.
Across a cut w = u + i v goes over into +-w + c; these c are the periods.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import breadth_first_order, connected_components, minimum_spanning_tree

from lamella.base.arrays import Booleans, Complexes, Floats, Integers
from lamella.base.ties import MARGIN
from lamella.network.isothermic.integration_mesh import IntegrationMesh
from lamella.network.isothermic.poisson import Poisson, deviator_root
from lamella.surface.element.connectivity import Connectivity
from lamella.surface.element.edge_basis import edge_values
from lamella.surface.element.quadrature import triangle_rule


@dataclass(frozen=True)
class Transition:
    """One piece of the cut, between two of its ends or branches: w on the right is sign w on the left + shift.

    Attributes
    ----------
    left, right : (c,) int
        Elements on both sides of each edge of the piece.
    left_edge, right_edge : (c,) int
        Their local edges.
    sign : int
    shift : complex
        sqrt(m).
    ends : (2,) int
        Where the piece ends: boundary loop k as -1 - k, or a vertex.
    stub : bool
        Whether it leads from a corner of the rim into nothing: there w goes like a power that turns it by itself.
    """

    left: Integers
    right: Integers
    left_edge: Integers
    right_edge: Integers
    sign: int
    shift: complex
    ends: tuple[int, int]
    stub: bool = False


@dataclass(frozen=True)
class Isothermic:
    """w = u + i v on a cut surface.

    Attributes
    ----------
    mesh : IntegrationMesh
    odd : (z,) int
        Vertices that are umbilics of odd order.
    sign : (m,) int
        Of each element's root.
    cut : (m, 3) bool
        Local edges that are cut.
    value : (m, k) complex
        w at each element's own nodes, sqrt(m).
    transitions : tuple of Transition
    across : (m, 3) int
        Transition through each local edge: 0: none, t + 1: transition t from left to right, -t - 1: back.
    moves : (t, m, k)
        How w changes with the shift of each transition, the least that |change of dw|^2 / |D|^2 can be.
    gram : (t, t)
        That integral, per pair of shifts.
    residual : float
        Root mean square of |dw - sqrt(D) dz| over that of |sqrt(D) dz|: how far the surface is from constant mean
        curvature.
    plain : Poisson
        What w was fitted to, not weighted.
    """

    mesh: IntegrationMesh
    odd: Integers
    sign: Integers
    cut: Booleans
    value: Complexes
    transitions: tuple[Transition, ...]
    across: Integers
    moves: Floats
    gram: Floats
    residual: float
    plain: Poisson

    @cached_property
    def on_rim(self) -> Complexes:
        """w all along the rim, sqrt(m), (n,): harmonic functions have their extremes there."""
        connectivity = self.mesh.connectivity
        nodes = connectivity.basis.edge_nodes[connectivity.rim_edges]
        along = edge_values(connectivity.basis.order, np.linspace(0, 1, ALONG_EDGE))
        return np.asarray((self.value[connectivity.rim_elements[:, None], nodes] @ along.T).ravel())

    @cached_property
    def longest(self) -> float:
        """How far u or v reaches over the cut surface, sqrt(m)."""
        cut = self.value[:, :3][self.cut.any(1)]
        return float(max(np.ptp(np.concatenate([part(self.on_rim), part(cut).ravel()])) for part in (np.real, np.imag)))

    @cached_property
    def area(self) -> float:
        """Of the surface in the plane of w, m: the integral of mu^2."""
        basis = self.mesh.connectivity.basis
        points, weights = triangle_rule(2 * basis.order - 2)
        w_x, w_y = (self.value @ basis.basis(points, *d).T for d in ((1, 0), (0, 1)))
        return float((np.abs(w_x.real * w_y.imag - w_x.imag * w_y.real) * weights).sum())

    @cached_property
    def dirichlet(self) -> Floats:
        """The integral of |change of dw|^2 per pair of shifts, (t, t): without the weight, how large a change is.

        Where two zeros are close `gram` is large for what pulls them apart, however little that is.
        """
        stiff = np.matmul(self.plain.blocks, self.moves[..., None])[..., 0]
        return np.asarray(np.einsum("tek,sek->ts", self.moves, stiff))


# places along an edge of the rim among which extremes are looked for
ALONG_EDGE = 17
# middles of the local edges and the edges' directions in local coordinates
_MIDDLES = np.array([[0.5, 0.0], [0.5, 0.5], [0.0, 0.5]])
_DIRECTIONS = np.array([[1.0, 0.0], [-1.0, 1.0], [0.0, -1.0]])


@dataclass(frozen=True)
class EdgeTurns:
    """What roots do over the edges between elements, once from either side.

    Attributes
    ----------
    element, edge, neighbour : (e,) int
    same : (e,) int
        -1 where the roots of the elements on both sides run against each other.
    root : (m, 3) complex
        At the middles of all local edges.
    """

    element: Integers
    edge: Integers
    neighbour: Integers
    same: Integers
    root: Complexes

    @classmethod
    def of(cls, mesh: IntegrationMesh) -> EdgeTurns:
        """Of each element's own branch."""
        root, along, other, _ = deviator_root(mesh, _MIDDLES)
        through = root * (along * _DIRECTIONS[:, 0] + other * _DIRECTIONS[:, 1])
        connectivity = mesh.connectivity
        element, edge = np.nonzero(connectivity.neighbours >= 0)
        neighbour = connectivity.neighbours[element, edge]
        back = through[neighbour, connectivity.neighbour_edges[element, edge]]
        # the neighbour runs along the edge the other way
        same = np.where((through[element, edge] * -back.conj()).real > 0, 1, -1)
        return cls(element, edge, neighbour, same, root)

    def turns(self, sign: Integers) -> Integers:
        """What roots with signs (m,) do over edges, (m, 3): -1 where they run against each other."""
        result = np.ones(self.root.shape, np.int64)
        result[self.element, self.edge] = self.same * sign[self.element] * sign[self.neighbour]
        return result


def root_signs(mesh: IntegrationMesh, cut: Booleans) -> tuple[Integers, Booleans, Integers]:
    """Sign of each element's root, (m,), alike across what is not cut; the cut; and what signs do over edges, (m, 3).

    Where an umbilic next to the rim was not cut to, the signs still disagree across some edges: these are cut as well.
    """
    edges = EdgeTurns.of(mesh)
    m = len(mesh.connectivity.elements)
    over = ~cut[edges.element, edges.edge]
    element, edge, neighbour, same = (part[over] for part in (edges.element, edges.edge, edges.neighbour, edges.same))
    # signs are handed on where the root is large, away from umbilics
    cost = 1 / np.maximum(np.abs(edges.root[element, edge]), 1e-300)
    tree = minimum_spanning_tree(coo_matrix((cost, (element, neighbour)), (m, m)).tocsr())
    # of equal ones the first
    size = np.abs(edges.root).mean(1)
    start = int(np.rint(size / (MARGIN * size.max())).argmax())
    order, parent = breadth_first_order(tree, start, directed=False)
    relation = coo_matrix((same, (element, neighbour)), (m, m)).tocsr()
    to_parent = np.asarray(relation[order[1:], parent[order[1:]]]).ravel()
    sign = np.ones(m, np.int64)
    for child, value in zip(order[1:].tolist(), to_parent.tolist(), strict=True):
        sign[child] = value * sign[parent[child]]
    cut = cut.copy()
    off = same * sign[element] * sign[neighbour] < 0
    cut[element[off], edge[off]] = True
    return sign, cut, edges.turns(sign)


def sectors(connectivity: Connectivity, cut: Booleans) -> Integers:
    """Number of the unknown of each element's own nodes, (m, k): nodes are shared across edges that are not cut."""
    m, k = connectivity.elements.shape
    element, edge = np.nonzero((connectivity.neighbours >= 0) & ~cut)
    neighbour, other = connectivity.neighbours[element, edge], connectivity.neighbour_edges[element, edge]
    mine = element[:, None] * k + connectivity.basis.edge_nodes[edge]
    theirs = neighbour[:, None] * k + connectivity.basis.edge_nodes[other][:, ::-1]
    graph = coo_matrix((np.ones(mine.size), (mine.ravel(), theirs.ravel())), (m * k, m * k))
    _, group = connected_components(graph, directed=False)
    return np.asarray(group.reshape(m, k), np.int64)


def cut_pieces(
    mesh: IntegrationMesh, cut: Booleans, turns: Integers, odd: Integers
) -> tuple[tuple[Transition, ...], Integers]:
    """The pieces of the cut, their shifts still 0, and the transition through each local edge (m, 3).

    Parameters
    ----------
    mesh : IntegrationMesh
    cut : (m, 3) bool
    turns : (m, 3) int
        -1 where the roots of the elements on both sides of an edge run against each other.
    odd : (z,) int
        Vertices that are umbilics of odd order.
    """
    connectivity = mesh.connectivity
    element, edge = np.nonzero(cut)
    once = element < connectivity.neighbours[element, edge]
    element, edge = element[once], edge[once]
    ends = connectivity.faces[element[:, None], (edge[:, None] + [0, 1]) % 3]
    vertices = int(connectivity.faces.max()) + 1
    rim = mesh.loop[ends] >= 0
    degree = np.bincount(ends[~rim].ravel(), minlength=vertices)
    # edges that meet in an inner vertex of two edges belong to one piece, but for odd umbilics: w turns around them
    passed = (degree == 2) & (mesh.loop < 0)
    passed[odd] = False
    owner: dict[int, int] = {}
    links = []
    for number, (a, b) in enumerate(ends.tolist()):
        for vertex in (a, b):
            if passed[vertex]:
                if vertex in owner:
                    links.append((owner[vertex], number))
                else:
                    owner[vertex] = number
    pairs = np.array(links, np.int64).reshape(-1, 2)
    count = len(element)
    graph = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), (count, count))
    pieces, group = connected_components(graph, directed=False) if count else (0, np.zeros(0, np.int64))
    across = np.zeros(cut.shape, np.int64)
    result = []
    for piece in range(pieces):
        mine = _chained(np.flatnonzero(group == piece), ends)
        index = np.array([i for i, _ in mine])
        forward = np.array([direction for _, direction in mine])
        one, one_edge = element[index], edge[index]
        two, two_edge = connectivity.neighbours[one, one_edge], connectivity.neighbour_edges[one, one_edge]
        # left of the way along the piece is the element that has the edge in this direction
        left, left_edge = np.where(forward, one, two), np.where(forward, one_edge, two_edge)
        right, right_edge = np.where(forward, two, one), np.where(forward, two_edge, one_edge)
        sign = 1 if turns[left, left_edge].sum() > 0 else -1
        across[left, left_edge], across[right, right_edge] = piece + 1, -piece - 1
        first, last = ends[index[0]][0 if forward[0] else 1], ends[index[-1]][1 if forward[-1] else 0]
        where = (_end(mesh, int(first)), _end(mesh, int(last)))
        result.append(Transition(left, right, left_edge, right_edge, sign, 0j, where))
    met = Counter(end for piece in result for end in piece.ends)
    return tuple(replace(piece, stub=_is_stub(mesh, piece, odd, met)) for piece in result), across


def _is_stub(mesh: IntegrationMesh, piece: Transition, odd: Integers, met: Counter[int]) -> bool:
    """Whether a piece ends in no umbilic and on no other piece, next to a corner of the rim."""
    tips = [end for end in piece.ends if end >= 0 and met[end] == 1 and end not in odd]
    return bool(mesh.at_corner(mesh.nodes[tips]).any())


def _end(mesh: IntegrationMesh, vertex: int) -> int:
    loop = int(mesh.loop[vertex])
    return -1 - loop if loop >= 0 else vertex


def _chained(edges: Integers, ends: Integers) -> list[tuple[int, bool]]:
    """Edges of one piece in order along it, each with whether it is passed from its first end to its second."""
    at: dict[int, list[int]] = {}
    for number in edges.tolist():
        for vertex in ends[number].tolist():
            at.setdefault(vertex, []).append(number)
    tips = [vertex for vertex, numbers in at.items() if len(numbers) == 1]
    vertex = tips[0]
    left = set(edges.tolist())
    result = []
    while left:
        number = next((n for n in at[vertex] if n in left), None)
        if number is None:
            break
        forward = int(ends[number][0]) == vertex
        result.append((number, forward))
        left.discard(number)
        vertex = int(ends[number][1 if forward else 0])
    return result
