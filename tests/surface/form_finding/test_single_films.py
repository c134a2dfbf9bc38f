"""Boundaries that have one film without pressure: no unstable one is searched for (Rado 1932)."""

from __future__ import annotations

import numpy as np
import pytest

from lamella.base.errors import InputError
from lamella.surface.boundary import make_loop
from lamella.surface.boundary.pieces import lines
from lamella.surface.boundary.splines import closed_spline
from lamella.surface.form_finding import find as finding
from lamella.surface.form_finding.find import find_film
from lamella.surface.form_finding.necessary_conditions import is_convex_along, refuse_single
from surface.form_finding.exact_patches import ring

X, Y, Z = np.eye(3)
TURN = np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))[0]
ROUND = 2 * np.pi * np.arange(24) / 24


def saddle(rise: float):
    return np.column_stack([3 * np.cos(ROUND), 2 * np.sin(ROUND), rise * np.cos(2 * ROUND)])


TETRAHEDRON = np.array([[0, 0, 0], [6, 0, 6], [6, 6, 0], [0, 6, 6.0]])


@pytest.mark.parametrize(
    "pieces",
    [closed_spline(saddle(0.5)), closed_spline(saddle(3.0) @ TURN.T), lines(TETRAHEDRON @ TURN.T, closed=True)],
    ids=["low", "steep and turned", "tetrahedron"],
)
def test_no_unstable_film_in_a_loop_of_convex_plan(pieces, monkeypatch) -> None:
    # nothing is searched for, but what the remedy offers
    monkeypatch.setattr(finding, "FirstFilm", None)
    monkeypatch.setattr(finding.Tries, "curvature_of_bubble", lambda self: None)
    with pytest.raises(InputError, match=r"seen along .* convex curve.*Rado") as error:
        find_film((make_loop("saddle", pieces),), branch="unstable")
    assert error.value.where == "branch"


def test_other_boundaries_are_searched() -> None:
    """A loop that winds twice, a plan with a waist, a pressure, two loops: no bound is known."""
    twice = np.column_stack([np.cos(2 * ROUND), np.sin(2 * ROUND), np.cos(ROUND)])
    r = 1 + 0.5 * np.cos(2 * ROUND)
    waist = np.column_stack([r * np.cos(ROUND), r * np.sin(ROUND), np.cos(3 * ROUND)])
    for points in (twice, waist):
        refuse_single((make_loop("rim", closed_spline(points)),), 0.0)
    refuse_single((make_loop("rim", closed_spline(saddle(0.5))),), 0.1)
    refuse_single((ring(1.0, 0.5), ring(1.0, 0.0)), 0.0)


def test_convexity_is_seen_along_a_direction() -> None:
    assert is_convex_along(saddle(0.5), Z)
    assert is_convex_along(saddle(0.5)[::-1], Z)
    assert not is_convex_along(saddle(0.5), X)
    assert not is_convex_along(saddle(0.5), Y)
    # upright parts are points
    assert not is_convex_along(np.array([[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 1, 1.0]]), Z)
