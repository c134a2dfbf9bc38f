"""What is built in the report: its solids come back, colours are those of the nearest samples, sizes are bounded."""

from __future__ import annotations

import base64
from typing import Any

import numpy as np
import pytest

import lamella
from lamella import compute, parse_project
from lamella.files.write.drawn_layer import DrawnLayer, Repeated
from lamella.stages.report import report_data
from lamella.view import built_payload as module
from lamella.view.built_payload import built_payload
from lamella.view.report import report_html

PROJECT: dict[str, Any] = {
    "surface": {"kind": "catenoid", "neck_radius": 0.8, "height": [-0.3, 0.4]},
    "network": {"cells": 6},
}


def decoded(spec: dict[str, Any]) -> np.ndarray:
    return np.frombuffer(base64.b64decode(spec["data"]), f"<{spec['type']}")


@pytest.fixture(scope="module")
def results() -> lamella.Results:
    return compute(parse_project(PROJECT | {"joint": {"block_spacing": 0}}))


def test_strips_and_hardware_come_back(results: lamella.Results) -> None:
    network = results.network
    data = report_data(results)
    centre = np.array([0.1, 0.2, 0.3])
    payload, notes = built_payload(data.built, network, np.arange(len(network.sample_points)), centre)
    assert payload is not None
    assert notes == []
    owner = np.repeat(network.families, np.diff(network.sample_offsets))
    for strip in payload["strips"]:
        points = decoded(strip["points"]).reshape(-1, 3) + centre
        samples = decoded(strip["samples"])
        triangles = decoded(strip["triangles"])
        assert len(samples) == len(points) == triangles.max() + 1
        assert set(owner[samples]) == {strip["family"]}
        # beside the centre line by the layer's distance, over it by half a strip; ends reach beyond the rim
        off = np.linalg.norm(points - network.sample_points[samples], axis=1)
        assert np.median(off) < 0.06
        assert off.max() < 0.15
    hardware = results.outputs["fabrication"].hardware
    assert {one["id"]: len(decoded(one["matrices"])) // 16 for one in payload["hardware"]} == {
        item.id: item.quantity for item in hardware
    }
    bolt = next(one for one in payload["hardware"] if one["id"].startswith("bolt"))
    item = next(item for item in hardware if item.id == bolt["id"])
    placed = decoded(bolt["matrices"]).reshape(-1, 4, 4)[:, 3, :3] + centre
    assert placed == pytest.approx(item.places.origins, abs=1e-6)


def test_reports_are_bounded(results: lamella.Results, monkeypatch: pytest.MonkeyPatch) -> None:
    network, data = results.network, report_data(results)
    kept = np.arange(len(network.sample_points))
    every = sum(item.quantity for item in results.outputs["fabrication"].hardware)
    monkeypatch.setattr(module, "PIECE_LIMIT", every // 2)
    payload, notes = built_payload(data.built, network, kept, np.zeros(3))
    assert payload is not None
    shown = sum(len(decoded(one["matrices"])) // 16 for one in payload["hardware"])
    assert 0 < shown <= every // 2
    assert f"{every - shown:,}" in notes[0]
    monkeypatch.setattr("lamella.stages.fabrication.scene.REPORT_TRIANGLES", 10)
    assert not any(layer.bodies for layer in report_data(results).built)


def test_a_kind_with_too_many_triangles_is_left_out(results: lamella.Results, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "SHOWN_TRIANGLES", 3)
    triangle = np.array([[0, 1, 2]])
    kinds = [
        Repeated(name, np.eye(3), triangle, np.zeros((count, 3)), np.tile(np.eye(3), (count, 1, 1)), ("x",) * count)
        for name, count in (("few", 3), ("many", 4))
    ]
    layers = [DrawnLayer("kind", repeated=tuple(kinds))]
    payload, notes = built_payload(layers, results.network, np.arange(3), np.zeros(3))
    assert payload is not None
    assert [one["id"] for one in payload["hardware"]] == ["few"]
    assert len(notes) == 1


def test_without_joints_there_is_nothing() -> None:
    data = report_data(compute(parse_project(PROJECT)))
    assert data.built == ()
    assert '"built":null' in report_html(data)
