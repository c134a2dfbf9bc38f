"""Warm frames: those of a project whatever came before; stresses of lines agree with those of strips."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lamella
from interactive.designs import RINGS, write
from lamella.base.progress import silent
from lamella.interactive.edits import Design, edited
from lamella.interactive.exact_frame import exact_frame, exact_results
from lamella.interactive.fields import fields_of, key_help
from lamella.interactive.frame import Frame, triangles
from lamella.interactive.point_stresses import mesh_points
from lamella.interactive.warm_frame import WarmFrames, total_length
from lamella.project.tables import SURFACE_TABLES, Project
from lamella.surface.element.places import Places
from lamella.view.scene.encode import encode_scene
from lamella.view.scene.layer import LinesLayer
from lamella.view.scene.scene import make_scene

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.toml"))


def moved(path: Path, shift: float) -> Project:
    design = Design.of(path.read_text(), path)
    text = edited(design, {"do": "move", "handles": {"0.points.1": [2.1213, 2.1213, shift]}})
    return Design.of(text, path).project


def test_frames_do_not_drift(tmp_path: Path) -> None:
    path, frames = write(tmp_path, RINGS), WarmFrames()
    first = frames.frame(moved(path, 0.0), tmp_path, silent)
    draws = np.random.default_rng(4)
    for _ in range(6):
        other = frames.frame(moved(path, float(0.02 + draws.uniform(high=0.05))), tmp_path, silent)
        assert other.details["made_anew"] == ""
    again = frames.frame(moved(path, 0.0), tmp_path, silent)
    assert np.abs(other.arrays["vertices"] - first.arrays["vertices"]).max() > 1e-3
    for name in ("vertices", "lines", "line_values"):
        assert np.array_equal(again.arrays[name], first.arrays[name]), name


@pytest.mark.slow
def test_figures_of_lines_are_those_of_strips(tmp_path: Path) -> None:
    """Lengths and stresses of a warm frame agree with a whole net within what coarse elements allow."""
    path = write(tmp_path, RINGS.replace("radius = 2.0", "radius = 2.6"))
    project = lamella.read_project(path)
    warm = WarmFrames().frame(project, tmp_path, silent)
    exact = exact_frame(exact_results(project, tmp_path, lamella.Memory(), silent))
    for key, share in (("area", 1e-4), ("total_length", 5e-3), ("utilisation_max", 0.02), ("mass", 0.02)):
        assert warm.figures[key] == pytest.approx(exact.figures[key], rel=share), key


@pytest.mark.slow
def test_curvatures_on_the_nets_elements_are_those_of_the_surface() -> None:
    rings = [lamella.circle((0, 0, z), 3.0) for z in (0.0, 2.5)]
    errors = []
    for tolerance in (0.03, 0.003):
        net = lamella.follow_net(lamella.follow(rings, tolerance=tolerance).surface, cells=10)
        mesh = net.coordinates.mesh
        where = Places.everywhere(len(mesh.connectivity.elements), np.array([[0.2, 0.3], [0.5, 0.1]]))
        points = mesh_points(mesh, 0.0, where)
        # a catenoid: tg = c / r^2, |grad ln mu| = |d ln mu / ds| = |z'| / r
        r = np.linalg.norm(points.position[:, :2], axis=1)
        waist = np.median(np.abs(points.deviator) * r**2)
        slope = np.sqrt(1 - (waist / r) ** 2) / r
        errors.append(np.abs(np.abs(points.log_mu_gradient) - slope).max() / slope.max())
    assert errors[1] < errors[0] / 3
    assert errors[1] < 0.02


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_every_example_has_fields_and_handles(path: Path) -> None:
    """Each handle put where it is, and each field set to its value, changes nothing."""
    design = Design.of(path.read_text("utf-8"), path)
    kept = {handle.id: list(handle.at) for handle in design.handles if handle.kind != "normal"}
    text = edited(design, {"do": "move", "handles": kept})
    again = Design.of(text, path)
    assert [one.id for one in again.handles] == [one.id for one in design.handles]
    for one, other in zip(again.handles, design.handles, strict=True):
        assert np.allclose(one.at, other.at, atol=2 * 10.0**-design.decimals)
    fields = fields_of(design.project, design.values, design.handles, 10.0)
    assert len(fields) > 8
    help_ = key_help(design.project.surface.kind)
    for field in fields:
        assert field["help"]
        if field["kind"] != "choice":
            assert field["min"] <= field["value"] <= field["max"], field
        if "shift" not in field:
            assert ".".join(key for key in field["path"] if isinstance(key, str)) in help_
            set_ = edited(design, {"do": "set", "values": [[field["path"], field["value"]]]})
            assert Design.of(set_, path).project == design.project, field


def test_every_kind_of_surface_has_help() -> None:
    for kind in SURFACE_TABLES:
        found = key_help(kind)
        assert all(row["help"] for key, row in found.items() if "." in key and not key.endswith("kind")), kind


def test_units_of_a_loop_are_kept(tmp_path: Path) -> None:
    text = RINGS.replace('name = "ring"', 'name = "ring"\nunit = "mm"').replace(
        "[0.0, 0.0, 2.0], radius = 2.0", "[0, 0, 2000], radius = 2000"
    )
    design = Design.of(text, write(tmp_path, text))
    center = next(one for one in design.handles if one.id == "1.circle.center")
    assert center.at == (0.0, 0.0, 2.0)
    new = edited(
        design, {"do": "move", "handles": {"1.circle.center": [0.0, 0.1234, 2.0], "1.circle.radius": [1.5, 0, 2]}}
    )
    assert "center = [0, 123.4, 2000], radius = 1500.0" in new
    up = edited(design, {"do": "shift", "loop": 1, "by": [0.0, 0.0, 0.25]})
    assert "center = [0, 0, 2250.0]" in up


def test_points_of_parts_are_moved_together(tmp_path: Path) -> None:
    path = EXAMPLES[14]
    assert path.stem == "15_vault"
    design = Design.of(path.read_text("utf-8"), path)
    shared = next(one for one in design.handles if len(one.paths) == 2)
    to = [shared.at[0] + 0.1, shared.at[1], shared.at[2]]
    again = Design.of(edited(design, {"do": "move", "handles": {shared.id: to}}), path)
    assert next(one for one in again.handles if one.id == shared.id).at == pytest.approx(to)
    assert len(again.handles) == len(design.handles)


def test_loops_are_drawn_and_taken_out(tmp_path: Path) -> None:
    path = write(tmp_path, RINGS)
    design = Design.of(RINGS, path)
    new = edited(design, {"do": "add_hole", "center": [1.5, 0.0, 0.5], "radius": 0.4})
    more = Design.of(new, path)
    assert [loop.name for loop in more.project.surface.boundary] == ["base", "ring", "hole 2"]  # type: ignore[union-attr]
    assert edited(more, {"do": "remove_loop", "loop": 2}) == RINGS
    square = [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 1]]
    sketched = Design.of(
        edited(design, {"do": "sketch", "points": square, "as": "outer", "interpolation": "polyline"}), path
    )
    loop: Any = sketched.project.surface.boundary[0]  # type: ignore[union-attr]
    assert (loop.points[3], loop.interpolation, loop.name) == ((0.0, 4.0, 1.0), "polyline", "base")


def test_a_point_that_is_put_in_lies_on_the_curve(tmp_path: Path) -> None:
    path = write(tmp_path, RINGS)
    design = Design.of(RINGS, path)
    again = Design.of(edited(design, {"do": "insert_point", "loop": 0, "after": 7}), path)
    new: Any = again.project.surface.boundary[0].points[8]  # type: ignore[union-attr]
    # on the circle within what the cubic through four of eight points leaves
    assert np.linalg.norm(new) == pytest.approx(3.0, rel=1e-2)
    assert edited(again, {"do": "delete_point", "loop": 0, "index": 8}) == RINGS


def test_messages_hold_the_arrays() -> None:
    layer = LinesLayer(name="l", label="L", positions=np.arange(6.0).reshape(2, 3), offsets=np.array([0, 2]))
    scene = make_scene("x", [layer])
    frame = Frame("coarse", {"vertices": layer.positions, "nodes": np.arange(6.0).reshape(2, 3)}, {}, scene)
    raw = frame.message("frame", 7, {"revision": 3})
    count = int.from_bytes(raw[:4], "little")
    assert (4 + count) % 4 == 0
    assert raw[4 + count :][:24] == np.arange(6, dtype="<f4").tobytes()
    assert raw[4 + count + 24 :].rstrip(b"\0") == encode_scene(scene).rstrip(b"\0")


def test_faces_and_lengths() -> None:
    assert triangles(np.array([[0, 1, 2, 2], [3, 4, 5, 6]])).tolist() == [[0, 1, 2], [3, 4, 5], [3, 5, 6]]
    points = np.array([[0.0, 0, 0], [1, 0, 0], [9, 9, 9], [9, 9, 11]])
    assert total_length(points, np.array([0, 2, 4])) == 3.0
    assert Frame("coarse", {"vertices": points}, {}, make_scene("x", [])).size == pytest.approx(np.sqrt(81 + 81 + 121))
