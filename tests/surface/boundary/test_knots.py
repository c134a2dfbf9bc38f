"""Knots by their Alexander polynomials (Rolfsen's table and the formula for torus knots), and curves that are none."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from lamella import InputError
from lamella.surface.boundary import check_loops, make_loop
from lamella.surface.boundary.knots import AT, PRIME, alexander, find_crossings, is_knotted
from lamella.surface.boundary.pieces import lines
from lamella.surface.boundary.splines import closed_spline


def torus_knot(p: int, q: int, count: int = 60) -> NDArray[np.float64]:
    """It turns p times around the axis and q times around the tube."""
    t = 2 * np.pi * np.arange(count) / count
    r = 3 + np.cos(q * t)
    return np.stack([r * np.cos(p * t), r * np.sin(p * t), np.sin(q * t)], axis=1)


def figure_eight(count: int = 60) -> NDArray[np.float64]:
    t = 2 * np.pi * np.arange(count) / count
    r = 2 + np.cos(2 * t)
    return np.stack([r * np.cos(3 * t), r * np.sin(3 * t), np.sin(4 * t)], axis=1)


def at(coefficients: list[int]) -> int:
    return int(np.polynomial.polynomial.polyval(AT, np.array(coefficients, object)) % PRIME)


def of_torus(p: int, q: int) -> int:
    """(t^pq - 1)(t - 1) / ((t^p - 1)(t^q - 1))."""
    own = [pow(AT, power, PRIME) - 1 for power in (p * q, 1, p, q)]
    return own[0] * own[1] * pow(own[2] * own[3], -1, PRIME) % PRIME


KNOTS = {
    "3_1": (torus_knot(2, 3), at([1, -1, 1])),
    "4_1": (figure_eight(), at([1, -3, 1])),
    "5_1": (torus_knot(2, 5), at([1, -1, 1, -1, 1])),
    "8_19": (torus_knot(3, 4, 120), at([1, -1, 0, 1, 0, -1, 1])),
    # of determinant 1: no colouring tells these from a circle
    "10_124": (torus_knot(3, 5, 120), at([1, -1, 0, 1, -1, 1, 0, -1, 1])),
    "T(5, 7)": (torus_knot(5, 7, 240), of_torus(5, 7)),
}
# each turns once around the axis or around the tube
NONE = {
    "rim": torus_knot(1, 3),
    "coil": torus_knot(5, 1),
    "wound": torus_knot(9, 1, 120),
    "spring": torus_knot(1, 20, 240),
    "plain": torus_knot(1, 0),
    "curl": torus_knot(2, 1),
}


@pytest.mark.parametrize("name", KNOTS)
def test_knots(name: str) -> None:
    """The polynomial, up to sign and powers of t, from any side; so turned over too, as it is symmetric."""
    points, value = KNOTS[name]
    powers = {sign * value * pow(AT, k, PRIME) % PRIME for k in range(-90, 90) for sign in (1, -1)}
    for seed in range(2):
        turned = points @ Rotation.random(random_state=seed).as_matrix()
        for there in (turned, turned[::-1], turned * [1, 1, -1]):
            assert alexander(find_crossings(there)) in powers
        assert is_knotted(make_loop("x", closed_spline(turned)))


@pytest.mark.parametrize("name", NONE)
def test_curves_without_a_knot(name: str) -> None:
    for seed in range(3):
        points = NONE[name] @ Rotation.random(random_state=seed).as_matrix()
        assert not is_knotted(make_loop("x", closed_spline(points)))


@pytest.mark.parametrize("name", ["3_1", "10_124"])
def test_a_knotted_boundary_is_refused(name: str) -> None:
    with pytest.raises(InputError) as error:
        check_loops([make_loop("x", closed_spline(KNOTS[name][0]))])
    assert error.value.where == "loops[0]"
    assert "knotted" in error.value.message


def test_a_strand_that_passes_within_a_corner() -> None:
    """A trefoil of eight sticks, one corner of which is drawn back to where a stick passes through it."""
    t = 2 * np.pi * (np.arange(8) + 0.3) / 8
    r = 3 + np.cos(3 * t)
    corners = np.stack([r * np.cos(2 * t), r * np.sin(2 * t), np.sin(3 * t)], axis=1)
    through = np.array([-0.59071856, -1.74229952, -0.01205937])
    for share, knotted in ((1.0, True), (2e-3, True), (-2e-3, False)):
        drawn = corners.copy()
        drawn[3] = through + share * (corners[3] - through)
        assert is_knotted(make_loop("x", lines(drawn, closed=True))) == knotted
