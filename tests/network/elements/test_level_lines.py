"""Level lines on small triangles: what cannot be named is refused."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
import pytest

from lamella import InputError
from lamella.network.elements.level_chains import level_chains
from lamella.network.elements.small_triangles import SmallTriangles


@pytest.mark.parametrize("far", [1e12, 1e18])
def test_names_of_crossings_end_at_two_to_the_63(far: float) -> None:
    """Two triangles, many cells apart: 6 points make 36 pairs, and 36e18 is beyond 2^63 = 9.2e18."""
    chi = np.array([0.25, 1.5, 0.5 + 1j, far, far + 512, far + 256 + 512j])
    small = SmallTriangles(
        np.arange(2),
        np.arange(6).reshape(2, 3),
        np.array([[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]]),
        chi,
        np.zeros((6, 2), bool),
        np.zeros((0, 2), np.int64),
        np.zeros((0, 2), np.int64),
        np.zeros(0, np.int64),
    )
    nothing = type("Cells", (), {"shifts": np.zeros(0, complex), "signs": np.zeros(0, np.int64)})()
    if far < 1e15:
        chains = level_chains(small, cast(Any, nothing), 1)
        # Re chi = 1, and those from far on; at far itself the line only touches a corner
        assert len(chains.offsets) - 1 == 1 + 511
        return
    with pytest.raises(InputError, match="names for the crossings") as refused:
        level_chains(small, cast(Any, nothing), 1)
    assert refused.value.where == "cells"
