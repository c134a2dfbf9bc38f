"""The lamellas of a network: stresses, planarity and developed node marks of every strip."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field, replace
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np

from lamella.base.arrays import Booleans, Floats
from lamella.base.blocks import blocks
from lamella.base.errors import InputError, require_positive
from lamella.base.material import Material, find_material
from lamella.base.onward import onward
from lamella.base.result import Shown
from lamella.base.wording import counted, rounded
from lamella.network.network import SINGULAR, Network
from lamella.strip.layer_curves import lamella_layers
from lamella.strip.layers import LayerCurves, Layers, at_stops, parallel_layers, running
from lamella.strip.levels import cut_curvatures, on_levels
from lamella.strip.planarity import planarity_score
from lamella.strip.stress import Stresses, shortening, stresses
from lamella.surface.surface import Surface

if TYPE_CHECKING:
    from lamella.fabrication.part import Parts

Marks = Literal["arc-length", "relaxed"]
LayerLengths = Literal["alike", "own"]


@dataclass(frozen=True)
class Section:
    """Cross section and layout of a lamella.

    Attributes
    ----------
    height, thickness : float
        m; the height stands along the surface normal, half of it on either side.
    layers : int
        Parallel strips of each lamella.
    offset : float
        Distance of neighbouring layers, m.
    marks : str
        "arc-length": nodes are marked at the 3D arc length, the nodes then hold the strip's length and it carries
        the restraint tension. "relaxed": at the integral of (1 + h^2 tg^2 / 24) ds, without that tension.
    layer_lengths : str
        "alike": all layers are marked like the centre line. "own": each at the arc lengths of its own curve c + d u,
        d to the side of the centre line, where an element is sqrt((1 - d kg)^2 + (d tg)^2) ds long.
    layer_curves : str
        "offset", "cut" or "lamella", see `lamella.strip.layers`; with the last two layers have their own lengths.
    level : float
        From the surface to the middle of a strip, m: the A lamellas stand as much below it as the B lamellas above.

    Examples
    --------
    >>> import lamella
    >>> section = lamella.Section(height=0.08, thickness=0.001, layers=3, offset=0.02)
    >>> section.layer_offsets
    array([-0.02,  0.  ,  0.02])
    """

    height: float = 0.1
    thickness: float = 0.0015
    layers: int = 2
    offset: float = 0.025
    marks: Marks = "arc-length"
    layer_lengths: LayerLengths = "alike"
    layer_curves: LayerCurves = "offset"
    level: float = 0.0

    @property
    def layer_offsets(self) -> Floats:
        """Sideways distances d of the layers from the centre line, m, towards u = n x t, (layers,)."""
        return np.asarray((np.arange(self.layers) - 0.5 * (self.layers - 1)) * self.offset)

    @property
    def own_parts(self) -> bool:
        """Whether the layers of a lamella differ, so that each is a part of its own."""
        return self.layers > 1 and (self.layer_lengths == "own" or self.layer_curves != "offset")

    @property
    def record(self) -> dict[str, Any]:
        """What files tell of it: the level only of stacked lamellas."""
        told = asdict(self)
        if not self.level:
            del told["level"]
        return told

    def __post_init__(self) -> None:
        """Raise an `InputError` for a section that is none."""
        require_positive(height=self.height, thickness=self.thickness, layers=self.layers, offset=self.offset)
        if not 0 <= self.level < np.inf:
            raise InputError(f"level = {self.level:g} m", "give 0 or more", "level")
        if self.thickness >= self.height:
            raise InputError(
                f"thickness = {self.thickness:g} m is not below height = {self.height:g} m",
                "the strip stands on edge: its height is the larger measure",
                "thickness",
            )
        for key, value, known in (
            ("marks", self.marks, get_args(Marks)),
            ("layer_lengths", self.layer_lengths, get_args(LayerLengths)),
            ("layer_curves", self.layer_curves, get_args(LayerCurves)),
        ):
            if value not in known:
                raise InputError(f"{key} = {value!r}", f"choose one of {', '.join(known)}", key)


@dataclass(frozen=True, eq=False, repr=False)
class Lamellas(Shown):
    """Flat strips that stand normal to the surface along the centre lines of a network.

    Arrays of shape (k,) run over the network's samples, (q,) over its stops, (m,) over its lamellas. The
    curvatures are the network's (`Network.sample_darboux`).

    Attributes
    ----------
    network : Network
        With stacked lamellas that of their levels (`lamella.strip.levels`).
    section : Section
    material : Material
    bending, torsion : (k,)
        Weak-axis bending stress E t |kg| / 2 and St-Venant shear G t |tg|, Pa.
    layer : (k,)
        Strong-axis bending stress of the layers farthest from the centre line, E h/2 d |d kn / d u|, Pa; zero where
        they are cut to their curvature or lie on lamella curves.
    helix_edge, helix_centre : (k,)
        Helix normal stress, with plate action, at the strip's edge (tension) and centre line (compression), Pa, where
        it is free to shorten.
    restraint : (k,)
        Tension on the centre line from node marks at the unshortened length, Pa; zero where marks are relaxed.
    von_mises : (k,)
        Largest equivalent stress of the section, Pa.
    utilisation : (k,)
        Share of the material's strength.
    net_utilisation : (q,)
        The same of the half height that is left at the slots (`lamella.strip.stress.net_section`); 0 at nodes without.
    planarity : (k,)
        Planarity score of the strip quad between a sample and the next; zero at each lamella's end.
    stop_stations : (q,)
        Place of the node on the developed centre line, m from the lamella's start.
    layers : Layers
        The layers beside it.
    developed_lengths : (m,)
        Length of the developed centre line from first to last node, m.

    Examples
    --------
    >>> import lamella
    >>> strips = lamella.net(lamella.Catenoid(2.5, (-2.0, 3.0)), cells=12).strips()
    >>> print(f"{strips.utilisation.max():.2f}, {strips.developed_lengths.sum():.1f} m")
    0.40, 203.4 m
    """

    network: Network = field(compare=False)
    section: Section
    material: Material
    bending: Floats
    torsion: Floats
    layer: Floats
    helix_edge: Floats
    helix_centre: Floats
    restraint: Floats
    von_mises: Floats
    utilisation: Floats
    net_utilisation: Floats
    planarity: Floats
    stop_stations: Floats
    layers: Layers
    developed_lengths: Floats

    def _line(self) -> str:
        section = self.section
        return (
            f"{counted(len(self.developed_lengths), 'lamella')} of {section.layers} x {1e3 * section.height:g} x "
            f"{1e3 * section.thickness:g} mm, {self.developed_lengths.sum():.4g} m, utilisation up to "
            f"{self.utilisation.max(initial=0.0):.2f}"
        )

    def parts(
        self,
        *,
        end_distance: float | None = None,
        rim_overhang: float = 0.01,
        hub_radius: float | None = None,
        slot_width: float | None = None,
        slot_play: float = 0.0,
        foot_radius: float = 0.0,
        sheet: tuple[float, float] = (12.0, 2.0),
        gap: float = 0.01,
    ) -> Parts:
        """Flat parts of every lamella, with their slots.

        Parameters
        ----------
        end_distance, rim_overhang, hub_radius, slot_width, slot_play, foot_radius, sheet, gap
            m, see `lamella.fabrication.parts.make_parts`.

        Raises
        ------
        InputError
            Where the measures contradict each other.

        Examples
        --------
        >>> import lamella
        >>> strips = lamella.net(lamella.Catenoid(2.5, (-2.0, 3.0)), cells=12).strips()
        >>> strips.parts()
        Parts(24 parts, 48 pieces, 481.9 kg)
        """
        parts: Parts = onward("lamella.fabrication.parts.make_parts")(
            self.network,
            self,
            density=self.material.density,
            end_distance=end_distance,
            rim_overhang=rim_overhang,
            hub_radius=hub_radius,
            slot_width=slot_width,
            slot_play=slot_play,
            foot_radius=foot_radius,
            sheet=sheet,
            gap=gap,
        )
        return parts

    @property
    def cut_curvatures(self) -> Floats:
        """Curvatures of the flat strips, 1/m, (m,), but for layers that are cut to their own."""
        return cut_curvatures(self.network, self.section.level)

    @property
    def layer_stations(self) -> Floats:
        """Place of the nodes on each flat layer, m from its start, (layers, q)."""
        return self.layers.stop_stations


def twisted_strip(network: Network, height: float) -> tuple[Floats, Floats]:
    """Lower and upper edge of the strips along the surface normals, c -+ h/2 n, m, each (k, 3)."""
    reach = height / 2 * network.sample_normals
    return network.sample_points - reach, network.sample_points + reach


def layer_drift(network: Network) -> Floats:
    """Turn of each lamella's tangent to the side, max - min of the integral of kg ds over its nodes, (m,).

    Times the distance of two layers this is what their node marks would have to shift along each other, from one end
    of the lamella to the other, where both are cut alike.
    """
    turn = at_stops(network, running(network, network.sample_darboux.kg))
    starts = network.stop_offsets[:-1]
    return np.asarray(np.maximum.reduceat(turn, starts) - np.minimum.reduceat(turn, starts))


def make_lamellas(
    network: Network, section: Section, material: Material, surface: Surface[Any] | None = None
) -> Lamellas:
    """Strips of a section along every lamella of a network.

    Parameters
    ----------
    network : Network
    section : Section
    material : Material
    surface : Surface, optional
        The network's, for layers on lamella curves of their own.

    Raises
    ------
    InputError
        The strip is so high that its circular development would reach its own centre; the net is one of curves that
        no strips are made for, or whose layers cannot have lamella curves of their own.
    """
    if network.pattern.no_strips:
        raise InputError(
            f"there are no strips for this net: {network.pattern.no_strips}", "make a net of lamellas", "network"
        )
    curvature = network.normal_curvature
    limit = 2 / abs(curvature) if curvature else np.inf
    if section.height >= limit:
        raise InputError(
            f"height = {section.height:g} m: strips of radius {limit / 2:.4g} m cannot be "
            f"{limit:.4g} m high or more, their inner edge would reach the centre",
            f"write height = {rounded(0.99 * limit / 2, up=False):g} or less, or check that the surface is in metres",
            "section.height",
        )
    _check_level(section)
    network = on_levels(network, section.level)
    held, tg = section.marks == "arc-length", network.sample_darboux.tg
    s = stresses_of(network, section, material)

    lengthening = np.zeros_like(tg) if held else shortening(section.height, tg)
    stations = network.stop_arclengths + at_stops(network, running(network, lengthening))
    return Lamellas(
        network,
        section,
        material,
        s.bending,
        s.torsion,
        s.layer,
        s.helix_edge,
        s.helix_centre,
        s.restraint,
        s.von_mises,
        s.utilisation,
        np.where(slotted(network, section)[network.stop_nodes], at_stops(network, s.net_utilisation), 0.0),
        _planarity(network, section.height),
        stations,
        _layers(network, section, lengthening, surface),
        stations[network.stop_offsets[1:] - 1],
    )


def _planarity(network: Network, height: float) -> Floats:
    """Planarity score of the quad of a strip between each sample and the next, (k,); 0 at a lamella's end."""
    planarity = np.zeros(len(network.sample_points))
    for block in blocks(len(planarity) - 1):
        reach = height / 2 * network.sample_normals[block.start : block.stop + 1]
        points = network.sample_points[block.start : block.stop + 1]
        low, high = points - reach, points + reach
        planarity[block] = planarity_score(low[:-1], low[1:], high[1:], high[:-1])
    planarity[network.sample_offsets[1:] - 1] = 0.0
    return planarity


def largest_utilisation(network: Network, section: Section, material: Material) -> float:
    """The largest utilisation of strips that `make_lamellas` would make, from their stresses alone."""
    return float(stresses_of(on_levels(network, section.level), section, material).utilisation.max())


def stresses_of(
    network: Network,
    section: Section,
    material: Material,
    *,
    height: Floats | None = None,
    thickness: Floats | None = None,
    offset: Floats | None = None,
) -> Stresses:
    """Stresses at the samples of a network.

    Parameters
    ----------
    network : Network
    section : Section
    material : Material
    height, thickness, offset : (k,), optional
        Instead of the section's, m.
    """
    kn, kg, tg = network.sample_darboux
    cut = np.repeat(cut_curvatures(network, section.level), np.diff(network.sample_offsets))
    farthest = np.abs(section.layer_offsets).max() if offset is None else (section.layers - 1) / 2 * offset
    beside = farthest * np.abs(network.sample_slopes)
    # what layers cut to their own curvature are cut to
    off = kn - cut if section.layer_curves != "cut" or not section.level else np.zeros_like(kn)
    return stresses(
        material,
        section.height if height is None else height,
        section.thickness if thickness is None else thickness,
        curvature_error=off,
        layer_curvature=beside if section.layer_curves == "offset" else np.zeros_like(kn),
        kg=kg,
        tg=tg,
        held=section.marks == "arc-length",
    )


def strips_of(network: Network, section: Section | tuple[float, float], material: Material | str) -> Lamellas:
    """What `Network.strips` does."""
    section = section if isinstance(section, Section) else Section(*section)
    material = find_material(material) if isinstance(material, str) else material
    return make_lamellas(network, section, material, network.surface)


def _layers(network: Network, section: Section, lengthening: Floats, surface: Surface[Any] | None) -> Layers:
    """The layers as the section has them."""
    offsets = section.layer_offsets
    if section.layer_curves == "lamella" and section.layers > 1:
        if surface is None:
            raise InputError(
                'layer_curves = "lamella" needs the surface that the network is on',
                "give make_lamellas the surface, or choose another value",
                "surface",
            )
        return lamella_layers(surface, network, offsets, lengthening)
    cut = section.layer_curves == "cut"
    made = parallel_layers(network, offsets, lengthening, own_lengths=section.own_parts, cut=cut)
    if not (cut and section.level):
        return made
    straight = np.repeat(cut_curvatures(network, section.level), np.diff(network.sample_offsets))
    return replace(made, bow=made.bow + (network.sample_darboux.kn - straight))


def _check_level(section: Section) -> None:
    """Refuse layers on lamella curves where there are levels: these are curves of the surface alone.

    Raises
    ------
    InputError
    """
    if section.level and section.layers > 1 and section.layer_curves == "lamella":
        raise InputError(
            'layer_curves = "lamella" follows the surface, and stacked lamellas run beside it',
            'write layer_curves = "cut", or "offset"',
            "section.layer_curves",
        )


def slotted(network: Network, section: Section) -> Booleans:
    """Nodes where strips have slots for each other, (n,): crossings, but not of lamellas on two levels."""
    return crossings(network) & (section.level == 0)


def crossings(network: Network) -> Booleans:
    """Nodes where strips are slotted into each other: an A meets a B, and no rays, (n,)."""
    degree_a, degree_b = network.node_degrees()
    return np.asarray((degree_a > 0) & (degree_b > 0) & (network.node_kinds != SINGULAR))
