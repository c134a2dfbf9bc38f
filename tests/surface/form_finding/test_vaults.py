"""Vaults between two arches whose sides slide on the ground: halves of tubes, with the tubes' closed forms.

A half cylinder of radius R and length L, fixed at its arches: at fixed H its lowest Jacobi eigenvalue belongs to
sin(pi x / L), constant around (the ground leaves it free), and is (pi / L)^2 - 1 / R^2: stable while L < pi R.
"""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from scipy.optimize import brentq

from lamella.base.errors import InputError
from lamella.surface.boundary import Sliding, make_loop
from lamella.surface.boundary.arcs import bulge_arc
from lamella.surface.boundary.pieces import lines, stack
from lamella.surface.form_finding.enclosed_volume import enclosed_volume
from lamella.surface.form_finding.find import find_film
from surface.form_finding.films import random_places
from surface.form_finding.unduloid_pieces import Piece, unduloid_of_volume

SLOW = partial(pytest.param, marks=pytest.mark.slow)
R = 4.0
GROUND = {"point": np.zeros(3), "normal": np.array([0, 0, 1.0])}


def vault(length: float, drawn: float = R):
    """Half circles at x = 0 and x = length; the sides drawn with a corner at y = +-drawn. The normal points inwards."""

    def arch(x: float, side: float):
        axis = np.array([side, 0, 0])
        return bulge_arc(np.array([x, side * R, 0]), np.array([x, -side * R, 0]), 1.0, axis)

    def ground(x: float, y: float, end: float):
        return lines(np.array([[x, y, 0], [length / 2, np.sign(y) * drawn, 0], [end, y, 0]]), closed=False)

    parts = [arch(0.0, -1), ground(0.0, R, length), arch(length, 1), ground(length, -R, 0.0)]
    first = np.cumsum([0, *(part.count for part in parts)])
    sliding = [Sliding(int(first[k]), parts[k].count, **GROUND) for k in (1, 3)]
    return (make_loop("vault", stack(parts), sliding),)


def profile(found, length: float):
    """Distance from the axis and place along it, from the middle, at random places."""
    x = found.surface("x").at(random_places(found.equilibrium.film, 20_000)).position
    return np.hypot(x[:, 1], x[:, 2]), x[:, 0] - length / 2


def is_half_cylinder(found, length: float) -> bool:
    r, _ = profile(found, length)
    return bool(np.abs(r - R).max() < 1e-3 * R) and found.equilibrium.film.nodes[:, 2].min() > -1e-9


@pytest.mark.parametrize("length", [10.0, SLOW(12.0), 12.5])
def test_half_cylinder_up_to_pi_radii(length) -> None:
    found = find_film(vault(length), 1 / (2 * R))
    assert is_half_cylinder(found, length)
    assert found.stability.verdict in ("stable", "fold")
    assert found.stability.negative == 0
    assert found.stability.lowest == pytest.approx((np.pi / length) ** 2 - 1 / R**2, rel=0.01)


def test_half_cylinder_behind_pi_radii_is_unstable() -> None:
    length = 12.7
    found = find_film(vault(length), 1 / (2 * R), branch="unstable")
    assert is_half_cylinder(found, length)
    assert found.stability.negative == 1
    assert found.stability.lowest == pytest.approx((np.pi / length) ** 2 - 1 / R**2, rel=0.01)


def test_behind_pi_radii_the_stable_film_bulges() -> None:
    """Half of the unduloid about its bulge with neck + bulge = 1 / H, as in a tube between rings."""
    length = 12.7
    found = find_film(vault(length), 1 / (2 * R))
    assert found.stability.negative == 0
    bulge = brentq(lambda b: Piece(2 * R - b, b, R, about_bulge=True).length - length, 1.001 * R, 1.2 * R)
    r, x = profile(found, length)
    assert np.abs(r - Piece(2 * R - bulge, bulge, R, about_bulge=True).radius_at(x)).max() < 1e-3 * R


@pytest.mark.slow
def test_where_no_stable_film_is_the_unstable_one_is_told() -> None:
    """At 4 radii bulging vaults of H = 1 / (2 R) are gone too: a sphere of radius 2 R is 3.46 R long there."""
    length = 16.0
    with pytest.raises(InputError, match="there is an unstable surface") as error:
        find_film(vault(length), 1 / (2 * R))
    assert 'branch = "unstable"' in error.value.remedy
    assert error.value.where == "branch"
    own = float(error.value.remedy.split("its own is ")[1].split()[0])
    assert own == pytest.approx(-np.pi * R**2 * length / 2, rel=1e-3)


@pytest.mark.parametrize("drawn", [SLOW(2.5), 5.0, SLOW(6.0)])
def test_sides_drawn_elsewhere_come_to_their_place(drawn) -> None:
    found = find_film(vault(12.0, drawn), 1 / (2 * R))
    assert is_half_cylinder(found, 12.0)
    assert found.stability.negative == 0


@pytest.mark.parametrize(("length", "drawn"), [SLOW(10.0, R), (12.0, 6.0), SLOW(16.0, R), (24.0, R)])
def test_half_cylinder_of_given_volume(length, drawn) -> None:
    """pi R^2 L / 2 down to the ground, however the sides are drawn; stable at fixed volume up to 2 pi R (25.1 m)."""
    volume = np.pi * R**2 * length / 2
    found = find_film(vault(length, drawn), volume=-volume)
    assert is_half_cylinder(found, length)
    assert found.equilibrium.mean_curvature == pytest.approx(1 / (2 * R), rel=1e-6)
    assert enclosed_volume(found.equilibrium.film) == pytest.approx(-volume, rel=1e-9)
    assert found.stability.negative == int(length > np.pi * R)
    assert found.stability.lowest == pytest.approx((np.pi / length) ** 2 - 1 / R**2, rel=0.01)


@pytest.mark.parametrize("part", [0.7, SLOW(0.9), 1.3])
def test_vault_of_given_volume_is_half_an_unduloid(part) -> None:
    """A vault with both sides free on the ground is the half of an unduloid, by its volume."""
    length = 10.0
    tube = unduloid_of_volume(R, length, part * np.pi * R**2 * length, about_bulge=part > 1)
    found = find_film(vault(length), volume=-tube.volume / 2)
    assert found.equilibrium.mean_curvature == pytest.approx(tube.surface.mean_curvature, rel=2e-4)
    r, x = profile(found, length)
    assert np.abs(r - tube.radius_at(x)).max() < 2e-3 * R
