"""Zeros of the deviator of minimal surfaces that have them in given places: `surface.element.weierstrass`."""

from __future__ import annotations

import numpy as np
import pytest

from lamella.base.vectors import diagonal
from lamella.surface.element.umbilics import DEPTH, deepest_first
from surface.element.weierstrass import weierstrass


@pytest.mark.parametrize("order", [1, 2, 3, 4, 5])
@pytest.mark.parametrize(("noise", "seed"), [(0.0, 0), (1e-6, 1), (1e-6, 2), (1e-5, 3)])
def test_a_zero_of_any_order_is_one(order, noise, seed) -> None:
    umbilics = weierstrass([0.1 + 0.05j] * order, noise=noise, seed=seed).umbilics
    assert umbilics.orders.tolist() == [order]
    assert umbilics.rays.tolist() == [2 * (order + 2)]
    # X = z / 2 + ... there, mirrored; a point moves by the error of the shape operator over its slope at about 0.3 m
    assert np.hypot(*(umbilics.position[0, :2] - [0.05, -0.025])) < 0.004 + 3e3 * noise


@pytest.mark.parametrize("apart", [0.05, 0.1, 0.3])
def test_zeros_that_are_separate_stay(apart) -> None:
    """The deviator between them, scale apart^2 / 4, is far above its error, 4e-6."""
    umbilics = weierstrass([apart / 2, -apart / 2], rings=16).umbilics
    assert umbilics.orders.tolist() == [1, 1]
    assert np.linalg.norm(np.diff(umbilics.position, axis=0)) == pytest.approx(apart / 2, rel=0.02)


def test_a_double_zero_beside_others() -> None:
    umbilics = weierstrass([0.4, 0.4, -0.3j, -0.4 + 0.3j], rings=16, scale=1.0).umbilics
    assert sorted(umbilics.orders.tolist()) == [1, 1, 2]


def test_zeros_nearer_than_the_surface_can_tell_are_one() -> None:
    assert weierstrass([1e-4, -1e-4], noise=1e-6).umbilics.orders.tolist() == [2]


def test_umbilics_next_to_each_other_have_an_order_of_their_own() -> None:
    """In whatever order they are found: it hangs on the numbers of the elements."""
    surface = weierstrass([0.01, -0.01])
    size = diagonal(surface.nodes)
    around = np.exp(2j * np.pi * (np.arange(6) + 0.3) / 6)
    position = 1e-3 * size * np.column_stack([around.real, around.imag, 0 * around.real])
    wanted = position[deepest_first(surface, position, DEPTH * size)]
    for seed in range(5):
        some = position[np.random.default_rng(seed).permutation(6)]
        assert np.array_equal(some[deepest_first(surface, some, DEPTH * size)], wanted)


def test_smallest_separation_falls_with_the_square_root_of_the_error() -> None:
    """The deviator between zeros goes with the square of their distance, its error with the cube of the elements'."""
    smallest = []
    for rings in (5, 8, 14):
        low, high = 1e-4, 0.5
        while high > 1.3 * low:
            apart = np.sqrt(low * high)
            split = len(weierstrass([apart / 2, -apart / 2], rings=rings).umbilics.orders) == 2
            low, high = (low, apart) if split else (apart, high)
        smallest.append(high)
    assert smallest[2] < smallest[0] / 2
    assert smallest[2] < 0.03
