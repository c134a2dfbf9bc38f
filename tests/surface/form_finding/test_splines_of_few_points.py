"""Holes drawn by five or six points: cubic splines, whose third derivative jumps at their points.

There the film goes like r^3 log r, and its curvature is off by the elements' size to the first power. Elements that end
at the points, graded towards them, take as many nodes as a smooth hole does: 14,000 to 16,000, a third of what it was.
"""

from __future__ import annotations

import numpy as np
import pytest

from lamella.surface.boundary import make_loop
from lamella.surface.boundary.splines import closed_spline
from lamella.surface.form_finding.find import find_film


def roof_with_hole(points: int, scatter: float, seed: int):
    """A roof of 12 x 9 m with an oculus of about 1.3 m drawn by a few points."""
    t = 2 * np.pi * np.arange(24) / 24
    outer = np.stack([6 * np.cos(t), 4.5 * np.sin(t), 2.5 - 2.5 * np.cos(2 * t)], 1)
    t = 2 * np.pi * np.arange(points) / points
    r = 1.3 + scatter * np.random.default_rng(seed).normal(size=points)
    hole = np.stack([r * np.cos(t), r * np.sin(t), np.full(points, 2.0)], 1)
    return make_loop("roof", closed_spline(outer)), make_loop("oculus", closed_spline(hole))


@pytest.mark.parametrize(
    ("points", "scatter", "seed"),
    [(6, 0.0, 0), *(pytest.param(*one, marks=pytest.mark.slow) for one in ((5, 0.0, 0), (5, 0.12, 1), (6, 0.15, 2)))],
)
def test_hole_of_few_points_takes_few_nodes(points, scatter, seed) -> None:
    """A spline through few points is met to the tolerance with under 20,000 nodes, its points vertices."""
    loops = roof_with_hole(points, scatter, seed)
    found = find_film(loops)
    film = found.equilibrium.film
    assert found.deviation <= 5e-3
    assert film.connectivity.node_count < 20_000
    # each point of the hole is a vertex
    vertices = film.nodes[: len(film.mesh.points)]
    for point in loops[1].at(loops[1].corners):
        assert np.linalg.norm(vertices - point, axis=1).min() < 1e-9
