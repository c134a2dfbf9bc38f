"""`lamella.strips = "developable"`: figures, warnings and the file of developable strips."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rhino3dm

import lamella
from lamella import compute, parse_project, write
from lamella.stages.lamellas.stage import LamellasStage

CATENOID: dict[str, Any] = {
    "surface": {"kind": "catenoid", "neck_radius": 1.2, "height": [-1.0, 1.5]},
    "network": {"cells": 8},
}
ASKED = {"lamella": {"strips": "developable", "layers": 1}}


def test_places_without_a_strip_are_named(tmp_path: Path) -> None:
    results = compute(parse_project(CATENOID | ASKED))
    figures = results.summary["lamellas"]
    score = figures["planarity_score"]
    assert score["developable"]["max"] < 5e-4 < score["twisted"]["max"]
    told = figures["developable"]
    assert told["height_min"] == 0.0
    assert told["recommended"] == "twisted"
    # borders that move make all quads planar; where no developable strip is the rulings jump
    moved = told["optimised"]
    assert moved["lamellas"] == len(results.network.ids)
    assert moved["fault"] is None
    assert moved["planarity_max"] < 5e-4 < moved["planarity_before_max"]
    assert 0.01 < moved["shift_max"] < 0.2
    assert moved["turn_max_deg"] > 10
    layers = list(LamellasStage().model(results.outputs["lamellas"], results.upstream))
    (borders,) = (layer for layer in layers if layer.name == "strips made planar")
    assert len(borders.curves) == 2 * len(results.network.ids)
    # the upper border lies on the parallel surface at the strips' height
    feet = lamella.foot_surface(results.surface)
    for curve, off in zip(borders.curves[:4], (0.0, 0.1) * 2, strict=True):
        foot = feet.foot(curve)
        assert np.einsum("ij,ij->i", curve - foot.position, foot.normal) == pytest.approx(off, abs=1e-5)
    assert [place["lamella"] for place in told["places"]] == list(results.network.ids)
    assert all(abs(place["point"][2]) < 0.1 for place in told["places"])
    keys = [message.key for message in results.summary["warnings"]]
    assert keys.count("not_developable") == keys.count("strips_recommended") == 1
    write(results, tmp_path / "run")
    with (tmp_path / "run" / "developable.csv").open(encoding="utf-8", newline="") as file:
        file.readline()
        rows = list(csv.DictReader(file))
    assert len(rows) == len(results.network.sample_points)
    for row in rows:
        if row["slope"]:
            low, high = (np.array([float(row[f"{end}_{axis}_m"]) for axis in "xyz"]) for end in ("low", "high"))
            ruling = np.linalg.norm(high - low)
            assert ruling == pytest.approx(0.1 * np.hypot(1, float(row["slope"])), rel=1e-6)
            flat = np.hypot(
                float(row["flat_high_x_mm"]) - float(row["flat_low_x_mm"]),
                float(row["flat_high_y_mm"]) - float(row["flat_low_y_mm"]),
            )
            assert flat == pytest.approx(1e3 * ruling, rel=1e-6)
        else:
            assert float(row["buildable_height_m"]) <= 0.1


def test_developable_strips_are_recommended_where_they_are_stressed_less() -> None:
    # helices of a helicoid have kg and tg that do not change; as twisted strips high ones have a large helix stress
    surface = {"kind": "helicoid", "pitch": 4.0, "inner_radius": 1.0, "outer_radius": 3.0, "turns": 1.0}
    results = compute(parse_project({"surface": surface, "network": {"cells": 6}} | ASKED))
    told = results.summary["lamellas"]["developable"]
    # rulings are lamellas too: kg = 0 there, so that half of the net has none
    assert 0.3 < told["share"] < 0.7
    assert told["recommended"] == "twisted"
    assert told["lamellas"] >= 0
    assert told["stress_bending_max"] > 0


def test_nothing_unless_asked_for(tmp_path: Path) -> None:
    results = compute(parse_project(CATENOID))
    assert results.summary["lamellas"]["planarity_score"]["developable"] is None
    assert "developable" not in results.summary["lamellas"]
    assert "strips" not in results.project.to_toml()


def test_developable_strips_are_in_the_model_and_in_the_view(tmp_path: Path) -> None:
    """Where they exist: a solid of every piece, and its bending stress; nothing of it without the key."""
    results = compute(parse_project(CATENOID | ASKED), until="lamellas")
    write(results, tmp_path / "run")
    model = rhino3dm.File3dm.Read(str(tmp_path / "run" / "model.3dm"))
    layers = {layer.Index: layer.Name for layer in model.Layers}
    drawn = [one for one in model.Objects if layers[one.Attributes.LayerIndex].startswith("developable")]
    # the waist cuts every lamella in two
    assert len(drawn) == 2 * len(results.network.ids)
    shown = list(LamellasStage().scene(results.outputs["lamellas"], results.upstream))
    stress = results.outputs["lamellas"].developable.bending
    for family in "AB":
        (layer,) = (one for one in shown if getattr(one, "name", "") == f"developable {family}")
        (quantity,) = layer.quantities
        assert quantity.most == pytest.approx(stress[np.isfinite(stress)].max() * 1e-6, rel=0.2)
        assert len(layer.positions) == len(quantity.values)
    upper = CATENOID | {"surface": CATENOID["surface"] | {"height": [1.0, 2.0]}}
    whole = compute(parse_project(upper | {"lamella": ASKED["lamella"] | {"height": 0.04}}), until="lamellas")
    assert whole.summary["lamellas"]["developable"]["optimised"] is None
    plain = compute(parse_project(CATENOID), until="lamellas")
    assert not list(LamellasStage().model(plain.outputs["lamellas"], plain.upstream))
