"""The surface's elements in the cell plane: chi = (u - v) + i (u + v) over l0, and back.

A lamellas are Im chi = whole, B lamellas Re chi = whole (`lamella.network.domain`); nodes are the whole numbers. Each
element has its own sheet; through a cut chi goes over into sign chi + shift. For principal lines, and where curves are
left out, chi is that of `lamella.network.pattern`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lamella.network.isothermic import Isothermic
from lamella.network.net_mesh import NetMesh
from lamella.network.pattern import LAMELLAS, Pattern
from lamella.surface.element.places import Places
from lamella.surface.points import Complexes, Floats

Integers = NDArray[np.int64]

MOST_STEPS = 40
# cells; Newton's steps for a place of given chi end below it
FINE = 1e-12


@dataclass(frozen=True)
class CellMap:
    """chi on the elements of a net mesh.

    Attributes
    ----------
    mesh : NetMesh
    value : (m, k) complex
        chi at each element's own nodes.
    across : (m, 3) int
        Transition through each local edge, see `Isothermic.across`.
    signs : (t,) int
    shifts : (t,) complex
        Of the transitions, from left to right.
    step : float
        l0, sqrt(m).
    pattern : Pattern
        What chi is of w, and which curves are kept: chi counts these.
    """

    mesh: NetMesh
    value: Complexes
    across: Integers
    signs: Integers
    shifts: Complexes
    step: float
    pattern: Pattern = LAMELLAS

    @classmethod
    def of(cls, iso: Isothermic, origin: complex, step: float, pattern: Pattern = LAMELLAS) -> CellMap:
        """The map whose lattice has a point at w = origin (sqrt(m)) and neighbours l0 = step apart."""
        signs = np.array([piece.sign for piece in iso.transitions], np.int64)
        shifts = np.array([piece.shift for piece in iso.transitions], complex)
        return cls(
            iso.mesh,
            pattern.cells(iso.value - origin, step),
            iso.across,
            signs,
            pattern.cells(shifts + (signs - 1) * origin, step),
            step,
            pattern,
        )

    @cached_property
    def _chi(self) -> Complexes:
        """Coefficients of chi, (m, k)."""
        return np.asarray(self.mesh.connectivity.basis.coefficients(self.value))

    @cached_property
    def _position(self) -> Floats:
        """Coefficients of the position, (m, k, 3)."""
        corners = self.mesh.nodes[self.mesh.connectivity.elements]
        return np.asarray(self.mesh.connectivity.basis.coefficients(corners))

    def jet(self, where: Places) -> tuple[Complexes, Complexes, Complexes]:
        """chi at places, each on its element's own sheet, and its derivatives by both local coordinates, (n,)."""
        chi = self._chi[where.element]
        value, first, second = (
            np.einsum("nk,nk->n", table, chi) for table in self.mesh.connectivity.basis.monomials(where.local)
        )
        return value, first, second

    def tangents(self, where: Places) -> tuple[Floats, Floats, Floats]:
        """Position and its derivatives by both local coordinates, m, (n, 3) each."""
        corners = self._position[where.element]
        position, first, second = (
            np.einsum("nk,nkc->nc", table, corners) for table in self.mesh.connectivity.basis.monomials(where.local)
        )
        return position, first, second

    def invert(self, start: Places, chi: Complexes) -> tuple[Places, Floats, NDArray[np.bool_]]:
        """Places of given chi near given ones.

        Parameters
        ----------
        start : Places
            Where to begin.
        chi : (n,) complex
            Wanted value, on the sheet of the starting element.

        Returns
        -------
        places : Places
        turn : (n,)
            -1 where the place was found on a sheet on which chi runs the other way, else 1.
        found : (n,) bool
            Whether the place was reached; else it is the starting one.
        """
        element, local, target = start.element.copy(), start.local.copy(), chi.copy()
        found = np.zeros(len(element), bool)
        hops, turn = np.zeros(len(element), int), np.ones(len(element))
        active = np.arange(len(element))
        for _ in range(MOST_STEPS):
            here = Places(element[active], local[active])
            value, first, second = self.jet(here)
            miss = target[active] - value
            determinant = first.real * second.imag - first.imag * second.real
            safe = np.where(np.abs(determinant) < 1e-300, 1.0, determinant)
            step = np.stack(
                [miss.real * second.imag - miss.imag * second.real, first.real * miss.imag - first.imag * miss.real], 1
            )
            step /= safe[:, None]
            step *= np.minimum(1, 0.5 / np.maximum(np.abs(step).max(1), 1e-300))[:, None]
            moved = local[active] + step
            done = np.abs(miss) < FINE
            barycentric = np.column_stack([1 - moved.sum(1), moved])
            # beyond an edge by more than rounding: go on in the neighbour
            lowest = barycentric.argmin(1)
            edge = (lowest + 1) % 3
            across = self.mesh.connectivity.neighbours[element[active], edge]
            leaves = (barycentric.min(1) < -1e-9) & (across >= 0) & ~done & (hops[active] < 20)
            stays = ~leaves & ~done
            local[active[stays]] = np.clip(moved[stays], -0.3, 1.3)
            if leaves.any():
                self._hop(active[leaves], edge[leaves], barycentric[leaves], element, local, target, turn)
                hops[active[leaves]] += 1
            found[active[done]] = True
            active = active[~done]
            if not len(active):
                break
        close = np.abs(target - self.jet(Places(element, local))[0]) < 1e-9
        barycentric = np.column_stack([1 - local.sum(1), local])
        found |= close
        found &= barycentric.min(1) > -1e-6
        element = np.where(found, element, start.element)
        local = np.where(found[:, None], local, start.local)
        return Places(element, local), np.where(found, turn, 1.0), found

    def _hop(
        self,
        index: Integers,
        edge: Integers,
        barycentric: Floats,
        element: Integers,
        local: Floats,
        target: Complexes,
        turn: Floats,
    ) -> None:
        """Carry some points over an edge, with their targets."""
        connectivity = self.mesh.connectivity
        own = element[index]
        rows = np.arange(len(index))
        through = self.across[own, edge]
        piece = np.abs(through) - 1
        crossing = through != 0
        sign = np.where(crossing, self.signs[piece] if len(self.signs) else 1, 1)
        shift = np.where(crossing, self.shifts[piece] if len(self.signs) else 0, 0)
        target[index] = np.where(through >= 0, sign * target[index] + shift, sign * (target[index] - shift))
        turn[index] *= sign
        other = connectivity.neighbour_edges[own, edge]
        share = np.clip(barycentric[rows, (edge + 1) % 3], 0, 1)
        entered = np.zeros((len(index), 3))
        entered[rows, other], entered[rows, (other + 1) % 3] = share, 1 - share
        element[index] = connectivity.neighbours[own, edge]
        local[index] = entered[:, 1:]
