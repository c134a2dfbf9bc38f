"""Loops from plain numbers: the curves they should be, and what is refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import lamella
from lamella import InputError

T = np.linspace(0, 1, 50, endpoint=False)


def test_circles_and_ellipses_are_exact() -> None:
    ring = lamella.circle((1, 2, 3), 2.0, (0, 0, -5))
    away = ring.at(T) - (1, 2, 3)
    np.testing.assert_allclose(np.linalg.norm(away, axis=1), 2.0, rtol=1e-12)
    # counter-clockwise about the normal
    assert (np.cross(away[:-1], away[1:])[:, 2] < 0).all()
    oval = lamella.ellipse((0, 0, 1), (3, 0, 0), (0, 2, 0), name="oval")
    x, y, z = oval.at(T).T
    np.testing.assert_allclose(x**2 / 9 + y**2 / 4, 1.0, rtol=1e-12)
    assert oval.name == "oval"
    assert (z == 1).all()


def test_polylines_keep_their_corners_and_splines_have_none() -> None:
    corners = [[0, 0, 0], [6, 0, 2], [6, 6, 0], [0, 6, 2], [0, 0, 0]]
    square = lamella.polyline(corners)
    assert square.length == pytest.approx(4 * np.sqrt(40), rel=1e-12)
    np.testing.assert_allclose(np.degrees(square.turns), 95.739, atol=1e-3)
    assert lamella.spline(corners).turns.max() < 1e-6
    assert square.rounded(0.4).curvature(np.linspace(0, 1, 4001)).max() == pytest.approx(1 / 0.4, rel=1e-3)


def test_parts_are_joined() -> None:
    half = lamella.arc((3, 0, 0), (0, 0, 3), (-3, 0, 0))
    loop = lamella.joined([half, [[-3, 0, 0], [0, 0, 0], [3, 0, 0]]], name="door")
    assert loop.length == pytest.approx(3 * np.pi + 6, rel=1e-12)
    assert loop.name == "door"
    with pytest.raises(InputError) as caught:
        lamella.joined([half, [[-3, 0, 0], [2.9, 0, 0]]])
    assert "0.1 m" in caught.value.message
    with pytest.raises(InputError):
        lamella.joined([])


def test_loops_slide() -> None:
    ring = lamella.circle((0, 0, 2), 1.0)
    (slide,) = ring.sliding(normal=(0, 0, 3)).slides
    assert (slide.start, slide.end) == (0, 1)
    np.testing.assert_allclose(slide.normal, (0, 0, 1))
    assert slide.point[2] == pytest.approx(2)
    (slide,) = ring.sliding(direction=(0, 0, -2)).slides
    np.testing.assert_allclose(slide.direction, (0, 0, -1))
    for wrong in ({}, {"normal": (0, 0, 1), "direction": (0, 0, 1)}):
        with pytest.raises(InputError) as caught:
            ring.sliding(**wrong)
        assert caught.value.where == "normal"


@pytest.mark.parametrize(
    ("make", "where"),
    [
        (lambda: lamella.circle((0, 0), 1.0), "center"),
        (lambda: lamella.circle((0, 0, np.nan), 1.0), "center"),
        (lambda: lamella.circle((0, 0, 0), 1.0, (0, 0, 0)), "normal"),
        (lambda: lamella.ellipse((0, 0, 0), (1, 0, 0), (2, 0, 0)), "minor"),
        (lambda: lamella.spline([[0, 0, 0], [1, 0, 0]]), "points"),
        (lambda: lamella.polyline([[0, 0, 0], [1, 0, 0], [1, 0, 0], [0, 1, 0]]), "points"),
        (lambda: lamella.arc((0, 0, 0), (1, 0, 0), (2, 0, 0)), "middle"),
    ],
)
def test_refused(make: Any, where: str) -> None:
    with pytest.raises(InputError) as caught:
        make()
    assert caught.value.where == where
    assert caught.value.remedy
