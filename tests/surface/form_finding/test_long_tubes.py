"""Tubes between rings nearly or more than half a circumference apart, and how far films without pressure go."""

from __future__ import annotations

from contextlib import suppress

import numpy as np
import pytest
from scipy.optimize import brentq

from lamella.surface.form_finding.find import find_film
from lamella.surface.form_finding.necessary_conditions import RING_DISTANCE
from lamella.surface.form_finding.tubes import farthest, pressure_of, tube_of
from surface.form_finding.exact_patches import ring
from surface.form_finding.unduloid_pieces import Piece


def between(lower: float, upper: float, distance: float):
    tube = tube_of((ring(upper, distance), ring(lower, 0.0)), 4)
    assert tube
    return tube


def test_cylinder_of_two_rings() -> None:
    """Seen from the upper ring the film lies below it: its normal points to the axis, H > 0 and the volume is below 0.

    Rings in one plane are no tube.
    """
    tube = between(1.0, 1.0, 3.0)
    assert tube.mean_curvature == pytest.approx(1 / 2, rel=1e-4)
    assert tube.volume == pytest.approx(-3 * np.pi, rel=1e-3)
    reversed_ = tube_of(tube.loops[::-1], 4)
    assert reversed_
    assert reversed_.mean_curvature == pytest.approx(-tube.mean_curvature)
    assert tube_of((ring(2.0, 0.0), ring(1.0, 0.0)), 4) is None


def folds(length: float) -> tuple[float, float]:
    """Least and largest H of the stable tubes between unit rings: where H turns back along the exact unduloids."""
    values = []
    for about_bulge, radii in ((False, np.linspace(0.8, 0.998, 40)), (True, np.linspace(1.002, 1.85, 60))):
        for radius in radii:
            other = (1 + 1e-6, 2.5) if not about_bulge else (1e-3, 1 - 1e-6)

            def off(x: float, radius: float = radius, about_bulge: bool = about_bulge) -> float:
                neck, bulge = (x, radius) if about_bulge else (radius, x)
                return Piece(neck, bulge, 1.0, about_bulge=about_bulge).length - length

            with suppress(ValueError):
                values.append(1 / (radius + brentq(off, *other)))
    values = np.array(values)
    turns = np.flatnonzero(np.diff(np.sign(np.diff(values)))) + 1
    low, high = values[turns]
    return float(low), float(high)


@pytest.mark.parametrize("share", [0.97, pytest.param(1.03, marks=pytest.mark.slow)])
@pytest.mark.slow
def test_pressures_that_a_long_tube_bears(share: float) -> None:
    """Stable at a fixed mean curvature: from fold to fold of the unduloids (T. I. Vogel, Stability of a liquid drop
    trapped between two parallel planes, SIAM J. Appl. Math. 47 (1987) 516-525). The cylinder is one of them up to pi
    radii; what is offered is the H nearest to its own that keeps a quarter of the range from both ends.
    """
    low, high = folds(share * np.pi)
    assert low < 0.5 < high
    tube = between(1.0, 1.0, share * np.pi)
    value = pressure_of(tube)
    assert value == pytest.approx(low + (high - low) / 4, abs=0.02 * (high - low))
    assert find_film(tube.loops, value, tolerance=2e-2).stability.negative == 0


@pytest.mark.slow
def test_no_stable_tube_of_half_as_much_again() -> None:
    assert pressure_of(between(1.0, 1.0, 1.5 * np.pi)) is None


@pytest.mark.parametrize("distance", [1.5, 3.0])
def test_farthest_catenoid(distance: float) -> None:
    """Followed to within a step of the largest distance, 1.3254868 radii (see test_rings)."""
    reached = farthest(between(1.0, 1.0, distance), 0.0)
    assert reached is not None
    assert RING_DISTANCE - 0.02 * distance < reached <= RING_DISTANCE * (1 + 1e-4)
