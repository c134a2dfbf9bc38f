"""Quadrature rules against the integrals of monomials: x^i y^j over the triangle is i! j! / (i + j + 2)!."""

from __future__ import annotations

from math import factorial

import numpy as np
import pytest

from lamella.surface.element.quadrature import triangle_rule

DEGREES = [4, 6, 8, 10]
POINTS = {4: 6, 6: 12, 8: 16, 10: 25}  # Dunavant 1985, table II


def errors(degree: int, of: int) -> list[float]:
    points, weights = triangle_rule(degree)
    x, y = points.T
    exact = [factorial(i) * factorial(of - i) / factorial(of + 2) for i in range(of + 1)]
    return [abs(weights @ (x**i * y ** (of - i)) - exact[i]) for i in range(of + 1)]


@pytest.mark.parametrize("degree", DEGREES)
class TestRule:
    def test_every_monomial_is_exact(self, degree) -> None:
        for of in range(degree + 1):
            assert max(errors(degree, of)) < 2e-15

    def test_some_monomial_of_the_next_degree_is_not(self, degree) -> None:
        """Else the rule would be called by too low a degree."""
        assert max(errors(degree, degree + 1) + errors(degree, degree + 2)) > 1e-8

    def test_points_lie_inside_with_positive_weights(self, degree) -> None:
        points, weights = triangle_rule(degree)
        assert len(points) == POINTS[degree]
        assert points.min() > 0
        assert points.sum(1).max() < 1
        assert weights.min() > 0

    def test_corners_may_be_renamed(self, degree) -> None:
        points, weights = triangle_rule(degree)
        turned = np.column_stack([points[:, 1], 1 - points.sum(1)])
        for mine, other in ((points, turned), (points, points[:, ::-1])):
            found = np.abs(mine[:, None] - other).max(2)
            assert found.min(1).max() < 1e-14
            assert weights[found.argmin(1)] == pytest.approx(weights)
