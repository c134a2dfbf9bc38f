"""What the laser gets against what was computed: slot distances in the DXF equal the arc lengths in network.json.

The drawings are read with ezdxf alone: a slot's foot is a segment as long as the slot is wide, between two sides half
the strip's height long; distances of feet along a circle are chords of radius 1/H.
"""

import ezdxf
import numpy as np
import pytest

from conftest import load
from lamella.fabrication.read_back import read_slots

# how far slots are from one another does not hang on how many there are
CELLS = 12
SURFACES = [
    {"kind": "unduloid", "neck_radius": 1.1, "bulge_radius": 2.3, "height": [-1.3, 2.2]},
    {"kind": "nodoid", "neck_radius": 3.0, "bulge_radius": 8.0, "height": [-1.1, 0.8]},
    {"kind": "catenoid", "neck_radius": 1.7, "height": [-1.5, 2.1]},
    {"kind": "helicoid", "pitch": 5.0, "inner_radius": 0.9, "outer_radius": 3.3, "turns": 0.9},
    {"kind": "enneper", "order": 3, "radius": 0.9, "scale": 4.0},
    {"kind": "scherk", "extent": 1.2, "scale": 3.0},
]


def _feet(entity, width, half_height):
    """Midpoints of the slots' feet along an outline, mm."""
    p = np.array([(x, y) for x, y in entity.get_points("xy")])
    after = np.linalg.norm(np.roll(p, -1, 0) - p, axis=1)
    before, two_after = np.roll(after, 1), np.roll(after, -1)
    foot = (np.abs(after - width) < 1e-6) & (np.abs(before - two_after) < 1e-6) & (np.abs(before - half_height) < 0.05)
    return (p + np.roll(p, -1, 0))[foot] / 2


def _crossings(network):
    """Which of each lamella's nodes are crossings with slots."""
    kinds = [node["kind"] for node in network["nodes"]]
    families = {}
    for item in network["lamellas"]:
        for node in item["nodes"]:
            families.setdefault(node, set()).add(item["family"])
    return {
        item["id"]: [len(families[n]) == 2 and kinds[n] != "singular" for n in item["nodes"]]
        for item in network["lamellas"]
    }


@pytest.mark.parametrize("surface", SURFACES, ids=lambda s: s["kind"])
@pytest.mark.parametrize("layers", [1, 2])
@pytest.mark.few(5)
def test_slot_distances_are_the_arc_lengths(run, surface, layers):
    """Distances of slots in the .dxf along the cut arcs are those of nodes in network.json, to 0.01 mm."""
    lamella = {"layers": layers, "height": 0.08, "thickness": 0.001}
    folder = run(surface=surface, network={"cells": CELLS}, lamella=lamella)
    network = load(folder, "network.json")
    curvature = network["surface"]["mean_curvature"] / 1000
    crossing = _crossings(network)
    told = {item["id"]: np.array(item["node_arclengths"])[crossing[item["id"]]] * 1000 for item in network["lamellas"]}
    compared = 0
    for family in "AB":
        drawing = ezdxf.readfile(folder / "fabrication" / f"{family}.dxf")
        assert drawing.header["$INSUNITS"] == 4
        found = {}
        for entity in drawing.modelspace().query('LWPOLYLINE[layer=="CUT"]'):
            assert entity.closed
            name = next(value for code, value in entity.get_xdata("LAMELLA") if code == 1000)
            found.setdefault(str(name).partition(".")[0], []).append((str(name), _feet(entity, 2.0, 40.0)))
        assert set(found) == {name for name in told if name[0] == family}
        for name, pieces in found.items():
            at = 0
            for _, feet in sorted(pieces, key=lambda piece: int((piece[0].partition(".")[2]) or 1)):
                if family == "A":
                    feet = feet[::-1]  # the outline runs back along its upper edge
                for layer in range(layers):
                    same = feet[layer::layers]
                    chord = np.linalg.norm(np.diff(same, axis=0), axis=1)
                    arc = 2 / curvature * np.arcsin(chord * curvature / 2) if curvature else chord
                    wanted = np.diff(told[name][at : at + len(same)])
                    np.testing.assert_allclose(arc, wanted, atol=0.01)
                    compared += len(arc)
                at += len(feet) // layers
            assert at == len(told[name])
    assert compared > 3 * CELLS


@pytest.mark.parametrize("surface", SURFACES, ids=lambda s: s["kind"])
@pytest.mark.few(2)
def test_layers_of_their_own_have_their_own_distances(run, surface):
    """Slots of every layer's part against lamellas.json; their mean over the two layers is the centre line's."""
    lamella = {"layers": 2, "height": 0.08, "thickness": 0.001, "layer_lengths": "own"}
    folder = run(surface=surface, network={"cells": CELLS}, lamella=lamella)
    told = {item["id"]: item for item in load(folder, "lamellas.json")["lamellas"]}
    crossing = _crossings(load(folder, "network.json"))
    compared = 0
    for family in "AB":
        found = read_slots(folder / "fabrication" / f"{family}.dxf")
        assert {name.partition("-")[0] for name in found} == {n for n in told if n[0] == family}
        for name, reading in found.items():
            whole, _, piece = name.partition(".")
            if piece:
                continue
            owner, _, layer = whole.partition("-")
            stations = np.array(told[owner]["layer_node_stations"][int(layer) - 1]) * 1000
            between = np.diff((reading.slots[::2] + reading.slots[1::2]) / 2)
            np.testing.assert_allclose(between, np.diff(stations[crossing[owner]]), atol=0.01)
            compared += len(between)
    assert compared > 50
    for item in told.values():
        mean = np.mean(item["layer_node_stations"], axis=0)
        # second order in d: (d tg)^2 / 2 of the length
        np.testing.assert_allclose(mean, item["node_stations"], rtol=1e-3, atol=1e-9)


def test_schedule_adds_up(run):
    import csv

    folder = run(surface=SURFACES[0], network={"cells": 18})
    with (folder / "fabrication" / "schedule.csv").open(newline="") as file:
        assert file.readline().startswith("#")
        rows = list(csv.DictReader(file))
    summary = load(folder, "summary.json")
    mass = sum(float(row["mass_kg"]) * int(row["quantity"]) for row in rows)
    assert mass == pytest.approx(summary["fabrication"]["mass"], rel=1e-3)
    # a 100 x 1.5 mm strip of 7900 kg/m3 weighs 1.185 kg/m; slots take a little off, ends add a little
    plain = 7900 * 0.1 * 0.0015 * 2 * summary["lamellas"]["total_length"]
    assert mass == pytest.approx(plain, rel=0.05)
    assert {row["family"] for row in rows} == {"A", "B"}
    assert all(float(row["radius_mm"]) == pytest.approx(3400, abs=0.01) for row in rows)
