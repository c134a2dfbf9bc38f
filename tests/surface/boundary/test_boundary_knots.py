"""Knots by their determinants (Rolfsen's table: 3 for 3_1, 5 for 4_1 and 5_1, 7 for 7_1), and curves that are none."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from lamella import InputError
from lamella.surface.boundary import check_loops, make_loop
from lamella.surface.boundary.knots import is_knotted
from lamella.surface.boundary.splines import closed_spline

T = 2 * np.pi * np.arange(60) / 60


def torus_knot(p: int, q: int) -> NDArray[np.float64]:
    r = 3 + np.cos(q * T)
    return np.stack([r * np.cos(p * T), r * np.sin(p * T), np.sin(q * T)], axis=1)


def figure_eight() -> NDArray[np.float64]:
    r = 2 + np.cos(2 * T)
    return np.stack([r * np.cos(3 * T), r * np.sin(3 * T), np.sin(4 * T)], axis=1)


KNOTS = {"trefoil": torus_knot(2, 3), "cinquefoil": torus_knot(2, 5), "eight": figure_eight()}
# each turns once around the axis or around the tube
NONE = {"rim": torus_knot(1, 3), "coil": torus_knot(5, 1), "plain": torus_knot(1, 0), "curl": torus_knot(2, 1)}


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("name", [*KNOTS, *NONE])
def test_knots(name: str, seed: int) -> None:
    points = (KNOTS | NONE)[name] @ Rotation.random(random_state=seed).as_matrix()
    assert is_knotted(make_loop("x", closed_spline(points))) == (name in KNOTS)


def test_a_knotted_boundary_is_refused() -> None:
    with pytest.raises(InputError) as error:
        check_loops([make_loop("x", closed_spline(KNOTS["trefoil"]))])
    assert error.value.where == "surface.boundary[0]"
    assert "knot" in error.value.message
