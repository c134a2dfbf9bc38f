"""Curves from written .3dm, .dxf and .json files: exact, in metres, and the right one of several."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import orjson
import pytest
import rhino3dm
from ezdxf.path import make_path
from scipy.spatial import cKDTree

from lamella import InputError, parse_project
from lamella.files.read import curves_json
from lamella.stages.surface.boundary_of_tables import boundary_loops
from lamella.surface.boundary import CORNER_ANGLE, Loop
from refusals import refused

T = np.random.default_rng(4).uniform(0, 1, 300)


def loop_of(folder: Path, **table: Any) -> Loop:
    project = parse_project({"surface": {"kind": "form-found", "boundary": [table]}})
    (loop,) = boundary_loops(project.surface, folder)  # type: ignore[arg-type]
    return loop


def check_refused(
    folder: Path, numbers: Sequence[float] = (), names: Sequence[str] = (), **table: Any
) -> pytest.ExceptionInfo[InputError]:
    with refused("surface.boundary[0].file", numbers, [str(folder), *names]) as error:
        loop_of(folder, **table)
    return error


def drawing(folder: Path, insunits: int = 4) -> Any:
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = insunits
    document.saveas(folder / "c.dxf")
    return document


# --- 3dm --------------------------------------------------------------------------------------------------------


def model(folder: Path, unit: Any, *curves: tuple[str, str, Any]) -> None:
    file = rhino3dm.File3dm()
    file.Settings.ModelUnitSystem = unit
    for layer in sorted({layer for layer, _, _ in curves}):
        file.Layers.AddLayer(layer, (0, 0, 0, 255))
    for layer, name, curve in curves:
        about = rhino3dm.ObjectAttributes()
        about.Name = name
        about.LayerIndex = sorted({layer for layer, _, _ in curves}).index(layer)
        file.Objects.AddCurve(curve, about)
    assert file.Write(str(folder / "c.3dm"), 8)


def rhino_circle(radius: float, x: float = 0.0) -> Any:
    return rhino3dm.Circle(rhino3dm.Point3d(x, 2, 3), radius).ToNurbsCurve()


def points_of(*points: tuple[float, float, float]) -> Any:
    return [rhino3dm.Point3d(*p) for p in points]


@pytest.mark.parametrize(
    ("unit", "metres"),
    [("Millimeters", 1e-3), ("Meters", 1.0), ("Centimeters", 0.01), ("Feet", 0.3048), ("Inches", 0.0254)],
)
def test_a_rational_circle_of_a_3dm_is_exact(tmp_path: Path, unit: str, metres: float) -> None:
    model(tmp_path, getattr(rhino3dm.UnitSystem, unit), ("a", "ring", rhino_circle(50.0)))
    loop = loop_of(tmp_path, file="c.3dm")
    assert loop.length == pytest.approx(2 * math.pi * 50 * metres, rel=1e-13)
    distance = np.linalg.norm(loop.at(T) - np.array([0, 2, 3]) * metres, axis=1)
    np.testing.assert_allclose(distance, 50 * metres, rtol=1e-13)
    assert len(loop.corners) == 0


def test_units_asked_for_win_and_none_is_refused(tmp_path: Path) -> None:
    none = getattr(rhino3dm.UnitSystem, "None")
    model(tmp_path, none, ("a", "ring", rhino_circle(50.0)))
    check_refused(tmp_path, names=['unit = "mm"'], file="c.3dm")
    assert loop_of(tmp_path, file="c.3dm", unit="cm").length == pytest.approx(math.pi)
    model(tmp_path, rhino3dm.UnitSystem.Millimeters, ("a", "ring", rhino_circle(50.0)))
    assert loop_of(tmp_path, file="c.3dm", unit="cm").length == pytest.approx(math.pi)


def off_curve(loop: Any, points: np.ndarray) -> float:
    """Largest distance of points from the chords of a loop: these are off it by the square of their length."""
    dense = loop.at(np.union1d(np.arange(5_001) / 5_000, loop.corners))
    at = cKDTree(dense[:-1]).query(points)[1]
    distances = []
    for begin in (at - 1, at):
        first = dense[begin]
        chord = dense[begin + 1] - first
        # the chord before the first one is the last one
        chord[begin < 0] = dense[-1] - dense[-2]
        first[begin < 0] = dense[-2]
        share = np.clip(((points - first) * chord).sum(1) / (chord**2).sum(1), 0, 1)
        distances.append(np.linalg.norm(points - first - share[:, None] * chord, axis=1))
    return float(np.minimum(*distances).max())


def test_rhino_curves_of_all_kinds_are_evaluated_as_rhino_does(tmp_path: Path) -> None:
    """Points of NURBS, polylines and joined curves are where Rhino's own evaluation puts them."""
    periodic = rhino3dm.NurbsCurve.Create(
        True, 3, points_of((0, 0, 0), (4, 0, 1), (5, 3, 0), (2, 5, 2), (-1, 3, 0), (-2, 1, 1))
    )
    square = rhino3dm.PolylineCurve(
        rhino3dm.Point3dList(points_of((0, 0, 0), (3, 0, 0), (3, 2, 1), (0, 2, 0), (0, 0, 0)))
    )
    mixed = rhino3dm.PolyCurve()
    mixed.Append(rhino3dm.Line(rhino3dm.Point3d(0, 0, 0), rhino3dm.Point3d(4, 0, 0)))
    mixed.Append(rhino3dm.Arc(rhino3dm.Point3d(4, 0, 0), rhino3dm.Point3d(5, 1, 0), rhino3dm.Point3d(4, 2, 0)))
    mixed.Append(rhino3dm.Line(rhino3dm.Point3d(4, 2, 0), rhino3dm.Point3d(0, 2, 0)))
    mixed.Append(rhino3dm.Line(rhino3dm.Point3d(0, 2, 0), rhino3dm.Point3d(0, 0, 0)))
    for curve, corners in ((periodic, 0), (square, 4), (mixed, 2)):
        model(tmp_path, rhino3dm.UnitSystem.Meters, ("a", "x", curve))
        loop = loop_of(tmp_path, file="c.3dm")
        domain = curve.Domain
        u = domain.T0 + (domain.T1 - domain.T0) * np.arange(400) / 400
        exact = np.array([(p.X, p.Y, p.Z) for p in (curve.PointAt(x) for x in u)])
        assert off_curve(loop, exact) < loop.length / 200_000
        assert (loop.turns > CORNER_ANGLE).sum() == corners
    assert loop.length == pytest.approx(4 + math.pi + 4 + 2, rel=1e-13)


def test_layer_and_id_choose_among_rhino_curves(tmp_path: Path) -> None:
    curves = [
        ("Rim", "outer", rhino_circle(9.0)),
        ("Holes", "h1", rhino_circle(1.0)),
        ("Holes", "h2", rhino_circle(2.0)),
    ]
    model(tmp_path, rhino3dm.UnitSystem.Meters, *curves)
    for table, radius in (({"layer": "rim"}, 9), ({"id": "H1"}, 1), ({"layer": "Holes", "id": "h2"}, 2)):
        assert loop_of(tmp_path, file="c.3dm", **table).length == pytest.approx(2 * math.pi * radius)
    ident = next(o.Attributes.Id for o in rhino3dm.File3dm.Read(str(tmp_path / "c.3dm")).Objects)
    assert loop_of(tmp_path, file="c.3dm", id=str(ident)).length == pytest.approx(18 * math.pi)
    lengths = [2 * math.pi, 4 * math.pi]
    check_refused(tmp_path, [2, *lengths], ["Holes", "h1", "h2", "id = ..."], file="c.3dm", layer="Holes")
    check_refused(tmp_path, [18 * math.pi], ["roof", "x", "Rim", "outer"], file="c.3dm", layer="roof", id="x")


def test_files_that_are_none(tmp_path: Path) -> None:
    check_refused(tmp_path, names=["missing.3dm"], file="missing.3dm")
    for name, kind in (("a.3dm", ".3dm"), ("a.dxf", "DXF"), ("a.json", "JSON")):
        for content in (b"what\0is this", b""):
            (tmp_path / name).write_bytes(content)
            check_refused(tmp_path, names=[name, kind], file=name)
    model(tmp_path, rhino3dm.UnitSystem.Meters)
    check_refused(tmp_path, file="c.3dm")


# --- DXF --------------------------------------------------------------------------------------------------------


def test_a_bulge_is_an_exact_arc_in_metres(tmp_path: Path) -> None:
    document = drawing(tmp_path)
    # a slot: two lines and two half circles, the second by a bulge of a quarter twice
    quarter = math.tan(math.pi / 8)
    vertices = [(0, 0, 0), (4000, 0, 1), (4000, 2000, 0), (0, 2000, quarter), (-1000, 1000, quarter)]
    document.modelspace().add_lwpolyline(vertices, format="xyb", close=True, dxfattribs={"elevation": 500})
    document.saveas(tmp_path / "c.dxf")
    loop = loop_of(tmp_path, file="c.dxf")
    assert loop.length == pytest.approx(8 + 2 * math.pi, rel=1e-13)
    x = loop.at(T)
    assert np.abs(x[:, 2] - 0.5).max() < 1e-15
    right, left = x[x[:, 0] > 4], x[x[:, 0] < 0]
    np.testing.assert_allclose(np.hypot(right[:, 0] - 4, right[:, 1] - 1), 1, rtol=1e-13)
    np.testing.assert_allclose(np.hypot(left[:, 0], left[:, 1] - 1), 1, rtol=1e-13)
    assert len(right) > 30
    assert len(left) > 30
    # lines and arcs are tangent, and their curvatures differ
    assert loop.turns.max() < CORNER_ANGLE
    assert len(loop.corners) == 4


@pytest.mark.parametrize(("code", "metres"), [(1, 0.0254), (2, 0.3048), (4, 1e-3), (5, 0.01), (6, 1.0), (14, 0.1)])
def test_units_of_dxf(tmp_path: Path, code: int, metres: float) -> None:
    document = drawing(tmp_path, code)
    document.modelspace().add_circle((1, 2, 3), 70)
    document.saveas(tmp_path / "c.dxf")
    assert loop_of(tmp_path, file="c.dxf").length == pytest.approx(140 * math.pi * metres, rel=1e-13)


def test_a_drawing_without_unit(tmp_path: Path) -> None:
    document = drawing(tmp_path, 0)
    document.modelspace().add_circle((1, 2, 3), 70)
    document.saveas(tmp_path / "c.dxf")
    check_refused(tmp_path, names=["$INSUNITS", 'unit = "mm"'], file="c.dxf")
    assert loop_of(tmp_path, file="c.dxf", unit="mm").length == pytest.approx(0.14 * math.pi)


EXTRUSION = (1.0, 2.0, 2.0)


@pytest.mark.parametrize("kind", ["circle", "ellipse", "lwpolyline", "polyline", "polyline3d", "spline", "rational"])
def test_entities_are_where_the_drawing_library_puts_them(tmp_path: Path, kind: str) -> None:
    """Against ezdxf's own flattening, in tilted planes."""
    document = drawing(tmp_path, 6)
    space = document.modelspace()
    flat = [(0, 0, 0.2), (3, 0, 0), (3, 2, -0.3), (0, 2, 0)]
    about = {"extrusion": EXTRUSION}
    if kind == "circle":
        entity = space.add_circle((1, 2, 3), 2, dxfattribs=about)
    elif kind == "ellipse":
        entity = space.add_ellipse((1, 2, 3), (2, -1, 0), 0.4, dxfattribs=about)
    elif kind == "lwpolyline":
        entity = space.add_lwpolyline(flat, format="xyb", close=True, dxfattribs=about | {"elevation": 2})
    elif kind == "polyline":
        entity = space.add_polyline2d(flat, format="xyb", close=True, dxfattribs=about | {"elevation": (0, 0, 2)})
    elif kind == "polyline3d":
        entity = space.add_polyline3d([(0, 0, 0), (3, 0, 1), (3, 2, 0), (0, 2, 2)], close=True)
    else:
        controls = [(0, 0, 0), (3, 0, 1), (3, 2, 0), (0, 2, 2), (-1, 1, 0)]
        weights = [1, 2, 1, 0.5, 1] if kind == "rational" else None
        entity = space.add_spline(dxfattribs={"degree": 3})
        entity.set_closed(controls, degree=3)
        if weights:
            entity.weights = [*weights, *weights[:3]]
    document.saveas(tmp_path / "c.dxf")
    loop = loop_of(tmp_path, file="c.dxf")
    if kind in ("spline", "rational"):
        exact = np.array([tuple(p) for p in entity.construction_tool().approximate(200)])
    elif kind == "polyline3d":
        exact = np.array([tuple(p) for p in entity.points()])
    elif kind == "circle":
        exact = np.array([tuple(p) for p in entity.flattening(1e-4)])
    elif kind == "ellipse":
        exact = np.array([tuple(p) for p in entity.vertices(np.linspace(0, 6, 50))])
    else:
        exact = np.array([tuple(p) for p in make_path(entity).flattening(1e-4)])
    # the library makes cubics of bulges, good to 3e-4 of the radius
    assert off_curve(loop, exact) < (2e-3 if "polyline" in kind else loop.length / 200_000)
    dense = loop.at(np.arange(5_000) / 5_000)
    span = np.ptp(exact, axis=0)
    np.testing.assert_allclose(np.ptp(dense, axis=0), span, atol=0.02 * span.max())


def test_open_lines_and_arcs_are_joined_in_any_order_and_direction(tmp_path: Path) -> None:
    document = drawing(tmp_path)
    space = document.modelspace()
    layer = {"layer": "rim"}
    space.add_line((4000, 2000), (0, 2000), dxfattribs=layer)
    space.add_arc((4000, 1000), 1000, -90, 90, dxfattribs=layer)
    space.add_line((4000, 0), (0, 1e-4), dxfattribs=layer)
    spline = space.add_spline(dxfattribs=layer | {"degree": 3})
    spline.control_points = [(0, 0, 0), (-1000, 500, 0), (-1000, 1500, 0), (0, 2000, 0)]
    spline.knots = [0, 0, 0, 0, 1, 1, 1, 1]
    space.add_line((9000, 0), (9500, 0), dxfattribs={"layer": "other"})
    document.saveas(tmp_path / "c.dxf")
    for table in ({}, {"layer": "RIM"}):
        loop = loop_of(tmp_path, file="c.dxf", **table)
        assert (loop.turns > CORNER_ANGLE).sum() == 2
        ends = loop.at(loop.corners[loop.turns > CORNER_ANGLE])
        np.testing.assert_allclose(np.sort(ends[:, 1]), [0, 2], atol=1e-6)
        assert (loop.at(T)[:, 0] < 5 + 1e-12).all()
        # the loop is closed: the length of the spline by its own Bezier formula
        s = np.linspace(0, 1, 20001)[:, None]
        p = np.array([[0, 0], [-1, 0.5], [-1, 1.5], [0, 2.0]])
        x = (1 - s) ** 3 * p[0] + 3 * s * (1 - s) ** 2 * p[1] + 3 * s**2 * (1 - s) * p[2] + s**3 * p[3]
        bow = np.linalg.norm(np.diff(x, axis=0), axis=1).sum()
        assert loop.length == pytest.approx(8 + math.pi + bow, rel=1e-6)


def test_open_curves_that_do_not_join(tmp_path: Path) -> None:
    document = drawing(tmp_path)
    space = document.modelspace()
    space.add_line((0, 0), (4000, 0), dxfattribs={"layer": "rim"})
    space.add_line((4000, 0), (4000, 3000), dxfattribs={"layer": "rim"})
    line = space.add_line((4000, 3000), (1, 0), dxfattribs={"layer": "rim"})
    document.saveas(tmp_path / "c.dxf")
    check_refused(tmp_path, [1], ["rim", "(0.001, 0, 0) m", "(0, 0, 0) m"], file="c.dxf", layer="rim")
    space.delete_entity(line)
    line = space.add_line((4000, 2000), (2000, 0), dxfattribs={"layer": "rim"})
    document.saveas(tmp_path / "c.dxf")
    check_refused(tmp_path, [2 * math.sqrt(2)], ["rim", line.dxf.handle, "LINE"], file="c.dxf", layer="rim")
    space.add_circle((0, 0), 500, dxfattribs={"layer": "rim"})
    document.saveas(tmp_path / "c.dxf")
    # the closed one is the only candidate, and the others are no curve that a gap alone keeps open
    assert loop_of(tmp_path, file="c.dxf", layer="rim").length == pytest.approx(math.pi)


def test_chains_and_closed_curves_are_listed_together(tmp_path: Path) -> None:
    document = drawing(tmp_path, 6)
    space = document.modelspace()
    for a, b in (((0, 0), (4, 0)), ((4, 0), (4, 3)), ((4, 3), (0, 0))):
        space.add_line(a, b, dxfattribs={"layer": "rim"})
    space.add_circle((2, 1), 0.2, dxfattribs={"layer": "hole"})
    document.saveas(tmp_path / "c.dxf")
    check_refused(tmp_path, [2, 0.4 * math.pi, 3, 12], ["hole", "CIRCLE", "rim"], file="c.dxf")


# --- JSON -------------------------------------------------------------------------------------------------------


def test_the_json_of_the_documentation(tmp_path: Path) -> None:
    """docs/files.md and the docstring of the reader show the same file, and it is read."""

    page = (Path(__file__).parents[3] / "docs" / "files.md").read_text(encoding="utf-8")
    shown = page.partition("```json\n")[2].partition("```")[0]
    reported = (curves_json.__doc__ or "").partition("::\n")[2].partition("`unit` is")[0]
    assert orjson.loads(shown) == orjson.loads(reported)
    (tmp_path / "c.json").write_text(shown)
    outer, oculus = (loop_of(tmp_path, file="c.json", id=name) for name in ("outer", "oculus"))
    assert len(outer.corners) == 4
    assert outer.length == pytest.approx(4 * np.hypot(4, 1))
    assert oculus.smooth.all()
    assert not outer.smooth.any()
    np.testing.assert_allclose(oculus.at(0.0), [1.5, 1.5, 0.9])


def test_interpolation_of_a_json_file_stands_in_it(tmp_path: Path) -> None:
    with refused("surface.boundary[0].interpolation", names=['"interpolation": "polyline"']):
        loop_of(tmp_path, file="c.json", interpolation="polyline")


def test_json_curves(tmp_path: Path) -> None:
    t = 2 * np.pi * np.arange(64) / 64
    ring = np.stack([2000 * np.cos(t), 2000 * np.sin(t), 0 * t], axis=1).tolist()
    square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 0]]
    curves = {"ring": {"points": ring}, "square": {"points": square, "interpolation": "polyline"}}
    (tmp_path / "c.json").write_bytes(orjson.dumps({"unit": "mm", "curves": curves}))
    assert loop_of(tmp_path, file="c.json", id="ring").length == pytest.approx(4 * math.pi, rel=1e-9)
    assert loop_of(tmp_path, file="c.json", id="square", unit="m").length == pytest.approx(4)
    check_refused(tmp_path, [4 * math.pi, 0.004], ["ring", "square"], file="c.json")
    (tmp_path / "c.json").write_bytes(orjson.dumps({"curves": {"square": curves["square"]}}))
    check_refused(tmp_path, names=["unit"], file="c.json")


@pytest.mark.parametrize(
    ("content", "numbers", "names"),
    [
        ([], [], ["curves"]),
        ({"unit": "yd", "curves": {}}, [], ["yd"]),
        ({"units": "m", "curves": {}}, [], ["units"]),
        ({"unit": "m", "curves": {"a": 3}}, [], ["a", "points"]),
        ({"unit": "m", "curves": {"a": {"points": [[0, 0, 0], [1, 2]]}}}, [2], ["a", "points[1]"]),
        ({"unit": "m", "curves": {"a": {"points": [[0, 0, 0], [1, 2, 3]]}}}, [2], ["a"]),
        ({"unit": "m", "curves": {"a": {"points": [], "colour": 3}}}, [], ["a", "colour"]),
        ({"unit": "m", "curves": {"a": {"points": [], "interpolation": "x"}}}, [], ["x"]),
    ],
)
def test_json_that_is_something_else(tmp_path: Path, content: Any, numbers: list[float], names: list[str]) -> None:
    (tmp_path / "c.json").write_bytes(orjson.dumps(content))
    check_refused(tmp_path, numbers, names, file="c.json")
