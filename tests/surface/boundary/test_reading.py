"""Drawings as CAD saves them: gaps, doubled lines, blocks, several layers, escaped names, smooth rims as polylines."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import orjson
import pytest
import rhino3dm

from lamella import InputError, parse_project
from lamella.stages.surface.boundary_of_tables import boundary_loops
from lamella.surface.boundary import CORNER_ANGLE, Loop
from lamella.surface.boundary.smooth_polyline import LITTLE
from refusals import refused, warned

T = np.linspace(0, 1, 301)[:-1]


def loop_of(folder: Path, file: str = "c.dxf", **table: Any) -> Loop:
    project = parse_project({"surface": {"kind": "form-found", "boundary": [{"file": file, **table}]}})
    (loop,) = boundary_loops(project.surface, folder)  # type: ignore[arg-type]
    return loop


def check_refused(
    folder: Path, file: str = "c.dxf", *, numbers: Sequence[float] = (), names: Sequence[str] = (), **table: Any
) -> InputError:
    with refused("surface.boundary[0].file", numbers, names) as error:
        loop_of(folder, file, **table)
    return error.value


def drawing(unit: int = 4) -> tuple[Any, Any]:
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = unit
    return document, document.modelspace()


def rim(t: Any, size: float = 5000.0) -> Any:
    """A smooth closed curve, analytic, in the unit of a drawing."""
    a = 2 * np.pi * np.asarray(t)
    x = size * np.cos(a) * (1 + 0.1 * np.cos(2 * a))
    return np.stack([x, 0.7 * size * np.sin(a), 0.15 * size * np.cos(2 * a + 0.3)], axis=-1)


def distance(loop: Loop, points: Any) -> float:
    """Largest distance of points from a loop, m."""
    dense = loop.at(np.arange(40_000) / 40_000)
    along = np.roll(dense, -1, 0) - dense
    from scipy.spatial import cKDTree

    off, near = cKDTree(dense).query(points)
    away, t = points - dense[near], along[near] / np.linalg.norm(along[near], axis=1)[:, None]
    return float(np.sqrt(np.maximum(off**2 - (away * t).sum(1) ** 2, 0)).max())


# --- polylines that mean curves ---------------------------------------------------------------------------------


@pytest.mark.parametrize("bulge", [0.0, 1e-13])
@pytest.mark.parametrize("where", ["model", "block", "old"])
def test_plane_polylines_mean_curves_too(tmp_path: Path, where: str, bulge: float) -> None:
    """LWPOLYLINE and the old POLYLINE have a bulge a vertex: straight where it is nought but for rounding."""
    document, space = drawing()
    angle = 2 * np.pi * np.arange(48) / 48
    ring = np.column_stack([1000 * np.cos(angle), 800 * np.sin(angle)])
    points = [(x, y, bulge) for x, y in ring.tolist()]
    if where == "old":
        space.add_polyline2d(points, format="xyb", close=True)
    elif where == "model":
        space.add_lwpolyline(points, format="xyb", close=True)
    else:
        small = [(x / 9, y / 9, b) for x, y, b in points]
        document.blocks.new("OCULUS").add_lwpolyline(small, format="xyb", close=True)
        space.add_blockref("OCULUS", (0, 0), dxfattribs={"xscale": 9, "yscale": 9, "zscale": 9})
    document.saveas(tmp_path / "c.dxf")
    for interpolation in (None, "spline"):
        loop = loop_of(tmp_path, interpolation=interpolation)
        assert not len(loop.corners)
        x = loop.at(T)
        # the ellipse itself within the error of quintic splines, far below a facet's height of 2 mm
        assert np.abs(np.hypot(x[:, 0], x[:, 1] / 0.8) - 1).max() < 1e-6
    assert len(loop_of(tmp_path, interpolation="polyline").corners) == 48


@pytest.mark.parametrize("count", [45, 2000])
def test_a_smooth_rim_saved_as_a_polyline_is_the_curve_again(tmp_path: Path, count: int) -> None:
    document, space = drawing()
    space.add_polyline3d(rim(np.arange(count) / count), close=True)
    document.saveas(tmp_path / "c.dxf")
    loop = loop_of(tmp_path)
    assert not (loop.turns > CORNER_ANGLE).any()
    ways = ['interpolation = "spline"', 'interpolation = "polyline"']
    warned(loop.remarks, "polyline_smooth", [count] if count < 1000 else [], ways)
    # between its vertices too: a periodic quintic through n points of an analytic curve
    assert distance(loop, rim(T) / 1000) < (2e-4 if count == 45 else 1e-6)
    said = loop_of(tmp_path, interpolation="spline")
    assert 'interpolation = "polyline"' not in warned(said.remarks, "polyline_smooth")
    np.testing.assert_array_equal(said.at(T), loop.at(T))


def test_the_quintic_through_a_polyline_converges(tmp_path: Path) -> None:
    """With order six in the spacing (de Boor, A practical guide to splines, chapter XII)."""
    off = []
    for count in (40, 80):
        document, space = drawing()
        space.add_polyline3d(rim(np.arange(count) / count), close=True)
        document.saveas(tmp_path / "c.dxf")
        off.append(distance(loop_of(tmp_path), rim(T) / 1000))
    assert off[1] < off[0] / 2**5


def test_polylines_that_mean_their_corners_keep_them(tmp_path: Path) -> None:
    document, space = drawing()
    twelve = rim(np.arange(12) / 12)
    space.add_polyline3d(twelve, close=True)
    document.saveas(tmp_path / "c.dxf")
    polygon = loop_of(tmp_path)
    assert len(polygon.corners) == 12
    assert not polygon.remarks
    smooth = loop_of(tmp_path, interpolation="spline")
    assert not (smooth.turns > CORNER_ANGLE).any()
    assert distance(smooth, twelve / 1000) < 1e-6
    document, space = drawing()
    space.add_polyline3d(rim(np.arange(60) / 60), close=True)
    document.saveas(tmp_path / "c.dxf")
    kept = loop_of(tmp_path, interpolation="polyline")
    assert len(kept.corners) == 60
    assert np.degrees(kept.turns).max() < LITTLE
    assert not kept.remarks


def test_true_corners_between_smooth_sides_stay(tmp_path: Path) -> None:
    """Two arcs that meet at 90 degrees: a lens of many short lines."""
    a = np.linspace(-np.pi / 4, np.pi / 4, 25)
    right = np.stack([np.cos(a) - np.cos(np.pi / 4), np.sin(a), 0 * a], axis=1)
    points = 3000 * np.concatenate([right[:-1], (right * [-1, -1, 1])[:-1]])
    document, space = drawing()
    for k in range(len(points)):
        space.add_line(points[k], points[(k + 1) % len(points)])
    document.saveas(tmp_path / "c.dxf")
    loop = loop_of(tmp_path)
    sharp = loop.turns > CORNER_ANGLE
    np.testing.assert_allclose(np.degrees(loop.turns[sharp]), 90, atol=0.5)
    assert sharp.sum() == 2
    assert loop.length == pytest.approx(2 * 3 * np.pi / 2, rel=1e-7)


def test_interpolation_goes_with_polylines_alone(tmp_path: Path) -> None:
    document, space = drawing()
    space.add_circle((0, 0), 3000)
    document.saveas(tmp_path / "c.dxf")
    with refused("surface.boundary[0].file", names=["interpolation"]):
        loop_of(tmp_path, interpolation="spline")


# --- gaps, doubled and zero-length lines ------------------------------------------------------------------------


@pytest.mark.parametrize("gap", [0.005, 0.09])
@pytest.mark.parametrize("kind", ["lines", "arcs", "spline"])
def test_gaps_within_the_tolerance_of_cad_are_closed(tmp_path: Path, kind: str, gap: float) -> None:
    document, space = drawing()
    if kind == "lines":
        corners = np.array([(0, 0, 0), (6000, 0, 900), (6000, 4000, 0), (0, 4000, 900)], float)
        for k in range(4):
            space.add_line(corners[k] + (gap, 0, 0) * np.array(k == 0), corners[(k + 1) % 4])
        exact = None
    elif kind == "arcs":
        space.add_line((0, 0), (4000, 0))
        space.add_arc((4000, 1000), 1000, -90, 90)
        space.add_line((4000, 2000 + gap), (0, 2000 + gap))
        space.add_arc((0, 1000), 1000, 90, 270)
        exact = 8 + 2 * math.pi
    else:
        points = rim(np.linspace(0, 1, 60))
        points[-1] += (0, gap, 0)
        space.add_spline(points)
        exact = None
    document.saveas(tmp_path / "c.dxf")
    loop = loop_of(tmp_path)
    warned(loop.remarks, "gaps_closed", [gap])
    ends = loop.at(loop.corners[loop.turns > CORNER_ANGLE])
    # nothing moves by more than the gap
    if exact:
        assert loop.length == pytest.approx(exact, abs=4 * gap / 1000)
    # where the drawing is tangent, closing makes no corner
    # (the spline's own tangents at the two sides of the gap differ)
    assert len(ends) == {"lines": 4, "arcs": 0, "spline": 1}[kind]


def test_wider_gaps_are_refused_with_their_place(tmp_path: Path) -> None:
    document, space = drawing()
    space.add_polyline3d([(0, 0, 0), (8000, 0, 500), (8000, 5000, 0), (0, 5000, 500), (0, 17.5, 0)])
    document.saveas(tmp_path / "c.dxf")
    check_refused(tmp_path, numbers=[17.5], names=["(0, 0.0175, 0) m"])
    # a smaller closed curve beside it is not taken for the boundary, but by name
    circle = space.add_circle((4000, 2500), 700)
    document.saveas(tmp_path / "c.dxf")
    check_refused(tmp_path, numbers=[17.5, 1.4 * math.pi], names=[f'id = "{circle.dxf.handle}"'])
    assert loop_of(tmp_path, id=circle.dxf.handle).length == pytest.approx(1.4 * math.pi)


def test_doubled_points_and_lines_and_lines_of_no_length_are_left_out(tmp_path: Path) -> None:
    corners = [(0, 0, 0), (6000, 0, 900), (6000, 4000, 0), (0, 4000, 900)]
    document, space = drawing()
    for k in range(4):
        space.add_line(corners[k], corners[(k + 1) % 4])
    space.add_line(corners[2], corners[1])
    space.add_line(corners[3], corners[3])
    space.add_line(corners[0], (0.01, 0, 0))
    document.saveas(tmp_path / "c.dxf")
    exact = loop_of(tmp_path)
    assert len(exact.corners) == 4
    assert len(exact.remarks) == 2
    document, space = drawing()
    near = [(x + 0.02, y, z) for x, y, z in corners]
    space.add_polyline3d([point for pair in zip(corners, near, strict=True) for point in pair], close=True)
    document.saveas(tmp_path / "c.dxf")
    loop = loop_of(tmp_path)
    assert len(loop.corners) == 4
    np.testing.assert_allclose(np.degrees(loop.turns), np.degrees(exact.turns), atol=1e-2)


# --- layers, names ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("written", "shown"), [("D\\U+00E4ch\\U+7E01", "Däch縁"), ("%%c60 %%d %%p1", "Ø60 ° ±1"), ("Rand", "RAND")]
)
def test_escaped_layer_names(tmp_path: Path, written: str, shown: str) -> None:
    document, space = drawing()
    space.add_circle((0, 0), 2000, dxfattribs={"layer": "PLACE"})
    space.add_circle((0, 0), 900, dxfattribs={"layer": "other"})
    document.saveas(tmp_path / "c.dxf")
    text = (tmp_path / "c.dxf").read_text(encoding="utf-8")
    (tmp_path / "c.dxf").write_text(text.replace("PLACE", written), encoding="utf-8")
    assert loop_of(tmp_path, layer=shown).length == pytest.approx(4 * math.pi)


def test_a_curve_over_several_layers(tmp_path: Path) -> None:
    document, space = drawing()
    corners = [(0, 0, 0), (6000, 0, 900), (6000, 4000, 0), (0, 4000, 900)]
    for k, layer in enumerate(("a", "b", "a", "c")):
        space.add_line(corners[k], corners[(k + 1) % 4], dxfattribs={"layer": layer})
    document.saveas(tmp_path / "c.dxf")
    loop = loop_of(tmp_path)
    assert len(loop.corners) == 4
    assert all(repr(layer) in loop.remarks[0] for layer in "abc")
    check_refused(tmp_path, names=["b", "c"], layer="a")
    # followed to the letter, beside another closed curve
    space.add_circle((3000, 2000), 800, dxfattribs={"layer": "hole"})
    document.saveas(tmp_path / "c.dxf")
    (named,) = re.findall(r'id = "(.*?)"', check_refused(tmp_path, layer="a").remedy)
    again = loop_of(tmp_path, id=named)
    assert again.length == pytest.approx(loop.length)
    assert all(repr(layer) in again.remarks[0] for layer in "abc")


def test_a_chain_is_chosen_by_the_id_that_messages_name_it_by(tmp_path: Path) -> None:
    """Two chains of two polylines each on one layer, one of them drawn twice: each of four ids names one."""
    document, space = drawing()
    lengths = {}
    for size in (6000.0, 2000.0):
        points = rim(T[::5], size)
        for part in (points[:31], np.vstack([points[30:], points[:1]])):
            line = space.add_polyline3d(part.tolist())
            lengths[line.dxf.handle] = size
    space.add_polyline3d(rim(T[::5], 2000.0)[:31].tolist())
    document.saveas(tmp_path / "c.dxf")
    listed = re.findall(r"id '(.*?)'", check_refused(tmp_path).message)
    assert len(listed) == 2
    assert set(listed) < set(lengths)
    for handle, size in lengths.items():
        assert np.ptp(loop_of(tmp_path, id=handle).at(T)[:, 0]) == pytest.approx(2.2 * size / 1000, rel=1e-3)
    # a curve that joins to nothing is refused as before
    lone = space.add_line((0, 0, 9000), (900, 0, 9000))
    document.saveas(tmp_path / "c.dxf")
    check_refused(tmp_path, names=[lone.dxf.handle], id=lone.dxf.handle)


@pytest.mark.parametrize("way", ["off", "freeze", "object"])
def test_hidden_curves_are_left_out_or_said(tmp_path: Path, way: str) -> None:
    document, space = drawing()
    layer = document.layers.add("old")
    ring = space.add_circle((0, 0), 2000, dxfattribs={"layer": "old"})
    if way == "object":
        ring.dxf.invisible = 1
    else:
        getattr(layer, way)()
    document.saveas(tmp_path / "c.dxf")
    warned(loop_of(tmp_path).remarks, "curve_hidden")
    space.add_circle((0, 0), 3000)
    document.saveas(tmp_path / "c.dxf")
    assert loop_of(tmp_path).length == pytest.approx(6 * math.pi)
    assert loop_of(tmp_path, layer="old").length == pytest.approx(4 * math.pi)


def test_beginnings_of_ids(tmp_path: Path) -> None:
    model = rhino3dm.File3dm()
    model.Settings.ModelUnitSystem = rhino3dm.UnitSystem.Meters
    for radius in (1.0, 2.0, 3.0):
        model.Objects.AddCircle(rhino3dm.Circle(rhino3dm.Point3d(0, 0, 0), radius))
    assert model.Write(str(tmp_path / "c.3dm"), 8)
    ids = [str(item.Attributes.Id) for item in rhino3dm.File3dm.Read(str(tmp_path / "c.3dm")).Objects]
    for radius, ident in zip((1, 2, 3), ids, strict=True):
        beginning = next(ident[:k] for k in range(1, 37) if sum(one.startswith(ident[:k]) for one in ids) == 1)
        assert loop_of(tmp_path, "c.3dm", id=beginning).length == pytest.approx(2 * math.pi * radius)
    check_refused(tmp_path, "c.3dm", numbers=[3, 2 * math.pi, 4 * math.pi, 6 * math.pi])
    model.Objects.AddCircle(rhino3dm.Circle(rhino3dm.Point3d(0, 0, 0), 4.0), named("rim 1"))
    model.Objects.AddCircle(rhino3dm.Circle(rhino3dm.Point3d(0, 0, 0), 5.0), named("rim 2"))
    assert model.Write(str(tmp_path / "c.3dm"), 8)
    check_refused(tmp_path, "c.3dm", names=["rim 1", "rim 2"], id="rim")


def named(name: str) -> Any:
    about = rhino3dm.ObjectAttributes()
    about.Name = name
    return about


# --- blocks -----------------------------------------------------------------------------------------------------


def test_nested_blocks_put_their_curves_where_they_are(tmp_path: Path) -> None:
    """Against the map written out: scaled unevenly, turned, shifted, twice."""
    document, space = drawing()
    inner = document.blocks.new("inner", base_point=(100, 0, 0))
    inner.add_circle((1000, 0), 500)
    outer = document.blocks.new("outer")
    outer.add_blockref("inner", (200, 300, 50), {"xscale": 2, "yscale": 1, "rotation": 30})
    space.add_blockref("outer", (7000, -1000, 400), {"xscale": 3, "yscale": 3, "zscale": 3, "rotation": -40})
    document.saveas(tmp_path / "c.dxf")
    loop = loop_of(tmp_path)

    def put(points: Any, scale: Any, degrees: float, shift: Any) -> Any:
        a = math.radians(degrees)
        turn = np.array([[math.cos(a), -math.sin(a), 0], [math.sin(a), math.cos(a), 0], [0, 0, 1]])
        return (points * scale) @ turn.T + shift

    ring = np.stack([900 + 500 * np.cos(6 * T), 500 * np.sin(6 * T), 0 * T], axis=1)
    exact = put(put(ring, (2, 1, 1), 30, (200, 300, 50)), (3, 3, 3), -40, (7000, -1000, 400)) / 1000
    assert distance(loop, exact) < 1e-6


def test_the_same_block_twice_is_told_apart_by_its_instances(tmp_path: Path) -> None:
    document, space = drawing()
    block = document.blocks.new("roof")
    block.add_circle((0, 0), 500)
    space.add_blockref("roof", (0, 0), {"xscale": 4, "yscale": 4})
    second = space.add_blockref("roof", (9000, 0), {"xscale": 2, "yscale": 2})
    document.saveas(tmp_path / "c.dxf")
    check_refused(tmp_path, numbers=[2, 4 * math.pi, 2 * math.pi])
    assert loop_of(tmp_path, id=second.dxf.handle).length == pytest.approx(2 * math.pi)


def test_blocks_of_rhino(tmp_path: Path) -> None:
    model = rhino3dm.File3dm()
    model.Settings.ModelUnitSystem = rhino3dm.UnitSystem.Millimeters
    ring = rhino3dm.Circle(rhino3dm.Point3d(1000, 0, 0), 500.0).ToNurbsCurve()
    index = model.InstanceDefinitions.Add("roof", "", "", "", rhino3dm.Point3d(0, 0, 0), (ring,), (named("rim"),))
    block = model.InstanceDefinitions[index] if isinstance(index, int) else model.InstanceDefinitions.FindIndex(0)
    form = rhino3dm.Transform.Translation(5000, 0, 700)
    form = rhino3dm.Transform.Multiply(form, rhino3dm.Transform.Scale(rhino3dm.Point3d(0, 0, 0), 3.0))
    model.Objects.AddInstanceObject(rhino3dm.InstanceReference(block.Id, form), rhino3dm.ObjectAttributes())
    assert model.Write(str(tmp_path / "c.3dm"), 8)
    loop = loop_of(tmp_path, "c.3dm")
    assert loop.length == pytest.approx(3 * math.pi)
    np.testing.assert_allclose(loop.at(T).mean(0), [8, 0, 0.7], atol=1e-9)


# --- what a file does hold --------------------------------------------------------------------------------------


def test_a_drawing_without_curves_says_what_it_holds(tmp_path: Path) -> None:
    document, space = drawing()
    for k in range(3):
        space.add_3dface([(k, 0), (k + 1, 0), (k + 1, 1), (k, 1)])
    space.add_hatch()
    document.layout().add_circle((0, 0), 5)
    document.saveas(tmp_path / "c.dxf")
    check_refused(tmp_path, numbers=[3, 1], names=["3DFACEs"])


def test_edges_of_surfaces_are_curves_where_they_are_named(tmp_path: Path) -> None:
    model = rhino3dm.File3dm()
    model.Settings.ModelUnitSystem = rhino3dm.UnitSystem.Meters
    tube = rhino3dm.Cylinder(rhino3dm.Circle(rhino3dm.Point3d(0, 0, 0), 2.0), 3.0)
    model.Objects.AddBrep(rhino3dm.Brep.CreateFromCylinder(tube, False, False), named("tube"))
    assert model.Write(str(tmp_path / "c.3dm"), 8)
    check_refused(tmp_path, "c.3dm", numbers=[1], names=["tube/1", "tube/2"])
    for number in (1, 2):
        assert loop_of(tmp_path, "c.3dm", id=f"tube/{number}").length == pytest.approx(4 * math.pi)


# --- byte order marks -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-32"])
def test_byte_order_marks(tmp_path: Path, encoding: str) -> None:
    ring = [[math.cos(t), math.sin(t), 0] for t in np.linspace(0, 6, 20)]
    text = orjson.dumps({"unit": "m", "curves": {"rim": {"points": ring}}}).decode()
    (tmp_path / "c.json").write_bytes(text.encode(encoding))
    assert loop_of(tmp_path, "c.json").name == "outer"
