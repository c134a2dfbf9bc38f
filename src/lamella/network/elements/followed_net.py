"""A net that follows its surface: level lines at once, the whole net where it is asked for.

What a net on surfaces of the same elements shares is kept (`lamella.network.elements.kept_coordinates`): the elements
to integrate on and their places, the cut, the roots' signs, which values are one unknown, the symbolic factorisation,
the straight lines of the cut, and the lattice. A changed surface costs one factorisation. Like the film's, its
coordinates depend on the surface and on what is kept, not on the surfaces in between.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property

from lamella.base.errors import InputError
from lamella.base.result import Result
from lamella.network.density_request import DensityRequest
from lamella.network.elements.cell_count import CellCount
from lamella.network.elements.element_network import Closing, ElementNetwork, NetPlan, border_names, plan_net
from lamella.network.elements.integer_grid_map import IntegerGridMap
from lamella.network.elements.kept_coordinates import KeptCoordinates, coordinates_of
from lamella.network.elements.lattice import choose_lattice
from lamella.network.elements.level_lines import LevelLines, level_lines
from lamella.network.isothermic.isothermic import Isothermic
from lamella.network.isothermic.lattice_origin import lattice_origin
from lamella.network.isothermic.mesh_layout import LayoutError
from lamella.network.network import Network
from lamella.network.pattern import NetKind, Pattern
from lamella.surface.element.surface import ElementSurface
from lamella.surface.element.umbilics import Umbilics
from lamella.surface.umbilic import refuse_umbilic


@dataclass(frozen=True)
class NetRequest:
    """What a net is to be, whatever its surface; see `lamella.net`."""

    density: DensityRequest
    minimum_length: float
    pattern: Pattern
    closing: Closing

    @property
    def seams(self) -> bool:
        """Whether the net is left open where it does not meet itself."""
        return self.closing == "open"


@dataclass(frozen=True, eq=False)
class NetReference:
    """What nets on surfaces of the same elements share.

    Attributes
    ----------
    kept : KeptCoordinates
    cells : int
        Of the lattice.
    step : float or None
        Its spacing l0, sqrt(m), where a median cell edge was asked for.
    """

    kept: KeptCoordinates
    cells: int
    step: float | None


@dataclass(frozen=True, eq=False, repr=False)
class FollowedNet(Result):
    """A net, and what nets on changed surfaces take over from it.

    Attributes
    ----------
    request : NetRequest
    surface : ElementSurface
    umbilics : Umbilics
    coordinates : Isothermic
        Isothermic coordinates.
    made_anew : str
        Why what the net before it had was not kept; empty: it was, or it is the first one.
    reference, home : NetReference
        What it was made with; that of the first net.

    Examples
    --------
    >>> import lamella
    >>> film = lamella.follow([lamella.circle((0, 0, z), 3.0) for z in (0.0, 2.5)], tolerance=0.03)
    >>> net = lamella.follow_net(film.surface, cells=12)
    >>> film = film.at([lamella.circle((0, 0, z), 3.0) for z in (0.0, 2.6)])
    >>> net.at(film.surface).network
    Network(12 cells: 24 lamellas, 84 nodes, 60 faces)
    """

    request: NetRequest
    surface: ElementSurface
    umbilics: Umbilics
    coordinates: Isothermic
    made_anew: str
    reference: NetReference
    home: NetReference

    @classmethod
    def first(cls, surface: ElementSurface, request: NetRequest) -> FollowedNet:
        """The net of a surface from nothing.

        Raises
        ------
        InputError
            See `lamella.net`.
        """
        refuse_umbilic(surface)
        kept = KeptCoordinates.of(surface)
        reference = _laid(kept, request)
        return cls(request, surface, kept.umbilics, kept.iso, "", reference, reference)

    def at(self, surface: ElementSurface) -> FollowedNet:
        """The net of another surface; this one stays as it is.

        Parameters
        ----------
        surface : ElementSurface
            A changed one on the same elements (`lamella.FollowedFilm.surface`); on others the net is made anew.

        Raises
        ------
        InputError
            See `lamella.net`.
        """
        reason = "the surface has other elements"
        for reference in dict.fromkeys((self.home, self.reference)):
            if not reference.kept.serves(surface):
                continue
            try:
                umbilics, iso = reference.kept.on(surface)
            except LayoutError as error:
                reason = str(error)
                continue
            return replace(self, surface=surface, umbilics=umbilics, coordinates=iso, made_anew="", reference=reference)
        return replace(FollowedNet.first(surface, self.request), made_anew=reason, home=self.home)

    @cached_property
    def step(self) -> float:
        """Spacing l0 of the lattice, sqrt(m)."""
        if self.reference.step is not None:
            return self.reference.step
        pattern, coordinates = self.request.pattern, coordinates_of(self.umbilics, self.coordinates)
        return CellCount.of(self.coordinates, coordinates.around, pattern).step(self.reference.cells, pattern)

    @cached_property
    def lines(self) -> LevelLines:
        """The net's curves as polylines.

        Those of the lattice with all their short pieces, to the size of the small triangles that they are looked for
        on; neither rounded nor moved where the net closes by less than a thousandth of a cell.
        """
        iso, pattern = self.coordinates, self.request.pattern
        cells = IntegerGridMap.of(iso, lattice_origin(iso, self.step, pattern), self.step, pattern)
        return level_lines(cells, iso.cut, self.reference.kept.grid(cells))

    @cached_property
    def network(self) -> Network:
        """The whole net, as `lamella.net` gives it.

        Raises
        ------
        InputError
            See `lamella.net`.
        """
        made = self.element_network
        return replace(made.network, surface=self.surface, figures=made.describe(), notes=tuple(made.warnings()))

    @cached_property
    def element_network(self) -> ElementNetwork:
        """The whole net with what it rests on."""
        request, kept = self.request, self.reference.kept
        iso = self.coordinates
        if request.seams:
            # seams along edges of elements are as good, and not as straight
            with suppress(LayoutError):
                iso = kept.straightened(iso, self.surface)
        coordinates = coordinates_of(self.umbilics, iso)
        names = border_names(iso)
        lattice = choose_lattice(
            iso,
            coordinates.around,
            request.density,
            step=self.reference.step,
            pattern=request.pattern,
            names=names,
            seams=request.seams,
        )
        plan = NetPlan(self.surface, self.umbilics, iso.mesh, iso, coordinates.around, lattice, request.pattern, names)
        return plan.traced(closing=request.closing, minimum_length=request.minimum_length)

    def _line(self) -> str:
        return (
            f"{self.reference.cells} cells, {len(self.umbilics.orders)} umbilics, "
            f"{self.coordinates.mesh.connectivity.node_count:,} nodes, {'made anew' if self.made_anew else 'kept'}"
        )


def follow_net(
    surface: ElementSurface,
    *,
    cells: int | None = None,
    spacing: float | None = None,
    minimum_length: float = 0.5,
    kind: NetKind = "lamellas",
    every: tuple[int, int] = (1, 1),
    closing: Closing = "open",
) -> FollowedNet:
    """A net that follows its surface.

    Parameters
    ----------
    surface : ElementSurface
        `lamella.FollowedFilm.surface`, or any surface of elements of constant mean curvature.
    cells, spacing, minimum_length, kind, every, closing
        See `lamella.net`. Of a spacing the lattice's l0 is kept while the surface changes; of a number of cells the
        number.

    Returns
    -------
    FollowedNet
        `lines` are its curves, `network` the net; `at` follows the surface.

    Raises
    ------
    InputError
        See `lamella.net`.

    Examples
    --------
    >>> import lamella
    >>> rings = [lamella.circle((0, 0, z), 3.0) for z in (0.0, 2.5)]
    >>> net = lamella.follow_net(lamella.film(rings, tolerance=0.03), cells=12)
    >>> net
    FollowedNet(12 cells, 0 umbilics, 746 nodes, kept)
    >>> points, offsets = net.lines.points, net.lines.offsets
    """
    request = NetRequest(DensityRequest.of(cells, spacing), minimum_length, Pattern(kind, every), closing)
    if not isinstance(surface, ElementSurface) or not surface.has_lattice():
        raise InputError(
            f"a net cannot follow a {type(surface).__name__}",
            "take a surface of constant mean curvature that was found: lamella.follow(...).surface, or lamella.film",
            "surface",
        )
    return FollowedNet.first(surface, request)


def _laid(kept: KeptCoordinates, request: NetRequest) -> NetReference:
    """The lattice of a surface's coordinates, as a net is planned."""
    iso = kept.straightened(kept.iso, kept.surface) if request.seams else kept.iso
    plan = plan_net(
        kept.surface,
        cells=request.density.cells,
        spacing=request.density.spacing,
        pattern=request.pattern,
        seams=request.seams,
        minimum_length=request.minimum_length,
        coordinates=coordinates_of(kept.umbilics, iso),
    )
    spaced = request.density.spacing is not None
    return NetReference(kept, plan.lattice.cells, plan.lattice.step if spaced else None)
