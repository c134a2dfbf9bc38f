"""Lagrange polynomials along an element's edge, parameter 0 to 1."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from lamella.base.arrays import Floats


@lru_cache
def _powers_to_basis(order: int) -> Floats:
    """Coefficients (power, node) of the polynomials that are 1 at one equidistant node and 0 at the others."""
    return np.asarray(np.linalg.inv(np.vander(np.linspace(0, 1, order + 1), increasing=True)), np.float64)


def edge_values(order: int, t: Floats) -> Floats:
    """The polynomials of an order at parameters (n,), (n, order + 1)."""
    return np.asarray(np.vander(t, order + 1, increasing=True) @ _powers_to_basis(order))


def edge_slopes(order: int, t: Floats) -> Floats:
    """Their derivatives, (n, order + 1)."""
    powers = np.arange(1, order + 1) * np.vander(t, order, increasing=True)
    return np.asarray(powers @ _powers_to_basis(order)[1:])


def edge_rule(order: int) -> tuple[Floats, Floats]:
    """Gauss points and weights on 0 to 1 for lengths and areas along edges of an order: 2 order of them."""
    points, weights = np.polynomial.legendre.leggauss(2 * order)
    return (points + 1) / 2, weights / 2
