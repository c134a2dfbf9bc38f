"""Polynomials on elements at many places at once, against the tables of the basis at each of them."""

from __future__ import annotations

import numpy as np
import pytest

from lamella.surface.element.lagrange import lagrange
from lamella.surface.element.places import Places
from lamella.surface.element.polynomials import Polynomials

ELEMENTS = 7
DERIVATIVES = ((0, 0), (1, 0), (0, 1))


@pytest.fixture(params=[1, 2, 3, 4])
def nodal(request) -> tuple[Polynomials, np.ndarray]:
    """Polynomials of an order on a few elements, and their nodal values."""
    basis = lagrange(request.param)
    values = np.random.default_rng(request.param).normal(size=(ELEMENTS, len(basis.nodes), 5))
    return Polynomials.through(basis, values), values


def rounding(polynomials: Polynomials, values: np.ndarray) -> float:
    """What sums of the monomials' terms may be off by: some units in the last place of the sum of their sizes."""
    terms = np.einsum("nkc,kj->ncj", np.abs(values), np.abs(polynomials.basis.to_monomials))
    return float(8 * np.finfo(float).eps * terms.sum(2).max())


def scattered(count: int, elements: list[int]) -> Places:
    """That many places, in elements in no order."""
    rng = np.random.default_rng(count)
    return Places(rng.choice(elements, count), rng.dirichlet([1, 1, 1], count)[:, 1:])


@pytest.mark.parametrize("elements", [[3], [6, 0], list(range(ELEMENTS))], ids=["one", "two", "all"])
@pytest.mark.parametrize("count", [0, 1, 2, 15, 17, 200, 60_000])
def test_they_are_those_of_the_basis(nodal, count, elements) -> None:
    """However many places there are in an element, and where some elements have none."""
    polynomials, values = nodal
    where = scattered(count, elements)
    jet = polynomials.jet(where)
    assert jet.shape == (3, 5, count)
    for part, derivative in zip(jet, DERIVATIVES, strict=True):
        table = polynomials.basis.basis(where.local, *derivative)
        exact = np.einsum("nk,nkc->cn", table, values[where.element])
        # a derivative of x^i has i times the size
        most = rounding(polynomials, values) * (1 if derivative == (0, 0) else polynomials.basis.order)
        assert np.abs(part - exact).max(initial=0) < most < 1e-9
    assert np.abs(polynomials.values(where) - jet[0]).max(initial=0) < rounding(polynomials, values)


def test_the_places_of_an_element_are_told_apart(nodal) -> None:
    """The same places in another order have the same values in that order."""
    polynomials, values = nodal
    where = scattered(500, list(range(ELEMENTS)))
    order = np.random.default_rng(0).permutation(500)
    off = polynomials.values(where[order]) - polynomials.values(where)[:, order]
    assert np.abs(off).max() < rounding(polynomials, values)


@pytest.mark.parametrize("derivative", DERIVATIVES)
def test_at_the_same_places_of_every_element(nodal, derivative) -> None:
    polynomials, values = nodal
    local = scattered(9, [0]).local
    everywhere = polynomials.everywhere(local, *derivative)
    jet = polynomials.jet(Places.everywhere(ELEMENTS, local))
    most = polynomials.basis.order * rounding(polynomials, values)
    assert np.abs(everywhere - jet[DERIVATIVES.index(derivative)]).max() < most


def test_some_of_them(nodal) -> None:
    polynomials, values = nodal
    where = scattered(40, list(range(ELEMENTS)))
    most = polynomials.basis.order * rounding(polynomials, values)
    assert np.abs(polynomials[1:3].jet(where) - polynomials.jet(where)[:, 1:3]).max() < most
