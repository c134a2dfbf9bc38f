"""A film with its isothermic coordinates, as the boundary is adjusted: how far its net is from closing."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lamella.base.arrays import Complexes, Floats
from lamella.network.elements.integer_grid_map import IntegerGridMap
from lamella.network.elements.kept_coordinates import KeptCoordinates
from lamella.network.isothermic.holonomy import fixed_point_factors
from lamella.network.isothermic.integer_transitions import IntegerTransitions
from lamella.network.isothermic.isothermic import Isothermic
from lamella.network.isothermic.lattice_origin import lattice_origin
from lamella.network.isothermic.mesh_layout import LayoutError
from lamella.network.pattern import Pattern
from lamella.surface.element.surface import ElementSurface
from lamella.surface.element.umbilics import Umbilics
from lamella.surface.form_finding.followed_film import FollowedFilm


@dataclass(frozen=True, eq=False)
class FilmNet:
    """A film at some shares of the boundary's parameters, with its coordinates.

    Attributes
    ----------
    shares : (p,)
    film : FollowedFilm
    surface : ElementSurface
        The film, as coordinates are found on it.
    kept : KeptCoordinates
        What coordinates on the same elements share.
    umbilics : Umbilics
    iso : Isothermic
    pattern : Pattern
        Which curves the net has.
    """

    shares: Floats
    film: FollowedFilm
    surface: ElementSurface
    kept: KeptCoordinates
    umbilics: Umbilics
    iso: Isothermic
    pattern: Pattern

    @classmethod
    def of(cls, shares: Floats, film: FollowedFilm, pattern: Pattern) -> FilmNet:
        """The coordinates of a film from nothing."""
        surface = film.surface
        kept = KeptCoordinates.of(surface)
        return cls(shares, film, surface, kept, kept.umbilics, kept.iso, pattern)

    def moved(self, shares: Floats, film: FollowedFilm) -> FilmNet:
        """The coordinates of another film: on the same elements, with all that holds for it as well."""
        surface = film.surface
        if surface.connectivity is self.kept.surface.connectivity:
            with suppress(LayoutError):
                umbilics, iso = self.kept.on(surface)
                return FilmNet(shares, film, surface, self.kept, umbilics, iso, self.pattern)
        return FilmNet.of(shares, film, self.pattern)

    @cached_property
    def whole(self) -> IntegerTransitions:
        """The shifts with which the net closes."""
        return IntegerTransitions.of(self.iso, self.iso.dirichlet)

    @property
    def orders(self) -> list[int]:
        """Orders of the umbilics off the rim, sorted."""
        return sorted(self.umbilics.orders[self.iso.mesh.umbilics >= 0].tolist())

    def cells(self, step: float) -> Complexes:
        """Shifts of the pieces of the cut, (t,), in cells of a lattice with l0 = step, sqrt(m)."""
        return IntegerGridMap.of(self.iso, lattice_origin(self.iso, step, self.pattern), step, self.pattern).shifts

    def cell_sensitivities(self, sensitivities: Complexes, step: float) -> Complexes:
        """Change of the shifts in cells, (t, p + 1), from that in sqrt(m), (t, p); the last by the logarithm of l0."""
        signs = np.array([piece.sign for piece in self.iso.transitions])
        place = fixed_point_factors(self.iso) @ sensitivities
        in_cells = self.pattern.cells(sensitivities + np.outer(signs - 1, place), step)
        return np.column_stack([in_cells, self.whole.offset - self.cells(step)])
