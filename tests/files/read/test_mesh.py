"""Mesh files of every format, whole and broken, written here byte by byte and read back."""

import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lamella import InputError
from lamella.files.read.mesh import read_mesh
from lamella.surface.from_mesh.split_polygons import split_polygons
from refusals import keys, refused, warned
from surface.from_mesh.meshes import grid, obj_text, ply_bytes, rhino_bytes, stl_bytes, triangles

POINTS, QUADS = grid()
FACES = triangles(QUADS)
PLY = "ply\nformat ascii 1.0\n"
PLY_ROW = "element vertex {}\nproperty float x\nproperty float y\n"
MIXED = [*QUADS[:7].tolist(), *FACES[14:].tolist()]


def area(points, faces):
    a, b, c = (points[faces[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


@pytest.fixture
def read(tmp_path):
    def read(name, content, unit=None):
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return read_mesh(path, unit)

    return read


def same_quads(faces, quads):
    """Whether triangles are the halves of quads, each with its orientation."""
    turned = np.concatenate([np.roll(quads, k, axis=1)[:, :3] for k in range(4)])
    smallest = [np.roll(row, -row.argmin()).tolist() for row in faces]
    known = {tuple(np.roll(row, -row.argmin())) for row in turned}
    return len(faces) == 2 * len(quads) and all(tuple(row) in known for row in smallest)


@pytest.mark.parametrize("corner", ["{0}", "{0}/1", "{0}//1", "{0}/1/1"])
def test_obj_corner_forms(read, corner):
    mesh = read("a.obj", obj_text(POINTS, QUADS, corner))
    assert (mesh.points == POINTS).all()
    assert same_quads(mesh.faces, QUADS)


def test_obj_negative_numbers_continuations_colours_and_line_ends(read):
    text = (
        "v 0 0 0 1 1 1\r\nv\t1 0 0 0.5\r\n  v 1 1 \\\r\n0 # comment\r\nf -3 -2 -1\r\nv 0 1 0\r\nf 1 3 \\\r\n4\r\nl 1 2"
    )
    mesh = read("a.OBJ", text)
    assert mesh.points.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    assert mesh.faces.tolist() == [[0, 1, 2], [0, 2, 3]]


@pytest.mark.parametrize("order", ["ascii", "binary_little_endian", "binary_big_endian"])
@pytest.mark.parametrize("real", ["double", "float"])
@pytest.mark.parametrize("extras", [False, True])
@pytest.mark.parametrize("faces", [FACES.tolist(), QUADS.tolist(), MIXED], ids=["triangles", "quads", "mixed"])
def test_ply(read, order, real, extras, faces):
    mesh = read("a.ply", ply_bytes(POINTS, faces, order, real, extras))
    np.testing.assert_allclose(mesh.points, POINTS, atol=0 if real == "double" or order == "ascii" else 1e-7)
    assert len(mesh.faces) == len(FACES)
    if faces == FACES.tolist():
        assert (mesh.faces == FACES).all()
    assert area(mesh.points, mesh.faces) == pytest.approx(area(POINTS, FACES), rel=1e-3)


def test_ply_of_other_line_ends_and_our_own(read):
    content = ply_bytes(POINTS, QUADS, newline="\r\n")
    assert same_quads(read("a.ply", content).faces, QUADS)
    content = ply_bytes(POINTS, QUADS, "binary_big_endian", newline="\r")
    assert same_quads(read("a.ply", content).faces, QUADS)


@pytest.mark.parametrize("kind", ["unduloid", "enneper"])
def test_our_own_surface_files_come_back(read, kind):
    from lamella import Enneper, Unduloid
    from lamella.files.write.meshes import surface_obj_bytes, surface_ply_bytes

    written = (Unduloid(0.5, 1.0, (-1, 1)) if kind == "unduloid" else Enneper(2, 1.0, 1.0)).mesh()
    for name, content in (
        ("a.obj", surface_obj_bytes(written, name="x", version="0")),
        ("a.ply", surface_ply_bytes(written, name="x", version="0")),
    ):
        np.testing.assert_array_equal(read(name, content).points, written.points)


@pytest.mark.parametrize("header", [b"solid but binary", b"exported", b"solid facet"])
def test_stl_binary(read, header):
    mesh = read("a.stl", stl_bytes(POINTS, FACES, header=header))
    np.testing.assert_allclose(mesh.points[mesh.faces], POINTS[FACES], atol=1e-7)


@pytest.mark.parametrize("change", [bytes, bytes.upper, lambda text: text.replace(b"\n", b"\r\n")])
def test_stl_text(read, change):
    mesh = read("a.stl", change(stl_bytes(POINTS, FACES, binary=False)))
    np.testing.assert_allclose(mesh.points[mesh.faces], POINTS[FACES], atol=1e-6)


def test_3dm_in_millimetres(read):
    mesh = read("a.3dm", rhino_bytes([("roof", 1000 * POINTS, QUADS)]))
    np.testing.assert_allclose(mesh.points, POINTS, atol=1e-12)
    assert same_quads(mesh.faces, QUADS)
    assert "unit mm" in mesh.source


def test_3dm_meshes_are_joined_at_shared_borders_or_named(read):
    flat = POINTS * [1, 1, 0]
    joined = read("a.3dm", rhino_bytes([("left", flat, FACES), ("right", flat + np.array([1, 0, 0]), QUADS)], "Meters"))
    assert len(joined.faces) == 2 * len(FACES)
    warned(joined.notes, "meshes_joined", [2])
    with refused("path", [2], ["left", "right"]):
        read("a.3dm", rhino_bytes([("left", flat, FACES), ("right", flat + np.array([3, 0, 0]), FACES)]))


def test_3dm_hidden_objects_and_layers_are_left_out(read):
    def hide(model, rhino3dm):
        shown = rhino3dm.Layer()
        shown.Name = "on"
        assert model.Layers.Add(shown) == 0
        layer = rhino3dm.Layer()
        layer.Name, layer.Visible = "off", False
        number = model.Layers.Add(layer)
        for place, (visible, layer_number) in enumerate([(False, 0), (True, number)]):
            mesh = model.Objects[0].Geometry.Duplicate()
            mesh.Translate(rhino3dm.Vector3d(1e4 * (place + 1), 0, 0))
            attributes = rhino3dm.ObjectAttributes()
            attributes.Visible, attributes.LayerIndex = visible, layer_number
            model.Objects.AddMesh(mesh, attributes)

    mesh = read("a.3dm", rhino_bytes([("roof", POINTS, FACES)], extra=hide), "m")
    assert len(mesh.faces) == len(FACES)
    warned(mesh.notes, "objects_hidden", [2])


def test_3dm_without_meshes_says_to_mesh(read):
    def sphere(model, rhino3dm):
        model.Objects.AddBrep(rhino3dm.Brep.CreateFromSphere(rhino3dm.Sphere(rhino3dm.Point3d(0, 0, 0), 1)), None)

    def curve(model, rhino3dm):
        model.Objects.AddCurve(rhino3dm.LineCurve(rhino3dm.Point3d(0, 0, 0), rhino3dm.Point3d(1, 0, 0)), None)

    with refused("path", [1]):
        read("a.3dm", rhino_bytes([], extra=sphere))
    with refused("path", [1]):
        read("a.3dm", rhino_bytes([], extra=curve))
    with refused("path"):
        read("a.3dm", rhino_bytes([]))


SHADED = """
import base64, os, rhino3dm, sys
lines = (rhino3dm.LineCurve(rhino3dm.Point3d(0, y, 0), rhino3dm.Point3d(1, y, 0)).ToNurbsCurve() for y in (0.0, 1.0))
brep = rhino3dm.Brep.CreateFromSurface(rhino3dm.NurbsSurface.CreateRuledSurface(*lines))
mesh = rhino3dm.Mesh()
for x, y in ((0, 0), (1, 0), (1, 1), (0, 1)):
    mesh.Vertices.Add(x, y, 0)
mesh.Faces.AddFace(0, 1, 2, 3)
brep.Faces[0].SetMesh(mesh, rhino3dm.MeshType.Render)
model = rhino3dm.File3dm()
model.Settings.ModelUnitSystem = rhino3dm.UnitSystem.Meters
model.Objects.AddBrep(brep, None)
sys.stdout.buffer.write(base64.b64decode(model.Encode()))
sys.stdout.flush()
os._exit(0)  # SetMesh gives the mesh two owners, both of which would free it
"""


def test_3dm_render_mesh_of_a_surface(read):
    content = subprocess.run([sys.executable, "-c", SHADED], check=True, capture_output=True).stdout
    mesh = read("a.3dm", content)
    assert mesh.points[mesh.faces].tolist() == [[[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[0, 0, 0], [1, 1, 0], [0, 1, 0]]]
    assert keys(mesh.notes) == ["mesh_rendered"]


def test_units(read):
    text = obj_text(1000 * POINTS, FACES)
    np.testing.assert_allclose(read("a.obj", text, "mm").points, POINTS, rtol=1e-14, atol=1e-14)
    np.testing.assert_allclose(read("a.obj", obj_text(POINTS, FACES), "ft").points, 0.3048 * POINTS)
    warned(read("a.obj", obj_text(POINTS, FACES)).notes, "unit_assumed")
    for factor, unit in ((1200, "m"), (1000, "m")):
        with refused("unit", names=[f'unit = "{unit}"']):
            read("a.obj", obj_text(factor * POINTS, FACES))
        assert len(read("a.obj", obj_text(factor * POINTS, FACES), unit).points) == len(POINTS)
    with refused("unit", names=["furlong"]):
        read("a.obj", text, "furlong")
    # a metre drawn where the file says millimetres: the project's word counts, and is the remedy
    with refused("unit", names=['unit = "m"']):
        read("a.3dm", rhino_bytes([("a", POINTS, FACES)]))
    warned(read("a.3dm", rhino_bytes([("a", POINTS, FACES)]), "m").notes, "unit_overruled")
    assert read("a.3dm", rhino_bytes([("a", 1000 * POINTS, FACES)], "None"), "mm").points.max() == pytest.approx(1)
    with refused("path", [9000, 9], ['unit = "mm"']):
        read("a.obj", obj_text(9000 * POINTS, FACES))


@pytest.mark.parametrize(
    ("name", "content", "numbers", "names"),
    [
        ("a.fbx", "x", [], [".fbx"]),
        *((f"a.{ending}", "", [], [f"a.{ending}"]) for ending in ("obj", "ply", "stl", "3dm")),
        *((f"a.{ending}", b"\x00\xff" * 200, [], []) for ending in ("obj", "ply", "stl", "3dm")),
        # no faces: lines and points, free-form surfaces, vertices alone
        ("a.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n", [1, 0, 2], []),
        ("a.obj", "v 0 0 0\ncstype bspline\nsurf 0 1 0 1 1\n", [], []),
        ("a.obj", "v 0 0 0\n", [], []),
        ("a.stl", "solid nothing\nendsolid nothing\n", [], []),
        # lines and corners that are none
        ("a.obj", "v 0 0 0\nv 1 0 0\nf 1 2\n", [3], ["f 1 2"]),
        ("a.obj", "v 0 0 0\nv 1 zero 0\nf 1 2 1\n", [2], ["v 1 zero 0"]),
        ("a.obj", "v 0 0 0\nv 1 0\nf 1 2 1\n", [2], ["v 1 0"]),
        ("a.obj", "v 0 0 0\nf 1 x/1 1\n", [], ["x/1"]),
        ("a.obj", "v 0 0 0\nf 1 99999999999999999999 1\n", [], ["99999999999999999999"]),
        ("a.obj", "v 0 0 0\nf 0 1 1\n", [1], []),
        ("a.obj", "v 0 0 0\nf 1 2 -2\n", [2, 1], []),
        # vertices that are no numbers, in one place, or too far apart
        ("a.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n", [1, 2], []),
        ("a.obj", "v 0 0 0\nv 1e999 0 0\nv 0 1 0\nf 1 2 3\n", [1, 2], []),
        ("a.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n", [], []),
        ("a.obj", "v -1e308 1 1\nv 1e308 1 1\nv 1 1 1\nf 1 2 3\n", [1, 1e308, 1e11], []),
        ("a.obj", "v -1e10 1 1\nv 1e10 1 1\nv 1 1 1\nf 1 2 3\n", [2e10, 5000], []),
        ("a.obj", obj_text(np.random.default_rng(0).random((300, 3)), [range(300)]), [300, 256], []),
        # .ply without what it needs
        ("a.ply", PLY + "element face 1\nproperty list uchar int vertex_index\nend_header\n3 0 1 2\n", [], []),
        ("a.ply", PLY + PLY_ROW.format(1) + "property float z\nelement tristrips 0\nend_header\n0 0 0\n", [], []),
        ("a.ply", PLY + PLY_ROW.format(3) + "end_header\n0 0\n1 0\n1 1\n", [], []),
        ("a.ply", PLY + PLY_ROW.format(3) + "property quad z\nend_header\n", [], ["property quad z"]),
        ("a.ply", PLY + PLY_ROW.format(10**15) + "end_header\n0\n", [10**15], []),
        ("a.ply", ply_bytes(POINTS, FACES).replace(b"\n3 0 ", b"\n3 0.5 ", 1), [], []),
        # files that break off
        ("a.stl", stl_bytes(POINTS, FACES)[:3000], [60, 3084, 3000], []),
        ("a.stl", stl_bytes(POINTS, FACES, False)[:-18], [60, 60], []),
        ("a.stl", stl_bytes(POINTS, FACES, False).replace(b"vertex", b"vertx", 1), [60, 179], []),
        ("a.3dm", rhino_bytes([("a", POINTS, FACES)])[:-1], [], []),
    ],
)
def test_what_is_wrong_is_stated(read, name, content, numbers, names):
    with refused("path", numbers, names):
        read(name, content)


def test_files_that_are_not_there(tmp_path):
    with refused("path", names=["none.obj"]):
        read_mesh(tmp_path / "none.obj")
    (tmp_path / "folder.obj").mkdir()
    with refused("path", names=["folder.obj"]):
        read_mesh(tmp_path / "folder.obj")


def test_too_many_faces_are_refused(read, monkeypatch):
    monkeypatch.setattr("lamella.files.read.mesh_stl.MAXIMUM_FACES", 59)
    monkeypatch.setattr("lamella.files.read.mesh.MAXIMUM_FACES", 59)
    with refused("path", [60, 59]):
        read("a.stl", stl_bytes(POINTS, FACES))
    with refused("path", [30, 59]):
        read("a.obj", obj_text(POINTS, QUADS))


CONTENTS = {
    "a.obj": obj_text(POINTS, MIXED, "{0}/1/1").encode(),
    "b.ply": ply_bytes(POINTS, MIXED, extras=True),
    "c.ply": ply_bytes(POINTS, MIXED, "binary_little_endian", extras=True),
    "d.ply": ply_bytes(POINTS, FACES, "binary_big_endian"),
    "e.stl": stl_bytes(POINTS, FACES),
    "f.stl": stl_bytes(POINTS, FACES, binary=False),
    "g.3dm": rhino_bytes([("a", POINTS, QUADS)]),
}


@given(name=st.sampled_from(sorted(CONTENTS)), part=st.floats(0, 1, exclude_max=True))
@settings(deadline=None, max_examples=200)
def test_files_cut_off_anywhere_are_refused_or_read(tmp_path_factory, name, part):
    content = CONTENTS[name]
    path = tmp_path_factory.mktemp("cut") / name
    path.write_bytes(content[: int(part * len(content))])
    try:
        mesh = read_mesh(path)
    except InputError as refusal:
        assert refusal.remedy  # noqa: PT017
        return
    # A text can be cut where nobody can see it: then faces are missing at its end, and nothing else.
    assert name in ("a.obj", "b.ply", "f.stl")
    assert len(mesh.faces) <= len(FACES)
    assert np.isfinite(mesh.points).all()


@given(name=st.sampled_from(sorted(set(CONTENTS) - {"g.3dm"})), place=st.floats(0, 1, exclude_max=True), data=st.data())
@settings(deadline=None, max_examples=200)
def test_files_with_bytes_changed_are_refused_or_read(tmp_path_factory, name, place, data):
    content = bytearray(CONTENTS[name])
    junk = data.draw(st.binary(min_size=1, max_size=8))
    start = int(place * len(content))
    content[start : start + len(junk)] = junk
    path = tmp_path_factory.mktemp("changed") / name
    path.write_bytes(content)
    try:
        mesh = read_mesh(path)
    except InputError:
        return
    assert np.isfinite(mesh.points[mesh.faces]).all()


def test_quads_are_split_along_the_flatter_then_the_shorter_diagonal():
    # A flat kite: the short diagonal; a notched quad: the diagonal inside; a bent quad: along its fold.
    points = np.array(
        [[0, 0, 0], [1, -0.2, 0], [2, 0, 0], [1, 0.2, 0], [1, 2, 0], [0, 0, 0], [0.9, 0, 1], [2, 0, 0], [0.9, 2, 1.3]],
        dtype=float,
    )
    quads = np.array([[0, 1, 2, 3], [0, 3, 2, 4]])
    found = split_polygons(points, np.full(2, 4), quads.ravel())
    shared = [set(found[0]) & set(found[1]), set(found[2]) & set(found[3])]
    assert shared == [{1, 3}, {3, 4}]
    bent = np.array([[0, 0, 0], [3, 0, 1], [3, 1, 0], [0, 1, 1]], dtype=float)
    bent[:, 2] = [0, 1, 0, 0.0]
    found = split_polygons(bent, np.array([4]), np.arange(4))
    assert set(found[0]) & set(found[1]) == {0, 2}


@pytest.mark.parametrize("seed", range(20))
def test_polygons_with_notches_keep_their_area_and_orientation(seed):
    rng = np.random.default_rng(seed)
    size = int(rng.integers(5, 40))
    angle = 2 * np.pi * (np.arange(size) + rng.uniform(-0.3, 0.3, size)) / size
    flat = rng.uniform(0.3, 1, size)[:, None] * np.column_stack((np.cos(angle), np.sin(angle), 0 * angle))
    expected = np.cross(flat, np.roll(flat, -1, axis=0)).sum(axis=0)[2] / 2
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    found = split_polygons(flat @ turn.T, np.array([size]), np.arange(size))
    a, b, c = (flat[found[:, k]] for k in range(3))
    areas = np.cross(b - a, c - a)[:, 2] / 2
    assert (areas > 0).all()
    assert areas.sum() == pytest.approx(expected)
