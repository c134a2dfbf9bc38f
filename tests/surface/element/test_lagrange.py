"""The polynomial basis, by what defines it: nodal values, sums, and derivatives as differences."""

from __future__ import annotations

import numpy as np
import pytest

from lamella.surface.element.lagrange import EDGES, lagrange, subdivision

ORDERS = [1, 2, 3, 4]


@pytest.fixture
def local() -> np.ndarray:
    """Places inside the triangle, and its corners and edges."""
    places = np.random.default_rng(0).random((40, 2))
    places = np.where((places.sum(1) > 1)[:, None], 1 - places, places)
    return np.vstack([places, [[0, 0], [1, 0], [0, 1], [0.5, 0.5], [0, 0.3]]])


@pytest.mark.parametrize("order", ORDERS)
class TestBasis:
    def test_is_one_at_its_own_node_and_zero_at_the_others(self, order) -> None:
        basis = lagrange(order)
        assert len(basis.nodes) == (order + 1) * (order + 2) // 2
        assert basis.basis(basis.nodes) == pytest.approx(np.eye(len(basis.nodes)), abs=1e-12)

    def test_adds_up_to_one_and_its_derivatives_to_nought(self, order, local) -> None:
        values, *derivatives = lagrange(order).second_jet(local)
        assert values.sum(1) == pytest.approx(np.ones(len(local)), abs=1e-12)
        for derivative in derivatives:
            assert derivative.sum(1) == pytest.approx(np.zeros(len(local)), abs=1e-10)

    def test_reproduces_polynomials_of_its_order_and_their_derivatives(self, order, local) -> None:
        basis = lagrange(order)
        x, y = local.T
        a, b = basis.nodes.T
        for i in range(order + 1):
            j = order - i
            nodal = a**i * b**j + a
            jet = [part @ nodal for part in basis.second_jet(local)]
            exact = [
                x**i * y**j + x,
                i * x ** max(i - 1, 0) * y**j + 1,
                x**i * j * y ** max(j - 1, 0),
                i * (i - 1) * x ** max(i - 2, 0) * y**j,
                i * x ** max(i - 1, 0) * j * y ** max(j - 1, 0),
                x**i * j * (j - 1) * y ** max(j - 2, 0),
            ]
            for mine, right in zip(jet, exact, strict=True):
                assert mine == pytest.approx(right, abs=1e-10)

    def test_does_not_reproduce_a_polynomial_of_the_next_order(self, order, local) -> None:
        nodal = lagrange(order).nodes[:, 0] ** (order + 1)
        assert np.abs(lagrange(order).basis(local) @ nodal - local[:, 0] ** (order + 1)).max() > 1e-3

    def test_derivatives_are_limits_of_differences(self, order, local) -> None:
        """The error of central differences falls with the square of the step."""
        basis = lagrange(order)
        dx, dy = np.array([[1.0, 0.0]]), np.array([[0.0, 1.0]])
        first = {(1, 0): dx, (0, 1): dy}
        for (i, j), step in [*first.items(), ((2, 0), dx), ((1, 1), dy), ((0, 2), dy)]:
            lower = (i - 1, j) if step is dx else (i, j - 1)
            h = 1e-5
            difference = (basis.basis(local + h * step, *lower) - basis.basis(local - h * step, *lower)) / (2 * h)
            assert basis.basis(local, i, j) == pytest.approx(difference, abs=2e-7)

    def test_edge_nodes_divide_the_edges_evenly(self, order) -> None:
        basis = lagrange(order)
        share = np.arange(order + 1)[:, None] / order
        for (a, b), along in zip(EDGES, basis.edge_nodes, strict=True):
            straight = (1 - share) * basis.nodes[a] + share * basis.nodes[b]
            assert basis.nodes[along] == pytest.approx(straight, abs=1e-15)

    def test_does_not_reach_across_an_edge(self, order) -> None:
        """On an edge only its own nodes count: neighbours then meet without a gap."""
        basis = lagrange(order)
        t = np.linspace(0, 1, 9)[:, None]
        for (a, b), along in zip(EDGES, basis.edge_nodes, strict=True):
            values = basis.basis((1 - t) * basis.nodes[a] + t * basis.nodes[b])
            others = np.setdiff1d(np.arange(len(basis.nodes)), along)
            assert np.abs(values[:, others]).max(initial=0) < 1e-12


@pytest.mark.parametrize("parts", [1, 2, 3, 7])
def test_subdivision_covers_the_triangle_once(parts) -> None:
    places, faces = subdivision(parts)
    assert len(places) == (parts + 1) * (parts + 2) // 2
    assert len(faces) == parts**2
    a, b, c = np.moveaxis(places[faces], 1, 0)
    area = ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) / 2
    assert area == pytest.approx(np.full(parts**2, 0.5 / parts**2))
    edges = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), 1)
    _, count = np.unique(edges, axis=0, return_counts=True)
    assert count.max() <= 2
    assert (count == 1).sum() == 3 * parts
