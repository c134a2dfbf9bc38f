"""Least squares with limited moves, by solutions that are known."""

from __future__ import annotations

import numpy as np
import pytest

from lamella.network.adjust.least_squares_within import least_squares_within


def ball(count: int, radius: float = 1.0) -> np.ndarray:
    """|x| <= radius, as moves of up to three components."""
    return np.eye(3, count)[None] / radius


@pytest.mark.parametrize("radius", [0.1, 1.0, 4.0])
def test_nearest_point_of_a_ball(radius: float) -> None:
    """The nearest point of a ball is on the way to its middle."""
    wanted = np.array([1.0, -2.0, 2.0])
    found = least_squares_within(np.eye(3), wanted, ball(3, radius))
    assert np.allclose(found, wanted * min(1.0, radius / 3), rtol=0, atol=1e-5)


def test_nearest_point_of_a_cylinder_between_planes() -> None:
    """A disc in x and y and a segment in z limit each their own components."""
    disc, segment = np.zeros((2, 3, 3))
    disc[0, 0] = disc[1, 1] = segment[0, 2] = 1
    found = least_squares_within(np.eye(3), np.array([3.0, 4.0, -0.5]), np.stack([disc, segment]))
    assert np.allclose(found, [0.6, 0.8, -0.5], rtol=0, atol=1e-5)


def test_least_change_is_where_no_limit_matters() -> None:
    """Two unknowns for one equation: the shortest solution."""
    system = np.vstack([1e4 * np.array([[0.3, 0.4]]), np.eye(2)])
    found = least_squares_within(system, np.array([1e4 * 0.1, 0, 0]), ball(2))
    assert np.allclose(found, np.array([0.3, 0.4]) * 0.1 / (0.25 + 1e-8), rtol=0, atol=1e-12)


def test_optimality() -> None:
    """Within the limits, and the gradient a sum of the outward normals of those that are reached, none negative.

    Karush, Kuhn and Tucker's conditions: sufficient where all is convex.
    """
    from scipy.optimize import nnls

    rng = np.random.default_rng(11)
    for _ in range(20):
        p, n = int(rng.integers(4, 30)), int(rng.integers(2, 60))
        system = np.vstack([100 * rng.normal(size=(5, p)), np.eye(p)])
        right = np.append(300 * rng.normal(size=5), np.zeros(p))
        limits = rng.normal(size=(n, 3, p))
        found = least_squares_within(system, right, limits)
        moves = limits @ found
        far = np.linalg.norm(moves, axis=1)
        assert far.max() <= 1 + 1e-12
        reached = far > 1 - 1e-4
        normals = np.einsum("kc,kcp->kp", moves[reached], limits[reached])
        gradient = system.T @ (right - system @ found)
        _, rest = nnls(normals.T, gradient, maxiter=10_000) if reached.any() else (0, np.linalg.norm(gradient))
        assert rest < 1e-2 * np.linalg.norm(system.T @ right)


def test_nearest_point_of_a_ball_behind_a_plane() -> None:
    """The foot of the point on the circle in which the plane cuts the ball."""
    planes = np.array([[2.0, 0.0, 0.0]]), np.array([1.0])
    found = least_squares_within(np.eye(3), np.array([3.0, 3.0, 0.0]), ball(3), planes)
    assert np.allclose(found, [0.5, np.sqrt(0.75), 0.0], rtol=0, atol=1e-5)
    # not reached, and beyond the middle
    assert np.allclose(least_squares_within(np.eye(3), np.array([0.3, 0.1, 0.0]), ball(3), planes), [0.3, 0.1, 0.0])
    behind = np.array([[1.0, 0.0, 0.0]]), np.array([-0.25])
    found = least_squares_within(np.eye(3), np.array([0.5, 0.1, 0.0]), ball(3), behind)
    assert np.allclose(found, [-0.25, 0.1, 0.0], rtol=0, atol=1e-5)
