"""Films between coaxial rings and over one ring: both branches, the limits, and the messages beyond them.

Two catenaries cosh(d / 2 c) = 1 / c span two unit rings at a distance d below 1.3254868387, where they become one;
a cap of height h over a ring of radius R has H = 2 h / (h^2 + R^2) (DESIGN section 9).
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar

from lamella.base.errors import InputError
from lamella.surface.element.places import Places
from lamella.surface.form_finding.find import Found, find_film
from lamella.surface.form_finding.necessary_conditions import refuse_flux, refuse_impossible
from surface.form_finding.exact_patches import catenoid_neck, ring
from surface.form_finding.films import random_places

LIMIT = 1.3254868387


def rings(distance: float, small: float = 1.0):
    return (ring(1.0, distance), ring(small, 0.0))


def neck_of(found: Found) -> float:
    """Narrowest radius, refined from random places by a parabola through the lowest ones."""
    surface = found.surface("found")
    x = surface.at(random_places(found.equilibrium.film, 40_000)).position
    radius, z = np.hypot(x[:, 0], x[:, 1]), x[:, 2]
    near = radius < radius.min() * 1.05
    return float(np.polynomial.Polynomial.fit(z[near], radius[near], 4).linspace(1001)[1].min())


def is_sound(found: Found, tolerance: float) -> None:
    assert found.deviation <= tolerance
    assert np.isfinite(found.equilibrium.film.nodes).all()


class TestRings:
    def test_stable_film(self) -> None:
        found = find_film(rings(1.3))
        is_sound(found, 5e-3)
        assert not found.followed
        assert found.start_steps <= 8
        assert found.stability.verdict == "stable"
        assert neck_of(found) == pytest.approx(catenoid_neck(1.3, thin=False), abs=1e-5)

    def test_unstable_film(self) -> None:
        found = find_film(rings(1.3), branch="unstable")
        is_sound(found, 5e-3)
        assert found.followed
        assert found.stability.verdict == "unstable"
        assert found.stability.negative == 1
        assert neck_of(found) == pytest.approx(catenoid_neck(1.3, thin=True), abs=1e-5)

    @pytest.mark.parametrize(
        ("distance", "tolerance"),
        [pytest.param(0.4, 5e-3, marks=pytest.mark.slow), pytest.param(0.8, 5e-3, marks=pytest.mark.slow), (0.8, 0.03)],
    )
    def test_unstable_film_of_nearer_rings(self, distance, tolerance) -> None:
        """Necks of 0.0559 and 0.158 radii."""
        found = find_film(rings(distance), branch="unstable", tolerance=tolerance)
        is_sound(found, tolerance)
        assert found.stability.negative == 1
        assert neck_of(found) == pytest.approx(catenoid_neck(distance, thin=True), rel=1e-3)

    def test_both_branches_next_to_the_limit(self) -> None:
        """The eigenvalue changes sign within 0.5 % of the critical distance."""
        stable = find_film(rings(0.995 * LIMIT))
        unstable = find_film(rings(0.995 * LIMIT), branch="unstable")
        assert stable.stability.lowest > 0
        assert unstable.stability.lowest < 0
        for found, thin in ((stable, False), (unstable, True)):
            assert neck_of(found) == pytest.approx(catenoid_neck(0.995 * LIMIT, thin=thin), abs=1e-4)

    @pytest.mark.parametrize("scale", [1.0, 25.0])
    def test_refused_beyond_the_limit(self, scale) -> None:
        far = (ring(scale, 1.34 * scale), ring(scale, 0.0))
        with pytest.raises(InputError, match=r"1\.3254868") as error:
            find_film(far)
        assert "remedy" in str(error.value)
        assert f"{1.34 * scale:.6g} m apart" in str(error.value)

    def test_limit_is_the_exact_one(self) -> None:
        """Maximum of 2 x / cosh x, and refused or not within a part in a million of it."""
        best = minimize_scalar(
            lambda x: -2 * x / np.cosh(x), bounds=(0.5, 2), method="bounded", options={"xatol": 1e-12}
        )
        assert -best.fun == pytest.approx(LIMIT, abs=1e-9)
        refuse_impossible(rings(LIMIT * (1 - 1e-6)), 0.0)
        with pytest.raises(InputError):
            refuse_impossible(rings(LIMIT * (1 + 1e-6)), 0.0)

    @pytest.mark.parametrize("small", [0.9, 0.5, 0.2])
    def test_unequal_rings_have_a_limit_of_their_own(self, small) -> None:
        """The catenaries through (1, 0) and (small, d), by a search over their necks, on either side of it."""

        def distance(neck):
            return neck * (np.arccosh(1 / neck) + np.arccosh(small / neck))

        necks = np.linspace(1e-4, small, 200_001)
        limit = float(distance(necks[:-1]).max())
        refuse_impossible(rings(limit * (1 - 1e-5), small), 0.0)
        with pytest.raises(InputError, match="rings"):
            refuse_impossible(rings(limit * (1 + 1e-5), small), 0.0)
        # and a film is there next to it
        found = find_film(rings(0.98 * limit, small))
        assert found.stability.verdict == "stable"
        # of the two catenaries the one with the thicker neck
        thick = brentq(lambda c: distance(c) - 0.98 * limit, necks[distance(necks[:-1]).argmax()], small - 1e-12)
        if distance(small - 1e-12) < 0.98 * limit:
            assert neck_of(found) == pytest.approx(thick, abs=1e-4)

    def test_rings_side_by_side_are_refused_by_the_cone(self) -> None:
        """No connected minimal surface leaves a cone of half opening arctan 1.5089 at both ends (Hildebrandt)."""

        class Shifted:
            def __init__(self, rim, shift) -> None:
                self.rim, self.shift = rim, np.asarray(shift)
                self.name, self.length, self.corners, self.slides = rim.name, rim.length, rim.corners, ()

            def at(self, t):
                return self.rim.at(t) + self.shift

        far = (ring(1.0, 3.0), Shifted(ring(1.0, 0.0), [0.3, 0, 0]))
        with pytest.raises(InputError, match="cone"):
            refuse_impossible(far, 0.0)
        near = (ring(1.0, 1.0), Shifted(ring(1.0, 0.0), [0.3, 0, 0]))
        refuse_impossible(near, 0.0)


class TestCap:
    def test_found_up_to_the_hemisphere(self) -> None:
        """H R = 0.999: h = (1 - sqrt(1 - (H R)^2)) / H on the stable side."""
        found = find_film((ring(1.0, 0.0),), 0.999)
        is_sound(found, 5e-3)
        height = (1 - np.sqrt(1 - 0.999**2)) / 0.999
        x = found.surface("found").at(random_places(found.equilibrium.film, 20_000)).position
        # H > 0 bends towards the normal, which is upwards: a bowl
        centre, radius = np.array([0, 0, 1 / 0.999 - height]), 1 / 0.999
        assert np.abs(np.linalg.norm(x - centre, axis=1) - radius).max() < 1e-3
        assert x[:, 2].min() == pytest.approx(-height, abs=2e-3)
        assert found.stability.lowest > 0

    def test_refused_beyond_it(self) -> None:
        with pytest.raises(InputError, match=r"\|H\| <= length / \(2 area\) = 1 ") as error:
            find_film((ring(1.0, 0.0),), 1.001)
        assert error.value.where == "mean_curvature"

    @pytest.mark.parametrize("mean_curvature", [0.999999, -0.999999])
    def test_bound_is_exact(self, mean_curvature) -> None:
        refuse_flux((ring(1.0, 0.0),), mean_curvature)
        with pytest.raises(InputError):
            refuse_flux((ring(1.0, 0.0),), 1.00001 * np.sign(mean_curvature))

    def test_hemisphere_by_its_volume(self) -> None:
        """V = 2 pi R^3 / 3: |H| = 1 / R, where H along the family of caps is largest: the fold at fixed H."""
        found = find_film((ring(1.0, 0.0),), volume=2 * np.pi / 3)
        assert abs(found.equilibrium.mean_curvature) == pytest.approx(1, rel=1e-4)
        assert found.stability.verdict == "fold"

    @pytest.mark.parametrize("part", [0.75, 0.95, 0.99])
    @pytest.mark.slow
    def test_most_of_a_sphere_by_its_volume(self, part) -> None:
        """A cap as high as a part of its sphere: a^2 = 4 part (1 - part) R^2, V = pi h^2 (3 R - h) / 3."""
        radius = 1 / (2 * np.sqrt(part * (1 - part)))
        h = 2 * radius * part
        found = find_film((ring(1.0, 0.0),), volume=np.pi * h**2 * (3 * radius - h) / 3)
        assert found.equilibrium.mean_curvature == pytest.approx(-1 / radius, rel=1e-4)
        assert found.start_steps < 80
        x = found.surface("x").at(random_places(found.equilibrium.film, 20_000)).position
        assert np.abs(np.linalg.norm(x - [0, 0, h - radius], axis=1) - radius).max() < 2e-3 * radius
        assert found.stability.negative == 1

    def test_flat_loop_has_no_unstable_film_without_pressure(self) -> None:
        """No minimal surface leaves the convex hull of its boundary."""
        with pytest.raises(InputError, match="the boundary is flat"):
            find_film((ring(1.0, 0.0),), branch="unstable")

    def test_other_cap_of_the_same_curvature(self) -> None:
        """Beyond the hemisphere: h = (1 + sqrt(1 - (H R)^2)) / H."""
        found = find_film((ring(1.0, 0.0),), 0.8, branch="unstable")
        is_sound(found, 5e-3)
        x = found.surface("found").at(random_places(found.equilibrium.film, 20_000)).position
        height = (1 + np.sqrt(1 - 0.8**2)) / 0.8
        assert x[:, 2].min() == pytest.approx(-height, abs=2e-3)
        assert found.stability.negative == 1


def test_normal_follows_the_outer_loop() -> None:
    found = find_film((ring(1.0, 0.0),), 0.3)
    m = len(found.equilibrium.film.connectivity.elements)
    at = found.surface("x").measured(Places(np.arange(m), np.full((m, 2), 1 / 3)))
    assert at.normal[:, 2].min() > 0.5
    assert at.mean_curvature == pytest.approx(0.3, abs=0.01)
