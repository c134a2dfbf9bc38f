"""Rectangles on sheets: apart, inside, and within the bound of shelves."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from lamella.cutting.rectangles import spread

SIDES = st.floats(0.02, 0.9)


@given(st.lists(st.tuples(SIDES, SIDES), min_size=1, max_size=40), st.floats(1e-3, 1e3))
@settings(max_examples=40, deadline=None)
def test_rectangles_keep_their_gap(sides: list[tuple[float, float]], scale: float) -> None:
    sizes, sheet, gap = np.array(sides) * scale, (2.0 * scale, 1.0 * scale), 0.01 * scale
    made = spread(sizes, sheet, gap)
    assert made is not None
    turned = np.where(made.turned[:, None], sizes[:, ::-1], sizes)
    low, high = made.corners, made.corners + turned
    assert low.min() >= gap * (1 - 1e-6)
    assert np.all(high <= np.array(sheet) - gap + 2e-9)
    for k in range(len(sizes)):
        same = made.sheets == made.sheets[k]
        same[k] = False
        apart = np.maximum(low[same] - high[k], low[k] - high[same]).max(axis=1)
        assert np.all(apart >= gap - 2e-9)
    assert len(made.ends) == made.sheets.max() + 1


def test_equal_rectangles_fill_a_grid_and_larger_ones_are_refused() -> None:
    made = spread(np.tile([0.19, 0.09], (100, 1)), (2.01, 1.01), 0.01)
    assert made is not None
    assert len(made.ends) == 1
    assert spread(np.array([[2.0, 0.5]]), (2.0, 1.0), 0.01) is None
    standing = spread(np.array([[0.5, 1.9]]), (2.0, 1.0), 0.01)
    assert standing is not None
    assert standing.turned.tolist() == [True]
