"""The lamellas of a network: stresses, planarity and developed node marks of every strip."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from lamella.errors import InputError, require_positive
from lamella.network.network import Network
from lamella.strip.material import Material
from lamella.strip.planarity import planarity_score
from lamella.strip.stress import shortening, stresses
from lamella.wording import rounded

Floats = NDArray[np.float64]
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
    """

    height: float = 0.1
    thickness: float = 0.0015
    layers: int = 2
    offset: float = 0.025
    marks: Marks = "arc-length"
    layer_lengths: LayerLengths = "alike"

    @property
    def layer_offsets(self) -> Floats:
        """Sideways distances d of the layers from the centre line, m, towards u = n x t, (layers,)."""
        return np.asarray((np.arange(self.layers) - 0.5 * (self.layers - 1)) * self.offset)

    def __post_init__(self) -> None:
        """Raise an `InputError` for a section that is none."""
        require_positive(height=self.height, thickness=self.thickness, layers=self.layers, offset=self.offset)
        if self.thickness >= self.height:
            raise InputError(
                f"thickness = {self.thickness:g} m is not below height = {self.height:g} m",
                "the strip stands on edge: its height is the larger measure",
                "lamella.thickness",
            )
        for key, value, known in (
            ("marks", self.marks, get_args(Marks)),
            ("layer_lengths", self.layer_lengths, get_args(LayerLengths)),
        ):
            if value not in known:
                raise InputError(f"{key} = {value!r}", f"choose one of {', '.join(known)}", f"lamella.{key}")


@dataclass(frozen=True)
class Lamellas:
    """Flat strips that stand normal to the surface along the centre lines of a network.

    Arrays of shape (k,) run over the network's samples, (q,) over its stops, (m,) over its lamellas. The
    curvatures are the network's (`Network.sample_darboux`).

    Attributes
    ----------
    section : Section
    bending, torsion : (k,)
        Weak-axis bending stress E t |kg| / 2 and St-Venant shear G t |tg|, Pa.
    helix_edge, helix_centre : (k,)
        Helix normal stress at the strip's edge (tension) and centre line (compression), Pa.
    restraint : (k,)
        Tension from node marks at the unshortened length, Pa; zero where marks are relaxed.
    von_mises : (k,)
        Largest equivalent stress of the section, Pa.
    utilisation : (k,)
        Share of the material's strength.
    planarity : (k,)
        Planarity score of the strip quad between a sample and the next; zero at each lamella's end.
    stop_stations : (q,)
        Place of the node on the developed centre line, m from the lamella's start.
    layer_stations : (layers, q)
        The same for each layer; equal to `stop_stations` where layers are cut alike.
    developed_lengths : (m,)
        Length of the developed centre line from first to last node, m.
    """

    section: Section
    bending: Floats
    torsion: Floats
    helix_edge: Floats
    helix_centre: Floats
    restraint: Floats
    von_mises: Floats
    utilisation: Floats
    planarity: Floats
    stop_stations: Floats
    layer_stations: Floats
    developed_lengths: Floats


def twisted_strip(network: Network, height: float) -> tuple[Floats, Floats]:
    """Lower and upper edge of the strips along the surface normals, c -+ h/2 n, m, each (k, 3)."""
    reach = height / 2 * network.sample_normals
    return network.sample_points - reach, network.sample_points + reach


def _along(network: Network, strain: Floats) -> Floats:
    """Integral of a strain given at the samples from each lamella's start to its nodes, m, (q,).

    Trapezia, whose samples are near-equal arcs a small part of a cell long.
    """
    growth = np.append(0.0, (strain[1:] + strain[:-1]) / 2 * np.diff(network.sample_arclengths))
    growth[network.sample_offsets[:-1]] = 0.0
    total = np.cumsum(growth)
    start = network.sample_offsets[network.stop_owner]
    return np.asarray(total[start + network.stop_samples] - total[start])


def layer_drift(network: Network) -> Floats:
    """Turn of each lamella's tangent to the side, max - min of the integral of kg ds over its nodes, (m,).

    Times the distance of two layers this is what their node marks would have to shift along each other, from one end
    of the lamella to the other, where both are cut alike.
    """
    turn = _along(network, network.sample_darboux.kg)
    starts = network.stop_offsets[:-1]
    return np.asarray(np.maximum.reduceat(turn, starts) - np.minimum.reduceat(turn, starts))


def make_lamellas(network: Network, section: Section, material: Material) -> Lamellas:
    """Strips of a section along every lamella of a network.

    Raises
    ------
    InputError
        The strip is so high that its circular development would reach its own centre; the net is one of curves that
        no strips are made for.
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
            f"write lamella.height = {rounded(0.99 * limit / 2, up=False):g} or less, or check that the surface is in "
            "metres",
            "lamella.height",
        )
    kn, kg, tg = network.sample_darboux
    held = section.marks == "arc-length"
    s = stresses(material, section.height, section.thickness, kn - curvature, kg, tg, held)

    low, high = twisted_strip(network, section.height)
    planarity = np.zeros(len(kn))
    planarity[:-1] = planarity_score(low[:-1], low[1:], high[1:], high[:-1])
    ends = network.sample_offsets[1:] - 1
    planarity[ends] = 0.0

    stations = network.stop_arclengths
    if not held:
        stations = stations + _along(network, shortening(section.height, tg))
    layers = np.tile(stations, (section.layers, 1))
    if section.layer_lengths == "own":
        d = section.layer_offsets[:, None]
        stretch = np.sqrt((1 - d * kg) ** 2 + (d * tg) ** 2) - 1
        layers = layers + np.stack([_along(network, strain) for strain in stretch])
    return Lamellas(
        section,
        s.bending,
        s.torsion,
        s.helix_edge,
        s.helix_centre,
        s.restraint,
        s.von_mises,
        s.utilisation,
        planarity,
        stations,
        layers,
        stations[network.stop_offsets[1:] - 1],
    )
