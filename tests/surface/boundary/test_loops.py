"""Boundary loops against closed forms: length, arc-length parameter, curvature, rates, corners, slides."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.interpolate import BSpline, make_interp_spline
from scipy.special import ellipe

from lamella import InputError
from lamella.surface.boundary import Loop, Sliding, make_loop
from lamella.surface.boundary.arcs import arc_through, bulge_arc, circle, ellipse_arc
from lamella.surface.boundary.pieces import lines, stack
from lamella.surface.boundary.splines import bezier, closed_spline, open_spline
from refusals import numbers_in, refused

X, Y, Z = np.eye(3)
RNG_T = np.random.default_rng(3).uniform(-2, 3, 400)


def ellipse_loop(a: float, b: float) -> Loop:
    return make_loop("e", ellipse_arc(np.zeros(3), a * X, b * Y, 0.0, 2 * math.pi))


def saddle(n: int) -> np.ndarray:
    t = 2 * np.pi * np.arange(n) / n
    return np.stack([6 * np.cos(t), 4.5 * np.sin(t), 2.5 - 2.5 * np.cos(2 * t)], axis=1)


def loops() -> dict[str, Loop]:
    square = np.array([[0, 0, 0], [3, 0, 0], [3, 2, 1], [0, 2, 0.0]])
    slot = stack([lines(np.array([0 * X, 4 * X]), closed=False), bulge_arc(4 * X, 4 * X + 2 * Y, 1.0, Z)])
    slot = stack([slot, open_spline(np.array([[4, 2, 0], [2, 3, 1], [0, 2, 0.0]])), bulge_arc(2 * Y, 0 * X, 0.3, Z)])
    return {
        "circle": make_loop("c", circle(np.array([1e4, -3e3, 7.0]), 2.5, np.array([1.0, 2.0, -3.0]))),
        "ellipse": ellipse_loop(5.0, 3.0),
        "spline": make_loop("s", closed_spline(saddle(24))),
        "cubic": make_loop("s", closed_spline(saddle(6))),
        "polyline": make_loop("p", lines(square, closed=True)),
        "slot": make_loop("slot", slot),
    }


@pytest.mark.parametrize("radius", [1e-3, 2.0, 700.0])
def test_circle(radius: float) -> None:
    center, normal = np.array([1.0, -2.0, 3.0]), np.array([1.0, 1.0, 2.0]) / math.sqrt(6)
    loop = make_loop("c", circle(center, radius, normal))
    assert loop.length == pytest.approx(2 * math.pi * radius, rel=1e-14)
    assert len(loop.corners) == 0
    t = RNG_T
    from_center = loop.at(t) - center
    np.testing.assert_allclose(np.linalg.norm(from_center, axis=1), radius, rtol=1e-12)
    np.testing.assert_allclose(loop.curvature(t), 1 / radius, rtol=1e-12)
    # counter-clockwise about the normal, and t is the angle
    np.testing.assert_allclose(
        np.cross(from_center / radius, loop.tangent(t)), np.tile(normal, (len(t), 1)), atol=1e-11
    )
    begin = (loop.at(0.0) - center) / radius
    angle = np.arctan2(from_center @ np.cross(normal, begin), from_center @ begin)
    wrapped = np.mod(angle / (2 * np.pi) - t + 0.5, 1) - 0.5
    assert np.abs(wrapped).max() < 1e-12


def test_a_circle_about_z_begins_at_x_and_runs_counter_clockwise() -> None:
    loop = make_loop("c", circle(np.zeros(3), 2.0, Z))
    np.testing.assert_allclose(loop.at([0.0, 0.25, 0.5, -0.25]), 2 * np.array([X, Y, -X, -Y]), atol=1e-14)


def test_length_of_an_ellipse() -> None:
    """4 a E(e^2), Abramowitz and Stegun 17."""
    for a, b in ((3.0, 1.0), (1.0, 0.02)):
        assert ellipse_loop(a, b).length == pytest.approx(4 * a * ellipe(1 - (b / a) ** 2), rel=1e-13)


@pytest.mark.parametrize("kind", loops())
def test_t_is_the_fraction_of_the_arc_length(kind: str) -> None:
    loop = loops()[kind]
    h = 1e-3
    t = np.mod(RNG_T, 1)
    joints = loop.course.joints / loop.length
    # the formula needs a smooth curve between t - 3 h and t + 3 h
    t = t[np.abs(np.mod(t[:, None] - joints + 0.5, 1) - 0.5).min(axis=1) > 3 * h]
    assert len(t) > 30
    x = loop.at(t[:, None] + h * np.array([-3, -2, -1, 1, 2, 3]))
    derivative = np.einsum("k,nkj->nj", np.array([-1, 9, -45, 45, -9, 1]) / (60 * h), x)
    speed = np.linalg.norm(derivative, axis=1)
    # of the formula itself, from the next term; 1e-9 where the curve is not sharply bent
    bend = loop.curvature(t) * loop.length
    assert (np.abs(speed / loop.length - 1) < 1e-9 + (bend * h) ** 6).all()
    np.testing.assert_allclose(derivative / speed[:, None], loop.tangent(t), atol=1e-8 + (bend.max() * h) ** 6)
    # the stretch between two places, measured by its own quadrature
    piece, s = loop.course.locate(np.mod(t, 1) * loop.length)
    np.testing.assert_allclose(loop.course.arc_at(piece, s), t * loop.length, rtol=0, atol=1e-12 * loop.length)


def test_curvature_is_that_of_the_ellipse() -> None:
    a, b = 5.0, 2.0
    loop = ellipse_loop(a, b)
    x = loop.at(RNG_T)
    angle = np.arctan2(x[:, 1] / b, x[:, 0] / a)
    expected = a * b / (a**2 * np.sin(angle) ** 2 + b**2 * np.cos(angle) ** 2) ** 1.5
    np.testing.assert_allclose(loop.curvature(RNG_T), expected, rtol=1e-11)


def _distance_to_ellipse(points: np.ndarray, a: float, b: float) -> float:
    """First-order distance, exact in the limit."""
    x, y = points[:, 0], points[:, 1]
    f = (x / a) ** 2 + (y / b) ** 2 - 1
    return float(np.abs(f / (2 * np.hypot(x / a**2, y / b**2))).max())


@pytest.mark.parametrize(("cubic", "order"), [(False, 6), (True, 4)])
def test_error_of_splines_falls_with_their_order(cubic: bool, order: int) -> None:
    a, b = 6.0, 4.5
    errors, curvatures = [], []
    for n in (40, 80, 160):
        t = 2 * np.pi * np.arange(n) / n
        points = np.stack([a * np.cos(t), b * np.sin(t), 0 * t], axis=1)
        if cubic:
            # what fewer points get; six are too few for a rate
            ring = np.vstack([points, points[:1]])
            u = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(ring, axis=0), axis=1))])
            spline = make_interp_spline(u, ring, k=3, bc_type="periodic")
            loop = make_loop("e", bezier(spline.t, 3, spline.c))
        else:
            loop = make_loop("e", closed_spline(points))
        fractions = np.arange(4001) / 4001
        x = loop.at(fractions)
        errors.append(_distance_to_ellipse(x, a, b))
        angle = np.arctan2(x[:, 1] / b, x[:, 0] / a)
        exact = a * b / (a**2 * np.sin(angle) ** 2 + b**2 * np.cos(angle) ** 2) ** 1.5
        curvatures.append(np.abs(loop.curvature(fractions) - exact).max())
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    assert (rates > order - 0.3).all(), rates
    assert (np.log2(np.array(curvatures[:-1]) / curvatures[1:]) > order - 2.3).all()


@pytest.mark.parametrize("n", [3, 4, 5, 6, 7, 8, 50])
def test_closed_splines_pass_through_their_points(n: int) -> None:
    points = saddle(n) + 1e3 * X
    loop = make_loop("s", closed_spline(points))
    joints = loop.course.joints / loop.length
    np.testing.assert_allclose(loop.at(joints), points, rtol=0, atol=1e-12)
    assert loop.smooth.all()
    assert loop.course.pieces.degree == (5 if n >= 7 else 3)


@pytest.mark.parametrize(("n", "smooth"), [(12, 4), (6, 2)])
def test_splines_are_as_smooth_as_promised(n: int, smooth: int) -> None:
    """Divided derivatives of neighbouring pieces at their joint, by the chord's parameter."""
    points = saddle(n)
    pieces = closed_spline(points)
    chord = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)[:, None]
    left = right = pieces.controls[..., :3] / pieces.controls[..., 3:]
    for order in range(1, smooth + 2):
        left, right = np.diff(left, axis=1), np.diff(right, axis=1)
        d_end = np.roll(left[:, -1] / chord**order, 1, axis=0)
        d_start = right[:, 0] / chord**order
        jump = np.abs(d_end - d_start).max() / np.abs(d_start).max()
        assert (jump < 1e-9) == (order <= smooth), (order, jump)


@pytest.mark.parametrize("n", [2, 3, 4, 5, 6, 7, 20])
def test_open_splines_of_points_on_a_line_are_that_line(n: int) -> None:
    u = np.sort(np.random.default_rng(n).uniform(0, 1, n))
    points = np.stack([3 * u, 4 * u, 0 * u + 1], axis=1)
    pieces = open_spline(points)
    assert pieces.degree == ({2: 1, 3: 2}.get(n, 5 if n >= 7 else 3))
    np.testing.assert_allclose(pieces.starts[0], points[0], atol=1e-14)
    np.testing.assert_allclose(pieces.ends[-1], points[-1], atol=1e-14)
    piece, s = np.repeat(np.arange(pieces.count), 5), np.tile(np.linspace(0, 1, 5), pieces.count)
    x, first, second = pieces.evaluate(piece, s)
    np.testing.assert_allclose(4 * x[:, 0], 3 * x[:, 1], atol=1e-12)
    # with chords for its parameter the spline runs at one speed
    np.testing.assert_allclose(second, 0, atol=1e-9)
    assert (first[:, :2] > 0).all()


def test_open_splines_have_their_order_too() -> None:
    """Half an ellipse: end conditions and all."""
    errors = []
    for n in (80, 160, 320):
        t = np.pi * np.arange(n + 1) / n
        arc = open_spline(np.stack([6 * np.cos(t), 4.5 * np.sin(t), 0 * t], axis=1))
        piece, s = np.repeat(np.arange(arc.count), 9), np.tile(np.linspace(0, 1, 9), arc.count)
        errors.append(_distance_to_ellipse(arc.evaluate(piece, s)[0], 6, 4.5))
    assert (np.log2(np.array(errors[:-1]) / errors[1:]) > 5.5).all(), errors


def test_splines_that_swing_out_are_refused() -> None:
    """Three of twelve points drawn together to a hundredth: the curve would leave them by five radii."""
    t = 2 * np.pi * np.arange(12) / 12
    points = np.stack([np.cos(t), np.sin(t), 0 * t], axis=1)
    assert closed_spline(points, where="here").extent < 3
    points[3:6] = points[3] + (points[3:6] - points[3]) / 100
    with refused("here", names=['interpolation = "polyline"']) as error:
        closed_spline(points, where="here")
    # between which of the points
    between = [int(number) for number in numbers_in(error.value.message)[:2]]
    assert 0 <= between[0] < between[1] < 12


def test_any_bspline_is_taken_over_exactly() -> None:
    rng = np.random.default_rng(5)
    for degree in (1, 2, 3, 5, 8):
        for clamped in (True, False):
            knots = np.sort(rng.uniform(0, 1, 14 + degree + 1))
            knots[7] = knots[6]  # a double knot
            if clamped:
                knots[: degree + 1], knots[-degree - 1 :] = knots[degree], knots[-degree - 1]
            controls = np.concatenate([rng.normal(size=(14, 3)), rng.uniform(0.5, 2, (14, 1))], axis=1)
            controls[:, :3] *= controls[:, 3:]
            pieces = bezier(knots, degree, controls)
            breaks = np.unique(knots[degree:15])
            piece, s = np.repeat(np.arange(pieces.count), 4), np.tile([0.01, 0.3, 0.6, 0.99], pieces.count)
            u = breaks[piece] + s * np.diff(breaks)[piece]
            w = BSpline(knots, controls, degree)(u)
            np.testing.assert_allclose(pieces.evaluate(piece, s)[0], w[:, :3] / w[:, 3:], atol=1e-11)


def test_polyline_corners() -> None:
    points = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0.0]])
    loop = make_loop("p", lines(points, closed=True))
    assert loop.length == pytest.approx(8, rel=1e-15)
    # (1, 0, 0) lies on a straight side
    np.testing.assert_allclose(loop.corners, [0, 2 / 8, 4 / 8, 6 / 8], atol=1e-15)
    np.testing.assert_allclose(loop.turns, np.pi / 2, atol=1e-14)
    np.testing.assert_allclose(loop.at(loop.corners), points[[0, 2, 3, 4]], atol=1e-14)
    # behind the corner, not before it
    np.testing.assert_allclose(loop.tangent(loop.corners), [X, Y, -X, -Y], atol=1e-14)
    np.testing.assert_allclose(loop.curvature(RNG_T), 0, atol=1e-13)


@pytest.mark.parametrize("n", [5, 7, 11, 97])
def test_tangents_at_the_corners_of_polygons_are_those_behind(n: int) -> None:
    """t of a corner is rounded, and still lies on its right side."""
    t = 2 * np.pi * np.arange(n) / n
    points = np.stack([np.cos(t) + 0.3, 0.7 * np.sin(t), 0.1 * np.cos(3 * t)], axis=1)
    loop = make_loop("p", lines(points, closed=True))
    sides = np.roll(points, -1, axis=0) - points
    expected = sides / np.linalg.norm(sides, axis=1)[:, None]
    np.testing.assert_allclose(loop.tangent(loop.corners), expected, atol=1e-12)
    np.testing.assert_allclose(loop.tangent(loop.corners + 1), expected, atol=1e-12)


@pytest.mark.parametrize("kind", loops())
def test_reversed_and_scaled(kind: str) -> None:
    loop = loops()[kind]
    t = RNG_T
    back = loop.reversed()
    size = np.abs(loop.at(t)).max()
    np.testing.assert_allclose(back.at(t), loop.at(-t), atol=1e-12 * size)
    assert back.length == pytest.approx(loop.length, rel=1e-13)
    np.testing.assert_allclose(
        np.sort(back.at(back.corners), axis=0), np.sort(loop.at(loop.corners), axis=0), atol=1e-9
    )
    shift = np.array([1.0, -2.0, 30.0])
    large = loop.scaled(1000.0, shift)
    np.testing.assert_allclose(large.at(t), 1000 * loop.at(t) + shift, atol=1e-9 * size)
    assert large.length == pytest.approx(1000 * loop.length, rel=1e-13)
    np.testing.assert_allclose(1000 * large.curvature(t), loop.curvature(t), atol=1e-9)
    with pytest.raises(ValueError):  # noqa: PT011
        loop.scaled(0.0)


def test_arcs() -> None:
    arc = arc_through(np.array([0.0, 0, 0]), np.array([1.0, 1, 0]), np.array([2.0, 0, 0]))
    assert arc is not None
    loop = make_loop("half", stack([arc, lines(np.array([2 * X, 0 * X]), closed=False)]))
    assert loop.length == pytest.approx(np.pi + 2, rel=1e-14)
    np.testing.assert_allclose(loop.corners, [0, np.pi / (np.pi + 2)], atol=1e-14)
    assert loop.at(np.pi / 2 / loop.length) == pytest.approx(np.array([1, 1, 0.0]))
    np.testing.assert_allclose(loop.curvature(np.array([0.1, 0.3])), 1, rtol=1e-12)
    assert arc_through(0 * X, X, 2 * X) is None
    assert arc_through(0 * X, X, 0 * X) is None
    # more than half a turn, through the far side
    large = arc_through(np.array([1.0, 0, 0]), np.array([-1.0, 0, 0]), np.array([0.0, -1, 0]))
    assert large is not None
    closed = make_loop("l", stack([large, lines(np.array([-Y, X]), closed=False)]))
    assert closed.length == pytest.approx(1.5 * np.pi + math.sqrt(2), rel=1e-13)


def test_a_flat_bulge_keeps_its_digits() -> None:
    """Sag of a bulge b over a chord c is b c / 2, though the centre is 2.5 million chords away."""
    arc = bulge_arc(0 * X, 10 * X, 1e-7, Z)
    x = arc.evaluate(np.array([0]), np.array([0.5]))[0][0]
    assert x[1] == pytest.approx(-0.5e-6, rel=1e-9)


def test_slides_and_their_corners() -> None:
    points = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0.0]])
    pieces = lines(points, closed=True)
    loop = make_loop("p", pieces, [Sliding(1, 1, direction=np.array([0, 0, 2.0])), Sliding(4, 1, X * 0, 3 * Z)])
    # the sliding part begins at (1, 0, 0), which is no corner otherwise
    np.testing.assert_allclose(loop.corners, [0, 1 / 8, 2 / 8, 4 / 8, 6 / 8], atol=1e-15)
    first, second = loop.slides
    assert (first.start, first.end, second.start, second.end) == (1 / 8, 2 / 8, 6 / 8, 1)
    np.testing.assert_array_equal(first.direction, Z)
    np.testing.assert_array_equal(second.normal, Z)
    back = loop.reversed()
    for slide, other in zip(loop.slides, back.slides, strict=True):
        middle = (slide.start + slide.end) / 2
        np.testing.assert_allclose(back.at((other.start + other.end) / 2), loop.at(middle), atol=1e-14)
        assert 0 <= other.start < 1
        assert other.end - other.start == pytest.approx(slide.end - slide.start)
    whole = make_loop("c", circle(X * 0, 1.0, Z), [Sliding(0, 4, Z * 0, Z)])
    assert len(whole.corners) == 0
    (slide,) = whole.slides
    assert (slide.start, slide.end) == (0, 1)
    (moved,) = whole.scaled(2.0, Z).slides
    np.testing.assert_array_equal(moved.point, Z)
    (turned,) = whole.reversed().slides
    assert (turned.start, turned.end) == (0, 1)


def test_curves_that_are_none() -> None:
    square = np.array([[0, 0, 0], [3, 0, 0], [3, 2, 1], [0, 2, 0.0]])
    bad = square.copy()
    bad[1, 1] = np.nan
    for pieces, words in (
        (lines(bad, closed=True), "not finite"),
        (lines(0 * square, closed=True), "no length"),
        # both inner control points in the first one
        (bezier(np.array([0, 0, 0, 0, 1, 1, 1, 1.0]), 3, square[[0, 0, 2, 0]]), "stacked control points at (0, 0, 0)"),
    ):
        with pytest.raises(InputError) as refused:
            make_loop("x", pieces, where="here")
        assert words in refused.value.message
        assert refused.value.where == "here"
        assert refused.value.remedy


@pytest.mark.parametrize("n", [4, 5, 6])
def test_few_points_of_a_spline_are_corners_that_are_smooth(n: int) -> None:
    """A cubic's third derivative jumps at its points: elements end there, curvatures are measured up to them."""
    points = saddle(n)
    loop = make_loop("s", closed_spline(points))
    assert loop.at(loop.corners) == pytest.approx(points, abs=1e-9)
    assert loop.smooth.all()
    assert loop.turns == pytest.approx(np.zeros(n), abs=1e-6)
    assert loop.reversed().smooth.all()


def test_curves_smoother_than_that_have_no_corners() -> None:
    """Quintics, circles, and cubics of many points, whose knots are closer than elements are."""
    n = 200
    t = np.append(np.linspace(0, 1, n, endpoint=False), 1.0)
    ring = np.vstack([saddle(n), saddle(n)[:1]])
    many = make_interp_spline(t, ring, k=3, bc_type="periodic")
    cubics = bezier(many.t, 3, many.c)
    for pieces in (closed_spline(saddle(7)), circle(np.zeros(3), 2.0, Z), cubics):
        assert not len(make_loop("s", pieces).corners)


def test_polygons_corners_are_none_but_corners() -> None:
    loop = make_loop("p", lines(saddle(5), closed=True))
    assert len(loop.smooth) == 5
    assert not loop.smooth.any()
