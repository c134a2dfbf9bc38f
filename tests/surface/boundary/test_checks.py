"""Loops that are no boundary are refused with the place."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

import numpy as np
import pytest

from lamella.surface.boundary import Loop, Sliding, check_loops, make_loop
from lamella.surface.boundary.arcs import circle
from lamella.surface.boundary.crossings import closest_touch, segment_distance
from lamella.surface.boundary.pieces import lines
from lamella.surface.boundary.point_list import clean_points
from lamella.surface.boundary.splines import closed_spline
from refusals import refused

Z = np.array([0, 0, 1.0])


def polygon(*points: tuple[float, ...], name: str = "p") -> Loop:
    return make_loop(name, lines(np.array([(*p, 0.0)[:3] for p in points], float), closed=True))


def spline(points: np.ndarray, name: str = "s") -> Loop:
    return make_loop(name, closed_spline(points))


def ring(radius: float, center: tuple[float, float, float] = (0, 0, 0), name: str = "ring") -> Loop:
    return make_loop(name, circle(np.array(center, float), radius, Z))


def check_refused(
    *loops: Loop, where: str | None = None, numbers: Sequence[float] = (), names: Sequence[str] = ()
) -> str:
    with refused(where, numbers, names) as error:
        check_loops(loops)
    return error.value.message


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
    message = check_refused(spline(points, "eight"), where="loops[0]", names=["eight", "(5, 6, 7) m"])
    first, second = map(float, re.findall(r"([\d.e+-]+) m (?:and|along)", message))
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
    check_refused(spline(eight(0.4e-6 * size)), where="loops[0]", names=["s"])
    check_loops([spline(eight(0.6e-6 * size))])


@pytest.mark.parametrize("gap", [0.9, 1.1])
def test_a_corner_near_a_side(gap: float) -> None:
    size = math.hypot(4, 3)
    loop = polygon((0, 0), (4, 0), (4, 3), (2, gap * 1e-6 * size), (0, 3), name="m")
    if gap < 1:
        check_refused(loop, where="loops[0]", numbers=[2], names=["m", "(2, 0, 0) m"])
    else:
        check_loops([loop])


def test_loops_that_cross_or_touch_each_other() -> None:
    outer, hole = ring(2.0, name="outer"), ring(1.0, (0, 2, 0), "hole 1")
    message = check_refused(outer, hole, where="loops[1]", names=["outer", "hole 1"])
    # x^2 + y^2 = 4 and x^2 + (y - 2)^2 = 1
    x, y = math.sqrt(4 - 1.75**2), 1.75
    at = re.search(r"\((\S+), (\S+), 0\) m", message)
    assert at
    assert (abs(float(at[1])), float(at[2])) == pytest.approx((x, y), abs=1e-5)
    # tangent from inside, far from any vertex of either
    check_refused(ring(2.0), ring(0.5, (1.5, 0, 0), "b"), names=["ring", "b", "(2, 0, 0) m"])
    check_loops([ring(2.0), ring(0.5, (1.49998, 0, 0), "b")])
    # in space: one goes through the other's curve
    tilted = make_loop("t", circle(np.array([2.0, 0, 1.0]), 1.0, np.array([0, 1.0, 0])))
    check_refused(ring(2.0), tilted, names=["ring", "t", "(2, 0, 0) m"])
    # one and the same, and one that follows the other for a while
    check_refused(ring(1.0), ring(1.0, name="b"), names=["ring", "b"])
    box = polygon((0, 0), (4, 0), (4, 3), (0, 3), name="b")
    check_refused(box, polygon((0, 0), (2, 0), (2, 1), (0, 1)), names=["b", "p"])


def test_spikes_and_straight_loops() -> None:
    thorn = polygon((0, 0), (2, 0), (4, 0), (2, 0), (2, 2), (0, 2), name="thorn")
    check_refused(thorn, numbers=[4, 180], names=["thorn", "(4, 0, 0) m"])
    half = 4 * math.tan(math.radians(0.9))
    check_refused(polygon((0, 0), (4, 0), (0, half)), numbers=[0.9, 1])
    check_refused(polygon((0, 0, 0), (1, 1, 1), (3, 3, 3), (2, 2, 2)), where="loops[0]", names=["p"])


def test_sizes() -> None:
    check_refused(ring(12_000.0), numbers=[24_000 * math.sqrt(2), 5000], names=['unit = "mm"'])
    check_refused(ring(1e-7), numbers=[1e-6])
    outer, tiny = ring(20.0, name="outer"), ring(1e-3, name="tiny")
    numbers = [2e-3 * math.sqrt(2), 40 * math.sqrt(2), 10_000]
    check_refused(outer, tiny, where="loops[1]", numbers=numbers, names=["tiny", "outer"])
    check_loops([ring(20.0), ring(2.1e-3, name="small")])


def test_slides_off_their_plane_or_along_themselves() -> None:
    pieces = circle(np.array([0, 0, 0.2]), 2.0, Z)
    foot = make_loop("foot", pieces, [Sliding(0, 4, 0 * Z, Z)])
    check_refused(foot, where="loops[0].slide", numbers=[0.2], names=["foot"])
    check_loops([make_loop("foot", pieces, [Sliding(0, 4, 0.2 * Z, -Z)])])
    check_loops([make_loop("foot", pieces, [Sliding(0, 4, direction=Z)])])
    sides = lines(np.array([[0, 0, 0], [4, 0, 0], [4, 3, 0], [0, 3, 0.0]]), closed=True)
    wall = make_loop("wall", sides, [Sliding(1, 1, direction=np.array([0, 1.0, 0]))])
    check_refused(wall, where="loops[0]", numbers=[4, 4.002], names=["wall"])


@pytest.mark.parametrize(
    ("points", "numbers", "names"),
    [
        ([[0, 0, 0], [1, 0, 0], [1, 0, 0], [0, 1, 0]], [1, 2], []),
        ([[0, 0, 0], [1, 0, 0], [1, 1e-7, 0], [0, 1, 0]], [1, 2], []),
        ([[0, 0, 0], [1, 0, 0], [0, 0, 0]], [2, 3], []),
        ([[0, 0, 0]], [1, 3], []),
        ([], [], ["(n, 3)"]),
        ([[1, 2, 3]] * 5, [1, 3], []),
        ([[0, 0, 0], [1, 0, 0], [0, 1, math.inf], [0, 1, 0]], [2], []),
        ([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 2, math.nan]], [3], []),
        ([[0, 0], [1, 0], [0, 1]], [3, 2], ["(n, 3)"]),
    ],
)
def test_lists_of_points(points: list[list[float]], numbers: list[float], names: list[str]) -> None:
    with refused("surface.boundary[0].points", numbers, names):
        clean_points(points, closed=True, where="surface.boundary[0].points")


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
