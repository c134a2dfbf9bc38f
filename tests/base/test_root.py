"""Brent's method: roots known in closed form, and scipy's to the last bit."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.optimize import brentq

from lamella.base.root import root_between


@pytest.mark.parametrize(
    ("f", "low", "high", "root"),
    [
        (lambda x: x * x - 2, 0.0, 2.0, math.sqrt(2)),
        (math.cos, 0.0, 3.0, math.pi / 2),
        (lambda x: math.exp(x) - 1e6, -100.0, 100.0, 6 * math.log(10)),
        # a jump
        (lambda x: math.copysign(1.0, x - 0.7), 0.0, 1.0, 0.7),
        # at an end
        (lambda x: x, 0.0, 1.0, 0.0),
        (lambda x: x - 1, -1.0, 1.0, 1.0),
    ],
)
def test_known_roots(f: Callable[[float], float], low: float, high: float, root: float) -> None:
    found = root_between(f, low, high, tolerance=1e-15)
    assert found == pytest.approx(root, rel=4e-15, abs=1e-15)


def test_the_same_as_scipy() -> None:
    rng = np.random.default_rng(3)
    compared = 0
    for _ in range(400):
        a, b, c = rng.normal(size=3)

        def f(x: float, a: float = a, b: float = b, c: float = c) -> float:
            return math.sin(3 * x + a) + b * x**3 + c

        low, high = -rng.exponential(3), rng.exponential(3)
        if f(low) * f(high) < 0:
            compared += 1
            assert root_between(f, low, high, tolerance=1e-15) == brentq(f, low, high, xtol=1e-15)
    assert compared > 100


def test_flat_at_its_root() -> None:
    with pytest.raises(ArithmeticError, match="100 steps"):
        root_between(lambda x: (x - 0.3) ** 9, -1.0, 2.0, tolerance=1e-15)


def test_one_sign_at_both_ends() -> None:
    with pytest.raises(ValueError, match="one sign"):
        root_between(math.cosh, -1.0, 1.0, tolerance=1e-9)
