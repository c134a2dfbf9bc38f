"""Strips with their thickness: closed bodies of the volume that they have."""

from __future__ import annotations

import numpy as np
import pytest

from lamella.view.render.sweep import swept
from lamella.view.scene.layer import StripsLayer


def volume(vertices: np.ndarray, faces: np.ndarray) -> float:
    a, b, c = vertices[faces].transpose(1, 0, 2)
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


def ring(count: int, sides: np.ndarray) -> StripsLayer:
    """An arc of three quarters of a circle of radius 2 in the plane z = 1, upright on it."""
    angle = np.linspace(0, 1.5 * np.pi, count)
    points = np.stack([2 * np.cos(angle), 2 * np.sin(angle), np.ones(count)], 1)
    up = np.tile([0.0, 0.0, 1.0], (count, 1))
    measures = {"height": 0.1, "thickness": 0.01, "level": 0.02}
    return StripsLayer(
        name="s", label="S", positions=points, normals=up, offsets=np.array([0, count]), sides=sides, **measures
    )


def test_the_volume_of_an_arc_comes_with_the_square_of_the_step() -> None:
    """Height times thickness times length, by Pappus; both layers together as the centre line."""
    errors = []
    for count in (21, 41):
        layer = ring(count, np.array([-0.2, 0.2]))
        vertices, faces, sample = swept(layer, np.arange(count))
        assert len(sample) == len(vertices) == 2 * 4 * count
        errors.append(abs(volume(vertices, faces) - 2 * 0.1 * 0.01 * 3 * np.pi))
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.1)
    assert np.ptp(vertices[:, 2]) == pytest.approx(0.1)
    assert vertices[:, 2].mean() == pytest.approx(1.02)


def test_a_layer_is_on_the_side_of_normal_times_tangent() -> None:
    """Up times the direction of travel on a circle run counter-clockwise points to its middle."""
    layer = ring(30, np.array([0.5]))
    vertices, _, _ = swept(layer, np.arange(30))
    assert np.hypot(*vertices[:, :2].T) == pytest.approx(1.5, abs=0.01)


def test_sides_at_every_sample_and_samples_left_out() -> None:
    layer = ring(31, np.linspace(0, 1, 31)[None])
    kept = np.arange(0, 31, 3)
    vertices, faces, sample = swept(layer, kept)
    assert faces.max() == len(vertices) - 1 == 4 * len(kept) - 1
    np.testing.assert_array_equal(np.unique(sample), kept)
    radius = np.hypot(*vertices[:, :2].T).reshape(-1, 4).mean(1)
    assert radius == pytest.approx(2 - np.linspace(0, 1, 11), abs=0.01)
