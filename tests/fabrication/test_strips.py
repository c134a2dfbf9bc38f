"""Networks and lamellas made by hand: stations are given, nothing is traced on a surface."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, fields

import numpy as np
import pytest

from lamella.base.material import find_material
from lamella.network.network import BOUNDARY, REGULAR, SINGULAR, Network
from lamella.network.pattern import LAMELLAS
from lamella.strip.lamellas import Lamellas, Section
from lamella.strip.layers import Layers
from lamella.surface.darboux import Darboux

KINDS = {"o": REGULAR, "|": BOUNDARY, "+": BOUNDARY, "*": SINGULAR}


@dataclass(frozen=True)
class Strip:
    """A lamella: family, stations (m) and a letter a node.

    "o" crossing, "|" rim end, "+" crossing on the rim, "*" singular.
    """

    family: str
    stations: tuple[float, ...]
    nodes: str
    closed: bool = False


def build(strips, curvature=0.0, *, layers=2, height=0.1, thickness=0.0015, offset=0.025, relax=1.0):
    """Network and lamellas of strips that share no nodes; each crossing gets a partner in the other family.

    ``relax`` is the ratio of stations on the strip to arc lengths in space.
    """
    kinds, stop_nodes, stop_samples, arcs, offsets = [], [], [], [], [0]
    ids, families, closed, sample_arcs, sample_offsets = [], [], [], [], [0]
    count = {"A": 0, "B": 0}
    for strip in strips:
        count[strip.family] += 1
        ids.append(f"{strip.family}{count[strip.family]}")
        families.append(strip.family)
        closed.append(strip.closed)
        own = list(range(len(kinds), len(kinds) + len(strip.nodes)))
        kinds += [KINDS[letter] for letter in strip.nodes]
        if strip.closed:
            own.append(own[0])
        stations = np.asarray(strip.stations, float) / relax
        stop_nodes += own
        arcs.append(stations)
        offsets.append(offsets[-1] + len(own))
        grid = np.concatenate([np.linspace(a, b, 9)[:-1] for a, b in itertools.pairwise(stations)] + [stations[-1:]])
        stop_samples += list(range(0, len(grid), 8))
        sample_arcs.append(grid)
        sample_offsets.append(sample_offsets[-1] + len(grid))
    stops = np.array(stop_nodes)
    owners = np.repeat(families, np.diff(offsets))
    crossing = np.array([letter in "o+*" for strip in strips for letter in strip.nodes], int)
    degree_a, degree_b = (
        np.maximum(np.bincount(stops[owners == family], minlength=len(kinds)), crossing) for family in "AB"
    )

    @dataclass(frozen=True)
    class Known(Network):
        def node_degrees(self):
            return degree_a, degree_b

    samples = sample_offsets[-1]
    # any distinct numbers do for curvatures and stresses: they are only looked up
    ramp = np.arange(1.0, samples + 1)
    # in space the strips are straight and a kilometre apart
    row = 1000.0 * np.repeat(np.arange(len(ids)), np.diff(sample_offsets))
    known = {
        "sample_points": np.column_stack((np.concatenate(sample_arcs), row, np.zeros(samples))),
        "sample_tangents": np.tile([1.0, 0.0, 0.0], (samples, 1)),
        "mean_curvature": curvature,
        "node_kinds": np.array(kinds),
        "ids": tuple(ids),
        "families": np.array(families),
        "closed": np.array(closed),
        "sample_offsets": np.array(sample_offsets),
        "sample_darboux": Darboux(np.full(samples, curvature), -ramp, ramp[::-1].copy()),
        "sample_arclengths": np.concatenate(sample_arcs),
        "stop_offsets": np.array(offsets),
        "stop_nodes": stops,
        "stop_samples": np.array(stop_samples),
        "stop_arclengths": np.concatenate(arcs),
    }
    # what else a network tells of its making no part asks for
    network = Known(**{field.name: known.get(field.name) for field in fields(Network)} | {"pattern": LAMELLAS})
    lamellas = Lamellas(
        network=network,
        material=find_material("1.4301"),
        section=Section(height, thickness, layers, offset),
        bending=1e6 * ramp,
        torsion=2e6 * ramp,
        helix_edge=3e6 * ramp,
        helix_centre=-1.5e6 * ramp,
        restraint=4e6 * ramp,
        von_mises=5e6 * ramp,
        utilisation=0.01 * ramp,
        planarity=np.zeros(samples),
        stop_stations=np.concatenate(arcs) * relax,
        layer=6e6 * ramp,
        net_utilisation=np.zeros(len(stops)),
        layers=Layers(
            np.zeros((layers, samples)),
            np.tile(np.concatenate(sample_arcs) * relax, (layers, 1)),
            np.tile(np.concatenate(arcs) * relax, (layers, 1)),
            np.zeros((layers, samples)),
            None,
            *np.zeros((2, layers, samples, 3)),
            np.ones(samples, bool),
        ),
        developed_lengths=np.array([arc[-1] * relax for arc in arcs]),
    )
    return network, lamellas


def sampled(outline, step=1e-3):
    """Points of a closed outline with bulges, arcs by the textbook's bulge formula, about ``step`` apart."""
    pieces = []
    for (x0, y0, bulge), (x1, y1, _) in zip(outline, np.roll(outline, -1, axis=0), strict=True):
        chord = np.hypot(x1 - x0, y1 - y0)
        count = int(np.ceil(chord * (1 + bulge**2) / step)) + 1
        t = np.linspace(0, 1, count, endpoint=False)
        if bulge == 0.0:
            pieces.append(np.column_stack((x0 + t * (x1 - x0), y0 + t * (y1 - y0))))
            continue
        reach = (1 - bulge**2) / (4 * bulge)
        cx, cy = (x0 + x1) / 2 - reach * (y1 - y0), (y0 + y1) / 2 + reach * (x1 - x0)
        angle = np.arctan2(y0 - cy, x0 - cx) + 4 * np.arctan(bulge) * t
        radius = np.hypot(x0 - cx, y0 - cy)
        pieces.append(np.column_stack((cx + radius * np.cos(angle), cy + radius * np.sin(angle))))
    return np.concatenate(pieces)


def random_strips(seed, count=4, cells=5, low=0.12, high=0.3):
    """Strips of both families with irregular cells, some crossing on the rim, some ending at a hub."""
    rng = np.random.default_rng(seed)
    ends = ["||", "+|", "|*", "++"]
    strips = []
    for family in "AB":
        for index in range(count):
            stations = np.concatenate(([0.0], np.cumsum(rng.uniform(low, high, cells))))
            first, last = ends[index % 4]
            strips.append(Strip(family, tuple(stations), first + "o" * (cells - 1) + last))
    return strips


@pytest.mark.parametrize("curvature", [0.0, 0.7])
def test_synthetic_networks_are_consistent(curvature):
    network, lamellas = build(random_strips(3), curvature)
    assert len(network.stop_nodes) == network.stop_offsets[-1] == len(lamellas.stop_stations)
    first = network.sample_offsets[:-1].repeat(np.diff(network.stop_offsets))
    np.testing.assert_array_equal(network.sample_arclengths[first + network.stop_samples], network.stop_arclengths)
