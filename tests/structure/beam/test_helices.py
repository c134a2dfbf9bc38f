"""Centre lines of elements between their ends."""

from __future__ import annotations

import numpy as np

from lamella.structure.beam.helices import points_between
from lamella.structure.beam.rotations import exponential

SHARES = np.linspace(0, 1, 9)


def test_helix() -> None:
    """Ends of a circular helix: all points between lie on it, with its frames."""
    radius, pitch, turn = 0.8, 0.5, 1.3
    speed = np.hypot(radius, pitch)

    def at(angle: float) -> tuple[np.ndarray, np.ndarray]:
        point = [radius * np.cos(angle), radius * np.sin(angle), pitch * angle]
        t = np.array([-radius * np.sin(angle), radius * np.cos(angle), pitch]) / speed
        n = np.array([-np.cos(angle), -np.sin(angle), 0.0])
        return np.array(point), np.stack((t, np.cross(n, t), n), 1)

    ends = [at(0.2), at(0.2 + turn)]
    points, frames = points_between(np.stack([p for p, _ in ends])[None], np.stack([f for _, f in ends])[None], SHARES)
    for share, point, frame in zip(SHARES, points[0], frames[0], strict=True):
        expected = at(0.2 + share * turn)
        np.testing.assert_allclose(point, expected[0], atol=1e-14)
        np.testing.assert_allclose(frame, expected[1], atol=1e-14)


def test_tangents_at_the_ends() -> None:
    """They are those of the end frames, whatever the S-bend: off by its product with the element's turn, no more."""
    rng = np.random.default_rng(4)
    size, step = 1e-2, 1e-6
    first = exponential(rng.standard_normal((6, 3)))
    turned = first @ exponential(size * rng.standard_normal((6, 3)))
    start = rng.standard_normal((6, 3))
    along = 0.3 * np.concatenate((np.ones((6, 1)), size * rng.standard_normal((6, 2))), 1)
    end = start + np.einsum("mij,mj->mi", first, along)
    frames = np.stack((first, turned), 1)
    points, _ = points_between(np.stack((start, end), 1), frames, np.array([0, step, 1 - step, 1]))
    np.testing.assert_allclose(points[:, 0], start, atol=1e-15)
    np.testing.assert_allclose(points[:, 3], end, atol=1e-15)
    for one, other, tangent in ((0, 1, first[..., 0]), (2, 3, turned[..., 0])):
        way = points[:, other] - points[:, one]
        way /= np.linalg.norm(way, axis=1)[:, None]
        assert np.linalg.norm(way - tangent, axis=1).max() < 10 * size**2


def test_no_turn() -> None:
    """A straight element: points on its chord."""
    frames = np.tile(np.eye(3), (1, 2, 1, 1))
    points, _ = points_between(np.array([[[0.0, 0, 0], [2.0, 0, 0]]]), frames, SHARES)
    np.testing.assert_allclose(points[0], np.column_stack((2 * SHARES, 0 * SHARES, 0 * SHARES)), atol=1e-15)
