"""The network of a surface of elements: umbilics, isothermic coordinates, lattice, lamellas."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any, Literal, NamedTuple

import numpy as np

from lamella.base.arrays import Booleans, Floats
from lamella.base.drawing_origin import coordinates
from lamella.base.errors import InputError
from lamella.base.message import Message
from lamella.base.progress import Progress, silent
from lamella.base.vectors import diagonal
from lamella.base.wording import counted
from lamella.network.density_request import DensityRequest
from lamella.network.elements.closing_steps import CLOSES
from lamella.network.elements.integer_grid_map import IntegerGridMap
from lamella.network.elements.lattice import Lattice, choose_lattice
from lamella.network.elements.net_coordinates import NetCoordinates, net_coordinates
from lamella.network.elements.rim_corners import RimCorners
from lamella.network.elements.rounding import largest_part, rounded_coordinates, stubs, turned
from lamella.network.elements.trace import trace_elements
from lamella.network.isothermic.holonomy import Holonomy, holonomies
from lamella.network.isothermic.integration_mesh import IntegrationMesh, onto_surface
from lamella.network.isothermic.isothermic import Isothermic, Transition
from lamella.network.isothermic.seamless_transitions import FoldedError, with_shifts
from lamella.network.network import REGULAR, SINGULAR, Network, Period
from lamella.network.pattern import LAMELLAS, Pattern
from lamella.network.written_lines import WrittenLines, angle_figures
from lamella.surface.element.surface import ElementSurface
from lamella.surface.element.umbilics import Umbilics

Closing = Literal["open", "round"]

# of the curvature scale: a larger error of the normal curvature is told
ASTRAY = 0.02
# cell edges from a corner of the boundary within which the corner is the reason for it
CORNER_EDGES = 1.5
# of the largest utilisation: where it is less than this away from corners, a corner is the reason for it
AWAY_UTILISATION_MAX = 0.4
# nets of up to so many nodes are tried out to meet a spacing, so often, until they do to so little
TRIED_NET_NODES_MAX, SPACING_TRIALS_MAX, NEAR_ENOUGH = 1_200, 3, 0.02


class Joint(NamedTuple):
    """Where a net has to meet itself: between what, how far from whole cells, and whether it was closed."""

    between: str
    off_cells: float
    closed: bool


@dataclass(frozen=True)
class ElementNetwork:
    """A network with what it rests on.

    Attributes
    ----------
    network : Network
    umbilics : Umbilics
    on_rim : (z,) bool
        Umbilics on the boundary: no lamella ends in them.
    lattice : Lattice
    residual : float
        Distance of the surface from constant mean curvature, see `Isothermic.residual`.
    joints : tuple of Joint
    corners : RimCorners
        Of the boundary.
    curves : bool
        Whether the boundary is of curves whose corners a project can round.
    """

    network: Network
    umbilics: Umbilics
    on_rim: Booleans
    lattice: Lattice
    residual: float
    joints: tuple[Joint, ...]
    corners: RimCorners
    curves: bool

    @property
    def requested(self) -> str:
        """What was asked for."""
        return self.lattice.requested

    def describe(self) -> dict[str, Any]:
        """Further figures of the network for summary.json."""
        nodes = self.network.node_points[self.network.node_kinds == SINGULAR]
        reach = 1e-6 * diagonal(self.network.node_points)
        # whether one on the rim lies within is decided by the surface's errors
        inner = ~self.on_rim
        umbilics = [
            {
                "point": point.tolist(),
                "order": int(order),
                "rays": int(2 * (order + 2)),
                "node": bool((np.linalg.norm(nodes - point, axis=1) < reach).any()) if len(nodes) else False,
            }
            for point, order in zip(self.umbilics.position[inner], self.umbilics.orders[inner], strict=True)
        ]
        return {
            "singular_nodes": [
                {key: umbilic[key] for key in ("point", "order", "rays")} for umbilic in umbilics if umbilic["node"]
            ],
            "umbilics": umbilics,
            "isothermic_residual": self.residual,
            "joints": [joint._asdict() for joint in self.joints],
            "closed": all(joint.closed for joint in self.joints),
            "corners": self.corners.rows(self.network, self._bend_off, self._node_angles),
        } | self._off()

    @cached_property
    def _written(self) -> WrittenLines:
        return WrittenLines.of(self.network)

    @cached_property
    def _bend_off(self) -> Floats:
        """What the normal curvature is off at the samples, by the surface and by the written points, 1/m, (k,)."""
        return self._written.bend_off(self.network, self.network.normal_curvature)

    @cached_property
    def _node_angles(self) -> Floats:
        """At regular nodes, by the surface and by the written points, deg, (2, n)."""
        return self._written.node_angles(self.network)

    def _off(self) -> dict[str, float]:
        """Node angles and errors of the lamellas' normal curvature, where the surface is resolved."""
        network, corners = self.network, self.corners
        nodes = network.node_points[network.node_kinds == REGULAR]
        resolved = corners.within(nodes, corners.cores) < 0
        figures = angle_figures(self._node_angles[:, resolved if resolved.any() else slice(None)])
        if network.pattern.kind != "lamellas":
            return figures
        off = self._bend_off[corners.within(network.sample_points, corners.cores) < 0]
        return figures | {"normal_curvature_deviation_max": float(off.max(initial=0.0))}

    def _remedy(self) -> str:
        """What closes an open net, with its umbilics on nodes."""
        advice = self.lattice.advice
        if advice and self.lattice.better_closes:
            return advice
        # a mesh has no curves to be adjusted
        ways = "'round' or 'adjust'" if self.curves else "'round'"
        return (f"{advice}; " if advice else "no density near this one closes it; ") + f"closing = {ways} may close it"

    def warnings(self, finer: float = 1.0) -> Iterator[Message]:
        """Where the net does not meet itself, umbilics that are no nodes, and where elements do not tell directions.

        Parameters
        ----------
        finer : float
            By how much smaller the tolerance of the surface that is to be judged is than that of this one.
        """
        open_, rounded = (
            [joint.off_cells for joint in self.joints if joint.off_cells > CLOSES and joint.closed == closed]
            for closed in (False, True)
        )
        if open_:
            yield Message(
                "net_open",
                f"the net does not meet itself along {len(open_)} seam{'s' if len(open_) > 1 else ''}: it misses whole "
                f"cells by up to {max(open_):.3g} (summary: network.joints); {self._remedy()}",
            )
        if rounded:
            yield Message(
                "net_rounded",
                f"the net was closed by rounding {len(rounded)} joint{'s' if len(rounded) > 1 else ''} by up to "
                f"{max(rounded):.3g} cells: node angles and normal curvatures pay for it"
                + (f"; {self.lattice.advice}" if self.lattice.advice else ""),
            )
        umbilics = self.describe()["umbilics"]
        missed = [umbilic for umbilic in umbilics if not umbilic["node"]]
        if missed:
            places = "; ".join(coordinates(umbilic["point"], 3) for umbilic in missed)
            yield Message(
                "umbilics_missed",
                f"{len(missed)} of {len(umbilics)} umbilics are no nodes of the net (at {places} m): "
                f"lamellas pass around them; {self._remedy()}",
            )
        if not rounded:
            yield from self._astray(finer)

    def _astray(self, finer: float) -> Iterator[Message]:
        """Lamellas whose normal curvature is another one, on the surface or by their written points."""
        network = self.network
        if network.pattern.kind != "lamellas":
            return
        there = network.sample_darboux
        off = self._bend_off / np.sqrt(np.mean(there.kn**2 + there.tg**2))
        yield from self._unresolved(off)
        # what elements do not resolve is told apart
        off[self.corners.within(network.sample_points, self.corners.cores) >= 0] = 0.0
        off /= finer
        far = off > ASTRAY
        if far.any():
            worst = network.sample_points[off.argmax()]
            yield Message(
                "lamellas_off",
                f"the normal curvature of lamellas is off by up to {off.max():.2g} of the curvature scale near "
                f"({coordinates(worst, 3)}) m (by more than {ASTRAY:g} at {far.mean():.2%} of the samples): "
                + self._why_astray(worst),
            )

    def _unresolved(self, off: Floats) -> Iterator[Message]:
        """Lamellas that come closer to a corner than the surface's elements follow its curvature."""
        at = self.corners.within(self.network.sample_points, self.corners.cores)
        found = np.unique(at[(at >= 0) & (off > ASTRAY)]).tolist()
        if found:
            places = "; ".join(coordinates(self.corners.points[corner], 3) for corner in found)
            yield Message(
                "corners_unresolved",
                f"next to {counted(len(found), 'corner')} of the boundary (at {places} m) the film is not resolved: "
                f"within {self.corners.cores[found].max():.2g} m the normal curvature of lamellas is off by up to "
                f"{off[np.isin(at, found)].max():.2g} of the curvature scale (summary: network.corners); "
                + self.rounding(found[0]),
            )

    def corner_stresses(self, utilisation: Floats) -> dict[str, Any]:
        """The largest utilisation (of samples, (k,)) next to each corner, and away from all of them."""
        at = self.corners.within(self.network.sample_points, self.corners.radii)
        rows = [float(utilisation[at == k].max()) if (at == k).any() else None for k in range(len(self.corners.points))]
        return {
            "utilisation_at_corners": rows,
            "utilisation_away_from_corners": float(utilisation[at < 0].max(initial=0.0)),
        }

    def at_corner(self, point: Floats, utilisation: Floats, searched: Callable[[int, tuple[float, float]], str]) -> str:
        """What helps at a point (3,) if a corner is why so much is used there and not farther away; else empty.

        `searched` tells what a radius does: see `lamella.stages.lamellas.corner_search.radius_that_does`.
        """
        reach = CORNER_EDGES * float(np.median(self.network.cell_edges))
        corner = self.corners.nearest(point, reach)
        if corner < 0:
            return ""
        radii = np.maximum(self.corners.radii, reach)
        away = utilisation[self.corners.within(self.network.sample_points, radii) < 0].max(initial=0.0)
        if away > AWAY_UTILISATION_MAX * utilisation.max():
            return ""
        relief = self._relief(corner, searched)
        return (
            "the boundary has a corner there, which concentrates curvature (up to "
            f"{away:.2f} more than {radii[corner]:.2g} m away from corners): {relief}; "
        )

    def _relief(self, corner: int, searched: Callable[[int, tuple[float, float]], str]) -> str:
        """What lowers the stress at a corner."""
        if not self.curves or self.corners.sliding[corner]:
            return self.rounding(corner)
        most = float(self.corners.fillets[corner])
        does = searched(int(self.corners.loops[corner]), (float(np.median(self.network.cell_edges)), most))
        return does or f"no corner_radius that was tried, up to the {most:.2g} m its loop has room for, brings it to 1"

    def rounding(self, corner: int) -> str:
        """What makes a corner one that a net can follow."""
        edge = float(np.median(self.network.cell_edges))
        if not self.curves:
            return f"round it over about {edge:.2g} m to either side"
        if self.corners.sliding[corner]:
            return "let the held part meet what the other one slides on at a right angle"
        return f"round it: corner_radius = {self.corners.fillet(corner, edge):g} m in the table of its loop"

    def _why_astray(self, worst: Floats) -> str:
        """What makes directions wrong at a place, and what helps."""
        corner = self.corners.nearest(worst, CORNER_EDGES * float(np.median(self.network.cell_edges)))
        if corner >= 0:
            return "the boundary has a corner there, which concentrates curvature; " + self.rounding(corner)
        return "the surface's directions are not told well enough there; write a smaller tolerance"


@dataclass(frozen=True)
class NetPlan:
    """Where the lattice of a net lies on a surface, before anything is traced.

    Attributes
    ----------
    surface : ElementSurface
    umbilics : Umbilics
    mesh : IntegrationMesh
    iso : Isothermic
    around : tuple of Holonomy
        Of the holes.
    lattice : Lattice
    pattern : Pattern
    names : tuple of str
        Of the boundary loops.
    """

    surface: ElementSurface
    umbilics: Umbilics
    mesh: IntegrationMesh
    iso: Isothermic
    around: tuple[Holonomy, ...]
    lattice: Lattice
    pattern: Pattern
    names: tuple[str, ...]

    def _lattice_of(self, cells: int) -> Lattice:
        """The lattice of another number of cells, for a net without seams."""
        return choose_lattice(
            self.iso, self.around, DensityRequest.of(cells), pattern=self.pattern, names=self.names, seams=False
        )

    def traced(self, *, closing: Closing, minimum_length: float) -> ElementNetwork:
        """The network, see `element_network`."""
        iso, mesh, lattice, pattern = self.iso, self.mesh, self.lattice, self.pattern
        raw = IntegerGridMap.of(iso, lattice.origin, lattice.step, pattern)
        if closing == "round":
            iso, wanted = rounded_coordinates(iso, lattice, pattern, self._lattice_of)
            off = largest_part(raw.shifts - wanted)
        else:
            near = np.round(raw.shifts)
            off = largest_part(raw.shifts - near)
            wanted = np.where(off <= CLOSES, near, np.nan)
            # lines of one family go on where those of the other one do not
            off_parts, near_parts = raw.shifts - near, np.stack([near.real, near.imag])
            closes = (np.abs(np.stack([off_parts.real, off_parts.imag])) <= CLOSES) & ~stubs(iso)
            if closes.any():
                try:
                    iso = with_shifts(iso, *turned(raw, np.where(closes, near_parts, np.nan), lattice))
                except FoldedError:
                    # coordinates that turn over somewhere stay as they are, with a seam
                    wanted[:] = np.nan
        around = holonomies(iso) if closing == "round" else self.around
        rim_loop = mesh.loop[mesh.connectivity.rim_nodes[:, 0]]
        network = trace_elements(
            IntegerGridMap.of(iso, lattice.origin, lattice.step, pattern),
            iso.cut,
            self.umbilics.orders,
            onto=partial(onto_surface, mesh, self.surface, self.umbilics),
            mean_curvature=self.surface.mean_curvature,
            rim_loop=rim_loop,
            count=lattice.cells,
            periods=tuple(
                Period(self.names[one.loop], *pattern.crossed(one.shift, lattice.step))
                for one in around
                if one.sign == 1
            ),
            minimum_length=minimum_length,
        )
        joints = tuple(
            Joint(joint_name(piece, mesh, self.names), float(miss), not np.isnan(whole))
            for piece, miss, whole in zip(iso.transitions, off, wanted, strict=True)
            if not piece.stub
        )
        surface = self.surface
        return ElementNetwork(
            network,
            self.umbilics,
            mesh.umbilics < 0,
            lattice,
            iso.residual,
            joints,
            RimCorners.of(surface),
            surface.has_boundary_curves,
        )


def plan_net(
    surface: ElementSurface,
    *,
    cells: int | None = None,
    spacing: float | None = None,
    step: float | None = None,
    pattern: Pattern = LAMELLAS,
    loop_names: tuple[str, ...] = (),
    seams: bool = True,
    minimum_length: float = 0.5,
    coordinates: NetCoordinates | None = None,
    progress: Progress = silent,
) -> NetPlan:
    """Umbilics, isothermic coordinates and lattice of a surface: how many cells its net has, and about how many nodes.

    Parameters
    ----------
    surface, cells, spacing, step, pattern, loop_names, minimum_length, progress
        See `element_network`.
    seams : bool
        Whether the net is left open where it does not meet itself.
    coordinates : NetCoordinates, optional
        Of the surface and `seams`, where they are known.

    Raises
    ------
    InputError
    """
    request = DensityRequest.of(cells, spacing)
    assert surface.has_lattice(pattern.normal_curvature)
    known = coordinates or net_coordinates(surface, seams=seams, progress=progress)
    iso, around = known.iso, known.around
    names = loop_names or border_names(iso)
    choose = partial(choose_lattice, iso, around, request, step=step, pattern=pattern, names=names, seams=seams)
    laid = NetPlan(surface, known.umbilics, iso.mesh, iso, around, choose(), pattern, names)
    if spacing is None or step is not None:
        return laid
    return _tried_out(laid, spacing, choose, "open" if seams else "round", minimum_length)


def border_names(iso: Isothermic) -> tuple[str, ...]:
    """Names of boundary loops that have none of their own."""
    return tuple(f"border {k}" if k else "outer" for k in range(int(iso.mesh.loop.max()) + 1))


def _tried_out(
    laid: NetPlan, spacing: float, choose: Callable[..., Lattice], closing: Closing, minimum_length: float
) -> NetPlan:
    """A net of few nodes with the density whose median cell edge, measured on the net, comes nearest to a spacing.

    In a net of a few rows the ends of the curves are half of its edges, and where they lie decides.
    """
    best, nearest, correction = laid, np.inf, 1.0
    for _ in range(SPACING_TRIALS_MAX):
        if laid.lattice.estimated_nodes > TRIED_NET_NODES_MAX:
            break
        # a spacing is that of the lattice before curves are left out
        whole = replace(laid, pattern=replace(laid.pattern, every=(1, 1)))
        try:
            edges = whole.traced(closing=closing, minimum_length=minimum_length).network.cell_edges
            measured = float(np.median(edges))
            correction *= measured / laid.lattice.edge
            again = choose(correction=correction)
        except InputError:
            break
        if abs(np.log(measured / spacing)) < nearest:
            best, nearest = laid, abs(np.log(measured / spacing))
        if nearest < NEAR_ENOUGH or again.step == laid.lattice.step:
            break
        laid = replace(laid, lattice=again)
    return best


def element_network(
    surface: ElementSurface,
    *,
    cells: int | None = None,
    spacing: float | None = None,
    closing: Closing = "open",
    step: float | None = None,
    minimum_length: float = 0.5,
    pattern: Pattern = LAMELLAS,
    loop_names: tuple[str, ...] = (),
    progress: Progress = silent,
) -> ElementNetwork:
    """The network of lamellas, or of principal lines, on a surface of elements.

    Parameters
    ----------
    surface : ElementSurface
        Of constant mean curvature.
    cells, spacing, minimum_length
        See `lamella.network.net.net`.
    closing : "open" or "round"
        What is done where shifts are not whole: a seam, or the nearest whole numbers by the smallest change of the
        coordinates.
    step : float, optional
        Spacing l0 of the lattice, sqrt(m), instead of the one that follows from cells or spacing.
    pattern : Pattern
        Which curves of the isothermic lattice the net has (see `lamella.network.streamlines` for others).
    loop_names : tuple of str
        Of the boundary loops.
    progress : callable

    Raises
    ------
    InputError
    """
    laid = plan_net(
        surface,
        cells=cells,
        spacing=spacing,
        step=step,
        pattern=pattern,
        loop_names=loop_names,
        seams=closing == "open",
        minimum_length=minimum_length,
        progress=progress,
    )
    return laid.traced(closing=closing, minimum_length=minimum_length)


def joint_name(piece: Transition, mesh: IntegrationMesh, names: tuple[str, ...]) -> str:
    """What a piece of the cut lies between."""

    def one(end: int) -> str:
        if end < 0:
            return f"the loop {names[-1 - end]!r}" if -1 - end < len(names) else "the rim"
        kind = "the singular node" if end in mesh.umbilics else "the seam"
        return f"{kind} at ({coordinates(mesh.nodes[end])}) m"

    # nodes first, then loops in the project's order: which end the cut came from means nothing
    first, second = sorted(piece.ends, reverse=True)
    return f"between {one(first)} and {one(second)}"
