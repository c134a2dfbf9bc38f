"""The door for programs: what comes out is what the library makes, as other programs read it."""

from __future__ import annotations

import base64
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rhino3dm

import lamella
from lamella.interactive.door import answer

CIRCLES = [{"circle": {"center": [0, 0, z], "radius": 3.0}} for z in (0.0, 2.5)]


def ask(name: str, form: str, boundary: Any = CIRCLES, **more: Any) -> Any:
    surface = {"kind": "form-found", "tolerance": 0.03, "boundary": boundary}
    body = {"project": {"surface": surface, "network": {"cells": 10}, **more}, "form": form}
    given = answer(name, json.dumps(body).encode())
    return given.status, json.loads(given.content)


def test_what_comes_out_is_what_the_library_makes() -> None:
    status, made = ask("parts", "plain")
    assert status == 200
    film = lamella.film([lamella.circle((0, 0, z), 3.0) for z in (0.0, 2.5)], tolerance=0.03)
    parts = lamella.net(film, cells=10).strips().parts()
    assert [part["length"] for part in made["parts"]] == pytest.approx([part.length for part in parts.parts])
    assert made["figures"]["surface"]["area"] == pytest.approx(film.area())
    status, net = ask("net", "plain")
    assert net["net"]["schema"] == "lamella/network/1"


@pytest.mark.slow
def test_rhino_reads_what_comes_out() -> None:
    _, made = ask("net", "rhino")
    objects = [rhino3dm.CommonObject.Decode(one["object"]) for one in made["net"]]
    assert any(isinstance(one, rhino3dm.Curve) for one in objects)
    assert any("lamellas" in one["layer"].lower() for one in made["net"])
    _, whole = ask("net", "3dm")
    model = rhino3dm.File3dm.FromByteArray(base64.b64decode(whole["net"]))
    assert len(model.Objects) == len(objects)
    _, surface = ask("surface", "rhino")
    mesh = rhino3dm.CommonObject.Decode(surface["surface"][0]["object"])
    assert len(mesh.Vertices) > 100


@pytest.mark.slow
def test_curves_of_rhino_come_in_as_they_are() -> None:
    """Exact circles as NURBS give the film of exact circles."""
    curves = [rhino3dm.Circle(rhino3dm.Point3d(0, 0, z), 3.0).ToNurbsCurve() for z in (0.0, 2.5)]
    status, made = ask("surface", "plain", [{"rhino": curve.Encode()} for curve in curves])
    assert status == 200, made
    assert made["figures"]["surface"]["area"] == pytest.approx(
        ask("surface", "plain")[1]["figures"]["surface"]["area"], rel=1e-4
    )


@pytest.mark.slow
def test_curves_of_compas_come_in_and_graphs_go_out() -> None:
    frame = {"point": [0, 0, 2.5], "xaxis": [1, 0, 0], "yaxis": [0, 1, 0]}
    circle = {"dtype": "compas.geometry/Circle", "data": {"radius": 3.0, "frame": {"dtype": "x/Frame", "data": frame}}}
    status, made = ask("net", "compas", [CIRCLES[0], {"compas": circle}])
    assert status == 200, made
    assert made["net"]["dtype"] == "compas.datastructures/Graph"
    square = {
        "dtype": "compas.geometry/Polyline",
        "data": {"points": [[0, 0, 0], [4, 0, 1], [4, 4, 0], [0, 4, 1], [0, 0, 0]]},
    }
    status, made = ask("surface", "compas", [{"compas": square}])
    assert status == 200, made
    assert made["surface"]["dtype"] == "compas.datastructures/Mesh"


@pytest.mark.slow
def test_meshes_come_in(tmp_path: Path) -> None:
    mesh = lamella.Catenoid(2.0, (-1.0, 1.0)).mesh(2e-3)
    lamella.write_compas(mesh, tmp_path / "mesh.json")
    compas = json.loads((tmp_path / "mesh.json").read_text())
    body = {"project": {"surface": {"kind": "mesh", "tolerance": 0.03, "compas": compas}}}
    given = answer("surface", json.dumps(body).encode())
    made = json.loads(given.content)
    assert given.status == 200, made
    # of a catenoid: pi c (2 z + c sinh(2 z / c)) / 2 between -z and z, doubled
    area = np.pi * 2.0 * (2.0 + 2.0 * np.sinh(1.0))
    assert made["figures"]["surface"]["area"] == pytest.approx(area, rel=2e-3)


@pytest.mark.parametrize(
    ("name", "body", "status", "where"),
    [
        ("fly", b"{}", 404, ""),
        ("net", b"{", 422, ""),
        ("net", b"[]", 422, "project"),
        ("net", b'{"project": {"surface": {"kind": "mesh", "file": "/etc/passwd"}}}', 422, "surface.file"),
        ("net", b'{"project": {}, "form": "x"}', 422, "form"),
        (
            "net",
            b'{"project": {"surface": {"kind": "cylinder", "radius": -1, "height": [0, 1]}}}',
            422,
            "surface.radius",
        ),
        ("surface", b'{"project": {}, "more": 1}', 422, "more"),
        ("surface", b'{"project": {}}', 422, "project"),
        ("surface", b'{"project": {"network": {}}}', 422, "surface"),
    ],
)
def test_what_cannot_be_is_refused(name: str, body: bytes, status: int, where: str) -> None:
    given = answer(name, body)
    assert given.status == status
    # of a program, not of a file
    assert "lamella new" not in json.loads(given.content)["error"].get("remedy", "")
    assert json.loads(given.content)["error"]["where"].endswith(where)


@pytest.mark.parametrize(
    ("loop", "where"),
    [
        ({"file": "curves.3dm"}, "surface.boundary[1].file"),
        ({"rhino": {"version": 1}}, "surface.boundary[1].rhino"),
        ({"rhino": "nonsense"}, "surface.boundary[1].rhino"),
        ({"rhino": 3}, "surface.boundary[1].rhino"),
        ({"rhino": rhino3dm.Mesh().Encode()}, "surface.boundary[1].rhino"),
        ({"compas": {"dtype": "compas.geometry/Sphere", "data": {}}}, "surface.boundary[1].compas"),
        ({"compas": {"dtype": "compas.geometry/Circle", "data": {"radius": 1}}}, "surface.boundary[1].compas"),
        ({"compas": 3}, "surface.boundary[1].compas"),
    ],
)
def test_curves_that_are_none(loop: dict[str, Any], where: str) -> None:
    status, made = ask("net", "plain", [CIRCLES[0], loop])
    assert (status, made["error"]["where"]) == (422, where)
    assert "Decode" not in made["error"]["message"]
