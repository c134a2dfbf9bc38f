"""The project tables of form-found surfaces and of meshes, and the loops built from them."""

from __future__ import annotations

import json
import math
import tomllib
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lamella import InputError, parse_project, read_project
from lamella.project.starter import starter
from lamella.project.tables import FormFoundTable, MeshTable, project_schema
from lamella.stages.surface.boundary_of_tables import boundary_loops
from lamella.surface.boundary import Loop

HEAD = '[surface]\nkind = "form-found"\n'
RING = "[[surface.boundary]]\ncircle = {center = [0, 0, 0], radius = 3}\n"
NEXT = HEAD + RING + "\n[[surface.boundary]]\n"
MESH = '[surface]\nkind = "mesh"\nfile = "a.obj"\n'
LINE, ARC = "points = [[0, 0, 0], [4, 0, 0]]\n", "arc = {start = [4, 0, 0], middle = [2, 2, 0], end = [0, 0, 0]}\n"
PART = "[[surface.boundary.part]]\n"


def loops_of(text: str) -> tuple[Loop, ...]:
    table = parse_project(tomllib.loads(text)).surface
    assert isinstance(table, FormFoundTable)
    return boundary_loops(table, Path())


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        (HEAD, 1, ["surface.boundary: missing: Tables [[surface.boundary]]", "add a table [[surface.boundary]]"]),
        (HEAD + "[surface.boundary]\n", 3, ["surface.boundary: it is one table", "double brackets"]),
        (HEAD + "boundary = 3\n", 3, ["surface.boundary: 3 is not a list of tables"]),
        (HEAD + "boundary = []\n", 3, ["surface.boundary: the list is empty"]),
        (HEAD + "boundary = [3]\n", 3, ["surface.boundary: 3, number 0 of the list, is not a table"]),
        (HEAD + "boundary = [" + "{}," * 51 + "]\n", 3, ["surface.boundary: 51 tables are too many (limit 50)"]),
        (NEXT, 6, ["surface.boundary[1]: no curve is given: has to be one of points, circle, file, part", "add one"]),
        (
            NEXT + "file = 'a.dxf'\ncircle = {center = [0, 0, 0], radius = 1}\n",
            6,
            ["surface.boundary[1]: circle and file are given", "keep one of circle, file"],
        ),
        (
            NEXT + "circle = {center = [0, 0, 0], radius = -1}\n",
            7,
            ["surface.boundary[1].circle.radius: -1 m is out of range: has to be at least 1e-06 and at most 1000000 m"],
        ),
        (
            NEXT + "[surface.boundary.circle]\ncenter = [0, 0, 0]\n\nradius = 0\n",
            10,
            ["surface.boundary[1].circle.radius: 0 m is out of range", "raise radius"],
        ),
        (
            NEXT + "circle = {center = [0, 0, 0], radus = 1}\n",
            7,
            ["surface.boundary[1].circle.radus: unknown key, did you mean 'radius'?", "keys here: center, radius"],
        ),
        (NEXT + "circle = {radius = 1}\n", 7, ["surface.boundary[1].circle.center: missing: Centre", "(in m)"]),
        (NEXT + "circle = {center = [0, 0], radius = 1}\n", 7, ["circle.center: [0, 0] has 2 numbers, needs three"]),
        (NEXT + "circle = 3\n", 7, ["surface.boundary[1].circle: 3 is not a table", "write circle = {...}"]),
        (
            NEXT + "circle = {center = [0, 0, 0], radius = 1, normal = [0, 0, 0.0]}\n",
            7,
            ["circle.normal: [0, 0, 0] has no direction"],
        ),
        (NEXT + "pionts = 3\n", 7, ["surface.boundary[1].pionts: unknown key, did you mean 'points'?"]),
        (
            NEXT + "points = [[0, 0, 0],\n[1, 0, 0], [1, 1, 0], [2, 3]]\n",
            7,
            ["surface.boundary[1].points: points[3] has 2 numbers, needs three", "write [x, y, z]"],
        ),
        (NEXT + "points = [[0, 0, 0], [nan, 0, 0]]\n", 7, ["points[1][0] = nan is not a finite number"]),
        (NEXT + "points = [[0, 0, 0], [0, -inf, 0]]\n", 7, ["points[1][1] = -inf is not a finite number"]),
        (NEXT + "points = [[0, 0, 0], [0, 0, '1']]\n", 7, ["points[1][2] = '1' is not a number"]),
        (NEXT + "points = [[0, 0, 0], [0, 0, true]]\n", 7, ["points[1][2] = true is not a number"]),
        (NEXT + "points = [[0, 0, 0], [0, 0, 1e7]]\n", 7, ["points[1][2] = 10000000 m is out of range", "metres"]),
        (NEXT + "points = [[0, 0, 0], 7]\n", 7, ["points[1] is 7, not three numbers"]),
        (NEXT + "points = 7\n", 7, ["surface.boundary[1].points: 7 is not a list of points"]),
        (NEXT + "file = 'a.dwg'\n", 7, ["'a.dwg' is no file that can be read", "ends in .3dm, .dxf, .json"]),
        (NEXT + "file = 'a.dxf'\nunit = 'yd'\n", 8, ["surface.boundary[1].unit: 'yd' is not one of 'm', 'mm'"]),
        (HEAD + RING + "layer = 'a'\n", 5, ["surface.boundary[0].layer: layer goes with file"]),
        (HEAD + RING + "interpolation = 'spline'\n", 5, ["surface.boundary[0].interpolation: interpolation goes with"]),
        (HEAD + RING + "slide = {point = [0, 0, 0]}\n", 5, ["surface.boundary[0].slide: point is given", "normal ="]),
        (
            HEAD + RING + "slide = {point = [0, 0, 0], normal = [0, 0, 1], direction = [0, 0, 1]}\n",
            5,
            ["surface.boundary[0].slide: point, normal, direction is given"],
        ),
        (
            HEAD + "[[surface.boundary]]\npoints = [[0, 0, 0], [1, 0, 0], [1, 1, 0]]\nplace = {scale = 2}\n",
            5,
            ["boundary[0].place: place goes with circle, file or part, not with points"],
        ),
        (
            NEXT + "file = 'a.dxf'\nslide = {direction = [0, 0, 1]}\nplace = {scale = 2}\n",
            9,
            ["surface.boundary[1].place: a loop that slides cannot be placed"],
        ),
        (
            NEXT + "adjust = {move = 1}\n" + PART + LINE + "slide = {direction = [0, 0, 1]}\n" + PART + ARC,
            7,
            ["surface.boundary[1].adjust: a loop that slides cannot be adjusted", "hold the loop, or leave adjust out"],
        ),
        (NEXT + "file = 'a.dxf'\nplace = {scale = 0}\n", 8, ["surface.boundary[1].place.scale: 0 is out of range"]),
        (
            NEXT + "file = 'a.dxf'\nplace = {waves = [[0, 0, 1], [0, 0, 0]]}\n",
            8,
            ["surface.boundary[1].place.waves: 2 shifts: has to be an odd number up to 9"],
        ),
        (HEAD + RING + "name = 'a'\n" + RING + "name = 'a'\n", 3, ["boundary[0] and boundary[1] are both called 'a'"]),
        (HEAD + "points = [[1]]\n" + RING, 3, ["surface.points: unknown key here", "[[surface.boundary]]"]),
        (HEAD + "mean_curvature = 1\nvolume = 2\n" + RING, 4, ["mean_curvature = 1 1/m and volume = 2 m3 are both"]),
        (HEAD + "order = 5\n" + RING, 3, ["surface.order: 5 is out of range: has to be at least 2 and at most 4"]),
        (HEAD + "tolerance = 0\n" + RING, 3, ["surface.tolerance: 0 is out of range: has to be at least 1e-06"]),
        (HEAD + "most_nodes = 100\n" + RING, 3, ["surface.most_nodes: 100 is out of range: has to be at least 500"]),
        (HEAD + "branch = 'other'\n" + RING, 3, ["'other' is not one of 'stable' or 'unstable'"]),
        (NEXT + PART + LINE + PART, 9, ["surface.boundary[1].part[1]: a part needs points or arc"]),
        (NEXT + PART + LINE + PART + LINE + ARC, 9, ["surface.boundary[1].part[1]: points and arc are both given"]),
        (
            NEXT + PART + LINE + PART + "arc = {start = [0, 0, 0], middle = [1, 1, 1]}\n",
            10,
            ["surface.boundary[1].part[1].arc.end: missing"],
        ),
        (NEXT + PART + LINE + PART + ARC + "interpolation = 'spline'\n", 11, ["part[1].interpolation: an arc has no"]),
        (
            HEAD + RING.replace("radius", "radus") + RING.replace("radius = 3", "radius = 0"),
            4,
            ["surface.boundary[0].circle.radus: unknown key", "p.toml:6: surface.boundary[1].circle.radius: 0 m"],
        ),
        (MESH.replace('file = "a.obj"\n', ""), 1, ["surface.file: missing: Mesh of", "add file = 'surface.obj'"]),
        (MESH.replace(".obj", ".step"), 3, ["'a.step' is no file that can be read", ".obj, .off, .ply, .stl, .3dm"]),
        (
            MESH + "mean_curvature = 'fitt'\n",
            4,
            ['surface.mean_curvature: \'fitt\' is not "fit", "varying" or a number'],
        ),
        (MESH + "mean_curvature = inf\n", 4, ["surface.mean_curvature: inf 1/m is out of range"]),
        (MESH + "deviation = 2\n", 4, ["surface.deviation: 2 is out of range: has to be above 0 and at most 1"]),
        (MESH + "corner_angle = 180\n", 4, ["surface.corner_angle: 180 deg is out of range"]),
        (MESH + "unit = 'yd'\n", 4, ["surface.unit: 'yd' is not one of"]),
    ],
)
def test_what_is_wrong_is_said_with_key_line_and_remedy(tmp_path: Path, text: str, line: int, words: list[str]) -> None:
    path = tmp_path / "p.toml"
    path.write_text(text)
    with pytest.raises(InputError) as error:
        read_project(path)
    told = str(error.value)
    assert told.startswith(f"{path}:{line}: "), told
    assert "remedy: " in told
    for word in words:
        assert word in told
    assert max(map(len, told.splitlines())) <= 400 + len(str(path))
    # one mistake, one message
    assert told.count("remedy: ") == (2 if "p.toml:6" in words[-1] else 1), told


def test_the_defaults() -> None:
    table = parse_project(tomllib.loads(HEAD + RING + RING.replace("3", "1"))).surface
    assert isinstance(table, FormFoundTable)
    assert (table.mean_curvature, table.volume, table.order, table.tolerance) == (0, None, 4, 2e-3)
    assert (table.branch, table.most_nodes) == ("stable", 100_000)
    assert [loop.name for loop in table.boundary] == ["outer", "hole 1"]
    mesh = parse_project(tomllib.loads(MESH)).surface
    assert isinstance(mesh, MeshTable)
    assert (mesh.mean_curvature, mesh.unit, mesh.corner_angle, mesh.deviation) == ("fit", None, 40, 0.1)
    assert (mesh.order, mesh.tolerance, mesh.most_nodes) == (4, 2e-3, 100_000)
    number = parse_project(tomllib.loads(MESH + "mean_curvature = 1\n")).surface
    assert isinstance(number, MeshTable)
    assert number.mean_curvature == 1.0


ALL = (
    HEAD
    + "mean_curvature = 0.1\nbranch = 'unstable'\n"
    + RING
    + "slide = {point = [0, 0, 0], normal = [0, 0, 1]}\n"
    + "[[surface.boundary]]\npoints = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\ninterpolation = 'polyline'\n"
    + "[[surface.boundary]]\nname = 'c'\nfile = 'x.DXF'\nlayer = 'a'\nid = 'b'\nunit = 'mm'\n"
    + "place = {shift = [1, 2, 3], scale = 0.5, turn = [0, 0, 90]}\nadjust = {move = 0.1}\n"
    + "[[surface.boundary]]\n"
    + PART
    + LINE
    + "slide = {direction = [0, 0, 1]}\n"
    + PART
    + ARC
)


@pytest.mark.parametrize(
    "text", [ALL, HEAD + RING, MESH, MESH + "mean_curvature = 0.2\n", starter("form-found", "x"), starter("mesh", "x")]
)
def test_a_written_project_reads_back_the_same_and_fits_the_schema(text: str) -> None:
    values = tomllib.loads(text)
    project = parse_project(values)
    written = tomllib.loads(project.to_toml())
    again = parse_project(written)
    assert again.surface == project.surface
    assert again.to_toml() == project.to_toml()
    validator = jsonschema.Draft202012Validator(project_schema())
    validator.validate(values)
    validator.validate(written)
    for spoilt in (values["surface"] | {"order": 5}, values["surface"] | {"x": 1}, {"kind": values["surface"]["kind"]}):
        assert list(validator.iter_errors({"surface": spoilt}))


def test_the_starter_is_the_annulus_of_the_design() -> None:
    """12 x 9 m, z = 2.5 - 2.5 cos 2 t, oculus of radius 1.3 m at z = 2."""
    outer, oculus = loops_of(starter("form-found", "x"))
    x = outer.at(np.arange(500) / 500)
    np.testing.assert_allclose((x[:, 0] / 6) ** 2 + (x[:, 1] / 4.5) ** 2, 1, atol=2e-3)
    t = np.arctan2(x[:, 1] / 4.5, x[:, 0] / 6)
    np.testing.assert_allclose(x[:, 2], 2.5 - 2.5 * np.cos(2 * t), atol=0.02)
    assert oculus.length == pytest.approx(2.6 * math.pi)
    np.testing.assert_allclose(oculus.at(0.3)[2], 2)


def test_loops_from_tables() -> None:
    square = "[[surface.boundary]]\npoints = [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0], [0, 0, 0]]\n"
    (loop,) = loops_of(HEAD + square + "interpolation = 'polyline'\nname = 'box'\n")
    assert (loop.name, loop.length, len(loop.corners)) == ("box", pytest.approx(16), 4)
    # a cubic spline: its points are corners to the elements alone
    (loop,) = loops_of(HEAD + square)
    assert loop.smooth.all()
    (loop,) = loops_of(HEAD + RING.replace("radius = 3", "radius = 3, normal = [1, 0, 0]"))
    np.testing.assert_allclose(loop.at([0.1, 0.7])[:, 0], 0, atol=1e-15)
    # counter-clockwise about +x
    assert np.cross(loop.at(0.0), loop.at(0.1))[0] > 0


def test_parts_are_joined_with_their_slides() -> None:
    text = (
        HEAD + "[[surface.boundary]]\n" + PART + LINE + "slide = {point = [0, 0, 0], normal = [0, 0, 2]}\n" + PART + ARC
    )
    (loop,) = loops_of(text)
    # the circle through (4, 0), (2, 2), (0, 0) has radius 2
    total = 4 + 2 * math.pi
    assert loop.length == pytest.approx(total, rel=1e-13)
    np.testing.assert_allclose(loop.corners, [0, 4 / total], atol=1e-14)
    (slide,) = loop.slides
    assert (slide.start, slide.end) == (0, pytest.approx(4 / total))
    np.testing.assert_array_equal(slide.normal, [0, 0, 1])
    # two halves of a circle meet without a corner, unless one of them slides
    half = "arc = {start = [0, 0, 0], middle = [2, -2, 0], end = [4, 0, 0]}\n"
    (loop,) = loops_of(HEAD + "[[surface.boundary]]\n" + PART + half + PART + ARC)
    assert len(loop.corners) == 0
    assert loop.length == pytest.approx(4 * math.pi, rel=1e-13)
    (loop,) = loops_of(HEAD + "[[surface.boundary]]\n" + PART + half + PART + ARC + "slide = {direction = [0, 0, 1]}\n")
    np.testing.assert_allclose(loop.corners, [0, 0.5], atol=1e-14)
    np.testing.assert_allclose(loop.turns, 0, atol=1e-9)


def test_a_placed_loop_is_turned_scaled_and_shifted(tmp_path: Path) -> None:
    """About the centroid of its length: half a circle of radius 2 over its diameter has that at 4 / (2 + pi)."""
    half = PART + LINE + PART + ARC
    place = "place = {shift = [1, 2, 3], scale = 0.5, turn = [0, 0, 90]}\n"
    (loop,) = loops_of(HEAD + "[[surface.boundary]]\n" + half)
    (placed,) = loops_of(HEAD + "[[surface.boundary]]\n" + place + half)
    t = np.arange(16) / 16
    x, y, z = (loop.at(t) - [2, 4 / (2 + math.pi), 0]).T
    expected = 0.5 * np.column_stack([-y, x, z]) + [3, 2 + 4 / (2 + math.pi), 3]
    np.testing.assert_allclose(placed.at(t), expected, atol=1e-5)
    assert placed.length == pytest.approx(loop.length / 2, rel=1e-12)
    np.testing.assert_allclose(placed.corners, loop.corners, atol=1e-12)
    points = [[0, 0, 0], [3000, 0, 500], [3000, 2000, 0], [0, 2000, 500]]
    (tmp_path / "c.json").write_text(json.dumps({"unit": "mm", "curves": {"a": {"points": points}}}))
    both = [{"name": "a", "file": "c.json"}, {"name": "b", "file": "c.json", "place": {"shift": [0, 0, 4.0]}}]
    table = parse_project({"surface": {"kind": "form-found", "boundary": both}}).surface
    assert isinstance(table, FormFoundTable)
    drawn, above = boundary_loops(table, tmp_path)
    np.testing.assert_allclose(above.at(t), drawn.at(t) + np.array([0, 0, 4]), atol=1e-12)


@pytest.mark.parametrize(
    ("text", "where", "words"),
    [
        (
            PART + LINE + PART + ARC.replace("[4,", "[4.1,"),
            "",
            ["part[0] ends at (4, 0, 0) m, 0.1 m from where part[1]"],
        ),
        (
            PART + LINE + PART + ARC.replace("end = [0,", "end = [1,"),
            "",
            ["part[1] ends at (1, 0, 0) m, 1 m", "part[0]"],
        ),
        (PART + ARC, "", ["part[0] is not closed: its end (0, 0, 0) m is 4 m from"]),
        (
            PART + LINE + PART + ARC.replace("2, 2", "2, 0"),
            ".part[1].arc",
            ["start, middle and end of the arc lie on a"],
        ),
        (PART + LINE.replace("4", "0") + PART + ARC, ".part[0].points", ["1 different point (limit 2 for a part)"]),
        ("points = [[0, 0, 0], [1, 0, 0], [1, 0, 0], [0, 1, 0]]", ".points", ["points 1 and 2 (counted from 0)"]),
        (
            "points = [[0, 0, 0], [0, 0, 0.01], [0, 0, 0], [0, 0, 0.01], [0, 0, 0], [0, 0, 0.01], [0, 0, 1e3], "
            "[0, 0, 0], [0, 0, 0.01]]",
            ".points",
            ["spaced too unevenly for a spline: 0.01 m after point 0 (counted from 0), 1000 m after point"],
        ),
        ("points = [[0, 0, 0], [1, 0, 0]]", ".points", ["2 different points (limit 3 for a closed curve)"]),
        ("circle = {center = [0, 0, 0], radius = 9e3}", "", ["'hole 1' is 25,456 m large", "looks like millimetres"]),
        (
            "circle = {center = [2.5, 0, 0], radius = 0.5}",
            "",
            ["'outer' and 'hole 1' cross or touch", "at (3, 0, 0) m"],
        ),
    ],
)
def test_loops_that_cannot_be_built_are_named_by_their_table(text: str, where: str, words: list[str]) -> None:
    with pytest.raises(InputError) as error:
        loops_of(NEXT + text)
    assert error.value.where == f"surface.boundary[1]{where}"
    for word in words:
        assert word in error.value.message
    assert error.value.remedy


COORDINATES = st.one_of(st.sampled_from([0.0, 1.0, 2.0, 1e-9, 1e5]), st.floats(-10, 10), st.integers(-3, 3))
TRIPLES = st.lists(COORDINATES, min_size=3, max_size=3)
SHAPES = st.one_of(
    st.fixed_dictionaries(
        {"points": st.lists(TRIPLES, min_size=2, max_size=9), "interpolation": st.sampled_from(["spline", "polyline"])}
    ),
    st.fixed_dictionaries({"circle": st.fixed_dictionaries({"center": TRIPLES, "radius": st.floats(1e-6, 20)})}),
    st.fixed_dictionaries(
        {
            "part": st.tuples(TRIPLES, TRIPLES, TRIPLES).map(
                lambda p: [{"points": [p[0], p[1]]}, {"arc": {"start": p[1], "middle": p[2], "end": p[0]}}]
            )
        }
    ),
)


def _built_or_refused(shapes: list[dict[str, Any]]) -> None:
    table = parse_project({"surface": {"kind": "form-found", "boundary": shapes}}).surface
    assert isinstance(table, FormFoundTable)
    refusal = None
    try:
        loops = boundary_loops(table, Path())
    except InputError as error:
        loops, refusal = (), error
    if refusal:
        assert refusal.remedy
        assert refusal.where.startswith("surface.boundary[")
        assert len(str(refusal)) < 400
    t = np.arange(64) / 64
    for loop in loops:
        assert np.isfinite(loop.at(t)).all()
        np.testing.assert_allclose(np.linalg.norm(loop.tangent(t), axis=1), 1, rtol=1e-12)
        # chords are no longer than their arcs
        chords = np.linalg.norm(loop.at(t + 1 / 64) - loop.at(t), axis=1)
        assert (chords <= loop.length / 64 * (1 + 1e-9)).all()


@settings(max_examples=100, deadline=None, derandomize=True)
@given(st.lists(SHAPES, min_size=1, max_size=3))
def test_any_loops_are_built_or_refused_readably(shapes: list[dict[str, Any]]) -> None:
    _built_or_refused(shapes)


@pytest.mark.slow
@settings(max_examples=1000, deadline=None)
@given(st.lists(SHAPES, min_size=1, max_size=3))
def test_any_loops_are_built_or_refused_readably_at_length(shapes: list[dict[str, Any]]) -> None:
    _built_or_refused(shapes)
