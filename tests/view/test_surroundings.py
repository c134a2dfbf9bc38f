"""Ground and person: of the right size, in the right place, closed."""

from __future__ import annotations

import numpy as np
import pytest

from lamella.view.surroundings import TALL, person, surroundings


def test_the_person_is_tall_and_a_closed_body() -> None:
    vertices, faces = person()
    assert vertices[:, 2].min() == 0
    assert vertices[:, 2].max() == pytest.approx(TALL)
    assert np.ptp(vertices[:, 0]) == pytest.approx(0.33 * TALL, rel=0.05)
    # outwards: the volume of a body is positive; 60 to 90 kg of about 1,000 kg/m3
    a, b, c = vertices[faces].transpose(1, 0, 2)
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
    assert 0.05 < volume < 0.1


def test_the_ground_is_where_the_structure_is_lowest() -> None:
    low, high = np.array([1.0, 2.0, -3.0]), np.array([9.0, 7.0, 2.0])
    ground, someone = surroundings(low, high)
    assert ground.positions[:, 2] == pytest.approx(-3.0)
    assert someone.positions[:, 2].min() == pytest.approx(-3.0)
    # beside it
    assert someone.positions[:, 0].min() > 9.0
    assert ground.visible
    # both see the sky
    corners = ground.positions[ground.faces]
    assert (np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2] > 0).all()


@pytest.mark.parametrize("factor", [0.01, 1000.0])
def test_beside_what_is_small_or_large_they_are_off_at_first(factor: float) -> None:
    shown = list(surroundings(np.zeros(3), factor * np.ones(3)))
    assert len(shown) == 2
    assert not any(layer.visible for layer in shown)


def test_nothing_beside_nothing() -> None:
    assert list(surroundings(np.zeros(3), np.zeros(3))) == []
