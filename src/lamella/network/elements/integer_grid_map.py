"""Integer-grid map: the surface's elements in the cell plane, chi = (u - v) + i (u + v) over l0, and back.

A lamellas are Im chi = whole, B lamellas Re chi = whole (`lamella.network.lattice.domain`); nodes are the whole
numbers. Each element has its own sheet; through a cut chi goes over into sign chi + shift. For principal lines, and
where curves are left out, chi is that of `lamella.network.pattern`. Where all shifts are whole the level curves of
whole numbers close to a net (D. Bommer, H. Zimmer, L. Kobbelt, Mixed-integer quadrangulation, ACM Transactions on
Graphics 28 (2009) 77).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lamella.base.arrays import Booleans, Complexes, Floats, Integers
from lamella.network.isothermic.integration_mesh import IntegrationMesh
from lamella.network.isothermic.isothermic import Isothermic
from lamella.network.pattern import LAMELLAS, Pattern
from lamella.surface.element.inverse_map import find_places
from lamella.surface.element.places import Places
from lamella.surface.element.polynomials import Polynomials

# of an element: nodes on the rim may lie this far beyond, within the surface's error
BEYOND_RIM = 0.25


@dataclass(frozen=True)
class IntegerGridMap:
    """chi on the elements of a net mesh.

    Attributes
    ----------
    mesh : IntegrationMesh
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

    mesh: IntegrationMesh
    value: Complexes
    across: Integers
    signs: Integers
    shifts: Complexes
    step: float
    pattern: Pattern = LAMELLAS

    @classmethod
    def of(cls, iso: Isothermic, origin: complex, step: float, pattern: Pattern = LAMELLAS) -> IntegerGridMap:
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
    def _both(self) -> Polynomials:
        """Both parts of chi, and the position, m."""
        connectivity = self.mesh.connectivity
        chi = np.stack([self.value.real, self.value.imag], 2)
        return Polynomials.through(connectivity.basis, np.concatenate([chi, self.mesh.nodes[connectivity.elements]], 2))

    @cached_property
    def _chi(self) -> Polynomials:
        return self._both[:2]

    @cached_property
    def _position(self) -> Polynomials:
        return self._both[2:]

    def jet(self, where: Places) -> tuple[Complexes, Complexes, Complexes]:
        """chi at places, each on its element's own sheet, and its derivatives by both local coordinates, (n,)."""
        jet = self._chi.jet(where)
        value, first, second = jet[:, 0] + 1j * jet[:, 1]
        return value, first, second

    def jet_and_tangents(self, where: Places) -> tuple[Complexes, Floats]:
        """chi and its derivatives by both local coordinates, (3, n), and the position and its, m, (3, n, 3)."""
        jet = self._both.jet(where)
        return jet[:, 0] + 1j * jet[:, 1], jet[:, 2:].transpose(0, 2, 1)

    def positions(self, where: Places) -> Floats:
        """m, (n, 3)."""
        return self._position.values(where).T

    def tangents(self, where: Places) -> tuple[Floats, Floats, Floats]:
        """Position and its derivatives by both local coordinates, m, (n, 3) each."""
        position, first, second = self.jet_and_tangents(where)[1]
        return position, first, second

    def invert(self, start: Places, target: Floats) -> tuple[Places, Floats, Booleans]:
        """Places of given chi near given ones.

        Parameters
        ----------
        start : Places
            Where to begin.
        target : (2, n)
            Real and imaginary part of the wanted value, on the sheet of the starting element.

        Returns
        -------
        places : Places
        turn : (n,)
            -1 where the place was found on a sheet on which chi runs the other way, else 1.
        found : (n,) bool
            Whether the place was reached; else it is the starting one.
        """
        target, turn = target.copy(), np.ones(len(start))

        def cross(index: Integers, element: Integers, edge: Integers) -> None:
            through = self.across[element, edge]
            passed = np.flatnonzero(through)
            if not len(passed):
                return
            index, through = index[passed], through[passed]
            piece = np.abs(through) - 1
            sign, shift = self.signs[piece], self.shifts[piece]
            before = target[0, index] + 1j * target[1, index]
            after = np.where(through > 0, sign * before + shift, sign * (before - shift))
            target[0, index], target[1, index] = after.real, after.imag
            turn[index] *= sign

        places, found = find_places(self.mesh.connectivity, self._chi.jet, start, target, cross, BEYOND_RIM)
        return places, np.where(found, turn, 1.0), found
