"""model.3dm: read back with rhino3dm, against the exact helices it was made from."""

from __future__ import annotations

import base64
import dataclasses
import os
import subprocess
import sys
import time
import uuid
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rhino3dm
from numpy.typing import NDArray
from scipy.interpolate import BSpline, make_interp_spline

from files.write.test_samples import RADIUS, cylinder_mesh, cylinder_net, helix, inward
from lamella.base.arrays import Floats
from lamella.files.write import model_3dm, splines
from lamella.files.write.drawn_layer import DrawnLayer, Repeated
from lamella.files.write.model_3dm import model_bytes
from lamella.files.write.splines import SPLINE_TOLERANCE, Spline, fit_splines

NODE_LAYERS = ["nodes regular", "nodes boundary", "nodes singular", "nodes seam"]
TESTS = Path(__file__).parents[2]


def model(lamellas: bool = True, **changes: Any) -> bytes:
    network, strips = cylinder_net(per_cell=16)
    network = dataclasses.replace(network, **changes)
    return model_bytes(
        name="Pavillon Ü",
        version="1.2.3",
        surface=cylinder_mesh(),
        network=network,
        lamellas=strips if lamellas else None,
    )


def read(content: bytes) -> tuple[Any, dict[str, list[Any]]]:
    """Return the file and its objects by layer."""
    file = rhino3dm.File3dm.FromByteArray(content)
    names = [layer.Name for layer in file.Layers]
    objects: dict[str, list[Any]] = {name: [] for name in names}
    for item in file.Objects:
        objects[names[item.Attributes.LayerIndex]].append(item)
    return file, objects


def xyz(point: Any) -> list[float]:
    return [point.X, point.Y, point.Z]


def exact(k: int, arclengths: NDArray[np.float64]) -> NDArray[np.float64]:
    return helix(2 * np.pi * (k % 6) / 6, 1 if k < 6 else -1, arclengths)


def test_layers_units_and_names() -> None:
    network, _ = cylinder_net()
    file, objects = read(model())
    assert file.Settings.ModelUnitSystem == rhino3dm.UnitSystem.Meters
    drawn = ["surface", "lamellas A", "lamellas B", "strips A", "strips B", "layers A", "layers B"]
    assert list(objects) == [*drawn, *NODE_LAYERS]
    assert len({layer.Color for layer in file.Layers}) == len(objects)
    assert file.ApplicationName == "lamella"
    assert "1.2.3" in file.ApplicationDetails
    strings = {file.Strings[i][0]: file.Strings[i][1] for i in range(len(file.Strings))}
    assert strings == {"lamella\\project": "Pavillon Ü", "lamella\\version": "1.2.3"}
    for kind in ("lamellas", "strips"):
        for family in "AB":
            items = objects[f"{kind} {family}"]
            assert [item.Attributes.Name for item in items] == [f"{family}{k}" for k in range(1, 7)]
            text = dict(items[2].Attributes.GetUserStrings())
            assert (text["id"], text["family"], text["version"]) == (f"{family}3", family, "1.2.3")
            assert float(text["length_m"]) == network.lengths[2]
    assert all(item.Geometry.IsValid for item in file.Objects)


def test_without_lamellas_there_are_no_strips() -> None:
    _, objects = read(model(lamellas=False))
    assert list(objects) == ["surface", "lamellas A", "lamellas B", *NODE_LAYERS]
    assert len(objects["lamellas A"]) == 6


def test_surface_mesh_is_in_double_precision() -> None:
    mesh = cylinder_mesh()
    _, objects = read(model())
    (item,) = objects["surface"]
    read_points = [xyz(point) for point in item.Geometry.Vertices.ToPoint3dArray()]
    assert np.array_equal(read_points, mesh.points)
    faces = [list(item.Geometry.Faces[i]) for i in range(item.Geometry.Faces.Count)]
    assert faces == mesh.faces.tolist()
    normals = [xyz(item.Geometry.Normals[i]) for i in range(len(mesh.normals))]
    np.testing.assert_allclose(normals, mesh.normals, atol=1e-7)


def test_centre_lines_pass_through_the_samples_and_between_them_along_the_helix() -> None:
    network, _ = cylinder_net(per_cell=16)
    _, objects = read(model())
    for k, item in enumerate(objects["lamellas A"] + objects["lamellas B"]):
        curve, length = item.Geometry, network.lengths[k]
        assert curve.Degree == 3
        assert (0, length) == (curve.Domain.T0, curve.Domain.T1)
        between = np.linspace(0, length, 331)
        points = np.array([xyz(curve.PointAt(s)) for s in between])
        assert np.linalg.norm(points - exact(k, between), axis=1).max() <= 2 * SPLINE_TOLERANCE * length
        span = slice(network.sample_offsets[k], network.sample_offsets[k + 1])
        at_samples = np.array([xyz(curve.PointAt(s)) for s in network.sample_arclengths[span]])
        errors = np.linalg.norm(at_samples - network.sample_points[span], axis=1)
        assert errors.max() <= SPLINE_TOLERANCE * length
        assert errors[[0, -1]].max() <= 1e-14
        assert len(curve.Points) < 0.6 * len(errors)


def test_strips_are_ruled_along_the_normals() -> None:
    network, strips = cylinder_net(per_cell=16)
    _, objects = read(model())
    for k, item in enumerate(objects["strips A"] + objects["strips B"]):
        strip, length = item.Geometry, network.lengths[k]
        strip = strip.Surfaces[0].ToNurbsSurface() if hasattr(strip, "Surfaces") else strip
        assert (strip.Degree(0), strip.Degree(1)) == (3, 1)
        assert (-strips.section.height / 2, strips.section.height / 2) == (
            strip.Domain(1).T0,
            strip.Domain(1).T1,
        )
        assert strip.Points.CountV == 2
        along = np.linspace(0, length, 101)
        centre = exact(k, along)
        for across in (-strips.section.height / 2, 0.02, strips.section.height / 2):
            points = np.array([xyz(strip.PointAt(s, across)) for s in along])
            wanted = centre + across * inward(centre)
            assert np.linalg.norm(points - wanted, axis=1).max() <= 2 * SPLINE_TOLERANCE * length


def test_layers_stand_beside_the_centre_lines() -> None:
    """Ruled along the surface's normals there, and at their distance; the first one lies right, the last one left."""
    network, strips = cylinder_net(per_cell=16)
    _, objects = read(model())
    items = objects["layers A"] + objects["layers B"]
    assert [item.Attributes.Name for item in items[:3]] == ["A1-1", "A1-2", "A2-1"]
    assert len(items) == 2 * len(network.ids)
    height, section = strips.section.height, strips.section
    for number, item in enumerate(items):
        k, row = divmod(number, 2)
        strip = item.Geometry
        strip = strip.Surfaces[0].ToNurbsSurface() if hasattr(strip, "Surfaces") else strip
        assert dict(item.Attributes.GetUserStrings())["side"] == "RL"[row]
        d = section.layer_offsets[row]
        line = slice(*network.sample_offsets[k : k + 2])
        at = network.sample_arclengths[line]
        normals, tangents = network.sample_normals[line], network.sample_tangents[line]
        middle, upper = (np.array([xyz(strip.PointAt(s, across)) for s in at]) for across in (0.0, height / 2))
        off = middle - network.sample_points[line]
        np.testing.assert_allclose((off * np.cross(normals, tangents)).sum(1), d, rtol=1e-3)
        # on the cylinder to second order of d
        assert np.abs(np.hypot(*middle.T[:2]) - RADIUS).max() < 10 * abs(d) ** 3 / RADIUS**2 + 1e-6
        assert np.abs((upper - middle) / (height / 2) - inward(middle)).max() < 3 * d**2 / RADIUS**2 + 1e-5


def test_nodes_are_named_points_on_the_layer_of_their_kind() -> None:
    network, _ = cylinder_net()
    kinds = network.node_kinds.copy()
    kinds[8], kinds[9] = 2, 3
    _, objects = read(model(node_kinds=kinds))
    for kind, layer in enumerate(NODE_LAYERS):
        found = {int(item.Attributes.Name): xyz(item.Geometry.Location) for item in objects[layer]}
        assert found == {i: network.node_points[i].tolist() for i in np.flatnonzero(kinds == kind)}


def test_many_nodes_are_a_point_cloud_a_layer(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(model_3dm, "POINT_OBJECTS", 29)
    network, _ = cylinder_net()
    assert len(network.node_points) == 30
    _, objects = read(model())
    for kind, layer in enumerate(NODE_LAYERS):
        members = network.node_points[network.node_kinds == kind]
        clouds = [[xyz(p) for p in item.Geometry.GetPoints()] for item in objects[layer]]
        assert clouds == ([members.tolist()] if len(members) else [])


def test_ids_are_stable_and_no_two_are_equal() -> None:
    file, _ = read(model())
    ids = [item.Attributes.Id for item in file.Objects] + [layer.Id for layer in file.Layers]
    assert len(set(ids)) == len(ids)
    assert {uuid.UUID(str(i)).version for i in ids} == {5}


def test_two_processes_a_second_apart_write_the_same_bytes(tmp_path: Path) -> None:
    program = (
        "import sys; from pathlib import Path; from files.write.test_model_3dm import model;"
        "Path(sys.argv[1]).write_bytes(model())"
    )
    contents = []
    for number in range(2):
        path = tmp_path / f"{number}.3dm"
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(TESTS), *sys.path])}
        subprocess.run([sys.executable, "-c", program, str(path)], check=True, env=environment)
        contents.append(path.read_bytes())
        time.sleep(1.1)
    assert contents[0] == contents[1]


def test_no_time_is_written() -> None:
    record = (0x20008021).to_bytes(4, "little")  # TCODE_PROPERTIES_REVISIONHISTORY of opennurbs_3dm.h
    assert record not in model()
    dated = rhino3dm.File3dm()
    assert record in base64.b64decode(dated.Encode())


def test_a_failed_write_raises_and_leaves_the_older_file(tmp_path: Path) -> None:
    program = """
import resource, sys
from pathlib import Path
from files.write.test_samples import RADIUS, cylinder_mesh, cylinder_net
from lamella.files.write.drawn_layer import DrawnLayer, Repeated
from lamella.files.write.model_3dm import model_bytes
from lamella.files.whole import write_whole
network, lamellas = cylinder_net()
resource.setrlimit(resource.RLIMIT_FSIZE, (10_000, 10_000))
try:
    write_whole(Path(sys.argv[1]), model_bytes(name="x", version="1", surface=cylinder_mesh(), network=network))
except OSError as error:
    print("OSError", error.errno)
"""
    path = tmp_path / "model.3dm"
    path.write_bytes(b"older")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(TESTS), *sys.path])}
    run = subprocess.run(
        [sys.executable, "-c", program, str(path)],
        check=True,
        env=environment,
        capture_output=True,
        text=True,
    )
    assert run.stdout.startswith("OSError")
    assert path.read_bytes() == b"older"
    assert list(tmp_path.iterdir()) == [path]


def test_a_network_with_a_bad_number_is_not_written() -> None:
    network, _ = cylinder_net()
    network.sample_tangents[3, 0] = np.nan
    with pytest.raises(ValueError, match="row 3"):
        model_bytes(name="x", version="1", surface=cylinder_mesh(), network=network)


def fit_spline(s: Floats, values: Floats, slopes: Floats, tolerance: float) -> Spline:
    """A curve alone."""
    return next(fit_splines(s, values, np.array([[0, len(s)]]), slopes[None], np.array([tolerance])))


@pytest.mark.parametrize("count", [2, 3, 4, 5, 17, 200])
@pytest.mark.parametrize("tolerance", [1e-3, 1e-7, 1e-12])
def test_splines_keep_their_tolerance_at_any_number_of_samples(count: int, tolerance: float) -> None:
    s = np.linspace(0, 2 * np.pi, count)
    values, slopes = np.column_stack((np.cos(s), np.sin(s))), np.column_stack((-np.sin(s), np.cos(s)))
    spline = fit_spline(s, values, slopes[[0, -1]], tolerance)
    curve = BSpline(spline.knots, spline.controls, 3)
    np.testing.assert_allclose(curve(s), values, atol=max(tolerance, 1e-14), rtol=0)
    np.testing.assert_allclose(curve(s[[0, -1]], 1), slopes[[0, -1]], atol=1e-9)


def test_splines_leave_samples_out_where_they_can() -> None:
    s = np.linspace(0, 1, 257)
    straight = np.column_stack((s, 2 * s))
    few = fit_spline(s, straight, np.array([[1.0, 2.0], [1.0, 2.0]]), 1e-9)
    assert len(few.controls) == 256 // 16 + 3
    wild = np.column_stack((np.cos(300 * s), s))
    all_of_them = fit_spline(s, wild, np.array([[0.0, 1.0], [0.0, 1.0]]), 1e-9)
    assert len(all_of_them.controls) == 257 + 2


def test_splines_of_many_curves_are_those_of_each(monkeypatch: pytest.MonkeyPatch) -> None:
    """Against scipy's interpolation of the same samples, whatever curves they are worked on with."""
    monkeypatch.setattr(splines, "TOGETHER", 300)
    counts = [2, 33, 3, 400, 18, 200, 5, 100]
    offsets = np.r_[0, np.cumsum(counts)]
    # a sample between curves belongs to none of them
    spans = np.column_stack((offsets[:-1], offsets[1:])) + np.arange(len(counts))[:, None]
    t = np.zeros(spans[-1, 1])
    for k, (first, end) in enumerate(spans.tolist()):
        t[first:end] = k + np.linspace(0, 1, end - first) ** 1.2 * 3
    values = np.column_stack((np.sin(5 * t), np.cos(3 * t), t))
    slopes = np.column_stack((5 * np.cos(5 * t), -3 * np.sin(3 * t), np.ones_like(t)))
    ends = slopes[np.column_stack((spans[:, 0], spans[:, 1] - 1))]
    fitted = list(fit_splines(t, values, spans, ends, np.full(len(counts), 1e-5)))
    assert len({len(spline.controls) for spline in fitted}) > 3
    for (first, end), spline, slope in zip(spans.tolist(), fitted, ends, strict=True):
        own = t[first:end] - t[first]
        sites = np.unique(spline.knots)
        kept = np.searchsorted(own, sites)
        conditions = ([(1, slope[0])], [(1, slope[1])])
        expected = make_interp_spline(sites, values[first:end][kept], k=3, bc_type=conditions)
        np.testing.assert_allclose(spline.knots, expected.t, atol=1e-15)
        np.testing.assert_allclose(spline.controls, expected.c, atol=1e-12)
        np.testing.assert_allclose(expected(own), values[first:end], atol=1e-5)


def test_many_places_have_their_names_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """Names say id and place; user text, which is as large as all else of a place, is left out of many."""
    network, _ = cylinder_net(per_cell=16)
    corners = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], float)
    triangles = np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])
    labels = tuple(f"node {k}" for k in range(200))
    places = np.arange(600.0).reshape(-1, 3), np.tile(np.eye(3), (200, 1, 1))
    layer = DrawnLayer("bolt", repeated=(Repeated("bolt-1", corners, triangles, *places, labels, {"id": "bolt-1"}),))

    def written() -> tuple[int, list[Any]]:
        content = model_bytes(name="n", version="1", surface=cylinder_mesh(), network=network, further=(layer,))
        return len(content), [one for one in read(content)[1]["bolt"] if "block" not in one.Attributes.Name]

    large, told = written()
    assert [one.Attributes.GetUserString("place") for one in told] == list(labels)
    monkeypatch.setattr(model_3dm, "TEXTS_MOST", 199)
    small, named = written()
    assert [one.Attributes.Name for one in named] == [f"bolt-1 {label}" for label in labels]
    assert not any(one.Attributes.GetUserStrings() for one in named)
    assert (large - small) / 200 > 300
