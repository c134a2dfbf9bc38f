"""Rounded corners: smooth to the derivative of the curvature, of the radius given, and nothing else changed."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lamella import InputError, parse_project
from lamella.project.tables import FormFoundTable
from lamella.stages.surface.boundary_of_tables import boundary_loops
from lamella.surface.boundary import Loop, Sliding, make_loop
from lamella.surface.boundary.arcs import arc_through
from lamella.surface.boundary.fillets import rounded_loop, tangent_length
from lamella.surface.boundary.pieces import lines, stack
from lamella.surface.boundary.splines import open_spline
from lamella.surface.form_finding.find import find_film
from refusals import refused

SAIL = np.array([[0.0, 0, 0], [6, 0, 2], [6, 6, 0], [0, 6, 2]])
LSHAPE = np.array([[0.0, 0, 0], [5, 0, 0.5], [5, 2, 0], [2, 2, 0.7], [2, 6, 0.2], [0, 6, 1]])


def polygon(points: np.ndarray) -> Loop:
    return make_loop("edge", lines(points, closed=True))


def bent() -> Loop:
    """Arcs, a spline and a straight side, with corners between all of them."""
    first = arc_through(np.zeros(3), np.array([2, -0.2, 1.2]), np.array([4.0, 0, 0]))
    third = arc_through(np.array([4.0, 4, 0]), np.array([2, 4.2, 1.2]), np.array([0.0, 4, 0]))
    assert first is not None
    assert third is not None
    second = open_spline(np.array([[4.0, 0, 0], [4.2, 1, -0.4], [4.3, 2, -0.2], [4, 4, 0]]))
    return make_loop("bent", stack([first, second, third, lines(np.array([[0.0, 4, 0], [0, 0, 0]]), closed=False)]))


def jumps(loop: Loop, t: float, h: float) -> tuple[float, float]:
    """Jump at t of the curvature and of its derivative by t, times the length, from values h and 2 h to either side."""
    far, near, close, beyond = loop.curvature(t + h * np.array([-2, -1, 1, 2])) * loop.length
    behind, before = (beyond - close) / h, (near - far) / h
    return abs((close - h * behind) - (near + h * before)), abs(behind - before)


@pytest.mark.parametrize("angle", [20, 60, 90, 120, 170])
def test_between_straight_sides_the_least_radius_is_the_given_one(angle: float) -> None:
    """Closed form of the fillet; the turning of a closed plane curve, the integral of its curvature, is 2 pi."""
    apex = np.radians(angle)
    tip = 30.0 * np.array([np.cos(apex), np.sin(apex), 0.0])
    loop = polygon(np.array([[0.0, 0, 0], [30, 0, 0], 0.7 * (tip + np.array([30.0, 0, 0])), tip]))
    least = max(tangent_length(turn) for turn in loop.turns)
    radius = 5 / least
    round_ = rounded_loop(loop, radius)
    t = (np.arange(20_000) + 0.5) / 20_000
    curvature = round_.curvature(t)
    assert 1 / curvature.max() == pytest.approx(radius, rel=1e-3)
    assert curvature.mean() * round_.length == pytest.approx(2 * np.pi, rel=3e-3)
    assert round_.smooth.all()
    assert len(round_.corners) == 2 * len(loop.corners)


@pytest.mark.parametrize(("make", "radius"), [(lambda: polygon(LSHAPE), 0.5), (bent, 0.4)])
def test_fillets_meet_their_sides_to_the_derivative_of_the_curvature(make: Any, radius: float) -> None:
    loop = rounded_loop(make(), radius)
    assert loop.smooth.all()
    assert loop.turns.max() < 1e-9
    for t in loop.corners:
        wide, narrow = jumps(loop, t, 4e-4), jumps(loop, t, 1e-4)
        # of the second and of the first order: both are continuous
        assert narrow[0] < max(wide[0] / 10, 1e-6)
        assert narrow[1] < max(wide[1] / 3, 1e-3)


def test_sides_stay_where_they_are() -> None:
    loop = polygon(LSHAPE)
    radius = 0.5
    round_ = rounded_loop(loop, radius)
    reach = radius * np.array([tangent_length(turn) for turn in loop.turns])
    np.testing.assert_allclose(round_.at(0.0), loop.at(reach[0] / loop.length), atol=1e-12)
    ends = np.append(loop.corners, 1.0) * loop.length
    for k in range(len(LSHAPE)):
        arc = np.linspace(ends[k] + reach[k], ends[k + 1] - reach[(k + 1) % len(reach)], 7)
        points = loop.at(arc / loop.length)
        # points of the side are points of the rounded loop: no farther apart than its samples allow
        near = round_.at(np.linspace(0, 1, 10_001))
        assert np.linalg.norm(points[:, None] - near, axis=2).min(1).max() < round_.length / 10_000
    # between them the fillet stays in the triangle of the corner: nearer to it than its ends
    nearest = np.linalg.norm(LSHAPE[:, None] - round_.at(np.linspace(0, 1, 4001)), axis=2).min(1)
    assert (nearest < reach).all()


def test_it_does_not_matter_where_a_loop_begins() -> None:
    middle = np.vstack([(SAIL[0] + SAIL[3]) / 2, SAIL])
    a, b = rounded_loop(polygon(SAIL), 0.4), rounded_loop(polygon(middle), 0.4)
    assert a.length == pytest.approx(b.length, rel=1e-12)
    near = b.at(np.linspace(0, 1, 20_001))
    assert np.linalg.norm(a.at(np.linspace(0, 1, 57))[:, None] - near, axis=2).min(1).max() < b.length / 20_000


def loop_of(folder: Path, **table: Any) -> Loop:
    project = parse_project({"surface": {"kind": "form-found", "boundary": [table]}})
    assert isinstance(project.surface, FormFoundTable)
    return boundary_loops(project.surface, folder)[0]


@pytest.mark.parametrize("radius", [0.9, 3.0, 200.0])
def test_fillets_that_overlap_are_refused_and_the_radius_offered_fits(tmp_path: Path, radius: float) -> None:
    table = {"points": LSHAPE.tolist(), "interpolation": "polyline"}
    with refused("surface.boundary[0].corner_radius", [2.062]) as error:
        loop_of(tmp_path, **table, corner_radius=radius)
    offered = float(re.findall(r"corner_radius = ([\d.]+)", error.value.remedy)[0])
    assert loop_of(tmp_path, **table, corner_radius=offered).smooth.all()
    with pytest.raises(InputError):
        loop_of(tmp_path, **table, corner_radius=1.03 * offered)


def test_a_corner_that_turns_back_is_refused() -> None:
    with pytest.raises(InputError) as error:
        rounded_loop(polygon(np.array([[0.0, 0, 0], [4, 0.05, 0], [0.2, 0.1, 0], [0.1, 3, 0]])), 0.01)
    assert "(4, 0.05, 0)" in error.value.message


def test_where_nothing_can_be_rounded_that_is_said(tmp_path: Path) -> None:
    for table, remedy in (
        ({"circle": {"center": [0, 0, 0], "radius": 2}}, "leave"),
        ({"points": SAIL.tolist()}, 'interpolation = "polyline"'),
    ):
        with pytest.raises(InputError) as error:
            loop_of(tmp_path, **table, corner_radius=0.3)
        assert error.value.where.endswith("corner_radius")
        assert remedy in error.value.remedy
    arcs = [
        {"arc": {"start": [3, 0, 0], "middle": [0, 3, 0], "end": [-3, 0, 0]}},
        {"arc": {"start": [-3, 0, 0], "middle": [0, -3, 0], "end": [3, 0, 0]}},
    ]
    assert any("corner_radius" in remark for remark in loop_of(tmp_path, part=arcs, corner_radius=0.3).remarks)


def test_corners_of_what_slides_stay() -> None:
    loop = make_loop("edge", lines(SAIL, closed=True), [Sliding(1, 1, SAIL[1], np.array([1.0, 0, 0]))])
    round_ = rounded_loop(loop, 0.4)
    (slide,) = round_.slides
    np.testing.assert_allclose(round_.at([slide.start, slide.end]), SAIL[1:3], atol=1e-12)
    sharp = round_.corners[round_.turns > 1e-3]
    np.testing.assert_allclose(round_.at(sharp), SAIL[1:3], atol=1e-12)
    assert np.count_nonzero(round_.smooth) == 4
    np.testing.assert_allclose(slide.normal, [1, 0, 0])


def test_curves_of_files_parts_and_placed_ones_are_rounded(tmp_path: Path) -> None:
    """The radius is that of the curve as it is built, in m, whatever its unit and size in the file."""
    curve = {"points": (1000 * SAIL).tolist(), "interpolation": "polyline"}
    (tmp_path / "c.json").write_text(json.dumps({"unit": "mm", "curves": {"a": curve}}))
    t = np.linspace(0, 1, 10_001)
    points = SAIL.tolist()
    parts = [{"points": [points[k], points[(k + 1) % 4]]} for k in range(4)]
    for table, scale in (
        ({"file": "c.json"}, 1.0),
        ({"part": parts}, 1.0),
        ({"file": "c.json", "place": {"scale": 1.5, "shift": [1, 2, 3]}}, 1.5),
        ({"points": curve["points"], "interpolation": "polyline", "unit": "mm"}, 1.0),
    ):
        loop = loop_of(tmp_path, **table, corner_radius=0.4)
        assert 1 / loop.curvature(t).max() == pytest.approx(0.4, rel=1e-3)
        sharp = scale * polygon(SAIL).length
        assert 0.9 * sharp < loop.length < sharp
    waves = {"waves": [[0, 0, 0], [0.05, 0, 0], [0, 0, 0.1]]}
    assert loop_of(tmp_path, part=parts, place=waves, corner_radius=0.4).smooth.all()


def test_a_film_between_rounded_corners_keeps_its_tolerance() -> None:
    """Everywhere: no place is left out, as it is next to a corner. Elements that end with a fillet halve the count."""
    found = find_film((rounded_loop(polygon(SAIL), 0.38),), tolerance=2e-3)
    assert found.deviation <= 2e-3
    assert found.equilibrium.film.connectivity.node_count < 12_000
