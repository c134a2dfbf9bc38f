"""Isothermic coordinates that go over into +-w + c across each piece of the cut, c alike along the whole piece.

One factorisation serves all: the coordinates are affine in the shifts c, and which shifts are best is a small problem
of its own.

With transitions of that kind a parametrisation is called seamless (F. Kaelberer, M. Nieser, K. Polthier, QuadCover -
surface parameterization using branched coverings, Computer Graphics Forum 26 (2007) 375-384). There the direction field
is given and the coordinates are fitted to it; here both follow from the surface's Hopf differential.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lamella.base.arrays import Booleans, Complexes, Floats, Integers
from lamella.base.result import Lean
from lamella.network.isothermic.cut import cut_edges
from lamella.network.isothermic.holonomy import vertex_relations
from lamella.network.isothermic.integration_mesh import IntegrationMesh
from lamella.network.isothermic.isothermic import EdgeTurns, Isothermic, Transition, cut_pieces, root_signs, sectors
from lamella.network.isothermic.mesh_layout import LayoutError
from lamella.network.isothermic.poisson import Poisson, Unknowns

# w + a constant is as good as w: it changes the shifts of pieces where w comes back as -w, and costs nothing. A change
# that costs less than this part of the dearest one is that, and rounding: it stays as small as it can. Between two
# umbilics near each other a change that matters costs 1e-6 of one that runs over the whole surface, and less
FREE = 1e-11


class FoldedError(ValueError):
    """Shifts that fold the net; `place` (3,), m, says where."""

    def __init__(self, place: Floats) -> None:
        super().__init__("the coordinates turn over")
        self.place = place


def integrate(mesh: IntegrationMesh, odd: Integers) -> Isothermic:
    """Isothermic coordinates of a surface.

    Parameters
    ----------
    mesh : IntegrationMesh
    odd : (z,) int
        Vertices that are umbilics of odd order.
    """
    return CutLayout.of(mesh, odd).integrated(mesh)


@dataclass(frozen=True, eq=False)
class CutLayout(Lean):
    """How a mesh is cut, and what follows from that alone: it serves all surfaces on which roots turn alike.

    Attributes
    ----------
    odd : (z,) int
        Vertices that are umbilics of odd order.
    sign : (m,) int
        Of each element's root on the reference.
    cut : (m, 3) bool
        Local edges that are cut.
    pieces : tuple of Transition
        Their shifts are 0.
    across : (m, 3) int
        See `Isothermic.across`.
    unknowns : Unknowns
    relations : tuple of (t,) int
        Whole factors whose sum with the shifts is 0.
    forms : (2, m, q) complex
        The forms on the reference along both local coordinates.
    """

    odd: Integers
    sign: Integers
    cut: Booleans
    pieces: tuple[Transition, ...]
    across: Integers
    unknowns: Unknowns
    relations: tuple[Integers, ...]
    forms: Complexes

    @classmethod
    def of(cls, mesh: IntegrationMesh, odd: Integers) -> CutLayout:
        """Of a mesh: each hole and each umbilic of odd order hangs on the outer rim."""
        sign, cut, turns = root_signs(mesh, cut_edges(mesh, odd))
        pieces, across = cut_pieces(mesh, cut, turns, odd)
        sector = sectors(mesh.connectivity, cut)
        plain = Poisson.of(mesh, sign)
        return cls(
            odd,
            sign,
            cut,
            pieces,
            across,
            Unknowns(sector, *links(mesh, pieces, sector)),
            tuple(vertex_relations(mesh, pieces, across, odd).values()),
            np.stack([plain.form_a, plain.form_b]),
        )

    def integrated(self, mesh: IntegrationMesh) -> Isothermic:
        """Isothermic coordinates on the mesh as it lies on a surface (see `refuse_turned`)."""
        plain, turn = Poisson.of(mesh, self.sign).alike(self.forms)
        system = plain.weighted()
        base, moves = system.solve(self.unknowns)
        gram, right = system.quadratic(base, moves)
        shifts = best_shifts(gram, right, list(self.relations), np.zeros(len(self.relations), complex))
        value = base + np.einsum("t,tek->ek", shifts, moves)
        transitions = _shifted(self.pieces, shifts)
        return Isothermic(
            mesh,
            self.odd,
            self.sign * turn,
            self.cut,
            value,
            transitions,
            self.across,
            moves,
            gram,
            plain.residual(value),
            plain,
        )

    def refuse_turned(self, mesh: IntegrationMesh, sign: Integers) -> None:
        """Refuse a surface whose roots, with signs (m,), turn otherwise than on the reference.

        Raises
        ------
        LayoutError
        """
        turns = EdgeTurns.of(mesh).turns(sign)
        if (turns[~self.cut] < 0).any():
            raise LayoutError("principal directions turn otherwise: an umbilic has come or gone")
        for piece in self.pieces:
            if (turns[piece.left, piece.left_edge].sum() > 0) != (piece.sign > 0):
                raise LayoutError("principal directions turn otherwise across the cut")


def with_shifts(iso: Isothermic, parts: Floats, turn: complex = 1.0) -> Isothermic:
    """The coordinates nearest to the given ones whose transitions have exactly these shifts.

    What is least is the integral of |change of dw|^2 / |D|^2. After a plain harmonic change, r^(1/2) next to a zero of
    order 1, half of the rays would miss it; with the weight the change dies out faster than w itself at all zeros.

    Parameters
    ----------
    iso : Isothermic
    parts : (2, t)
        Real and imaginary parts of turn times the shifts, sqrt(m); nan: any. They must not contradict each other where
        pieces of the cut meet.
    turn : complex
        What makes both parts be chosen one without the other.

    Raises
    ------
    FoldedError
        The coordinates would turn over somewhere.
    """
    mesh = iso.mesh
    before = turn * np.array([piece.shift for piece in iso.transitions], complex)
    relations = vertex_relations(mesh, iso.transitions, iso.across, iso.odd)
    found = np.stack([before.real, before.imag])
    for here, wanted in zip(found, parts, strict=True):
        given = np.flatnonzero(~np.isnan(wanted))
        rows = [*relations.values(), *np.eye(len(before), dtype=np.int64)[given]]
        goal = np.concatenate([np.zeros(len(relations)), wanted[given] - here[given]]).astype(complex)
        here += best_shifts(iso.gram, np.zeros(len(before), complex), rows, goal).real
        here[given] = wanted[given]
    after = (found[0] + 1j * found[1]) / turn
    change = after - before / turn
    value = iso.value + np.einsum("t,tek->ek", change, iso.moves)
    folds = iso.plain.folds(value) & ~iso.plain.folds(iso.value)
    if folds.any():
        raise FoldedError(mesh.nodes[mesh.connectivity.elements[np.flatnonzero(folds)[0], 0]])
    return replace(iso, value=value, transitions=_shifted(iso.transitions, after), residual=iso.plain.residual(value))


def _shifted(pieces: tuple[Transition, ...], shifts: Complexes) -> tuple[Transition, ...]:
    return tuple(replace(piece, shift=shift) for piece, shift in zip(pieces, shifts.tolist(), strict=True))


def best_shifts(gram: Floats, right: Complexes, rows: list[Integers], goal: Complexes) -> Complexes:
    """Least squares of shifts (t,) under conditions rows . shifts = goal, which may repeat each other."""
    count = len(gram)
    if not count:
        return np.zeros(0, complex)
    conditions = np.array(rows, float).reshape(-1, count)
    _, singular, directions = np.linalg.svd(conditions, full_matrices=True)
    rank = int((singular > 1e-9).sum())
    fixed = np.linalg.lstsq(conditions, goal, rcond=None)[0] if rank else np.zeros(count, complex)
    loose = directions[rank:]
    energy, along = np.linalg.eigh(loose @ gram @ loose.T)
    rest = along.T @ (loose @ (right - gram @ fixed))
    costs = energy > FREE * energy.max(initial=0.0)
    rest = np.where(costs, rest / np.where(costs, energy, 1.0), 0.0)
    return np.asarray(fixed + loose.T @ (along @ rest), np.complex128)


def links(
    mesh: IntegrationMesh, pieces: tuple[Transition, ...], sector: Integers
) -> tuple[Integers, Floats, Floats, dict[int, Floats]]:
    """Sectors joined across the cut: unknown of each, sign, offset per shift (s, t), and unknowns held by shifts."""
    nodes = mesh.connectivity.basis.edge_nodes
    links: dict[int, list[tuple[int, int, int, int]]] = {}
    for number, piece in enumerate(pieces):
        left = sector[piece.left[:, None], nodes[piece.left_edge]].ravel()
        right = sector[piece.right[:, None], nodes[piece.right_edge][:, ::-1]].ravel()
        for one, other in zip(left.tolist(), right.tolist(), strict=True):
            links.setdefault(one, []).append((other, piece.sign, number, 1))
            links.setdefault(other, []).append((one, piece.sign, number, -piece.sign))
    count = int(sector.max()) + 1
    sign, offset = np.ones(count), np.zeros((count, len(pieces)))
    home = np.arange(count)
    held: dict[int, Floats] = {}
    done: set[int] = set()
    for first in links:
        if first in done:
            continue
        stack = [first]
        done.add(first)
        while stack:
            one = stack.pop()
            for other, turn, number, direction in links[one]:
                there = turn * offset[one]
                there[number] += direction
                if other not in done:
                    done.add(other)
                    home[other], sign[other], offset[other] = first, turn * sign[one], there
                    stack.append(other)
                elif turn * sign[one] != sign[other]:
                    # only a fixed point of w -> -w + c comes back to itself: an umbilic
                    held[first] = (offset[other] - there) / (turn * sign[one] - sign[other])
    used, number_of = np.unique(home, return_inverse=True)
    fixed = {int(np.searchsorted(used, first)): row for first, row in held.items()}
    return number_of.ravel(), sign, offset, fixed or {0: np.zeros(len(pieces))}
