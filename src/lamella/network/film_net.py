"""A film with its isothermic coordinates, as the boundary is adjusted: how far its net is from closing."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lamella.network.cell_map import CellMap
from lamella.network.gluing import integrate
from lamella.network.holonomy import origin_factors
from lamella.network.isothermic import Isothermic
from lamella.network.net_mesh import make_net_mesh
from lamella.network.pattern import Pattern
from lamella.network.whole_shifts import WholeShifts
from lamella.surface.element.surface import ElementSurface
from lamella.surface.found.newton import Equilibrium
from lamella.surface.points import Complexes, Floats


@dataclass(frozen=True, eq=False)
class FilmNet:
    """A film at some shares of the boundary's parameters, with its coordinates.

    Attributes
    ----------
    shares : (p,)
    equilibrium : Equilibrium
    surface : ElementSurface
    iso : Isothermic
    pattern : Pattern
        Which curves the net has.
    """

    shares: Floats
    equilibrium: Equilibrium
    surface: ElementSurface
    iso: Isothermic
    pattern: Pattern

    @classmethod
    def of(cls, shares: Floats, equilibrium: Equilibrium, surface: ElementSurface, pattern: Pattern) -> FilmNet:
        """The coordinates of a film."""
        umbilics = surface.umbilics
        mesh = make_net_mesh(surface, umbilics)
        odd = mesh.umbilics[(umbilics.orders % 2 == 1) & (mesh.umbilics >= 0)]
        return cls(shares, equilibrium, surface, integrate(mesh, odd), pattern)

    @cached_property
    def whole(self) -> WholeShifts:
        """The shifts with which the net closes."""
        return WholeShifts.of(self.iso)

    @property
    def orders(self) -> list[int]:
        """Orders of the umbilics off the rim, sorted."""
        return sorted(self.surface.umbilics.orders[self.iso.mesh.umbilics >= 0].tolist())

    @property
    def shifts(self) -> Complexes:
        """Shifts of the pieces of the cut, (t,), sqrt(m)."""
        return np.array([piece.shift for piece in self.iso.transitions], complex)

    @cached_property
    def _origin(self) -> Floats:
        return origin_factors(self.iso)

    def cells(self, step: float) -> Complexes:
        """Shifts of the pieces of the cut, (t,), in cells, the lattice's origin on the first odd umbilic."""
        return CellMap.of(self.iso, complex(self._origin @ self.shifts), step, self.pattern).shifts

    def cell_rates(self, rates: Complexes, step: float) -> Complexes:
        """Change of the shifts in cells, (t, p), from that of the shifts in sqrt(m)."""
        signs = np.array([piece.sign for piece in self.iso.transitions])
        return self.pattern.cells(rates + np.outer(signs - 1, self._origin @ rates), step)
