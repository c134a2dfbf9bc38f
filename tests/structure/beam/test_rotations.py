"""Rotations: against the matrix exponential, at half a turn, and the coefficient against 30 digits."""

import numpy as np
import pytest
from mpmath import cot, diff, mp, mpf, sqrt
from scipy.linalg import expm

from lamella.structure.beam.rotations import (
    crossing,
    exponential,
    inverse_tangent_coefficient,
    logarithm,
    orthonormal,
)

RANDOM = np.random.default_rng(3)
DIRECTIONS = RANDOM.normal(size=(12, 3))
DIRECTIONS /= np.linalg.norm(DIRECTIONS, axis=1)[:, None]


@pytest.mark.parametrize("angle", [0.0, 1e-9, 1e-4, 0.7, 3.0, np.pi - 1e-9])
def test_exponential_and_logarithm(angle):
    vectors = angle * DIRECTIONS
    rotations = exponential(vectors)
    assert np.allclose(rotations, [expm(cross) for cross in crossing(vectors)], atol=1e-14)
    assert np.allclose(logarithm(rotations), vectors, rtol=0, atol=4e-15)


def test_logarithm_of_half_a_turn():
    """Either sense of the axis."""
    found = logarithm(exponential(np.pi * DIRECTIONS))
    assert np.allclose(np.linalg.norm(found, axis=1), np.pi, atol=1e-15)
    assert np.allclose(np.abs((found * DIRECTIONS).sum(1)), np.pi, atol=1e-14)


@pytest.mark.parametrize("square", [1e-12, 1e-3, 1.0, 5.0, np.pi**2])
def test_coefficient_to_all_digits(square):
    with mp.workdps(40):

        def c(s):
            return (1 - sqrt(s) / 2 * cot(sqrt(s) / 2)) / s

        exact = [float(diff(c, mpf(square), n)) for n in range(3)]
    found = inverse_tangent_coefficient(np.array([square]))
    assert [float(x[0]) for x in found] == pytest.approx(exact, rel=4e-15)


def test_rounding_is_taken_out_of_rotations():
    off = exponential(DIRECTIONS) + 1e-8 * RANDOM.normal(size=(12, 3, 3))
    better = orthonormal(off)
    assert np.abs(np.swapaxes(better, 1, 2) @ better - np.eye(3)).max() < 1e-14
