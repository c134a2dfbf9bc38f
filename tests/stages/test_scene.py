"""What the view shows of a run: each stage gives its own, true to its arrays."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import lamella
from lamella import compute, parse_project
from lamella.network.network import SEAM
from lamella.stages import all_stages
from lamella.stages.fabrication import view_layers
from lamella.stages.network import scene as network_scene
from lamella.stages.network.marks import network_marks
from lamella.stages.scene import scene_of
from lamella.view.scene.layer import InstancesLayer, LinesLayer, MeshLayer, StripsLayer
from lamella.view.scene.scene import Scene

PROJECT: dict[str, Any] = {
    "surface": {"kind": "catenoid", "neck_radius": 0.8, "height": [-0.3, 0.4]},
    "network": {"cells": 6},
}


@pytest.fixture(scope="module")
def results() -> lamella.Results:
    return compute(parse_project(PROJECT | {"joint": {"block_spacing": 0}}))


@pytest.fixture(scope="module")
def scene(results: lamella.Results) -> Scene:
    return scene_of(results)


def test_strips_are_those_of_the_net_at_their_measures(results: lamella.Results, scene: Scene) -> None:
    network, lamellas = results.lamellas.network, results.lamellas
    for family in "AB":
        strips = scene.layer(f"strips {family}")
        assert isinstance(strips, StripsLayer)
        own = np.repeat(network.families == family, np.diff(network.sample_offsets))
        np.testing.assert_array_equal(strips.positions, network.sample_points[own])
        assert strips.ids == tuple(np.array(network.ids)[network.families == family])
        assert (strips.height, strips.thickness) == (lamellas.section.height, lamellas.section.thickness)
        assert strips.sides.tolist() == lamellas.section.layer_offsets.tolist()
        use = next(one for one in strips.quantities if one.key == "utilisation")
        np.testing.assert_array_equal(use.values, lamellas.utilisation[own])


def test_solids_lie_about_the_samples_whose_colours_they_take(scene: Scene) -> None:
    for family in "AB":
        solids, strips = scene.layer(f"solids {family}"), scene.layer(f"strips {family}")
        assert isinstance(solids, MeshLayer)
        assert solids.like == strips.name
        off = np.linalg.norm(solids.positions - strips.points[solids.samples], axis=1)
        assert np.median(off) < 0.06
        assert off.max() < 0.15


def test_every_piece_of_hardware_is_in_its_place(results: lamella.Results, scene: Scene) -> None:
    shown: dict[str, int] = {}
    for layer in scene.layers:
        if isinstance(layer, InstancesLayer) or layer.name.endswith(" single"):
            for text in layer.ids:
                shown[text.split(",")[0]] = shown.get(text.split(",")[0], 0) + 1
    hardware = results.outputs["fabrication"].hardware
    assert shown == {item.id: item.quantity for item in hardware}
    bolt = next(item for item in hardware if item.id.startswith("bolt"))
    placed = scene.layer(f"bolt {bolt.id}")
    np.testing.assert_array_equal(placed.points, bolt.places.origins)


def test_hardware_is_bounded(results: lamella.Results, monkeypatch: pytest.MonkeyPatch) -> None:
    every = sum(item.quantity for item in results.outputs["fabrication"].hardware)
    monkeypatch.setattr(view_layers, "PIECE_LIMIT", every // 2)
    scene = scene_of(results)
    shown = sum(len(layer.ids) for layer in scene.layers if layer.material == "steel" and "A" not in layer.groups)
    assert any(f"{every - shown:,}" in remark for remark in scene.remarks) or shown < every
    assert scene.remarks
    monkeypatch.setattr("lamella.stages.fabrication.scene.REPORT_TRIANGLES", 10)
    assert not any(layer.name.startswith("solids") for layer in scene_of(results).layers)


def test_kinds_that_take_least_for_a_piece_come_first(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(view_layers, "SHOWN_TRIANGLES", 3)
    assert view_layers.bounded([(3, 1), (4, 1)]) == [0]


def test_beams_come_before_small_hardware_and_a_picture_has_room_of_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(view_layers, "STORED_TRIANGLES", 10)
    assert view_layers.bounded([(3, 1), (1, 10)], frozenset({1})) == [1]
    assert view_layers.bounded([(3, 1), (1, 10)], frozenset({1}), still=True) == [0, 1]


def test_names_of_quantities_are_those_that_stages_declare(scene: Scene) -> None:
    declared = {key for stage in all_stages.STAGES for key in stage.quantities}
    shown = {one.key for layer in scene.layers for one in layer.quantities}
    assert {"utilisation", "twist", "K"} <= shown <= declared


def test_without_joints_strips_have_their_thickness_still() -> None:
    scene = scene_of(compute(parse_project(PROJECT)))
    assert not any(isinstance(layer, InstancesLayer) for layer in scene.layers)
    assert isinstance(scene.layer("strips A"), StripsLayer)
    assert scene.layer("strips A").replaces == ("lines A",)


@pytest.mark.parametrize("until", ["surface", "network"])
def test_what_is_there_after_every_stage(until: str) -> None:
    scene = scene_of(compute(parse_project(PROJECT), until=until))
    lines = [layer for layer in scene.layers if isinstance(layer, LinesLayer)]
    assert [layer.name for layer in lines] == {"surface": ["rim"], "network": ["lines A", "lines B"]}[until]
    surface = scene.layer("surface")
    assert (surface.opacity == 1) == (until == "surface")
    assert [len(curves.plots) for curves in scene.curves] == {"surface": [], "network": [1]}[until]


def test_curves_hold_what_was_computed(results: lamella.Results, scene: Scene) -> None:
    (curves,) = scene.curves
    network = results.network
    assert curves.ids == network.ids
    np.testing.assert_array_equal(curves.stop_nodes, network.stop_nodes)
    np.testing.assert_array_equal(curves.stop_samples, network.stop_samples)
    series = {one.key: one.values for plot in curves.plots for one in plot.series}
    np.testing.assert_array_equal(series["geodesicTorsion"], network.sample_darboux.tg)
    np.testing.assert_allclose(series["von_mises"] * 1e6, results.lamellas.von_mises)
    assert [fact.label for fact in curves.facts] == [
        "Family", "Length", "Nodes", "Developed length", "Largest utilisation",
    ]  # fmt: skip


def test_big_nets_are_thinned_but_keep_their_nodes(results: lamella.Results, monkeypatch: pytest.MonkeyPatch) -> None:
    net = results.network
    limit = len(net.stop_nodes) + 300
    monkeypatch.setattr(network_scene, "SAMPLE_LIMIT", limit)
    scene = scene_of(results)
    (curves,) = scene.curves
    count = int(curves.offsets[-1])
    assert len(net.stop_nodes) <= count <= limit + len(net.ids)
    assert any(f"{count:,} of {len(net.sample_points):,}" in remark for remark in scene.remarks)
    lines = [scene.layer(f"lines {family}") for family in "AB"]
    points = np.concatenate([layer.points for layer in lines])
    starts = np.repeat(curves.offsets[:-1], np.diff(curves.stop_offsets))
    np.testing.assert_allclose(points[starts + curves.stop_samples], net.node_points[curves.stop_nodes], atol=1e-9)
    # the worst strip quad is still seen
    worst = max(q.values.max() for f in "AB" for q in scene.layer(f"strips {f}").quantities if q.key == "planarity")
    assert worst == results.lamellas.planarity.max()


def test_nodes_of_very_big_nets_are_thinned(monkeypatch: pytest.MonkeyPatch) -> None:
    """One node in so many of each lamella and its ends; their numbers stay those of network.json, and counts true."""
    tall = {"kind": "catenoid", "neck_radius": 0.8, "height": [-1.0, 1.2]}
    results = compute(parse_project(PROJECT | {"surface": tall}), until="lamellas")
    net = results.network
    monkeypatch.setattr(network_scene, "STOP_LIMIT", len(net.stop_nodes) // 3)
    monkeypatch.setattr(network_scene, "SAMPLE_LIMIT", len(net.stop_nodes))
    scene = scene_of(results)
    (curves,) = scene.curves
    assert len(net.stop_nodes) / 3 <= len(curves.stop_nodes) <= len(net.stop_nodes) / 3 + 2 * len(net.ids)
    nodes = next(fact for fact in curves.facts if fact.label == "Nodes")
    np.testing.assert_array_equal(nodes.values, np.diff(net.stop_offsets))
    regular = int(np.count_nonzero(net.node_kinds == 0))
    assert scene.layer("nodes regular").label == f"regular ({regular})"
    for k, (first, end) in enumerate(zip(curves.stop_offsets[:-1], curves.stop_offsets[1:], strict=True)):
        own = net.stop_nodes[net.stop_offsets[k] : net.stop_offsets[k + 1]]
        assert (curves.stop_nodes[first], curves.stop_nodes[end - 1]) == (own[0], own[-1])


def test_warnings_about_strips_lead_to_the_worst_place_of_each_lamella() -> None:
    """Of strips twenty times as thick as they may be; the lamella that the warning names comes first."""
    project = PROJECT | {"lamella": {"thickness": 0.01, "layers": 1}}
    results = compute(parse_project(project), until="lamellas")
    lamellas, network = results.lamellas, results.network
    mark = next(one for one in scene_of(results).marks if one.key == "overstressed")
    warning = next(one for one in results.summary["warnings"] if one.key == "overstressed")
    assert f"in lamella {mark.ids[0]} at" in warning
    np.testing.assert_array_equal(mark.positions[0], network.sample_points[np.argmax(lamellas.utilisation)])
    over = np.maximum.reduceat(lamellas.utilisation, network.sample_offsets[:-1]) > 1
    assert set(mark.ids) == {one for one, far in zip(network.ids, over, strict=True) if far}


def test_warnings_about_nets_lead_to_their_nodes(results: lamella.Results) -> None:
    network = results.network
    kinds = network.node_kinds.copy()
    kinds[3:5] = SEAM
    other = replace(network, node_kinds=kinds, faces_left_out=np.array([2]))
    found = {mark.key: mark.positions for mark in network_marks(other, 0.1)}
    np.testing.assert_array_equal(found["net_open"], network.node_points[3:5])
    np.testing.assert_array_equal(found["faces_left_out"], network.node_points[2:3])
    assert set(found) <= {"net_open", "faces_left_out", "cells_large", "cells_small"}


def test_supports_are_at_their_nodes() -> None:
    project = PROJECT | {
        "support": [{"boundary": "lower", "fixed": ["x", "y", "z", "rx", "ry", "rz"]}],
        "structure": {},
    }
    results = compute(parse_project(project))
    supports = results.outputs["structure"].analysis.model.supports.supported
    layer = scene_of(results).layer("supports")
    np.testing.assert_array_equal(layer.points, results.network.node_points[supports])
