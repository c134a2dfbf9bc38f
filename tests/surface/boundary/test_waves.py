"""Waves of boundary curves: what they shift, how smooth they leave it, and that CAD gets the same curve."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from lamella import parse_project
from lamella.base.units import METRES
from lamella.files.write.curves_3dm import write_curves_3dm
from lamella.files.write.rhino_file import Frame
from lamella.project.tables import FormFoundTable
from lamella.stages.surface.boundary_of_tables import adjustable_film, boundary_loops, drawing_unit
from lamella.surface.boundary.arcs import circle
from lamella.surface.boundary.curve import Loop, make_loop
from lamella.surface.boundary.freedom import Freedom
from lamella.surface.boundary.pieces import lines
from lamella.surface.boundary.splines import closed_spline
from lamella.surface.boundary.waves import wave_rows, waved

TURNS = 2 * np.pi * np.arange(6) / 6
DRAWN = {
    "circle": circle(np.array([1.0, 2.0, 3.0]), 3.0, np.array([0.0, 0.0, 1.0])),
    "spline": closed_spline(np.stack([3 * np.cos(TURNS), 2 * np.sin(TURNS), np.cos(2 * TURNS)], 1), where=""),
    "corners": lines(np.array([[0, 0, 0], [4, 0, 1.0], [4, 3, 0], [0, 3, 1]]), closed=True),
}
SHIFTS = 0.2 * np.random.default_rng(7).normal(size=(9, 3))


@pytest.mark.parametrize("name", DRAWN)
def test_every_point_is_shifted_by_the_waves_at_its_arc_length(name: str) -> None:
    loop = make_loop(name, DRAWN[name])
    same, _ = waved(loop, np.zeros((1, 3)))
    pieces, drawn = waved(loop, SHIFTS)
    rng = np.random.default_rng(3)
    k, s = rng.integers(0, pieces.count, 500), rng.uniform(size=500)
    old = make_loop(name, same)
    t = old.course.arc_at(k, s) / old.length
    shift = wave_rows(t, 4).T @ SHIFTS
    # of sixth order in the pieces' length: (2 pi 4 / 128)^6 / 46080 (the quintic's bound) is 1e-9 for a smooth t(s)
    assert np.abs(pieces.evaluate(k, s)[0] - same.evaluate(k, s)[0] - shift).max() < 1e-7 * np.abs(SHIFTS).max()
    assert np.count_nonzero(drawn) == DRAWN[name].count


@pytest.mark.parametrize("name", DRAWN)
def test_corners_stay_corners_and_knots_knots(name: str) -> None:
    loop = make_loop(name, DRAWN[name])
    pieces, drawn = waved(loop, SHIFTS)
    there = make_loop(name, pieces, drawn=drawn)
    assert len(there.corners) == len(loop.corners)
    assert there.smooth.tolist() == loop.smooth.tolist()
    # joints that were smooth are, to rounding of the derivatives
    assert (there.turns[there.smooth] < 1e-9).all()


def tables(**adjust: float | bool) -> FormFoundTable:
    ring = {"center": [0, 0, 2], "radius": 1.0}
    arcs = [
        {"arc": {"start": [4, 0, 0], "middle": [0, 4, 0], "end": [-4, 0, 0]}},
        {"arc": {"start": [-4, 0, 0], "middle": [0, -4, 0], "end": [4, 0, 0]}},
    ]
    loops = [{"name": "rim", "part": arcs, "adjust": adjust}, {"name": "eye", "circle": ring, "adjust": adjust}]
    table = parse_project({"surface": {"kind": "form-found", "boundary": loops}}).surface
    assert isinstance(table, FormFoundTable)
    return table


@pytest.mark.slow
def test_curves_of_parts_and_circles_have_waves() -> None:
    table = tables(points=0.2, keep_height=True, move=0.1)
    freedom = Freedom(adjustable_film(table))
    # four waves with cosine and sine and a shift, in x and y, of two loops
    assert freedom.count == 2 * (2 * 8 + 2)
    t = np.arange(400) / 400
    old = boundary_loops(table, Path())
    for number in range(freedom.count):
        new = freedom.changed(np.eye(freedom.count)[number]).loops()
        moved = [np.linalg.norm(a.at(t)[:, None] - b.at(np.arange(4000) / 4000), axis=2).min(1).max()
                 for a, b in zip(new, old, strict=True)]  # fmt: skip
        assert 0.03 < max(moved) < 0.2 + 1e-3
        assert max(np.abs(a.at(t)[:, 2] - z).max() for a, z in zip(new, (0.0, 2.0), strict=True)) < 1e-12


def test_waves_add_to_those_that_are_given() -> None:
    table = tables(points=0.2)
    freedom = Freedom(adjustable_film(table))
    shares = np.linspace(-1, 1, freedom.count)
    once = freedom.changed(shares / 2)
    twice = Freedom(once).changed(shares / 2)
    direct = freedom.changed(shares)
    t = np.arange(50) / 50
    for a, b in zip(twice.loops(), direct.loops(), strict=True):
        np.testing.assert_allclose(a.at(t), b.at(t), atol=1e-12)


@pytest.mark.parametrize("unit", ["m", "mm", "ft"])
def test_the_same_curve_comes_back_from_a_drawing(unit: str, tmp_path: Path) -> None:
    """In the drawing's unit, exactly, under the loop's name; rational and with corners too."""
    loops: list[Loop] = []
    for name in DRAWN:
        pieces, drawn = waved(make_loop(name, DRAWN[name]), SHIFTS)
        loops += [make_loop(name, DRAWN[name]), make_loop(f"{name} waved", pieces, drawn=drawn)]
    write_curves_3dm(tmp_path / "a.3dm", loops, Frame(unit), name="x", version="1")
    t = np.arange(300) / 300
    for loop in loops:
        boundary = [{"file": "a.3dm", "id": loop.name}]
        table = parse_project({"surface": {"kind": "form-found", "boundary": boundary}}).surface
        assert isinstance(table, FormFoundTable)
        assert drawing_unit(table, tmp_path) == unit
        (again,) = boundary_loops(table, tmp_path)
        assert np.abs(again.at(t) - loop.at(t)).max() < 1e-12 * loop.size / min(METRES[unit], 1)


def test_a_file_is_read_once_where_a_boundary_is_built_many_times(tmp_path: Path) -> None:
    write_curves_3dm(tmp_path / "a.3dm", [make_loop("rim", DRAWN["circle"])], Frame("mm"), name="x", version="1")
    boundary = [{"file": "a.3dm", "adjust": {"points": 0.1}}]
    table = parse_project({"surface": {"kind": "form-found", "boundary": boundary}}).surface
    assert isinstance(table, FormFoundTable)
    freedom = Freedom(adjustable_film(table, tmp_path))
    (first,) = freedom.film.loops()
    (tmp_path / "a.3dm").unlink()
    (there,) = freedom.changed(np.ones(freedom.count)).loops()
    assert np.abs(there.at(0.3) - first.at(0.3)).max() > 0.05
