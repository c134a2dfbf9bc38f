"""Isothermic coordinates cut along straight lines of the plane of w instead of edges of elements.

The coordinates stay what they are; which sheet they are on, and what happens across the cut, is counted anew.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from lamella.base.arrays import Booleans, Complexes, Floats, Integers
from lamella.base.result import Lean
from lamella.network.isothermic.holonomy import vertex_relations
from lamella.network.isothermic.integration_mesh import IntegrationMesh
from lamella.network.isothermic.isothermic import Isothermic, Transition, cut_pieces, root_signs
from lamella.network.isothermic.poisson import Poisson
from lamella.network.isothermic.split_elements import Split, split_elements
from lamella.network.isothermic.straight_cuts import CrossedError, straight_cuts
from lamella.network.isothermic.straight_walk import FlatTriangles
from lamella.surface.element.connectivity import Connectivity
from lamella.surface.element.surface import ElementSurface

# of the longest principal line: what coordinates jump by across an edge that is not cut
JUMP = 1e-6


def straightened(iso: Isothermic, surface: ElementSurface) -> Isothermic:
    """The same coordinates, cut along straight lines where these are found, else as they are cut.

    Between umbilics that all but fall together small triangles do not follow w well enough for lines to arrive.
    """
    try:
        return cut_straight(iso, surface)
    except CrossedError:
        return iso


def cut_straight(iso: Isothermic, surface: ElementSurface) -> Isothermic:
    """The same coordinates, cut along the shortest straight lines of their plane (`straight_cuts`).

    Raises
    ------
    CrossedError
        The lines are not found, or cross each other, or leave coordinates with several values.
    """
    straight = straight_cut_of(iso, surface)
    return straight.applied(iso) if straight else iso


def straight_cut_of(iso: Isothermic, surface: ElementSurface) -> StraightCut | None:
    """The shortest straight lines to cut coordinates along; None: there is nothing to cut straight.

    Raises
    ------
    CrossedError
    """
    if all(piece.stub for piece in iso.transitions):
        return None
    flat = FlatTriangles.of(iso)
    courses = straight_cuts(flat)
    if not courses:
        # what turns w lies on the rim
        return None
    return StraightCut.of(iso, split_elements(flat, courses, surface))


@dataclass(frozen=True, eq=False)
class StraightCut(Lean):
    """Straight lines that coordinates are cut along, and how they are counted over from the cut before.

    It serves all coordinates that are cut as those were, on surfaces of the same elements.

    Attributes
    ----------
    split : Split
    sign : (m,) int
        Of each element's root.
    cut : (m, 3) bool
    region : (m,) int
        Between what was cut and what is.
    direction : (r,) int
        Of w in each region, against what it was.
    offset : (r, t)
        What is added to it, times the shifts.
    pieces : tuple of Transition
        Of the cut, their shifts 0.
    across : (m, 3) int
        See `Isothermic.across`.
    rows : (s, t)
        The new shifts from the old ones.
    back : (t, s)
        The old shifts from new ones.
    forms : (2, m, q) complex
        Of the reference along both local coordinates.
    """

    split: Split
    sign: Integers
    cut: Booleans
    region: Integers
    direction: Integers
    offset: Floats
    pieces: tuple[Transition, ...]
    across: Integers
    rows: Floats
    back: Floats
    forms: Complexes

    @classmethod
    def of(cls, iso: Isothermic, split: Split) -> StraightCut:
        """Along the lines that elements were split by.

        Raises
        ------
        CrossedError
        """
        mesh = split.mesh
        sign, cut, turns = root_signs(mesh, split.cut)
        plain = Poisson.of(mesh, sign)
        before = split.restricted(iso.value)
        across = split.inherited(iso.across)
        region, of_region = _regions(split, cut, across)
        slope = before @ plain.x.T, before @ plain.y.T
        agrees = (slope[0] * plain.form_a.conj() + slope[1] * plain.form_b.conj()).real.sum(1)
        direction = np.where(np.bincount(region, agrees) > 0, 1, -1)
        offset = _offsets(iso, split, cut, across, region, of_region, direction)
        pieces, through = cut_pieces(mesh, cut, turns, iso.odd)
        rows = np.zeros((len(pieces), len(iso.transitions)))
        for number, piece in enumerate(pieces):
            left, right, edge = int(piece.left[0]), int(piece.right[0]), int(piece.left_edge[0])
            turn, row = _through(iso, int(across[left, edge]))
            one, other = region[left], region[right]
            if direction[other] * turn * direction[one] != piece.sign:
                raise CrossedError("coordinates turn across a cut in another way than their roots")
            rows[number] = direction[other] * row + offset[other] - piece.sign * offset[one]
        forms = np.stack([plain.form_a, plain.form_b])
        back = _inverse(iso, rows)
        return cls(split, sign, cut, region, direction, offset, pieces, through, rows, back, forms)

    def applied(self, iso: Isothermic, mesh: IntegrationMesh | None = None) -> Isothermic:
        """Coordinates cut along the lines.

        Parameters
        ----------
        iso : Isothermic
            Cut as those before.
        mesh : IntegrationMesh, optional
            That of the parts on the surface of these coordinates; the reference's when not given.

        Raises
        ------
        CrossedError
            Coordinates jump where nothing is cut.
        """
        mesh = mesh or self.split.mesh
        plain, turn = Poisson.of(mesh, self.sign).alike(self.forms)
        shifts = np.array([piece.shift for piece in iso.transitions], complex)
        along = self.direction[self.region]
        value = along[:, None] * self.split.restricted(iso.value) + (self.offset @ shifts)[self.region, None]
        pieces = tuple(
            replace(piece, shift=complex(row @ shifts)) for piece, row in zip(self.pieces, self.rows, strict=True)
        )
        before = np.asarray(self.split.restricted(iso.moves), np.float64)
        moves = np.tensordot(self.back.T, before, 1) * along[:, None]
        moves += (self.offset @ self.back).T[:, self.region, None]
        _check(mesh.connectivity, self.cut, value, iso.longest)
        return replace(
            iso,
            mesh=mesh,
            sign=self.sign * turn,
            cut=self.cut,
            value=value,
            transitions=pieces,
            across=self.across,
            moves=moves,
            gram=self.back.T @ iso.gram @ self.back,
            plain=plain,
        )


def _through(iso: Isothermic, across: int) -> tuple[int, Floats]:
    """Through an edge w goes over into sign w + row (t,) . shifts."""
    row = np.zeros(len(iso.transitions))
    if not across:
        return 1, row
    sign = iso.transitions[abs(across) - 1].sign
    row[abs(across) - 1] = 1 if across > 0 else -sign
    return sign, row


def _regions(split: Split, cut: Booleans, across: Integers) -> tuple[Integers, int]:
    """Number of the region of each element, (m,), between what was cut and what is, and how many there are."""
    connectivity = split.mesh.connectivity
    element, edge = np.nonzero((connectivity.neighbours >= 0) & ~cut & (across == 0))
    neighbour = connectivity.neighbours[element, edge]
    m = len(cut)
    graph = coo_matrix((np.ones(len(element)), (element, neighbour)), (m, m))
    count, region = connected_components(graph, directed=False)
    return np.asarray(region, np.int64), int(count)


def _offsets(
    iso: Isothermic, split: Split, cut: Booleans, across: Integers, region: Integers, count: int, direction: Integers
) -> Floats:
    """What is added to w in each region, times the shifts, (r, t), so that it goes on where nothing is cut any more."""
    connectivity = split.mesh.connectivity
    element, edge = np.nonzero(~cut & (across != 0))
    one, other = region[element], region[connectivity.neighbours[element, edge]]
    _, first = np.unique(one * count + other, return_index=True)
    steps: dict[int, list[tuple[int, int]]] = {}
    for index in first.tolist():
        steps.setdefault(int(one[index]), []).append((int(other[index]), int(across[element[index], edge[index]])))
    offset = np.zeros((count, len(iso.transitions)))
    stack, done = [0], {0}
    while stack:
        here = stack.pop()
        for there, through in steps.get(here, []):
            if there in done:
                continue
            done.add(there)
            offset[there] = offset[here] - direction[there] * _through(iso, through)[1]
            stack.append(there)
    if len(done) < count:
        raise CrossedError("the cut separates parts of the surface")
    return offset


def _inverse(iso: Isothermic, rows: Floats) -> Floats:
    """The old shifts (t,) that stand for new ones (s,): matrix (t, s), where rows (s, t) lead from old ones to new."""
    relations = list(vertex_relations(iso.mesh, iso.transitions, iso.across, iso.odd).values())
    conditions = np.array(relations, float).reshape(-1, rows.shape[1])
    _, singular, directions = np.linalg.svd(conditions, full_matrices=True)
    free = directions[int((singular > JUMP).sum()) :].T
    return np.asarray(free @ np.linalg.pinv(rows @ free))


def _check(connectivity: Connectivity, cut: Booleans, value: Complexes, longest: float) -> None:
    """Refuse coordinates that jump where nothing is cut."""
    element, edge = np.nonzero((connectivity.neighbours >= 0) & ~cut)
    neighbour, back = connectivity.neighbours[element, edge], connectivity.neighbour_edges[element, edge]
    nodes = connectivity.basis.edge_nodes
    jump = value[element[:, None], nodes[edge]] - value[neighbour[:, None], nodes[back][:, ::-1]]
    if np.abs(jump).max(initial=0.0) > JUMP * longest:
        raise CrossedError("coordinates jump where nothing is cut")
