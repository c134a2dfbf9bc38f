"""Tubes between coaxial rings that no film without pressure spans: cylinders and unduloids, by H and by volume.

Unduloids in closed form: `lamella.surface.closed_forms.delaunay`. A cylinder of radius R and length L has the lowest
Jacobi eigenvalue (pi / L)^2 - 1 / R^2 at fixed H (DESIGN section 9).
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

from lamella.base.errors import InputError
from lamella.surface.boundary import make_loop
from lamella.surface.boundary.arcs import circle
from lamella.surface.form_finding.continuation import to_curvature
from lamella.surface.form_finding.enclosed_volume import enclosed_volume
from lamella.surface.form_finding.find import find_film, notes_on
from lamella.surface.form_finding.newton import find_equilibrium
from surface.form_finding.exact_patches import ring
from surface.form_finding.films import random_places, start
from surface.form_finding.unduloid_pieces import Piece, unduloid_of_volume


def between(radius: float, length: float):
    """The upper ring first, counter-clockwise from above: the normal points towards the axis, and H > 0."""
    return (ring(radius, length), ring(radius, 0.0))


def profile(found, length: float):
    """Radius and height over the middle at random places."""
    x = found.surface("x").at(random_places(found.equilibrium.film, 20_000)).position
    return np.hypot(x[:, 0], x[:, 1]), x[:, 2] - length / 2


@pytest.mark.parametrize(("radius", "length"), [(3.0, 8.0), (1.0, 3.0)])
def test_cylinder_where_no_catenoid_is(radius, length) -> None:
    """Beyond 1.3255 radii, below pi radii."""
    found = find_film(between(radius, length), 0.5 / radius)
    r, _ = profile(found, length)
    assert np.abs(r - radius).max() < 1e-3 * radius
    assert found.stability.verdict == "stable"
    assert found.stability.lowest == pytest.approx((np.pi / length) ** 2 - 1 / radius**2, rel=1e-3)


def test_reversed_rings_want_the_other_sign() -> None:
    """The lower ring first: the normal points away from the axis."""
    found = find_film(between(3.0, 8.0)[::-1], -1 / 6)
    assert np.abs(profile(found, 8.0)[0] - 3).max() < 3e-3


def test_wrong_sign_is_told() -> None:
    with pytest.raises(InputError, match=r"there is one of 0\.166667 1/m") as error:
        find_film(between(3.0, 8.0), -1 / 6)
    assert "mean_curvature = 0.166667, or reverse the first loop" in error.value.remedy


class TestCylinderAtPi:
    """At fixed H the lowest eigenvalue changes sign within 0.5 % of the length pi R."""

    def test_stable_before(self) -> None:
        length = 0.995 * np.pi
        found = find_film(between(1.0, length), 0.5)
        assert np.abs(profile(found, length)[0] - 1).max() < 1e-3
        assert found.stability.verdict == "stable"
        assert found.stability.lowest == pytest.approx((np.pi / length) ** 2 - 1, rel=0.02)

    def test_unstable_behind(self) -> None:
        length = 1.005 * np.pi
        found = find_film(between(1.0, length), 0.5, branch="unstable")
        assert np.abs(profile(found, length)[0] - 1).max() < 1e-3
        assert found.stability.verdict == "unstable"
        assert found.stability.negative == 1
        assert found.stability.lowest == pytest.approx((np.pi / length) ** 2 - 1, rel=0.02)

    def test_an_unduloid_takes_over(self) -> None:
        """Behind pi R the stable film of the same H bulges: neck + bulge = 1 / H, as long as the rings are apart."""
        length = 1.005 * np.pi
        found = find_film(between(1.0, length), 0.5)
        assert found.stability.verdict == "stable"
        bulge = brentq(lambda b: Piece(2 - b, b, 1.0, about_bulge=True).length - length, 1.001, 1.2)
        r, z = profile(found, length)
        assert np.abs(r - Piece(2 - bulge, bulge, 1.0, about_bulge=True).radius_at(z)).max() < 1e-3
        assert r.max() > 1.01


@pytest.mark.parametrize("part", [0.98, 0.995, 1.005, 1.02])
@pytest.mark.few(2)
def test_the_other_film_is_told_with_its_distance(part) -> None:
    """Cylinder and unduloid of one H: the estimate is exact to first order in the distance from pi radii."""
    length = part * np.pi
    found = find_film(between(1.0, length), 0.5)
    about_bulge = part > 1
    bulge = brentq(lambda b: Piece(2 - b, b, 1.0, about_bulge=about_bulge).length - length, 1.001, 1.2)
    assert found.stability.beside == pytest.approx(bulge - 1, rel=4 * abs(part - 1))
    (note,) = notes_on(found)
    assert "another surface of the same mean curvature is beside this one" in note
    assert 'branch = "unstable" finds the other' in note


def test_no_other_film_is_told_where_none_is_near() -> None:
    found = find_film(between(1.0, 2.0), 0.5)
    assert found.stability.beside > 0.1
    assert not notes_on(found)
    # of a volume there is one
    held = find_film(between(1.0, 1.005 * np.pi), volume=-1.005 * np.pi**2)
    assert not any("beside" in note for note in notes_on(held, given_curvature=False))


@pytest.mark.parametrize(
    ("radius", "length", "part"),
    [(3.0, 4.0, 100 / (36 * np.pi)), (1.0, 2.0, 0.97), (1.0, 2.0, 1.04), (1.0, 0.8, 1.05), (1.0, 5.0, 1.01)],
)
@pytest.mark.few(2)
def test_tube_of_given_volume(radius, length, part) -> None:
    """A part of the cylinder's volume: an unduloid about its neck below it, about its bulge above; also unstable at
    its own pressure (beyond pi radii), where it is stable at fixed volume."""
    volume = part * np.pi * radius**2 * length
    found = find_film(between(radius, length), volume=-volume)
    exact = unduloid_of_volume(radius, length, volume, about_bulge=part > 1)
    assert exact.volume == pytest.approx(volume, rel=1e-9)
    assert found.equilibrium.mean_curvature == pytest.approx(exact.surface.mean_curvature, rel=2e-4)
    assert enclosed_volume(found.equilibrium.film) == pytest.approx(-volume, rel=1e-9)
    r, z = profile(found, length)
    assert np.abs(r - exact.radius_at(z)).max() < 2e-3 * radius


def test_bent_tube_of_given_volume() -> None:
    """Between rings at a right angle no soap film is; turned to face each other they have one to begin with."""
    rings = (
        make_loop("low", circle(np.zeros(3), 1.0, np.array([0, 0, 1.0]))),
        make_loop("side", circle(np.array([2.0, 0, 2.0]), 1.0, np.array([1.0, 0, 0]))),
    )
    found = find_film(rings, volume=9.0, tolerance=0.03)
    assert enclosed_volume(found.equilibrium.film) == pytest.approx(9, rel=1e-9)
    measured = found.surface("x").measured(random_places(found.equilibrium.film, 20_000))
    off = np.abs(measured.mean_curvature - found.equilibrium.mean_curvature)
    assert off.max() < 0.03 * found.scale
    # the mirror plane of both rings, x + z = 2 with x and z exchanged, is that of the film
    x = found.equilibrium.film.nodes
    mirrored = np.column_stack([2 - x[:, 2], x[:, 1], 2 - x[:, 0]])
    assert np.linalg.norm(found.surface("x").closest(mirrored)[1] - mirrored, axis=1).max() < 5e-3


@pytest.mark.slow
def test_volume_of_the_wrong_sign_is_told() -> None:
    with pytest.raises(InputError, match=r"there is one of 100 m3") as error:
        find_film(between(3.0, 4.0)[::-1], volume=-100)
    assert error.value.where == "volume"


def test_family_runs_through_a_fold_of_its_volume() -> None:
    """Between near rings the volume of the nodoids falls and grows again on the way to the thin-necked catenoid."""
    told: list[str] = []
    loops = between(1.0, 0.8)
    thick = find_equilibrium(start(loops, 3))
    reached = to_curvature(thick, 0.0, lambda report: told.append(report.text), unstable=True)
    volumes = [abs(float(line.split("volume ")[1].split()[0])) for line in told if "volume" in line]
    assert min(volumes) < abs(enclosed_volume(reached.equilibrium.film)) - 0.005
    assert reached.equilibrium.negative == 1
