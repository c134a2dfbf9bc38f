"""Isothermic coordinates on a surface of elements: one Poisson problem on a cut surface.

With the trace-free shape operator D as a complex number (`SurfacePoints.deviator`) the closed forms are
du + i dv = sqrt(D) dz, dz the tangent vector as a complex number. The root's sign is made consistent from element to
element; where that fails the surface is cut: from every umbilic of odd order to the boundary and between the rims.
Across a cut w = u + i v goes over into +-w + c; these c are the periods.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import breadth_first_order, connected_components, minimum_spanning_tree

from lamella.network.cut import cut_edges
from lamella.network.net_mesh import COLUMNS, ROWS, NetMesh
from lamella.sparse import SymmetricPattern, packed
from lamella.surface.element.connectivity import Connectivity
from lamella.surface.element.geometry import dirichlet_blocks, tangents, weighted_dirichlet_blocks
from lamella.surface.element.quadrature import triangle_rule
from lamella.surface.points import Complexes, Floats

Integers = NDArray[np.int64]


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
    spread : float
        Largest departure of single nodes from the shift, sqrt(m).
    ends : (2,) int
        Where the piece ends: boundary loop k as -1 - k, or a vertex.
    """

    left: Integers
    right: Integers
    left_edge: Integers
    right_edge: Integers
    sign: int
    shift: complex
    spread: float
    ends: tuple[int, int]


@dataclass(frozen=True)
class Isothermic:
    """w = u + i v on a cut surface.

    Attributes
    ----------
    mesh : NetMesh
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
    residual : float
        Root mean square of |dw - sqrt(D) dz| over that of |sqrt(D) dz|: how far the surface is from constant mean
        curvature.
    """

    mesh: NetMesh
    odd: Integers
    sign: Integers
    cut: NDArray[np.bool_]
    value: Complexes
    transitions: tuple[Transition, ...]
    across: Integers
    residual: float


class FoldedError(ValueError):
    """Shifts that fold the net; `place` (3,), m, says where."""

    def __init__(self, place: Floats) -> None:
        super().__init__("the coordinates turn over")
        self.place = place


def integrate(mesh: NetMesh, odd: Integers) -> Isothermic:
    """Isothermic coordinates of a surface.

    Parameters
    ----------
    mesh : NetMesh
    odd : (z,) int
        Vertices that are umbilics of odd order.
    """
    cut = cut_edges(mesh, odd)
    sign, cut = _signs(mesh, cut)
    sector = sectors(mesh.connectivity, cut)
    system = _Poisson.of(mesh, sign)
    value = system.solve(sector, np.ones(sector.max() + 1), np.zeros(sector.max() + 1, complex), {0: 0j})
    transitions, across = _transitions(mesh, cut, value, odd)
    return Isothermic(mesh, odd, sign, cut, value, transitions, across, system.residual(value))


def with_shifts(iso: Isothermic, shifts: Complexes) -> Isothermic:
    """The coordinates nearest to the given ones whose transitions have exactly these shifts.

    What is least is the integral of |change of dw|^2 / |D|^2. After a plain harmonic change, r^(1/2) next to a zero of
    order 1, half of the rays would miss it; with the weight the change dies out faster than w itself at all zeros.

    Parameters
    ----------
    iso : Isothermic
    shifts : (t,) complex
        sqrt(m); nan: the two sides of that piece stay free of each other.

    Raises
    ------
    FoldedError
        The coordinates would turn over somewhere.
    ValueError
        The shifts contradict each other where pieces of the cut meet.
    """
    mesh = iso.mesh
    sector = sectors(mesh.connectivity, iso.cut)
    nodes = mesh.connectivity.basis.edge_nodes
    links: dict[int, list[tuple[int, int, complex]]] = {}
    for piece, shift in zip(iso.transitions, shifts.tolist(), strict=True):
        if np.isnan(shift):
            continue
        left = sector[piece.left[:, None], nodes[piece.left_edge]].ravel()
        right = sector[piece.right[:, None], nodes[piece.right_edge][:, ::-1]].ravel()
        for one, other in zip(left.tolist(), right.tolist(), strict=True):
            links.setdefault(one, []).append((other, piece.sign, shift))
            links.setdefault(other, []).append((one, piece.sign, -piece.sign * shift))
    count = int(sector.max()) + 1
    sign, offset = np.ones(count), np.zeros(count, complex)
    home = np.arange(count)
    fixed: dict[int, complex] = {}
    tolerance = 1e-9 * max(1.0, float(np.nanmax(np.abs(shifts), initial=0.0)))
    for first in links:
        if home[first] != first or sign[first] != 1 or offset[first] != 0:
            continue
        stack = [first]
        reached = {first}
        while stack:
            one = stack.pop()
            for other, turn, shift in links[one]:
                new_sign, new_offset = turn * sign[one], turn * offset[one] + shift
                if other not in reached:
                    reached.add(other)
                    home[other], sign[other], offset[other] = first, new_sign, new_offset
                    stack.append(other)
                elif new_sign != sign[other]:
                    fixed[first] = complex((offset[other] - new_offset) / (new_sign - sign[other]))
                elif abs(new_offset - offset[other]) > tolerance:
                    raise ValueError("the shifts contradict each other where cuts meet")
    system = _Poisson.of(mesh, iso.sign)
    change = system.near(iso.value)
    used, number = np.unique(home, return_inverse=True)
    place = {int(v): k for k, v in enumerate(used)}
    held = {place[v]: w for v, w in fixed.items()} or {0: 0j}
    value = change.solve(number[sector], sign, offset, held, sector)
    folds = system.folds(value) & ~system.folds(iso.value)
    if folds.any():
        place = mesh.nodes[mesh.connectivity.elements[np.flatnonzero(folds)[0], 0]]
        raise FoldedError(place)
    measured, across = _transitions(mesh, iso.cut, value, iso.odd)
    pieces = tuple(
        piece if np.isnan(shift) else replace(piece, shift=complex(shift), spread=0.0)
        for piece, shift in zip(measured, shifts.tolist(), strict=True)
    )
    return replace(iso, value=value, transitions=pieces, across=across, residual=system.residual(value))


@dataclass(frozen=True)
class _Poisson:
    """The least squares problem of fitting dw to the forms, element by element."""

    blocks: Floats
    pull: Complexes
    form_a: Complexes
    form_b: Complexes
    metric: tuple[Floats, Floats, Floats]
    area: Floats
    x: Floats
    y: Floats

    @classmethod
    def of(cls, mesh: NetMesh, sign: Integers) -> _Poisson:
        """The problem on a mesh with signs (m,) of the roots."""
        basis = mesh.connectivity.basis
        points, weights = triangle_rule(2 * basis.order)
        form_a, form_b, (e, f, g) = _forms(mesh, points)
        form_a, form_b = form_a * sign[:, None], form_b * sign[:, None]
        x, y = basis.basis(points, 1, 0), basis.basis(points, 0, 1)
        corners = mesh.nodes[mesh.connectivity.elements]
        blocks, _, area = dirichlet_blocks(x, y, *tangents(x, y, corners), weights)
        pull = ((g * form_a - f * form_b) / area) @ x + ((e * form_b - f * form_a) / area) @ y
        return cls(blocks, pull, form_a, form_b, (e, f, g), area, x, y)

    def near(self, value: Complexes) -> _Poisson:
        """The problem of staying near to coordinates (m, k) instead, with the weight 1 / |D|^2."""
        e, f, g = self.metric
        square = g * np.abs(self.form_a) ** 2 - 2 * f * (self.form_a * self.form_b.conj()).real
        square = (square + e * np.abs(self.form_b) ** 2) / (e * g - f * f)
        # |sqrt(D) dz|^2 is 2 |D|
        weight = (square.mean() / square) ** 2
        blocks = weighted_dirichlet_blocks(self.x, self.y, self.metric, self.area / weight)
        return replace(self, blocks=blocks, pull=np.einsum("eij,ej->ei", blocks, value))

    def solve(
        self,
        unknown: Integers,
        sign: Floats,
        offset: Complexes,
        held: dict[int, complex],
        sector: Integers | None = None,
    ) -> Complexes:
        """Values (m, k) = sign U + offset, U the unknowns (m, k), sign and offset by sector; some U are held."""
        sector = unknown if sector is None else sector
        count = int(unknown.max()) + 1
        value = np.zeros(count, complex)
        free = np.ones(count, bool)
        for index, at in held.items():
            value[index], free[index] = at, False
        number = np.where(free, np.cumsum(free) - 1, -1)
        s, o = sign[sector], offset[sector]
        known = np.where(free[unknown], 0, value[unknown])
        blocks = self.blocks * s[:, :, None] * s[:, None, :]
        right = s * (self.pull - np.einsum("eij,ej->ei", self.blocks, o)) - np.einsum("eij,ej->ei", blocks, known)
        flat = number[unknown].ravel()
        inside = flat >= 0
        pattern = SymmetricPattern.from_elements(number[unknown], int(free.sum()))
        both = [np.bincount(flat[inside], part.ravel()[inside], free.sum()) for part in (right.real, right.imag)]
        solved = pattern.factor(pattern.assemble(packed(blocks))).solve(np.stack(both, 1).astype(np.float64))
        value[free] = solved[:, 0] + 1j * solved[:, 1]
        return np.asarray(s * value[unknown] + o)

    def folds(self, value: Complexes) -> NDArray[np.bool_]:
        """Elements (m,) on which coordinates turn over anywhere."""
        w_x, w_y = value @ self.x.T, value @ self.y.T
        return np.asarray((w_x.real * w_y.imag <= w_x.imag * w_y.real).any(1))

    def residual(self, value: Complexes) -> float:
        """Root mean square of dw - sqrt(D) dz over that of sqrt(D) dz."""
        e, f, g = self.metric

        def energy(one: Complexes, other: Complexes) -> float:
            density = g * np.abs(one) ** 2 - 2 * f * (one * other.conj()).real + e * np.abs(other) ** 2
            return float((density / self.area).sum())

        miss = energy(value @ self.x.T - self.form_a, value @ self.y.T - self.form_b)
        return float(np.sqrt(miss / energy(self.form_a, self.form_b)))


def _frames(mesh: NetMesh, local: Floats) -> tuple[Complexes, Complexes, tuple[Floats, Floats, Floats], Complexes]:
    """Tangents as complex numbers in the frame along the first one, metric, and D, at local points (m, q)."""
    connectivity = mesh.connectivity
    basis = connectivity.basis
    value, x, y = (basis.basis(local, *d) for d in ((0, 0), (1, 0), (0, 1)))
    corners = mesh.nodes[connectivity.elements]
    a, b = np.matmul(x, corners), np.matmul(y, corners)
    e, f, g = (np.einsum("eqc,eqc->eq", s, t) for s, t in ((a, a), (a, b), (b, b)))
    normal = np.cross(a, b)
    normal /= np.linalg.norm(normal, axis=2)[..., None]
    e_u = a / np.sqrt(e)[..., None]
    e_v = np.cross(normal, e_u)
    shape = np.matmul(value, mesh.shape[connectivity.elements])

    def form(s: Floats, t: Floats) -> Floats:
        both = s[..., ROWS] * t[..., COLUMNS] + s[..., COLUMNS] * t[..., ROWS]
        return np.asarray((shape * both * np.where(ROWS == COLUMNS, 0.5, 1.0)).sum(-1))

    deviator = (form(e_u, e_u) - form(e_v, e_v)) / 2 - 1j * form(e_u, e_v)
    along = np.sqrt(e) + 0j
    other = (f + 1j * np.sqrt(e * g - f * f)) / np.sqrt(e)
    return along, other, (e, f, g), deviator


def _root(mesh: NetMesh, local: Floats) -> tuple[Complexes, Complexes, Complexes, tuple[Floats, Floats, Floats]]:
    """sqrt(D), one branch an element, with the tangents and the metric, at local points (m, q)."""
    along, other, metric, deviator = _frames(mesh, np.vstack([local, [[1 / 3, 1 / 3]]]))
    root = np.sqrt(deviator)
    middle = root[:, -1:]
    root = np.where((root * middle.conj()).real < 0, -root, root)
    e, f, g = (part[:, :-1] for part in metric)
    return root[:, :-1], along[:, :-1], other[:, :-1], (e, f, g)


def _forms(mesh: NetMesh, local: Floats) -> tuple[Complexes, Complexes, tuple[Floats, Floats, Floats]]:
    """dw along both local coordinates at local points (m, q), and the metric."""
    root, along, other, metric = _root(mesh, local)
    return root * along, root * other, metric


# middles of the local edges and the edges' directions in local coordinates
_MIDDLES = np.array([[0.5, 0.0], [0.5, 0.5], [0.0, 0.5]])
_DIRECTIONS = np.array([[1.0, 0.0], [-1.0, 1.0], [0.0, -1.0]])


def _signs(mesh: NetMesh, cut: NDArray[np.bool_]) -> tuple[Integers, NDArray[np.bool_]]:
    """Sign of each element's root, (m,), alike across what is not cut; and the cut.

    Where an umbilic next to the rim was not cut to, the signs still disagree across some edges: these are cut as well.
    """
    root, along, other, _ = _root(mesh, _MIDDLES)
    through = root * (along * _DIRECTIONS[:, 0] + other * _DIRECTIONS[:, 1])
    connectivity = mesh.connectivity
    element, edge = np.nonzero((connectivity.neighbours >= 0) & ~cut)
    neighbour = connectivity.neighbours[element, edge]
    back = through[neighbour, connectivity.neighbour_edges[element, edge]]
    # the neighbour runs along the edge the other way
    same = np.where((through[element, edge] * -back.conj()).real > 0, 1, -1)
    m = len(connectivity.elements)
    # signs are handed on where the root is large, away from umbilics
    cost = 1 / np.maximum(np.abs(root[element, edge]), 1e-300)
    tree = minimum_spanning_tree(coo_matrix((cost, (element, neighbour)), (m, m)).tocsr())
    order, parent = breadth_first_order(tree, int(np.abs(root).mean(1).argmax()), directed=False)
    relation = coo_matrix((same, (element, neighbour)), (m, m)).tocsr()
    to_parent = np.asarray(relation[order[1:], parent[order[1:]]]).ravel()
    sign = np.ones(m, np.int64)
    for child, value in zip(order[1:].tolist(), to_parent.tolist(), strict=True):
        sign[child] = value * sign[parent[child]]
    cut = cut.copy()
    off = same * sign[element] * sign[neighbour] < 0
    cut[element[off], edge[off]] = True
    return sign, cut


def sectors(connectivity: Connectivity, cut: NDArray[np.bool_]) -> Integers:
    """Number of the unknown of each element's own nodes, (m, k): nodes are shared across edges that are not cut."""
    m, k = connectivity.elements.shape
    element, edge = np.nonzero((connectivity.neighbours >= 0) & ~cut)
    neighbour, other = connectivity.neighbours[element, edge], connectivity.neighbour_edges[element, edge]
    mine = element[:, None] * k + connectivity.basis.edge_nodes[edge]
    theirs = neighbour[:, None] * k + connectivity.basis.edge_nodes[other][:, ::-1]
    graph = coo_matrix((np.ones(mine.size), (mine.ravel(), theirs.ravel())), (m * k, m * k))
    _, group = connected_components(graph, directed=False)
    return np.asarray(group.reshape(m, k), np.int64)


def _transitions(
    mesh: NetMesh, cut: NDArray[np.bool_], value: Complexes, odd: Integers
) -> tuple[tuple[Transition, ...], Integers]:
    """The pieces of the cut with what w does across them."""
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
    nodes = connectivity.basis.edge_nodes
    for piece in range(pieces):
        mine = _chained(np.flatnonzero(group == piece), ends)
        index = np.array([i for i, _ in mine])
        forward = np.array([way for _, way in mine])
        one, one_edge = element[index], edge[index]
        two, two_edge = connectivity.neighbours[one, one_edge], connectivity.neighbour_edges[one, one_edge]
        # left of the way along the piece is the element that has the edge in this direction
        left, left_edge = np.where(forward, one, two), np.where(forward, one_edge, two_edge)
        right, right_edge = np.where(forward, two, one), np.where(forward, two_edge, one_edge)
        w_left = value[left[:, None], nodes[left_edge]]
        w_right = value[right[:, None], nodes[right_edge][:, ::-1]]
        step_left, step_right = np.diff(w_left, axis=1), np.diff(w_right, axis=1)
        sign = 1 if (step_left * step_right.conj()).real.sum() > 0 else -1
        shifts = w_right - sign * w_left
        shift = complex(shifts.mean())
        across[left, left_edge], across[right, right_edge] = piece + 1, -piece - 1
        first, last = ends[index[0]][0 if forward[0] else 1], ends[index[-1]][1 if forward[-1] else 0]
        where = (_end(mesh, int(first)), _end(mesh, int(last)))
        result.append(
            Transition(left, right, left_edge, right_edge, sign, shift, float(np.abs(shifts - shift).max()), where)
        )
    return tuple(result), across


def _end(mesh: NetMesh, vertex: int) -> int:
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
