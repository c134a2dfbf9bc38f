"""Isothermic coordinates of surfaces of the same elements: what of them is kept while the surface changes."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from lamella.base.arrays import Booleans
from lamella.base.result import Lean
from lamella.network.elements.integer_grid_map import IntegerGridMap
from lamella.network.elements.net_coordinates import NetCoordinates
from lamella.network.elements.small_triangles import SmallGrid, parts_of
from lamella.network.isothermic.holonomy import holonomies
from lamella.network.isothermic.isothermic import Isothermic
from lamella.network.isothermic.mesh_layout import LayoutError, MeshLayout, lay_out
from lamella.network.isothermic.recut import StraightCut, straight_cut_of
from lamella.network.isothermic.seamless_transitions import CutLayout
from lamella.network.isothermic.split_elements import fields_of_parts
from lamella.network.isothermic.straight_cuts import CrossedError
from lamella.surface.element.carried_umbilics import carried_umbilics
from lamella.surface.element.surface import ElementSurface
from lamella.surface.element.umbilics import Umbilics
from lamella.surface.umbilic import refuse_umbilic

# small triangles for lines that are only drawn reach over at most this many cells
LINE_CELLS = 1.0


@dataclass(frozen=True, eq=False)
class KeptCoordinates(Lean):
    """What the isothermic coordinates of surfaces of the same elements share.

    Attributes
    ----------
    layout : MeshLayout
    cut : CutLayout
    umbilics : Umbilics
        Of the reference.
    iso : Isothermic
        Of the reference.
    surface : ElementSurface
        The reference.
    """

    layout: MeshLayout
    cut: CutLayout
    umbilics: Umbilics
    iso: Isothermic
    surface: ElementSurface

    @classmethod
    def of(cls, surface: ElementSurface) -> KeptCoordinates:
        """With a surface as the reference."""
        umbilics = surface.umbilics
        layout = lay_out(surface, umbilics)
        mesh = layout.placed(surface, umbilics)
        cut = CutLayout.of(mesh, mesh.umbilics[(umbilics.orders % 2 == 1) & (mesh.umbilics >= 0)])
        return cls(replace(layout, places=mesh.places), cut, umbilics, cut.integrated(mesh), surface)

    @cached_property
    def inside(self) -> Booleans:
        """Which umbilics are not on the rim, (z,)."""
        return self.layout.umbilics >= 0

    @cached_property
    def straight(self) -> StraightCut | None:
        """Straight lines to cut along, see `lamella.network.isothermic.recut.straightened`."""
        try:
            return straight_cut_of(self.iso, self.surface)
        except CrossedError:
            return None

    @cached_property
    def _grids(self) -> dict[int, SmallGrid]:
        return {}

    def grid(self, cells: IntegerGridMap) -> SmallGrid:
        """Small triangles for the lines of coordinates that are not cut straight."""
        parts = parts_of(cells, LINE_CELLS)
        if parts not in self._grids:
            self._grids[parts] = SmallGrid.of(cells.mesh.connectivity, self.cut.cut, cells.across, parts)
        return self._grids[parts]

    def serves(self, surface: ElementSurface) -> bool:
        """Whether a surface has the elements of the reference, also where one of them has been pickled."""
        one, other = self.surface.connectivity, surface.connectivity
        return one is other or (
            one.basis.order == other.basis.order
            and one.elements.shape == other.elements.shape
            and bool(np.array_equal(one.elements, other.elements))
        )

    def on(self, surface: ElementSurface) -> tuple[Umbilics, Isothermic]:
        """Umbilics and isothermic coordinates of another surface.

        Raises
        ------
        LayoutError
            What is kept does not hold for it.
        """
        umbilics = carried_umbilics(surface, self.umbilics, self.inside)
        if umbilics is None:
            raise LayoutError("an umbilic is not found again")
        mesh = self.layout.placed(surface, umbilics, known=True)
        iso = self.cut.integrated(mesh)
        self.cut.refuse_turned(mesh, iso.sign)
        return umbilics, iso

    def straightened(self, iso: Isothermic, surface: ElementSurface) -> Isothermic:
        """Coordinates of a surface, cut along the lines of the reference.

        Raises
        ------
        LayoutError
            They do not hold for it.
        """
        straight = self.straight
        if straight is None:
            return iso
        mesh = fields_of_parts(straight.split, straight.split.mesh, iso.mesh, surface, known=True)
        try:
            return straight.applied(iso, mesh)
        except CrossedError as error:
            raise LayoutError(str(error)) from None


def coordinates_of(umbilics: Umbilics, iso: Isothermic) -> NetCoordinates:
    """Umbilics and isothermic coordinates as a net is planned from."""
    return NetCoordinates(umbilics, iso, holonomies(iso))


@dataclass(frozen=True, eq=False)
class FollowedCoordinates:
    """Isothermic coordinates of a surface, and what those of changed ones take over.

    Attributes
    ----------
    coordinates : NetCoordinates
    home, last : KeptCoordinates
        Of the first surface, and of the last one that they were made anew for.
    """

    coordinates: NetCoordinates
    home: KeptCoordinates
    last: KeptCoordinates

    @classmethod
    def of(cls, surface: ElementSurface, seams: bool, before: FollowedCoordinates | None = None) -> FollowedCoordinates:
        """Of a surface, from those before where these hold.

        Parameters
        ----------
        surface : ElementSurface
        seams : bool
            See `lamella.network.elements.net_coordinates.net_coordinates`.
        before : FollowedCoordinates, optional
        """
        for kept in dict.fromkeys((before.home, before.last)) if before else ():
            if before and kept.serves(surface):
                with suppress(LayoutError):
                    umbilics, iso = kept.on(surface)
                    iso = kept.straightened(iso, surface) if seams else iso
                    return cls(coordinates_of(umbilics, iso), before.home, before.last)
        refuse_umbilic(surface)
        kept = KeptCoordinates.of(surface)
        iso = kept.straightened(kept.iso, surface) if seams else kept.iso
        return cls(coordinates_of(kept.umbilics, iso), before.home if before else kept, kept)
