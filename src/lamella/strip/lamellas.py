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

Floats = NDArray[np.float64]
Marks = Literal["arc-length", "relaxed"]


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
    """

    height: float = 0.1
    thickness: float = 0.0015
    layers: int = 2
    offset: float = 0.025
    marks: Marks = "arc-length"

    def __post_init__(self) -> None:
        """Raise an `InputError` for a section that is none."""
        require_positive(height=self.height, thickness=self.thickness, layers=self.layers, offset=self.offset)
        if self.thickness >= self.height:
            raise InputError(
                f"thickness = {self.thickness:g} m is not below height = {self.height:g} m",
                "the strip stands on edge: its height is the larger measure",
                "lamella.thickness",
            )
        if self.marks not in get_args(Marks):
            raise InputError(f"marks = {self.marks!r}", f"choose one of {', '.join(get_args(Marks))}", "lamella.marks")


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
    developed_lengths: Floats


def twisted_strip(network: Network, height: float) -> tuple[Floats, Floats]:
    """Lower and upper edge of the strips along the surface normals, c -+ h/2 n, m, each (k, 3)."""
    reach = height / 2 * network.sample_normals
    return network.sample_points - reach, network.sample_points + reach


def make_lamellas(network: Network, section: Section, material: Material) -> Lamellas:
    """Strips of a section along every lamella of a network.

    Raises
    ------
    InputError
        The strip is so high that its circular development would reach its own centre.
    """
    limit = 2 / abs(network.mean_curvature) if network.mean_curvature else np.inf
    if section.height >= limit:
        raise InputError(
            f"height = {section.height:g} m: strips of radius 1/|H| = {limit / 2:.4g} m cannot be "
            f"{limit:.4g} m high or more, their inner edge would reach the centre",
            "lower lamella.height, or check that the surface is in metres",
            "lamella.height",
        )
    kn, kg, tg = network.sample_darboux
    held = section.marks == "arc-length"
    s = stresses(material, section.height, section.thickness, kn - network.mean_curvature, kg, tg, held)

    low, high = twisted_strip(network, section.height)
    planarity = np.zeros(len(kn))
    planarity[:-1] = planarity_score(low[:-1], low[1:], high[1:], high[:-1])
    ends = network.sample_offsets[1:] - 1
    planarity[ends] = 0.0

    stations = network.stop_arclengths
    if not held:
        # trapezia of the strain, whose samples are near-equal arcs a small part of a cell long
        strain = shortening(section.height, tg)
        step = np.diff(network.sample_arclengths, prepend=0.0)
        growth = np.append(0.0, (strain[1:] + strain[:-1]) / 2) * step
        growth[network.sample_offsets[:-1]] = 0.0
        total = np.cumsum(growth)
        owner = np.repeat(np.arange(len(network.ids)), np.diff(network.stop_offsets))
        start = network.sample_offsets[owner]
        stations = stations + total[start + network.stop_samples] - total[start]
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
        stations[network.stop_offsets[1:] - 1],
    )
