"""surface.obj, surface.ply, network.obj: read back with readers of their own."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from files.write.test_samples import cylinder_mesh, cylinder_net
from lamella.files.write.meshes import (
    surface_obj_bytes,
    surface_ply_bytes,
    write_network_obj,
    write_surface_obj,
    write_surface_ply,
)


def read_obj(path: Path) -> tuple[NDArray[np.float64], NDArray[np.float64], list[tuple[str, str, list[str]]]]:
    """Return vertices, normals and elements (object/group, letter, fields)."""
    vertices, normals, elements, place = [], [], [], ["", ""]
    for line in path.read_text("utf-8").splitlines():
        key, *fields = line.split()
        if key == "v":
            vertices.append([float(x) for x in fields])
        elif key == "vn":
            normals.append([float(x) for x in fields])
        elif key == "o":
            place = [fields[0], ""]
        elif key == "g":
            place = [place[0], fields[0]]
        elif key in "fl":
            elements.append(("/".join(place), key, fields))
        else:
            assert key == "#"
    return np.array(vertices), np.array(normals), elements


def cycles(faces: list[list[int]]) -> list[tuple[int, ...]]:
    """Faces from their smallest index on, sorted: the same faces whatever their start and order."""
    return sorted(tuple(face[face.index(min(face)) :] + face[: face.index(min(face))]) for face in faces)


def expected_faces() -> list[tuple[int, ...]]:
    return cycles([list(dict.fromkeys(face)) for face in cylinder_mesh().faces.tolist()])


def test_surface_obj(tmp_path: Path) -> None:
    mesh = cylinder_mesh()
    write_surface_obj(tmp_path / "surface.obj", mesh, name="one\ntwo", version="1.2.3")
    head = (tmp_path / "surface.obj").read_text("utf-8").splitlines()[:3]
    assert head == ["# lamella 1.2.3", "# project one two", "# units: m"]
    assert f"# faces within {mesh.sag():.1e} m of the surface" in (tmp_path / "surface.obj").read_text("utf-8")
    vertices, normals, elements = read_obj(tmp_path / "surface.obj")
    assert np.array_equal(vertices, mesh.points)
    assert np.array_equal(normals, mesh.normals)
    faces = []
    for _, letter, fields in elements:
        assert letter == "f"
        pairs = [field.split("//") for field in fields]
        assert all(a == b for a, b in pairs)
        faces.append([int(a) - 1 for a, _ in pairs])
    assert cycles(faces) == expected_faces()
    assert {len(face) for face in faces} == {3, 4}


def test_surface_ply(tmp_path: Path) -> None:
    mesh = cylinder_mesh()
    write_surface_ply(tmp_path / "surface.ply", mesh, name="one\ntwo", version="1.2.3")
    head, _, body = (tmp_path / "surface.ply").read_bytes().partition(b"end_header\n")
    lines = head.decode().splitlines()
    assert lines[:4] == [
        "ply",
        "format binary_little_endian 1.0",
        "comment lamella 1.2.3",
        "comment project one two",
    ]
    assert any(line.startswith("comment units") for line in lines)
    properties = [line.split()[-1] for line in lines if line.startswith("property double")]
    assert properties == ["x", "y", "z", "nx", "ny", "nz", "H", "K", "k1", "k2"]
    counts = {line.split()[1]: int(line.split()[2]) for line in lines if line.startswith("element")}
    table = np.frombuffer(body, "<f8", counts["vertex"] * 10).reshape(-1, 10)
    assert np.array_equal(table[:, :3], mesh.points)
    assert np.array_equal(table[:, 3:6], mesh.normals)
    curvatures = np.column_stack((mesh.mean_curvature, mesh.gaussian_curvature, mesh.k1, mesh.k2))
    assert np.array_equal(table[:, 6:], curvatures)
    faces, place = [], counts["vertex"] * 80
    for _ in range(counts["face"]):
        faces.append(np.frombuffer(body, "<i4", body[place], place + 1).tolist())
        place += 1 + 4 * body[place]
    assert place == len(body)
    assert cycles(faces) == expected_faces()


def test_network_obj(tmp_path: Path) -> None:
    network, _ = cylinder_net()
    write_network_obj(tmp_path / "network.obj", network, name="x", version="1")
    vertices, normals, elements = read_obj(tmp_path / "network.obj")
    assert np.array_equal(vertices, network.node_points)
    assert np.array_equal(normals, network.node_normals)
    faces = [[int(f.split("//")[0]) - 1 for f in fields] for _, key, fields in elements if key == "f"]
    wanted = np.split(network.face_nodes, network.face_offsets[1:-1])
    assert cycles(faces) == cycles([face.tolist() for face in wanted])
    lines = {place: [int(i) - 1 for i in fields] for place, key, fields in elements if key == "l"}
    stops = np.split(network.stop_nodes, network.stop_offsets[1:-1])
    assert lines == {
        f"lamellas_{identity[0]}/{identity}": stop.tolist() for identity, stop in zip(network.ids, stops, strict=True)
    }


def test_network_obj_without_faces(tmp_path: Path) -> None:
    network, _ = cylinder_net()
    none = np.zeros(0, dtype=np.int64)
    network = dataclasses.replace(network, face_offsets=np.zeros(1, dtype=np.int64), face_nodes=none)
    write_network_obj(tmp_path / "network.obj", network, name="x", version="1")
    _, _, elements = read_obj(tmp_path / "network.obj")
    assert [key for _, key, _ in elements] == ["l"] * len(network.ids)


@pytest.mark.parametrize("content", [surface_obj_bytes, surface_ply_bytes])
def test_a_number_that_is_not_finite_is_not_written(content: object) -> None:
    mesh = cylinder_mesh()
    mesh.normals[5, 2] = np.inf
    with pytest.raises(ValueError, match="row 5"):
        content(mesh, name="x", version="1")  # type: ignore[operator]
