"""Lamellas on two levels: their curves against the parallel surface, their joints, and what cannot be made."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

import lamella
from lamella import InputError, Section, compute, parse_project
from lamella.fabrication.drawing import write_drawings
from lamella.fabrication.parts import make_parts
from lamella.fabrication.read_back import read_slots
from lamella.hardware.beam_axes import edge_beam_axes
from lamella.hardware.edge_rules import EdgeBeamRules
from lamella.hardware.make_hardware import Joined, half_joint_of, make_hardware
from lamella.hardware.node_frames import NodeFrames
from lamella.hardware.rules import CableRules, JointRules
from lamella.solid.strip import layer_rows
from lamella.strip.lamellas import Lamellas
from lamella.strip.layer_map import LayerMap
from lamella.strip.levels import on_levels
from solid.overlaps import Structure

SECTION = Section(0.06, 0.006, 2, 0.04, layer_lengths="own", level=0.0325)
RULES = JointRules(block_material="C24", block_density=420.0)
FLAT = EdgeBeamRules(section=None, flat=(0.16, 0.01))

NETS = {
    "skew square": lambda: lamella.net(
        lamella.film([lamella.polyline([(0, 0, 0), (4, 0, 1.2), (4, 4, 0), (0, 4, 1.2)])]), cells=6
    ),
    "unduloid": lambda: lamella.net(lamella.Unduloid(1.0, 1.6, (-1.0, 1.0)), cells=8),
}


@cache
def strips_of(name: str, section: Section = SECTION) -> Lamellas:
    return NETS[name]().strips(section)


@cache
def built(name: str) -> Joined:
    lamellas = strips_of(name)
    axes = edge_beam_axes(lamellas, {0: FLAT, 1: FLAT}, RULES, half_joint_of(lamellas, RULES))
    parts = make_parts(lamellas.network, lamellas, density=420, trims=axes.trims)
    return make_hardware(lamellas, parts, RULES, CableRules(turnbuckle=0.1), axes)


def test_curves_on_a_level_have_the_curvatures_of_the_parallel_surface() -> None:
    # a cylinder of radius R at the distance z inwards is one of radius R - z: helices at 45 degrees become flatter
    network = lamella.net(lamella.Cylinder(2.0, (0.0, 3.0)), cells=8)
    for level in (0.1, 0.4):
        moved = on_levels(network, level)
        for family, z in (("A", -level), ("B", level)):
            some = np.repeat(network.families == family, np.diff(network.sample_offsets))
            # the normal points towards the axis
            radius = 2.0 - z
            assert np.hypot(*moved.sample_points[some, :2].T) == pytest.approx(radius, rel=1e-9)
            slope = np.arctan2(2.0, radius)  # rise over run of a helix that is 45 degrees steep on R = 2
            assert np.abs(moved.sample_tangents[some, 2]) == pytest.approx(np.sin(slope), rel=1e-9)
            kn, kg, tg = (part[some] for part in moved.sample_darboux)
            assert kn == pytest.approx(np.cos(slope) ** 2 / radius, rel=1e-9)
            assert np.abs(tg) == pytest.approx(np.sin(slope) * np.cos(slope) / radius, rel=1e-9)
            assert np.abs(kg).max() < 1e-9
            assert moved.sample_mean_curvature[some] == pytest.approx(1 / (2 * radius), rel=1e-9)
        grown = np.where(network.families == "A", 2.0 + level, 2.0 - level)
        assert moved.lengths == pytest.approx(network.lengths * np.sqrt((1 + (grown / 2) ** 2) / 2), rel=1e-9)


@pytest.mark.parametrize("surface", [lamella.Catenoid(2.5, (-2.0, 3.0)), lamella.Unduloid(1.0, 1.6, (-1.0, 1.0))])
def test_curvatures_and_lengths_of_moved_curves_by_their_points(surface) -> None:
    network = lamella.net(surface, cells=12)
    moved = on_levels(network, 0.06)
    # differences of points, normals and arc lengths inside of every lamella
    inner = np.ones(len(moved.sample_points), bool)
    inner[network.sample_offsets[:-1]] = inner[network.sample_offsets[1:] - 1] = False
    k = np.flatnonzero(inner)
    before, after = (moved.sample_points[k + side] for side in (-1, 1))
    step = np.linalg.norm(after - before, axis=1) / 2
    bend = (after - 2 * moved.sample_points[k] + before) / step[:, None] ** 2
    normal, tangent = moved.sample_normals[k], moved.sample_tangents[k]
    left = np.cross(normal, tangent)
    kn, kg, tg = (part[k] for part in moved.sample_darboux)
    scale = np.abs(tg).max()
    assert np.einsum("ij,ij->i", bend, normal) == pytest.approx(kn, abs=5e-3 * scale)
    assert np.einsum("ij,ij->i", bend, left) == pytest.approx(kg, abs=5e-3 * scale)
    twist = (moved.sample_normals[k + 1] - moved.sample_normals[k - 1]) / (2 * step)[:, None]
    assert -np.einsum("ij,ij->i", twist, left) == pytest.approx(tg, abs=5e-3 * scale)
    chords = np.linalg.norm(np.diff(moved.sample_points, axis=0), axis=1)
    arcs = np.diff(moved.sample_arclengths)
    same = np.diff(np.repeat(np.arange(len(network.ids)), np.diff(network.sample_offsets))) == 0
    assert arcs[same] == pytest.approx(chords[same], rel=2e-4)


def test_straight_strips_on_a_level_are_bent_on_edge_by_the_twist() -> None:
    # sigma = E h / 2 . z tg^2 / (1 + z^2 tg^2), at the neck of a catenoid tg = 1 / c
    lamellas = lamella.net(lamella.Catenoid(1.5, (-1.0, 1.0)), cells=12).strips(SECTION)
    z, tg = SECTION.level, 1 / 1.5
    kn = np.abs(lamellas.network.sample_darboux.kn)
    assert kn.max() == pytest.approx(z * tg**2 / (1 + (z * tg) ** 2), rel=1e-3)
    flat = lamella.net(lamella.Catenoid(1.5, (-1.0, 1.0)), cells=12).strips(
        Section(0.06, 0.006, 2, 0.04, layer_lengths="own")
    )
    strong = lamellas.material.youngs_modulus * 0.03 * kn.max()
    # there kg = 0: normal stress at the edge is that of the helix, held at the nodes, and this one
    neck = int(np.argmax(kn))
    normal = [np.sqrt(one.von_mises[neck] ** 2 - 3 * one.torsion[neck] ** 2) for one in (lamellas, flat)]
    assert normal[0] - normal[1] == pytest.approx(strong, rel=0.02)
    # cut to its own curvature a strip is free of it, on either level
    cut = lamella.net(lamella.Catenoid(1.5, (-1.0, 1.0)), cells=12).strips(
        Section(0.06, 0.006, 2, 0.04, layer_curves="cut", level=0.0325)
    )
    free = np.sqrt(cut.von_mises[neck] ** 2 - 3 * cut.torsion[neck] ** 2)
    assert free == pytest.approx(normal[1], abs=0.02 * strong)
    middle = cut.layers.bow.mean(axis=0)
    assert middle == pytest.approx(cut.network.sample_darboux.kn, abs=2e-3 * kn.max())


@pytest.mark.parametrize("name", NETS)
def test_nothing_is_slotted_and_everything_is_bolted(name: str) -> None:
    lamellas, made = strips_of(name), built(name)
    frames = NodeFrames.of(lamellas.network)
    assert all(len(part.slots) == 0 for part in made.parts.parts)
    counted = {kind: sum(item.quantity for item in made.hardware.of(kind)) for kind in ("washer", "spacer", "bolt")}
    # neighbours on the other level are in nobody's way
    assert sum(item.quantity for item in made.hardware.of("end plate")) == 2 * len(lamellas.network.ids)
    assert counted == {"washer": 2 * len(frames), "spacer": 2 * len(frames), "bolt": len(frames)}
    assert sum(item.quantity for item in made.hardware.of("cross plate")) == len(frames)
    assert {item.material for kind in ("spacer", "block") for item in made.hardware.of(kind)} == {"C24"}
    # arcs of two radii: r - z
    radii = {round(1 / part.curvature, 9) for part in made.parts.parts if part.curvature}
    mean = lamellas.network.mean_curvature
    assert radii == ({round(1 / mean - z, 9) for z in (-SECTION.level, SECTION.level)} if mean else set())
    cables = made.hardware.of("cable")
    assert [item.quantity for item in made.hardware.of("turnbuckle")] == [sum(item.quantity for item in cables)]


@pytest.mark.parametrize("name", ["unduloid"])
def test_no_two_solids_overlap(name: str) -> None:
    lamellas, made = strips_of(name), built(name)
    structure = Structure(lamellas, made.parts, made.hardware.items)
    for kind, count in (("bolt-", 2), ("end-1 ", 2), ("turnbuckle", 1)):
        some = structure.of(kind)
        middles = (structure.low[some] + structure.high[some]) / 2
        assert len(some)
        assert [pair for k in range(count) for pair in structure.overlaps(middles[k * len(some) // count])] == []


@pytest.mark.slow
def test_no_two_solids_overlap_at_any_node_and_any_end() -> None:
    lamellas, made = strips_of("skew square"), built("skew square")
    structure = Structure(lamellas, made.parts, made.hardware.items)
    some = [k for kind in ("bolt-", "end-1 ", "turnbuckle", "base") for k in structure.of(kind)]
    middles = (structure.low[some] + structure.high[some]) / 2
    assert [pair for place in middles for pair in structure.overlaps(place)] == []


@pytest.mark.parametrize("order", [3, pytest.param(4, marks=pytest.mark.slow)])
def test_hubs_on_both_levels_are_clear_of_everything(order: int) -> None:
    lamellas = lamella.net(lamella.Enneper(order, 0.8, 3.0), cells=8).strips(SECTION)
    made = make_hardware(lamellas, lamellas.parts(hub_radius=0.08), JointRules())
    structure = Structure(lamellas, made.parts, made.hardware.items)
    assert len(structure.of("hub-1-plate")) == len(structure.of("hub-2-plate")) == 2
    assert len(structure.of("hub-1-fin")) == len(structure.of("hub-2-fin")) == order
    assert len(structure.of("hub-1-post")) == 1
    hub = structure.of("hub")
    middles = (structure.low[hub] + structure.high[hub]) / 2
    assert [pair for place in middles[:: len(hub) // 4] for pair in structure.overlaps(place)] == []


def test_holes_of_both_levels_rebuilt_from_the_drawings_meet_their_screws(tmp_path: Path) -> None:
    lamellas, made = strips_of("unduloid"), built("unduloid")
    write_drawings(tmp_path, made.parts, made.parts.nest(), name="x", version="0")
    drawn = read_slots(tmp_path / "A.dxf") | read_slots(tmp_path / "B.dxf")
    holes = []
    for part in made.parts.parts:
        told = drawn[part.id]
        for row in layer_rows(part, lamellas):
            layer = LayerMap.of(lamellas, part.lamella, row)
            point, _, normal, _ = layer.frames(part.start + told.holes[:, 0] / 1e3)
            holes.append(point + told.holes[:, 1, None] / 1e3 * normal)
    screws = made.hardware.of("screw")
    heads = np.concatenate([item.places.origins for item in screws])
    axes = np.concatenate([item.places.axes[:, 2] for item in screws])
    bored = np.concatenate(holes)
    _, near = cKDTree(heads - 0.02 * axes).query(bored)
    off = bored - heads[near]
    off -= np.einsum("ij,ij->i", off, axes[near])[:, None] * axes[near]
    assert np.bincount(near).tolist() == [2] * len(heads)
    assert np.linalg.norm(off, axis=1).max() < 1e-4


PROJECT = {
    "surface": {"kind": "catenoid", "neck_radius": 1.5, "height": [-1.0, 1.0]},
    "network": {"cells": 12},
    "lamella": {"height": 0.06, "thickness": 0.006, "offset": 0.04, "layer_lengths": "own"},
    "joint": {"kind": "stacked"},
}


@pytest.mark.parametrize(
    ("tables", "where"),
    [
        ({"joint": {"kind": "stacked", "slot_width": 0.012}}, "joint.slot_width"),
        ({"joint": {"level_gap": 0.01}}, "joint.level_gap"),
        ({"joint": {"kind": "stacked", "level_gap": 0.003}}, "joint.level_gap"),
        ({"joint": {"kind": "stacked", "level_gap": 0.00401}}, "joint.level_gap"),
        ({"joint": {"kind": "stacked", "bolt": 0.012}, "lamella": PROJECT["lamella"] | {"offset": 0.02}}, "joint.bolt"),
        ({"joint": {"kind": "stacked", "washer_length": 1.0}}, "joint.washer_length"),
        ({"joint": {"kind": "stacked"}, "edge_beam": {}}, "edge_beam.section"),
        ({"joint": {"kind": "stacked"}, "edge_beam": {"flat": [0.07, 0.01]}}, "edge_beam.end_plate_height"),
        ({"joint": {"kind": "stacked"}, "cables": {"turnbuckle": 2.0}}, "cables.turnbuckle"),
        ({"joint": {"kind": "stacked", "block_material": "cheese"}}, "joint.block_material"),
        ({"lamella": PROJECT["lamella"] | {"layer_curves": "lamella"}}, "lamella.layer_curves"),
        ({"lamella": PROJECT["lamella"] | {"height": 2.9}}, "lamella.height"),
    ],
)
def test_what_cannot_be_stacked_is_refused_by_its_key(tables: dict, where: str) -> None:
    with pytest.raises(InputError) as refused:
        compute(parse_project(PROJECT | tables))
    assert refused.value.where == where
    assert refused.value.remedy


def test_a_project_with_stacked_lamellas_says_so() -> None:
    results = compute(parse_project(PROJECT))
    assert results.summary["lamellas"]["section"]["level"] == pytest.approx(0.0325)
    assert results.summary["lamellas"]["utilisation_net_section_max"] == 0
    again = parse_project(results.project.model_dump(mode="json", exclude_none=True))
    assert again.joint.kind == "stacked"
