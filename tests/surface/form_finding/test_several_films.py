"""Boundaries with several stable films of one mean curvature: the search reaches each, wherever it begins.

The image of the circle of radius R under Enneper's surface bounds Enneper's surface alone while R is below 1, and for
R a little above 1 two stable films more, Enneper's own being unstable (J. C. C. Nitsche, Contours bounding at least
three solutions of Plateau's problem, Archive for Rational Mechanics and Analysis 30 (1968) 1-11; M. J. Beeson, A. J.
Tromba, The cusp catastrophe of Thom in the bifurcation of minimal surfaces, Manuscripta Mathematica 46 (1984)
273-308). A quarter turn with a reflection in the plane maps the contour to itself and one stable film to the other,
and H to -H.
"""

from __future__ import annotations

import numpy as np
import pytest

from lamella.surface.boundary import make_loop
from lamella.surface.boundary.splines import closed_spline
from lamella.surface.form_finding.find import find_film

TURN = 2 * np.pi * np.arange(48) / 48


def contour(radius: float, lean: float = 0.0):
    """Enneper's, of a radius in its parameters; with `lean` of a third order added that breaks its symmetry."""
    u, v = radius * np.cos(TURN), radius * np.sin(TURN)
    points = np.stack([u - u**3 / 3 + u * v**2, v - v**3 / 3 + u**2 * v, u**2 - v**2], 1)
    points[:, 2] += lean * np.cos(3 * TURN + 0.4)
    return make_loop("rim", closed_spline(points / radius))


@pytest.mark.parametrize("radius", [1.25, pytest.param(1.4, marks=pytest.mark.slow)])
def test_pressure_of_either_sign(radius: float) -> None:
    """One of the stable films bears a pressure that the other one does not: by symmetry each has its own sign."""
    areas = []
    for value in (0.4, -0.4):
        found = find_film((contour(radius),), value, tolerance=2e-2)
        assert found.stability.negative == 0
        areas.append(found.surface("x").area())
    assert areas[0] == pytest.approx(areas[1], rel=1e-5)


@pytest.mark.slow
def test_without_symmetry() -> None:
    for value in (0.4, -0.4):
        assert find_film((contour(1.3, 0.05),), value, tolerance=2e-2).stability.negative == 0
