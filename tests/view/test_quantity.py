"""What a surface is coloured by: limits, signs and words, against meshes whose curvatures are chosen."""

from __future__ import annotations

import numpy as np
import pytest

from lamella import Catenoid, Cylinder, Unduloid
from lamella.surface.mesh import SurfaceMesh
from lamella.view.scene.surface_quantities import DIVERGING, SEQUENTIAL, surface_quantities
from surface.element.exact_elements import catenoid_patch


def mesh(k1: np.ndarray, k2: np.ndarray, x: np.ndarray | None = None) -> SurfaceMesh:
    """A flat band 1 m long, two rows of vertices at x (evenly spread when not given), with these curvatures in both."""
    n = len(k1)
    x = np.linspace(0, 1, n) if x is None else x
    points = np.column_stack([np.tile(x, 2), np.repeat([0.0, 0.1], n), np.zeros(2 * n)])
    i = np.arange(n - 1)
    faces = np.stack([i, i + 1, n + i + 1, n + i], -1)
    k1, k2 = np.tile(k1, 2), np.tile(k2, 2)
    return SurfaceMesh(points, np.tile([0.0, 0, 1], (2 * n, 1)), faces, (k1 + k2) / 2, k1 * k2, k1, k2)


def test_deviation_has_symmetric_limits_whatever_its_own_are() -> None:
    off = np.linspace(-2e-4, 5e-4, 101)
    shown = surface_quantities(mesh(1.2 + off, -0.8 + off), 0.2)["deviation"]
    np.testing.assert_allclose(shown.values, np.tile(off, 2), atol=1e-15)
    assert (shown.low, shown.high) == pytest.approx((-5e-4, 5e-4))
    assert (shown.least, shown.most) == pytest.approx((-2e-4, 5e-4))
    assert shown.stops == DIVERGING
    assert (shown.unit, shown.remark) == ("1/m", "H0 = 0.2 1/m")


def test_a_pole_does_not_take_the_colours_from_all_the_rest() -> None:
    off = np.linspace(-1e-4, 1e-4, 201)
    off[[0, 77]] = 0.3, -0.2
    shown = surface_quantities(mesh(1 + off, -1 + off), 0.0)["deviation"]
    assert shown.low == -shown.high
    assert 0.9e-4 < shown.high < 1.1e-4
    # what is beyond is said
    assert (shown.least, shown.most) == pytest.approx((-0.2, 0.3))


def test_a_small_part_of_the_area_is_small_however_many_its_vertices() -> None:
    # half of the vertices crowd into a hundredth of the length, where the deviation is a thousand times as large
    x = np.concatenate([np.linspace(0, 0.01, 100), np.linspace(0.011, 1, 100)])
    off = np.where(x < 0.0101, 1e-1, 1e-4) * np.sin(40 * np.arange(200.0))
    shown = surface_quantities(mesh(1 + off, -1 + off, x), 0.0)["deviation"]
    assert 0.9e-4 < shown.high < 1.1e-4
    assert shown.most > 0.09


@pytest.mark.parametrize("noise", [0.0, 1e-16, 1e-12])
def test_rounding_has_no_colours(noise: float) -> None:
    off = noise * np.cos(np.arange(50.0))
    shown = surface_quantities(mesh(1 + off, -1 + off), 0.0)["deviation"]
    assert shown.is_constant
    assert shown.low == shown.high == 0
    assert shown.remark.startswith("to rounding")


def test_sign_decides_the_scale() -> None:
    u = np.linspace(1, 2, 100)
    saddle = surface_quantities(mesh(u, -u), 0.0)
    assert (saddle["K"].low, saddle["K"].high) == pytest.approx((-4, -1))
    assert saddle["K"].stops == SEQUENTIAL
    assert saddle["k1"].stops == SEQUENTIAL[::-1]
    assert (saddle["k1"].low, saddle["k1"].high) == pytest.approx((1, 2))
    mixed = surface_quantities(mesh(u, 1.5 - u), 0.75)["K"]
    assert mixed.low == -mixed.high == pytest.approx(-1.0)
    assert mixed.stops == DIVERGING
    # a found film's K is 1e-4 above zero at a flat point: that is no second sign
    flat = np.append(np.linspace(0, 1, 100), 5e-5)
    nearly = surface_quantities(mesh(flat, 1e-4 - flat), 0.0)["K"]
    assert nearly.stops == SEQUENTIAL
    assert nearly.high == 0 < nearly.most


def test_ratio_is_minus_one_nought_and_one() -> None:
    ones = np.ones(5)
    for k1, k2, ratio in ((2, -2, -1), (2, 0, 0), (0, -2, 0), (3, 3, 1), (-3, -3, 1), (2, 1, 0.5), (1, -4, -0.25)):
        shown = surface_quantities(mesh(k1 * ones, k2 * ones), (k1 + k2) / 2)["ratio"]
        np.testing.assert_allclose(shown.values, ratio, atol=1e-15)
        assert (shown.low, shown.high) == (-1, 1)
    both = surface_quantities(mesh(np.array([1.0, 1, 0, 0]), np.array([-1.0, 0.5, 0, 0])), 0.0)["ratio"]
    np.testing.assert_array_equal(both.values, [-1, 0.5, np.nan, np.nan] * 2)


def test_closed_forms() -> None:
    catenoid = surface_quantities(Catenoid(2.0, (-1.0, 2.0)).mesh(), 0.0)
    assert catenoid["deviation"].is_constant
    np.testing.assert_allclose(catenoid["ratio"].values, -1, atol=1e-12)
    cylinder = surface_quantities(Cylinder(2.0, (0.0, 1.0)).mesh(), 0.25)
    assert [key for key, quantity in cylinder.items() if quantity.is_constant] == ["deviation", "K", "k1", "k2"]
    assert cylinder["k1"].low == pytest.approx(0.5)
    assert cylinder["K"].low == 0
    assert cylinder["K"].remark == "everywhere"
    unduloid = Unduloid(1.0, 2.0, (-2.0, 3.0))
    assert surface_quantities(unduloid.mesh(), unduloid.mean_curvature)["K"].stops == DIVERGING


def test_a_plane_found_to_rounding_has_no_curvature() -> None:
    noise = 1e-13 * np.cos(np.arange(60.0))
    plane = surface_quantities(mesh(noise + 1e-13, noise - 1e-13), 0.0)
    assert plane["deviation"].is_constant
    assert all(plane[key].is_constant and plane[key].low == 0 for key in ("K", "k1", "k2"))
    assert np.isnan(plane["ratio"].values).all()


def test_curved_triangles_deviate_by_what_they_are_off() -> None:
    surface = catenoid_patch(4)
    found = surface.mesh()
    shown = surface_quantities(found, 0.0)
    assert not shown["deviation"].is_constant
    worst = np.abs(found.mean_curvature).max()
    assert max(-shown["deviation"].least, shown["deviation"].most) == worst
    assert 1e-7 < worst < 1e-2
    exact = -1 / np.cosh(found.points[:, 2]) ** 4
    np.testing.assert_allclose(shown["K"].values, exact, atol=1e-2)
