"""surface.3dm: its NURBS, read back and evaluated by rhino3dm, against the curved triangles they were made from."""

from __future__ import annotations

import dataclasses
import os
import subprocess
import sys
import time
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rhino3dm

import lamella
from lamella.base.arrays import Floats
from lamella.files.write import surface_3dm
from lamella.files.write.surface_3dm import sag, surface_3dm_bytes, write_surface_3dm
from lamella.stages.write import write_files
from lamella.surface.element.places import Places
from lamella.surface.element.surface import ElementSurface
from stages.other_surface import on_surface
from surface.element.exact_elements import catenoid_patch, sphere_cap, whole_catenoid

TESTS = Path(__file__).parents[2]
SURFACES = {"patch": catenoid_patch, "cap": sphere_cap, "rings": whole_catenoid}
CORNERS = np.array([[0.0, 0], [1, 0], [0, 1]])


@pytest.fixture(params=[(kind, order) for kind in SURFACES for order in (2, 3, 4)], ids=str)
def surface(request: pytest.FixtureRequest) -> ElementSurface:
    kind, order = request.param
    return SURFACES[kind](order)


def content(surface: ElementSurface) -> bytes:
    return surface_3dm_bytes(surface, name="Saddle Ü", version="1.2.3")


def read(surface: ElementSurface) -> tuple[Any, list[Any], list[Any]]:
    """The file, and the objects of its layers "surface" and "boundary"."""
    file = rhino3dm.File3dm.FromByteArray(content(surface))
    assert [layer.Name for layer in file.Layers] == ["surface", "boundary"]
    layers = [[item for item in file.Objects if item.Attributes.LayerIndex == k] for k in range(2)]
    return file, *layers


def text(file: Any) -> dict[str, str]:
    return dict(file.Strings[i] for i in range(len(file.Strings)))


def xyz(point: Any) -> list[float]:
    return [point.X, point.Y, point.Z]


def size(surface: ElementSurface) -> float:
    return float(np.linalg.norm(np.ptp(surface.nodes, axis=0)))


def local_places(corner: int, s: Floats, t: Floats) -> Floats:
    """Where parameters of the patch at a corner lie in its triangle, from the module's description alone."""
    here, onward, back = (CORNERS[(corner + k) % 3] for k in range(3))
    low = (1 - s)[:, None] * here + s[:, None] * (here + onward) / 2
    high = (1 - s)[:, None] * (here + back) / 2 + s[:, None] / 3 * np.ones(2)
    return (1 - t)[:, None] * low + t[:, None] * high


def test_patches_are_the_curved_triangles_to_rounding(surface: ElementSurface) -> None:
    file, patches, _ = read(surface)
    order = surface.connectivity.basis.order
    assert len(patches) == 3 * len(surface.connectivity.elements)
    stated = float(text(file)["lamella\\tolerance_m"])
    assert stated <= 1.05e-12 * size(surface)
    rng = np.random.default_rng(1)
    s, t = np.vstack([rng.random((6, 2)), [[0, 0], [1, 1], [0, 1], [1, 0]]]).T
    worst = 0.0
    for item in patches:
        patch = item.Geometry
        assert patch.IsValid
        assert not patch.IsRational
        assert (patch.Degree(0), patch.Degree(1)) == (order, order)
        assert (patch.SpanCount(0), patch.SpanCount(1)) == (1, 1)
        element, corner = map(int, item.Attributes.Name.split("."))
        there = Places(np.full(len(s), element), local_places(corner, s, t))
        wanted = surface.measured(there)
        points = np.array([xyz(patch.PointAt(a, b)) for a, b in zip(s, t, strict=True)])
        worst = max(worst, float(np.linalg.norm(points - wanted.position, axis=1).max()))
        normals = np.array([xyz(patch.NormalAt(a, b)) for a, b in zip(s, t, strict=True)])
        np.testing.assert_allclose(normals, wanted.normal, atol=1e-9)
    assert worst <= stated


def test_patches_lie_on_the_closed_form_as_the_elements_do() -> None:
    _, patches, _ = read(whole_catenoid(4, 24, 8))
    points = np.array([xyz(item.Geometry.PointAt(a, b)) for item in patches for a in (0.2, 0.7) for b in (0.1, 0.8)])
    assert np.abs(np.hypot(points[:, 0], points[:, 1]) - np.cosh(points[:, 2])).max() < 2e-5
    # none is missing: all around, and from ring to ring
    normals = np.array([xyz(item.Geometry.NormalAt(0.5, 0.5)) for item in patches])
    outwards = np.array([xyz(item.Geometry.PointAt(0.5, 0.5)) for item in patches]) * [1, 1, 0]
    assert ((normals * outwards).sum(1) > 0.5).all()


def test_patches_share_their_edges_and_only_the_boundary_is_free(surface: ElementSurface) -> None:
    _, patches, _ = read(surface)
    along = np.linspace(0, 1, 5)
    zero, one = np.zeros(5), np.ones(5)
    sides = [(along, zero), (one, along), (along[::-1], one), (zero, along[::-1])]
    edges = np.array(
        [[xyz(item.Geometry.PointAt(a, b)) for a, b in zip(*side, strict=True)] for item in patches for side in sides]
    )
    near = 1e-13 * size(surface)
    middles, free = edges[:, 2], np.ones(len(edges), bool)
    order = np.argsort(middles @ [1.0, 0.7310, 0.3917])
    for a, b in zip(order[:-1].tolist(), order[1:].tolist(), strict=True):
        if np.linalg.norm(middles[a] - middles[b]) < near:
            # counter-clockwise neighbours run along their edge in opposite directions, whatever its parameter
            np.testing.assert_allclose(edges[a], edges[b][::-1], atol=near, rtol=0)
            free[[a, b]] = False
    assert free.sum() == 2 * len(surface.connectivity.rim_elements)


def test_boundary_is_one_closed_curve_a_loop_with_the_surface_to_its_left(surface: ElementSurface) -> None:
    _, _, curves = read(surface)
    rim, p = surface.connectivity.rim_nodes, surface.connectivity.basis.order
    assert len(curves) == len(np.unique(surface.rim_loop))
    starts = {tuple(surface.nodes[nodes[0]].tolist()): nodes for nodes in rim}
    count = 0
    for number, item in enumerate(curves):
        curve = item.Geometry
        assert curve.IsValid
        assert curve.IsClosed
        assert curve.Degree == p
        assert item.Attributes.Name == f"boundary {number + 1}"
        breaks = sorted(set(curve.Knots))
        count += len(breaks) - 1
        for begin, end in pairwise(breaks):
            key = min(starts, key=lambda point: np.linalg.norm(np.subtract(point, xyz(curve.PointAt(begin)))))
            nodes = surface.nodes[starts[key]]
            # at the nodes' parameters an element's edge passes through its nodes: p + 1 points say all
            points = [xyz(curve.PointAt(begin + (end - begin) * k / p)) for k in range(p + 1)]
            np.testing.assert_allclose(points, nodes, atol=1e-13 * size(surface), rtol=0)
    assert count == len(rim)


def test_loops_come_in_their_order() -> None:
    _, _, curves = read(whole_catenoid(3))
    heights = [xyz(item.Geometry.PointAtStart)[2] for item in curves]
    assert heights == pytest.approx([1.1, -0.8])
    assert [dict(item.Attributes.GetUserStrings())["loop"] for item in curves] == ["1", "2"]
    # a ring's length, as the parameter tells it, within the chords of the nodes
    length = curves[0].Geometry.Domain.T1
    assert length == pytest.approx(2 * np.pi * np.cosh(1.1), rel=5e-3)


def test_units_text_and_group() -> None:
    surface = sphere_cap(3)
    file, patches, curves = read(surface)
    assert file.Settings.ModelUnitSystem == rhino3dm.UnitSystem.Meters
    assert file.ApplicationName == "lamella"
    said = text(file)
    assert said["lamella\\project"] == "Saddle Ü"
    assert said["lamella\\version"] == "1.2.3"
    assert float(said["lamella\\mean_curvature"]) == -0.5
    assert f"{len(patches)} Bezier patches of degree 3 x 3" in said["lamella\\surface"]
    assert all(tuple(item.Attributes.GetGroupList2()) == (0,) for item in patches)
    ids = [item.Attributes.Id for item in file.Objects] + [layer.Id for layer in file.Layers]
    assert len(set(ids)) == len(ids)
    assert dict(curves[0].Attributes.GetUserStrings())["version"] == "1.2.3"


def test_too_many_patches_are_one_mesh_that_says_how_near_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    surface = sphere_cap(4)
    monkeypatch.setattr(surface_3dm, "MOST_PATCHES", 3 * len(surface.connectivity.elements) - 1)
    file, (item,), curves = read(surface)
    stated = float(text(file)["lamella\\tolerance_m"])
    assert stated <= 1e-4 * size(surface)
    assert f"within {stated:.1e} m" in text(file)["lamella\\surface"]
    assert dict(item.Attributes.GetUserStrings())["tolerance_m"] == f"{stated:.1e}"
    mesh = item.Geometry
    points = np.array([xyz(p) for p in mesh.Vertices.ToPoint3dArray()])
    faces = np.array([list(mesh.Faces[i])[:3] for i in range(mesh.Faces.Count)])
    weights = np.random.default_rng(2).dirichlet(np.ones(3), 50)
    distance = np.abs(np.linalg.norm(np.einsum("kc,fcd->fkd", weights, points[faces]), axis=2) - 2)
    # the elements themselves are within 2e-7 of the sphere
    assert 0.8 * stated < distance.max() < stated + 2e-7
    normals = np.cross(points[faces[:, 1]] - points[faces[:, 0]], points[faces[:, 2]] - points[faces[:, 0]])
    assert ((normals * points[faces[:, 0]]).sum(1) > 0).all()
    assert curves[0].Geometry.Degree == 4


def test_sag_falls_with_the_square_of_the_parts() -> None:
    surface = sphere_cap(4)
    sags = [sag(surface, parts) for parts in (1, 2, 4, 8)]
    np.testing.assert_allclose(np.divide(sags[:-1], sags[1:]), 4, rtol=0.1)
    # a chord of length l on a sphere of radius 2 is l^2 / 16 away from it, a triangle's middle l^2 / 12
    edges = surface.nodes[surface.connectivity.faces]
    longest = np.linalg.norm(edges - np.roll(edges, 1, 1), axis=2).max()
    assert longest**2 / 16 / 64 < 1.05 * sags[-1] < longest**2 / 10 / 64


def test_far_from_the_origin_the_tolerance_is_that_of_the_coordinates() -> None:
    near = catenoid_patch(4)
    away = np.array([4e5, 5e6, 100.0])
    far = dataclasses.replace(near, nodes=near.nodes + away)
    file, patches, _ = read(far)
    stated = float(text(file)["lamella\\tolerance_m"])
    assert stated == pytest.approx(5e-6, rel=0.1)
    for item in patches[::7]:
        element, corner = map(int, item.Attributes.Name.split("."))
        there = Places(np.array([element]), local_places(corner, np.array([0.3]), np.array([0.6])))
        off = xyz(item.Geometry.PointAt(0.3, 0.6)) - away - near.measured(there).position[0]
        assert np.linalg.norm(off) < 1e-8 < stated


def test_two_processes_a_second_apart_write_the_same_bytes(tmp_path: Path) -> None:
    program = (
        "import sys; from pathlib import Path; from files.write.test_surface_3dm import content, whole_catenoid;"
        "Path(sys.argv[1]).write_bytes(content(whole_catenoid(3)))"
    )
    contents = []
    for number in range(2):
        path = tmp_path / f"{number}.3dm"
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(TESTS), *sys.path])}
        subprocess.run([sys.executable, "-c", program, str(path)], check=True, env=environment)
        contents.append(path.read_bytes())
        time.sleep(1.1)
    assert contents[0] == contents[1]


def test_a_surface_with_a_bad_number_is_not_written(tmp_path: Path) -> None:
    surface = sphere_cap(2)
    surface.nodes[3, 0] = np.nan
    with pytest.raises(ValueError, match="row 3"):
        write_surface_3dm(tmp_path / "s.3dm", surface, name="x", version="1")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("make", [sphere_cap, None])
def test_a_run_writes_it_where_the_surface_is_of_curved_triangles(
    make: Callable[[int], ElementSurface] | None, tmp_path: Path
) -> None:
    project = lamella.parse_project({"name": "cap", "surface": {"kind": "cylinder", "radius": 1.0, "height": [0, 1]}})
    results = lamella.compute(project, until="surface")
    if make:
        surface = make(3)
        results = on_surface(results, surface)
    said: list[str] = []
    write_files(results, tmp_path, progress=lambda report: said.append(str(report)))
    assert (tmp_path / "surface.3dm").exists() == (make is not None)
    assert ("  surface.3dm" in said) == (make is not None)
    if make:
        file = rhino3dm.File3dm.Read(str(tmp_path / "surface.3dm"))
        assert text(file)["lamella\\version"] == lamella.__version__
