"""Quad meshes in files: what is written is read again, bit by bit, in the same order; others are refused."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import orjson
import pytest

from lamella import InputError, QuadMesh, quad_mesh
from lamella.files.compas_json import compas_at, quad_mesh_of_compas
from lamella.files.quad_mesh_files import FORMATS, QuadFile, quad_mesh_bytes, read_quad_mesh
from lamella.files.read.mesh_ply import read_ply
from lamella.projection.mesh_figures import mesh_figures


def sample() -> QuadMesh:
    """A bent grid of 4 x 5 with faces and vertices in no natural order."""
    draw = np.random.default_rng(0)
    i, j = (x.ravel() for x in np.meshgrid(np.arange(4), np.arange(5), indexing="ij"))
    points = np.column_stack([i, j, 0.1 * i * j]) / 3 + 0.01 * draw.normal(size=(20, 3))
    k = (5 * np.arange(3)[:, None] + np.arange(4)).ravel()
    faces = np.column_stack([k, k + 5, k + 6, k + 1])
    order = draw.permutation(20)
    return quad_mesh(points[order], np.argsort(order)[faces[draw.permutation(12)]])


def written(path: Path, mesh: QuadMesh, like: QuadFile | None = None, **more: Any) -> Path:
    own = like or QuadFile(mesh)
    path.write_bytes(quad_mesh_bytes(path.suffix, mesh, mesh_figures(mesh), like=own, name="a", version="0", **more))
    return path


@pytest.mark.parametrize("suffix", FORMATS)
def test_round_trip(suffix: str, tmp_path: Path) -> None:
    mesh = sample()
    found = read_quad_mesh(written(tmp_path / f"a{suffix}", mesh))
    assert np.array_equal(found.mesh.vertices, mesh.vertices)
    assert np.array_equal(found.mesh.faces, mesh.faces)
    # a .3dm says its unit
    assert [note for note in found.notes if "unit" in note] == (
        [] if suffix == ".3dm" else ["the file says no unit: taken as metres"]
    )


@pytest.mark.parametrize("suffix", FORMATS)
def test_results_have_the_unit_of_the_file(suffix: str, tmp_path: Path) -> None:
    mesh = sample()
    path = written(tmp_path / f"a{suffix}", mesh, QuadFile(mesh, metres=0.001))
    found = read_quad_mesh(path, None if suffix == ".3dm" else "mm")
    assert found.metres == 0.001
    assert np.allclose(found.mesh.vertices, mesh.vertices, rtol=1e-15, atol=1e-17)
    if suffix != ".3dm":
        assert read_quad_mesh(path).mesh.vertices == pytest.approx(1000 * mesh.vertices)


def test_figures_and_colours_are_properties_of_a_ply(tmp_path: Path) -> None:
    mesh = sample()
    red = np.tile(np.array([[200, 0, 7]], np.uint8), (12, 1))
    data = written(tmp_path / "a.ply", mesh, colours={"faces": red}).read_bytes()
    head, _, body = data.partition(b"end_header\n")
    names = [line.split()[-1].decode() for line in head.splitlines() if line.startswith(b"property double")]
    figures = mesh_figures(mesh)
    assert names == ["x", "y", "z", *figures.vertices, *figures.faces]
    columns = 3 + len(figures.vertices)
    table = np.frombuffer(body[: 20 * columns * 8], "<f8").reshape(20, columns)
    for k, values in enumerate(figures.vertices.values()):
        assert np.array_equal(table[:, 3 + k], values, equal_nan=True)
    row = np.dtype([("count", "u1"), ("corners", "<i4", 4), ("planarity", "<f8"), ("rgb", "u1", 3)])
    faces = np.frombuffer(body[20 * columns * 8 :], row)
    assert np.array_equal(faces["planarity"], figures.faces["planarity"])
    assert (faces["rgb"] == [200, 0, 7]).all()
    assert np.array_equal(read_ply(data).corners.reshape(-1, 4), mesh.faces)


def test_figures_are_comments_of_an_obj(tmp_path: Path) -> None:
    mesh = sample()
    text = written(tmp_path / "a.obj", mesh).read_text()
    figures = mesh_figures(mesh)
    for kind, mark, what in ((figures.vertices, "#v ", "vertex"), (figures.faces, "#f ", "face")):
        (title,) = [line for line in text.splitlines() if line.startswith(f"# figures of each {what}")]
        assert title.split(": ")[1].split() == list(kind)
        table = np.array([line.split()[1:] for line in text.splitlines() if line.startswith(mark)], np.float64)
        assert np.array_equal(table, np.column_stack(list(kind.values())), equal_nan=True)


def test_figures_are_user_text_of_a_rhino_mesh(tmp_path: Path) -> None:
    rhino3dm = pytest.importorskip("rhino3dm")
    mesh = sample()
    rgb = np.random.default_rng(1).integers(0, 256, (12, 3)).astype(np.uint8)
    path = written(tmp_path / "a.3dm", mesh, colours={"faces": rgb})
    (item,) = rhino3dm.File3dm.Read(str(path)).Objects
    figures = mesh_figures(mesh)
    for kind in ("vertices", "faces"):
        for key, values in getattr(figures, kind).items():
            found = np.array(item.Attributes.GetUserString(f"{kind}.{key}").split(","), np.float64)
            assert np.array_equal(found, values, equal_nan=True)
    # a vertex has the mean colour of its faces
    for k in range(20):
        around = rgb[(mesh.faces == k).any(1)].mean(0)
        assert list(item.Geometry.VertexColors[k][:3]) == pytest.approx(around, abs=0.5)


# as compas 2 writes it; keys need not be consecutive, and coordinates may be left to the default
COMPAS = {
    "attributes": {},
    "default_vertex_attributes": {"x": 0.0, "y": 0.0, "z": 0.5},
    "vertex": {"10": {"x": 0, "y": 0}, "4": {"x": 1.0, "y": 0}, "7": {"x": 1, "y": 1, "z": 0.75}, "2": {"y": 1.0}},
    "face": {"3": [10, 4, 7, 2]},
    "facedata": {},
    "edgedata": {},
}


@pytest.mark.parametrize(
    "content",
    [
        {"dtype": "compas.datastructures/Mesh", "data": COMPAS, "guid": "0"},
        {"dtype": "compas.datastructures/Mesh", "value": {"compas": "1.7", "data": COMPAS}},
        {"compas": "0.17", "datatype": "compas.datastructures/Mesh", "data": COMPAS},
        COMPAS,
    ],
    ids=["2", "1 value", "1 data", "bare"],
)
def test_forms_of_compas(content: Any, tmp_path: Path) -> None:
    (tmp_path / "a.json").write_text(json.dumps(content))
    found = read_quad_mesh(tmp_path / "a.json")
    assert found.mesh.vertices.tolist() == [[0, 0, 0.5], [1, 0, 0.5], [1, 1, 0.75], [0, 1, 0.5]]
    assert found.mesh.faces.tolist() == [[0, 1, 2, 3]]
    path = written(tmp_path / "b.json", found.mesh, found)
    result = orjson.loads(path.read_bytes())
    assert result["dtype"] == "compas.datastructures/Mesh"
    assert result["data"]["face"] == {"3": [10, 4, 7, 2]}
    assert list(result["data"]["vertex"]) == ["10", "4", "7", "2"]
    assert {key: result["data"]["vertex"]["2"][key] for key in "xyz"} == {"x": 0.0, "y": 1.0, "z": 0.5}
    assert (result["data"]["max_vertex"], result["data"]["max_face"]) == (10, 3)
    assert "planarity" in result["data"]["facedata"]["3"]


class InMemory:
    """What `quad_mesh_of_compas` and `compas_at` ask of a COMPAS mesh."""

    def __init__(self, points: dict[int, list[float]], corners: dict[int, list[int]]) -> None:
        self._points, self._corners = points, corners

    def vertices(self) -> Any:
        return iter(self._points)

    def faces(self) -> Any:
        return iter(self._corners)

    def vertex_coordinates(self, key: int) -> list[float]:
        return self._points[key]

    def face_vertices(self, key: int) -> list[int]:
        return self._corners[key]

    def copy(self) -> "InMemory":
        return InMemory(dict(self._points), self._corners)

    def vertex_attributes(self, key: int, names: str, values: list[float]) -> None:
        assert names == "xyz"
        self._points[key] = values


def test_compas_in_memory() -> None:
    mesh = InMemory({9: [0, 0, 0], 3: [1, 0, 0], 5: [1, 1, 0], 1: [0, 1, 0]}, {8: [9, 3, 5, 1]})
    found = quad_mesh_of_compas(mesh)
    assert found.faces.tolist() == [[0, 1, 2, 3]]
    moved = compas_at(mesh, found.at(found.vertices + np.array([0.0, 0.0, 2.0])))
    assert moved.vertex_coordinates(5) == [1, 1, 2]
    assert mesh.vertex_coordinates(5) == [1, 1, 0]
    with pytest.raises(InputError, match="face 0 has 3 corners"):
        quad_mesh_of_compas(InMemory({0: [0, 0, 0], 1: [1, 0, 0], 2: [0, 1, 0]}, {0: [0, 1, 2]}))


SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\n"


@pytest.mark.parametrize(
    ("name", "content", "match"),
    [
        ("a.obj", SQUARE + "f 1 2 3 4\nf 2 5 6\n", "1 of 2 faces are no quads; the first is face 1 with 3 corners"),
        ("a.obj", SQUARE + "f 1 2 3 4\nf 2 5 6 3\nv 9 9 9\n", "1 vertex is in no face; the first is vertex 6"),
        ("a.obj", SQUARE.replace("2 1 0", "nan 1 0") + "f 1 2 3 4\nf 2 5 6 3\n", "not a number"),
        ("a.obj", SQUARE + "v 1 0 1\nv 1 1 1\nf 1 2 3 4\nf 2 5 6 3\nf 2 7 8 3\n", "at most two may share an edge"),
        ("a.obj", SQUARE + "f 1 2 3 4\nf 2 3 6 5\n", "both run from vertex 1 to vertex 2"),
        ("a.obj", SQUARE + "v 5 0 0\nv 5 1 0\nv 6 1 0\nv 6 0 0\nf 1 2 3 4\nf 2 5 6 3\nf 7 8 9 10\n", "2 pieces"),
        ("a.obj", SQUARE + "f 1 2 3 3\nf 2 5 6 3\n", "a vertex comes twice"),
        ("a.obj", SQUARE.replace("2 0 0", "20000 0 0") + "f 1 2 3 4\nf 2 5 6 3\n", "at most 5,000 m"),
        ("a.obj", SQUARE, "no faces"),
        ("a.obj", "", "empty"),
        ("a.stl", "solid", "holds no quad mesh"),
        ("a.json", "{", "no JSON"),
        ("a.json", '{"dtype": "compas.geometry/Point", "data": [0, 0, 0]}', "no mesh of COMPAS but compas.geometry"),
        ("a.json", '{"vertex": {"0": {"x": null}}, "face": {}}', "vertex 0 is at"),
        ("a.json", '{"vertex": {"0": {}}, "face": {"0": [0, 1, 2, 3]}}', "names vertex '1'"),
        ("a.json", '{"vertex": {"0": {}}, "face": {"0": {}}}', "no list"),
        ("a.json", '{"vertex": {}, "face": {}}', "no faces"),
        ("a.ply", "plx", "ply"),
        ("a.3dm", "3D", ".3dm"),
    ],
)
def test_what_is_no_quad_mesh_is_refused(name: str, content: str, match: str, tmp_path: Path) -> None:
    path = tmp_path / name
    path.write_text(content)
    with pytest.raises(InputError, match=match) as caught:
        read_quad_mesh(path)
    assert caught.value.where == str(path)
    assert str(caught.value).count(name) == 1
    assert caught.value.remedy


def test_units(tmp_path: Path) -> None:
    path = written(tmp_path / "a.3dm", sample())
    assert read_quad_mesh(path, "m").metres == 1
    with pytest.raises(InputError, match="its unit is m, not mm"):
        read_quad_mesh(path, "mm")
    with pytest.raises(InputError, match="unit 'furlong' is not known"):
        read_quad_mesh(path, "furlong")
    with pytest.raises(InputError, match="no such file"):
        read_quad_mesh(tmp_path / "b.obj")
    tiny = written(tmp_path / "a.obj", sample())
    assert any("is its unit, mm, right" in note for note in read_quad_mesh(tiny, "mm").notes)
