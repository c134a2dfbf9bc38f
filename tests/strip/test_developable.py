"""Curvatures of polylines on a surface, and the height a developable strip can have.

1. kn, kg, tg converge with order two to the unduloid's closed forms (DESIGN section 9). 2. At the buildable height the
ruled surface stops being regular: its area element, by differences, changes its sign there. 3. Necks and cylinders.
"""

import numpy as np
import pytest

from lamella import Cylinder, Unduloid
from lamella.strip.darboux_of_polyline import polyline_darboux
from lamella.strip.developable import buildable_height

UNDULOID = Unduloid(0.6, 1.4, (-8.0, 8.0))


def line(count: int, start: float = 0.5, end: float = 2.5):
    """A lamella U - V = const: its U, points and normals."""
    u = np.linspace(start, end, count)
    at = UNDULOID.at(u + 1j * u)
    return u, at.position, at.normal


def test_curvatures_of_a_lamella() -> None:
    """kn = H; with U increasing tg = T / r^2 on U - V = const, kg = (ln r)_U / (sqrt 2 r)."""
    errors = []
    for count in (40, 80):
        u, points, normals = line(count)
        kn, kg, tg, s = polyline_darboux(points, normals)
        profile = UNDULOID.profile(u)
        exact = profile.r_u / profile.r / (np.sqrt(2) * profile.r)
        sides = [
            np.abs(np.abs(kg) - np.abs(exact)),
            np.abs(np.abs(tg) - UNDULOID.flux / profile.r**2),
            np.abs(kn - 0.5),
        ]
        errors.append(max(side[3:-3].max() for side in sides))
        assert s[-1] == pytest.approx(np.sqrt(2) * np.trapezoid(profile.r, u), rel=1e-3)
    assert np.log2(errors[0] / errors[1]) > 1.8


@pytest.mark.parametrize("side", [1, -1])
def test_a_helix_on_a_cylinder_bears_no_developable_strip(side: int) -> None:
    """kg = 0 and tg = 1 / (2 R) all along: rulings would run along the curve, on either side."""
    at = Cylinder(2.0, (-5.0, 5.0)).at(np.linspace(-1, 1, 30) * (1 + 1j))
    # at the ends differences are one-sided
    assert (buildable_height(at.position, side * at.normal)[1:-1] == 0).all()


def test_any_curve_on_a_sphere_bears_one_up_to_the_centre() -> None:
    """tg = 0: the rulings are normals, a cone from the centre; on the outer side nothing limits it."""
    turn = np.linspace(0, 2, 40)
    for height in (0.0, 0.7):  # a great circle, whose kg is 0, and a small one
        across = np.sqrt(1 - height**2)
        inwards = -np.column_stack([across * np.cos(turn), across * np.sin(turn), np.full(40, height)])
        assert buildable_height(-3 * inwards, inwards)[1:-1] == pytest.approx(3, rel=2e-3)
        assert np.isinf(buildable_height(-3 * inwards, -inwards)[1:-1]).all()


def test_the_ruled_surface_folds_at_the_buildable_height() -> None:
    _, points, normals = line(400)
    _, kg, tg, s = polyline_darboux(points, normals)
    height = buildable_height(points, normals)
    ruling = normals + (tg / kg)[:, None] * np.gradient(points, s, axis=0)

    def area(z: np.ndarray) -> np.ndarray:
        """Of the ruled surface, signed by the side of the strip's own normal."""
        ahead = points + z[:, None] * ruling
        speed = np.gradient(points, s, axis=0) + z[:, None] * np.gradient(ruling, s, axis=0)
        assert ahead.shape == speed.shape
        across = np.cross(np.gradient(points, s, axis=0), normals)
        return (np.cross(speed, ruling) * across).sum(1)

    inside = np.flatnonzero(np.isfinite(height))[5:-5]
    inside = inside[(inside > 5) & (inside < 394)]
    assert len(inside) > 100
    z = np.where(np.isfinite(height), height, 1.0)
    below, above = area(0.95 * z)[inside], area(1.05 * z)[inside]
    assert (below > 0).all()
    assert (above < 0).all()


def test_none_at_a_neck() -> None:
    _, points, normals = line(41, -1.0, 1.0)
    height = buildable_height(points, normals)
    assert height[20] == 0
    assert height.argmin() in (19, 20, 21)
    assert height[5] > 0


def test_generator_of_a_cylinder_has_no_limit() -> None:
    """kg = tg = kn = 0: a flat strip of any height."""
    at = Cylinder(1.0, (0.0, 2.0)).at(np.linspace(0.1, 1.9, 20) + 0j)
    assert np.isinf(buildable_height(at.position, at.normal)).all()
