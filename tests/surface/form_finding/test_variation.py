"""First and second variation against differences of the area and of the volume themselves."""

from __future__ import annotations

import numpy as np
import pytest

from lamella.surface.form_finding.variation import Variation
from surface.form_finding.films import disc_film, tube

ORDERS = [2, 3, 4]


def bumpy(order: int):
    """A film far from any equilibrium, with directions that are not its normals."""
    film = tube(lambda s: (1 + 0.3 * np.cos(3 * s), s), np.linspace(0, 1.4, 4), 7, order)
    rng = np.random.default_rng(order)
    nodes = film.nodes + 0.02 / order**2 * rng.normal(size=film.nodes.shape)
    directions = film.directions() + 0.3 * rng.normal(size=film.nodes.shape)
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    return film, nodes, Variation(film.connectivity, directions), rng


def difference(f, h):
    """Central difference of fourth order."""
    return (8 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h)


@pytest.mark.parametrize("order", ORDERS)
class TestVariation:
    def test_area_gradient(self, order) -> None:
        _, nodes, variation, rng = bumpy(order)
        shift = rng.normal(size=len(nodes))
        numeric = difference(lambda h: variation.first(nodes + h * shift[:, None] * variation.directions).area, 1e-4)
        assert variation.first(nodes).area_gradient @ shift == pytest.approx(numeric, rel=1e-8, abs=1e-7)

    def test_volume_gradient(self, order) -> None:
        """Against the volume of cones from the origin, whose change is that of the surface where the rim is held."""
        film, nodes, variation, rng = bumpy(order)
        shift = np.where(film.unknowns >= 0, rng.normal(size=len(nodes)), 0)
        points, weights = np.polynomial.legendre.leggauss(8)
        # Duffy's rule on the triangle: exact for the polynomial (x . x_1 x x_2) of degree 3 p - 2
        a, b = np.meshgrid((points + 1) / 2, (points + 1) / 2)
        local = np.column_stack([a.ravel(), (b * (1 - a)).ravel()])
        weight = (np.outer(weights, weights) / 4 * (1 - a)).ravel()
        basis, x, y, *_ = film.connectivity.basis.second_jet(local)

        def volume(h):
            corners = (nodes + h * shift[:, None] * variation.directions)[film.connectivity.elements]
            cross = np.cross(np.matmul(x, corners), np.matmul(y, corners))
            return float(((np.matmul(basis, corners) * cross).sum(2) @ weight).sum() / 3)

        assert variation.first(nodes).volume_gradient @ shift == pytest.approx(difference(volume, 1e-3), rel=1e-8)

    @pytest.mark.parametrize("mean_curvature", [0.0, 0.7, -2.0])
    def test_second_variation(self, order, mean_curvature) -> None:
        film, nodes, variation, rng = bumpy(order)
        free = film.unknowns >= 0
        shift = np.where(free, rng.normal(size=len(nodes)), 0)

        def gradient(h):
            first = variation.first(nodes + h * shift[:, None] * variation.directions)
            return (first.area_gradient + 2 * mean_curvature * first.volume_gradient)[free]

        pattern = film.pattern
        values = pattern.assemble(variation.second(nodes, variation.first(nodes), mean_curvature))
        numeric = difference(gradient, 1e-4)
        assert pattern.matrix(values) @ shift[free] == pytest.approx(numeric, abs=1e-7 * np.abs(numeric).max())

    def test_mass_of_a_flat_disc_is_its_area(self, order) -> None:
        """Integral of (sum phi_i)^2 with normals as directions."""
        film = disc_film(order, 6)
        directions = np.tile([0.0, 0.0, 1.0], (len(film.nodes), 1))
        variation = Variation(film.connectivity, directions)
        first = variation.first(film.nodes)
        packed = variation.mass(first)
        k = film.connectivity.elements.shape[1]
        i, j = np.tril_indices(k)
        total = (packed * np.where(i == j, 1, 2)).sum()
        assert total == pytest.approx(first.area, rel=1e-10)
        assert total == pytest.approx(np.pi, rel=1e-3 if order == 2 else 1e-5)


@pytest.mark.parametrize("order", ORDERS)
def test_sphere_is_nearly_in_equilibrium_and_more_so_on_finer_elements(order) -> None:
    """A + 2 H V is stationary on the exact sphere: the residual of its interpolants falls with their order."""
    residuals = []
    for rings in (3, 6, 12):
        film = disc_film(order, rings, lambda r2: -np.sqrt(2 - r2))  # bowl: H = 1 / sqrt(2) for the upward normal
        variation = Variation(film.connectivity, film.directions())
        first = variation.first(film.nodes)
        mean_curvature = 1 / np.sqrt(2)
        residual = (first.area_gradient + 2 * mean_curvature * first.volume_gradient)[film.unknowns >= 0]
        wrong = (first.area_gradient - 2 * mean_curvature * first.volume_gradient)[film.unknowns >= 0]
        assert np.abs(wrong).sum() > 1, "the sign of H matters"
        residuals.append(np.linalg.norm(residual))
    assert -np.polyfit(range(3), np.log2(residuals), 1)[0] > order - 0.5, residuals
