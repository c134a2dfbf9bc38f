"""Scales of drawings, and places of texts."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lamella.drawings.paper import SCALES, scale_text, standard_scale
from lamella.drawings.placing import Places, spread


@pytest.mark.parametrize(
    ("size", "scale", "text"),
    [
        (0.2, 1, "1:1"),
        (0.2000001, 2, "1:2"),
        (4.1, 25, "1:25"),
        (40.0, 200, "1:200"),
        (41.0, 500, "1:500"),
        (4e4, 2e5, "1:200000"),
        (0.1, 0.5, "2:1"),
        (0.011, 0.1, "10:1"),
    ],
)
def test_standard_scales(size: float, scale: float, text: str) -> None:
    assert standard_scale((size, 0.0), (200.0, 1.0)) == pytest.approx(scale)
    assert standard_scale((0.0, size), (1.0, 200.0)) == pytest.approx(scale)
    assert scale_text(standard_scale((size, 0.0), (200.0, 1.0))) == text


@given(st.floats(1e-4, 1e5))
def test_the_scale_is_the_largest_in_which_a_drawing_fits(size: float) -> None:
    scale = standard_scale((size, size), (100.0, 100.0))
    assert 1e3 * size / scale <= 100.0 * (1 + 1e-8)
    assert not any(1e3 * size / other <= 100.0 * (1 - 1e-8) for other in SCALES if other < scale * (1 - 1e-9))


@given(st.lists(st.floats(0, 100), min_size=1, max_size=20))
def test_spread_texts_do_not_meet_and_keep_their_middle(places: list[float]) -> None:
    ordered = np.sort(np.array(places))
    moved = spread(ordered, 3.0, -1e3, 1e3)
    assert np.all(np.diff(moved) >= 3.0 - 1e-9)
    assert moved.mean() == pytest.approx(ordered.mean(), abs=1e-9)
    held = spread(ordered, 3.0, 0.0, 100.0)
    assert np.all(np.diff(held) >= 3.0 - 1e-9)
    assert held[0] >= 0
    assert held[-1] <= 100.0 + 1e-9


def test_texts_take_their_places() -> None:
    places = Places((0.0, 0.0, 100.0, 100.0))
    found = [places.beside(np.array([50.0, 50.0]), 10.0, 3.0, 1.0) for _ in range(20)]
    placed = [one for one in found if one is not None]
    assert 2 <= len(placed) < 20
    boxes = np.array([(x, y, x + 10.0, y + 3.0) for x, y in placed])
    overlap = np.minimum(boxes[:, None, 2:], boxes[:, 2:]) - np.maximum(boxes[:, None, :2], boxes[:, :2])
    assert not np.triu((overlap > 1e-9).all(axis=2), 1).any()
    assert places.beside(np.array([99.0, 50.0]), 10.0, 3.0, 1.0) is not None
    assert Places((0.0, 0.0, 5.0, 5.0)).beside(np.array([2.0, 2.0]), 10.0, 3.0, 1.0) is None
