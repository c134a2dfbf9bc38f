"""Loops that are no boundary are refused with the place."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

from lamella import InputError
from lamella.surface.boundary import Loop, Sliding, check_loops, make_loop
from lamella.surface.boundary.arcs import circle
from lamella.surface.boundary.crossings import closest_touch, segment_distance
from lamella.surface.boundary.pieces import lines
from lamella.surface.boundary.point_list import clean_points
from lamella.surface.boundary.splines import closed_spline

Z = np.array([0, 0, 1.0])


def polygon(*points: tuple[float, ...], name: str = "p") -> Loop:
    return make_loop(name, lines(np.array([(*p, 0.0)[:3] for p in points], float), closed=True))


def spline(points: np.ndarray, name: str = "s") -> Loop:
    return make_loop(name, closed_spline(points))


def ring(radius: float, center: tuple[float, float, float] = (0, 0, 0), name: str = "ring") -> Loop:
    return make_loop(name, circle(np.array(center, float), radius, Z))


def refused(*loops: Loop) -> InputError:
    with pytest.raises(InputError) as error:
        check_loops(loops)
    assert error.value.remedy
    return error.value


def eight(height: float, n: int = 120) -> np.ndarray:
    """A figure of eight whose two branches pass each other at 2 height."""
    t = 2 * np.pi * (np.arange(n) + 0.3) / n
    return np.stack([np.sin(2 * t), np.sin(t), height * np.cos(t)], axis=1)


def test_good_loops_pass() -> None:
    check_loops([polygon((0, 0), (4, 0), (4, 3), (0, 3)), ring(0.5, (2, 1.5, 0))])
    check_loops([ring(1.0), ring(1.0, (0, 0, 1.2), "upper")])
    check_loops([spline(eight(0.1))])
    # rings linked like a chain do not touch
    link = make_loop("link", circle(np.array([1.0, 0, 0]), 1.0, np.array([0, 1.0, 0])))
    check_loops([ring(1.0), link])
    # a sharp corner of 3 degrees, a hairpin of 1 mm
    check_loops([polygon((0, 0), (4, 0), (0, 4 * math.tan(math.radians(3))))])
    t = 2 * np.pi * np.arange(400) / 400
    check_loops([spline(np.stack([np.cos(t), 1e-3 * np.sin(t), 0 * t], axis=1))])


@pytest.mark.parametrize("turn", [0.0, 0.7, 2.0])
def test_self_crossing_is_named_with_its_place(turn: float) -> None:
    c, s = math.cos(turn), math.sin(turn)
    points = eight(0.0) @ np.array([[c, s, 0], [0, 0, 1], [-s, c, 0]]) + [5, 6, 7]
    error = refused(spline(points, "eight"))
    assert "the loop 'eight' crosses or touches itself at (5, 6, 7) m" in error.message
    assert error.where == "loops[0]"
    first, second = map(float, re.findall(r"([\d.e+-]+) m (?:and|along)", error.message))
    length = spline(points).length
    # halfway round the other branch passes
    assert abs(second - first) == pytest.approx(length / 2, rel=1e-3)


def test_arc_lengths_of_a_crossing_are_those_of_its_points() -> None:
    """Two sides of a bow tie meet in the middle of both."""
    touch = closest_touch([polygon((0, 0), (4, 3), (4, 0), (0, 3))], 1e-6)
    assert touch is not None
    np.testing.assert_allclose(touch.points, [[2, 1.5, 0]] * 2, atol=1e-12)
    assert touch.arcs == pytest.approx((2.5, 5 + 3 + 2.5))
    assert touch.distance < 1e-12


def test_near_touch_limit() -> None:
    """The limit is a millionth of the size, sqrt(8) here, on either side of it."""
    size = spline(eight(0.0)).size
    assert "touches itself" in refused(spline(eight(0.4e-6 * size))).message
    check_loops([spline(eight(0.6e-6 * size))])


@pytest.mark.parametrize("gap", [0.9, 1.1])
def test_a_corner_near_a_side(gap: float) -> None:
    size = math.hypot(4, 3)
    loop = polygon((0, 0), (4, 0), (4, 3), (2, gap * 1e-6 * size), (0, 3), name="m")
    if gap < 1:
        assert "itself at (2, 0, 0) m: 2 m and" in refused(loop).message
    else:
        check_loops([loop])


def test_loops_that_cross_or_touch_each_other() -> None:
    error = refused(ring(2.0, name="outer"), ring(1.0, (0, 2, 0), "hole 1"))
    # x^2 + y^2 = 4 and x^2 + (y - 2)^2 = 1
    x, y = math.sqrt(4 - 1.75**2), 1.75
    at = re.search(r"at \((\S+), (\S+), 0\) m", error.message)
    assert at
    assert (abs(float(at[1])), float(at[2])) == pytest.approx((x, y), abs=1e-5)
    assert "'outer' and 'hole 1' cross or touch" in error.message
    assert error.where == "loops[1]"
    # tangent from inside, far from any vertex of either
    assert "touch each other at (2, 0, 0)" in refused(ring(2.0), ring(0.5, (1.5, 0, 0), "b")).message
    check_loops([ring(2.0), ring(0.5, (1.49998, 0, 0), "b")])
    # in space: one goes through the other's curve
    tilted = make_loop("t", circle(np.array([2.0, 0, 1.0]), 1.0, np.array([0, 1.0, 0])))
    assert "at (2, 0, 0) m" in refused(ring(2.0), tilted).message
    # one and the same, and one that follows the other for a while
    assert "cross or touch each other" in refused(ring(1.0), ring(1.0, name="b")).message
    box = polygon((0, 0), (4, 0), (4, 3), (0, 3), name="b")
    assert "cross or touch each other" in refused(box, polygon((0, 0), (2, 0), (2, 1), (0, 1))).message


def test_spikes_and_straight_loops() -> None:
    error = refused(polygon((0, 0), (2, 0), (4, 0), (2, 0), (2, 2), (0, 2), name="thorn"))
    assert "the loop 'thorn' has a spike at (4, 0, 0) m, 4 m along it: it turns back by 180 deg" in error.message
    half = 4 * math.tan(math.radians(0.9))
    assert "leaves 0.9 deg between its sides (limit 1 deg)" in refused(polygon((0, 0), (4, 0), (0, half))).message
    flat = refused(polygon((0, 0, 0), (1, 1, 1), (3, 3, 3), (2, 2, 2)))
    assert "a straight line there and back" in flat.message


def test_sizes() -> None:
    error = refused(ring(12_000.0))
    assert "is 33,941 m large (limit 5,000 m): this looks like millimetres" in error.message
    assert 'unit = "mm"' in error.remedy
    assert "(limit 1e-06 m)" in refused(ring(1e-7)).message
    error = refused(ring(20.0, name="outer"), ring(1e-3, name="tiny"))
    assert "'tiny' is 0.002828 m large and 'outer' 56.57 m: over 10,000 times" in error.message
    assert error.where == "loops[1]"
    check_loops([ring(20.0), ring(2.1e-3, name="small")])


def test_slides_off_their_plane_or_along_themselves() -> None:
    pieces = circle(np.array([0, 0, 0.2]), 2.0, Z)
    error = refused(make_loop("foot", pieces, [Sliding(0, 4, 0 * Z, Z)]))
    assert "slides on a plane but leaves it" in error.message
    assert "it is 0.2 m away" in error.message
    assert error.where == "loops[0].slide"
    check_loops([make_loop("foot", pieces, [Sliding(0, 4, 0.2 * Z, -Z)])])
    check_loops([make_loop("foot", pieces, [Sliding(0, 4, direction=Z)])])
    sides = lines(np.array([[0, 0, 0], [4, 0, 0], [4, 3, 0], [0, 3, 0.0]]), closed=True)
    error = refused(make_loop("wall", sides, [Sliding(1, 1, direction=np.array([0, 1.0, 0]))]))
    assert "runs along its own direction of sliding at (4, " in error.message


@pytest.mark.parametrize(
    ("points", "message", "remedy"),
    [
        ([[0, 0, 0], [1, 0, 0], [1, 0, 0], [0, 1, 0]], "points 1 and 2 (counted from 0) are the same", "point 2"),
        ([[0, 0, 0], [1, 0, 0], [1, 1e-7, 0], [0, 1, 0]], "points 1 and 2 (counted", "point 2"),
        ([[0, 0, 0], [1, 0, 0], [0, 0, 0]], "2 different points (limit 3", "add points"),
        ([[0, 0, 0]], "1 different point (limit 3", "add points"),
        ([], "not (n, 3)", "x, y, z"),
        ([[1, 2, 3]] * 5, "1 different point (limit 3", "add points"),
        ([[0, 0, 0], [1, 0, 0], [0, 1, math.inf], [0, 1, 0]], "point 2 is not finite", "finite numbers"),
        ([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 2, math.nan]], "point 3 is not finite", "finite numbers"),
        ([[0, 0], [1, 0], [0, 1]], "not (n, 3)", "x, y, z"),
    ],
)
def test_lists_of_points(points: list[list[float]], message: str, remedy: str) -> None:
    with pytest.raises(InputError) as error:
        clean_points(points, closed=True, where="loops[0].points")
    assert message in error.value.message
    assert remedy in error.value.remedy
    assert error.value.where == "loops[0].points"


def test_the_first_point_may_be_repeated_at_the_end() -> None:
    square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    np.testing.assert_array_equal(clean_points([*square, square[0]], closed=True), np.array(square, float))
    assert len(clean_points([*square, square[0]], closed=False)) == 5


def test_distance_of_segments_against_a_fine_grid() -> None:
    rng = np.random.default_rng(8)
    p, q = rng.normal(size=(2, 100, 2, 3))
    q[:40, 1] = q[:40, 0] + 1.3 * (p[:40, 1] - p[:40, 0])  # parallel ones
    p[40:60, 1] = p[40:60, 0]  # points
    apart, u, v = segment_distance(p, q)
    s = np.linspace(0, 1, 201)
    a = p[:, 0, None] + s[:, None] * (p[:, 1] - p[:, 0])[:, None]
    b = q[:, 0, None] + s[:, None] * (q[:, 1] - q[:, 0])[:, None]
    grid = np.linalg.norm(a[:, :, None] - b[:, None], axis=-1).min(axis=(1, 2))
    assert (apart <= grid + 1e-12).all()
    assert (grid - apart < 0.03).all()
    ends = [x[:, 0] + w[:, None] * (x[:, 1] - x[:, 0]) for x, w in ((p, u), (q, v))]
    np.testing.assert_allclose(np.linalg.norm(ends[0] - ends[1], axis=1), apart, atol=1e-12)


def random_loop(seed: int) -> Loop:
    """A flat loop of a few waves: about half of them cross themselves."""
    rng = np.random.default_rng(seed)
    t = 2 * np.pi * np.arange(60) / 60
    waves = [rng.normal(size=2)[:, None] * np.cos(k * t + rng.uniform(0, 6, 2)[:, None]) for k in (2, 3, 4)]
    x, y = np.stack([np.cos(t), np.sin(t)]) + 0.25 * sum(waves)
    return spline(np.stack([x, y, 0 * t], axis=1))


def crossings_of_chords(loop: Loop, count: int) -> np.ndarray:
    """Begins of those chords of a fine polygon that cross another one: signs of areas of all pairs, (n, 2)."""
    x = loop.at(np.arange(count) / count)[:, :2]
    y = np.roll(x, -1, axis=0)

    def side(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> np.ndarray:
        return (b[..., 0] - a[..., 0]) * (c[..., 1] - a[..., 1]) - (b[..., 1] - a[..., 1]) * (c[..., 0] - a[..., 0])

    i, j = np.triu_indices(len(x), 2)
    apart = (j - i) < len(x) - 1
    i, j = i[apart], j[apart]
    across = (side(x[i], y[i], x[j]) * side(x[i], y[i], y[j]) < 0) & (
        side(x[j], y[j], x[i]) * side(x[j], y[j], y[i]) < 0
    )
    return x[i[across]]


def test_random_loops_against_all_pairs_of_chords() -> None:
    crossed = 0
    for seed in range(20, 44):
        loop = random_loop(seed)
        touch = closest_touch([loop], 1e-6)
        places = crossings_of_chords(loop, 800)
        assert (touch is not None) == bool(len(places)), seed
        if touch:
            crossed += 1
            assert np.linalg.norm(places - touch.points[0, :2], axis=1).min() < 2 * loop.length / 800
            np.testing.assert_allclose(loop.at(np.array(touch.arcs) / loop.length), touch.points, atol=1e-9)
            assert touch.distance < 1e-6 * loop.size
    assert 6 <= crossed <= 18
