"""Solids of the examples, as they are built, by a solid-geometry library of its own: clear of each other at nodes."""

from __future__ import annotations

import numpy as np
import pytest

from conftest import run_of_example
from lamella.hardware.shape import Prism
from lamella.network.network import REGULAR
from lamella.solid.extrusion import prism_solid
from lamella.solid.solid import Solid
from solid.overlaps import Structure, manifold

BUILT = ["19_timber_stacked", "20_steel_interlocked"]
OTHERS = [
    *("01_unduloid", "02_nodoid", "03_catenoid", "04_helicoid", "05_enneper", "06_scherk", "07_hexagonal_node"),
    *("08_two_rings", "10_saddle", "15_vault"),
]
NODES_EACH = 5

# mm: least gap between a bolt's shank and the edge of a hole, drawn as an inscribed polygon of 16 corners
LEAST_PLAY = 0.2


def structure_of(name: str) -> Structure:
    results = run_of_example(name)
    return Structure(results.lamellas, results.parts, results.outputs["fabrication"].hardware.items)


@pytest.mark.slow
@pytest.mark.parametrize("name", BUILT)
def test_no_two_solids_overlap_at_any_node(name: str) -> None:
    network, structure = run_of_example(name).network, structure_of(name)
    nodes = np.flatnonzero(network.node_kinds == REGULAR)
    assert [pair for node in nodes for pair in structure.overlaps(network.node_points[node])] == []


@pytest.mark.slow
@pytest.mark.parametrize("name", OTHERS)
def test_strips_do_not_overlap_at_random_nodes(name: str) -> None:
    network, structure = run_of_example(name).network, structure_of(name)
    nodes = np.random.default_rng(1).permutation(np.flatnonzero(network.node_kinds == REGULAR))[:NODES_EACH]
    assert len(nodes) == NODES_EACH
    assert [pair for node in nodes for pair in structure.overlaps(network.node_points[node])] == []


@pytest.mark.slow
@pytest.mark.parametrize("name", BUILT)
def test_bolts_pass_their_holes_with_play(name: str) -> None:
    results, structure = run_of_example(name), structure_of(name)
    told = []
    for item in results.outputs["fabrication"].hardware:
        if item.kind not in ("bolt", "screw"):
            continue
        _, shank = item.shape
        assert isinstance(shank, Prism)
        # what is under the head and before the nut
        inside = prism_solid(Prism(shank.outline, shank.low + 0.02, shank.high - 0.0005))
        worlds = item.places.world(inside.vertices)
        for k in range(0, item.quantity, max(item.quantity // 6, 1)):
            own = manifold(Solid(worlds[k], inside.triangles))
            low, high = worlds[k].min(axis=0), worlds[k].max(axis=0)
            near = np.flatnonzero(((structure.low < high + 0.002) & (structure.high > low - 0.002)).all(axis=1))
            for n in near.tolist():
                other = structure.names[n].split()[0]
                # nuts are on its thread
                if other != item.id and "nut" not in other:
                    told.append((1e3 * own.min_gap(structure.solid(n), 0.002), item.id, structure.names[n]))
    assert len(told) > 50
    least = min(told)
    assert least[0] > LEAST_PLAY, least
