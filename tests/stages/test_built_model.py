"""What is built in model.3dm and model.glb: every part of the lists once, as a closed solid of its own mass."""

from __future__ import annotations

import json
import struct
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rhino3dm
import trimesh

import lamella
from lamella import compute, parse_project, write
from lamella.solid.bodies import body_step, strip_bodies, triangle_count
from stages.csv_rows import rows

PROJECT: dict[str, Any] = {
    "name": "waist",
    "surface": {"kind": "catenoid", "neck_radius": 0.8, "height": [-0.3, 0.4]},
    "network": {"cells": 6},
    "joint": {"block_spacing": 0.3},
}


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> tuple[lamella.Results, Path]:
    results = compute(parse_project(PROJECT))
    folder = tmp_path_factory.mktemp("built") / "run"
    write(results, folder)
    return results, folder


def listed(folder: Path) -> Counter[str]:
    """Pieces of the part list and of the hardware list by their ids."""
    strips = {row["id"]: int(row["quantity"]) for row in rows(folder / "fabrication" / "schedule.csv")}
    hardware = {row["id"]: int(row["quantity"]) for row in rows(folder / "fabrication" / "hardware.csv")}
    assert not strips.keys() & hardware.keys()
    return Counter(strips | hardware)


def content(path: Path) -> dict[str, Any]:
    """The JSON chunk of a binary glTF file."""
    data = path.read_bytes()
    magic, version, length = struct.unpack_from("<4sII", data)
    assert (magic, version, length) == (b"glTF", 2, len(data))
    size, kind = struct.unpack_from("<II", data, 12)
    assert kind == 0x4E4F534A
    found: dict[str, Any] = json.loads(data[20 : 20 + size])
    return found


def test_the_rhino_model_holds_every_piece_of_the_lists_once(written: tuple[lamella.Results, Path]) -> None:
    _, folder = written
    model = rhino3dm.File3dm.Read(str(folder / "model.3dm"))
    solids = {layer.Index for layer in model.Layers if layer.Name.startswith("solids")}
    drawn: Counter[str] = Counter()
    names = []
    for one in model.Objects:
        kind = one.Geometry.ObjectType
        if kind == rhino3dm.ObjectType.InstanceReference or one.Attributes.LayerIndex in solids:
            drawn[one.Attributes.GetUserString("id")] += 1
            names.append(one.Attributes.Name)
    assert drawn == listed(folder)
    assert len(set(names)) == len(names)


def test_the_gltf_model_holds_every_piece_of_the_lists_once(written: tuple[lamella.Results, Path]) -> None:
    _, folder = written
    file = content(folder / "model.glb")
    drawn = Counter(
        (node.get("extras") or file["meshes"][node["mesh"]]["extras"])["id"] for node in file["nodes"] if "mesh" in node
    )
    assert drawn == listed(folder)
    # a kind of hardware is stored once
    kinds = {row["id"] for row in rows(folder / "fabrication" / "hardware.csv")}
    strips = sum(int(row["quantity"]) for row in rows(folder / "fabrication" / "schedule.csv"))
    assert len(file["meshes"]) == len(kinds) + strips


def test_solids_of_the_gltf_model_are_closed_and_of_the_listed_mass(written: tuple[lamella.Results, Path]) -> None:
    results, folder = written
    scene = trimesh.load(folder / "model.glb")
    listed_mass = {row["id"]: float(row["mass_kg"]) for row in rows(folder / "fabrication" / "schedule.csv")}
    drawn: dict[str, list[float]] = {}
    for node in content(folder / "model.glb")["nodes"]:
        if "extras" in node:
            mesh = scene.geometry[node["name"]]
            assert mesh.is_watertight
            drawn.setdefault(node["extras"]["id"], []).append(mesh.volume * results.project.material().density)
    assert drawn.keys() == listed_mass.keys()
    # the layers of a lamella are longer and shorter than its centre line by the same; ruled faces are drawn flat and
    # round holes as polygons inscribed
    for part, masses in drawn.items():
        assert np.mean(masses) == pytest.approx(listed_mass[part], rel=1e-3)


def test_the_gltf_model_stands_upright_where_the_structure_is(written: tuple[lamella.Results, Path]) -> None:
    results, folder = written
    scene = trimesh.load(folder / "model.glb")
    points = results.network.node_points
    # y up: x, z, -y; strips and bolts reach beyond the nodes
    low, high = scene.bounds
    turned = points @ np.array([[1.0, 0, 0], [0, 0, -1.0], [0, 1.0, 0]])
    assert np.all(turned.min(axis=0) - low >= 0)
    assert np.all(high - turned.max(axis=0) >= 0)
    assert np.all(high - low - np.ptp(turned, axis=0) < 0.5)
    matrix, name = scene.graph["nut-1 " + next(iter(label_of(results, "nut-1")))]
    assert scene.geometry[name].is_watertight
    nut = next(item for item in results.outputs["fabrication"].hardware if item.id == "nut-1")
    x, y, z = nut.places.origins[0].tolist()
    assert matrix[:3, 3] == pytest.approx([x, z, -y], abs=1e-12)


def label_of(results: lamella.Results, identity: str) -> tuple[str, ...]:
    return next(item for item in results.outputs["fabrication"].hardware if item.id == identity).places.labels


def test_finishes_follow_the_material(written: tuple[lamella.Results, Path], tmp_path: Path) -> None:
    file = content(written[1] / "model.glb")
    assert [material["name"] for material in file["materials"]] == ["metal"]
    timber = {
        "lamella": {"material": "C24", "thickness": 0.006, "height": 0.06, "layers": 1},
        "files": {"solids": True},
    }
    plain = {key: value for key, value in PROJECT.items() if key != "joint"}
    write(compute(parse_project(plain | timber)), tmp_path / "timber")
    (wood,) = content(tmp_path / "timber" / "model.glb")["materials"]
    assert wood["name"] == "timber"
    assert wood["pbrMetallicRoughness"]["metallicFactor"] == 0.0


def test_triangles_are_estimated_before_they_are_made(written: tuple[lamella.Results, Path]) -> None:
    results, _ = written
    for step in (body_step(results.lamellas), 0.1):
        made = sum(len(one.solid.triangles) for one in strip_bodies(results.parts, results.lamellas, step))
        assert 0.9 < triangle_count(results.parts, step) / made < 1.1


def test_many_strips_are_left_out_unless_asked_for(
    written: tuple[lamella.Results, Path], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    results, _ = written
    limit = triangle_count(results.parts, body_step(results.lamellas)) - 1
    monkeypatch.setattr("lamella.stages.fabrication.scene.TRIANGLE_LIMIT", limit)
    left_out = compute(parse_project(PROJECT))
    assert [message.key for message in left_out.summary["warnings"]].count("solids_left_out") == 1
    write(left_out, tmp_path / "few")
    ids = {row["id"] for row in rows(tmp_path / "few" / "fabrication" / "schedule.csv")}
    named = {node["name"] for node in content(tmp_path / "few" / "model.glb")["nodes"]}
    assert not named & ids
    asked = compute(parse_project(PROJECT | {"files": {"solids": True}}))
    assert "solids_left_out" not in [message.key for message in asked.summary["warnings"]]
