"""Eigenvalues of the Jacobi operator -Laplace - |A|^2 against closed forms, and where the lowest one changes sign."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import lpmv

from lamella.surface.form_finding.newton import FixedH, find_equilibrium
from lamella.surface.form_finding.stability import stability_of
from surface.form_finding.exact_patches import catenoid_neck
from surface.form_finding.films import disc_film, tube

J01 = 2.404825557695773  # first zero of the Bessel function J0 (Abramowitz and Stegun, table 9.5)


def slope(errors) -> float:
    return float(-np.polyfit(np.arange(len(errors)), np.log2(errors), 1)[0])


def cylinder(length: float, order: int, across: int):
    """Radius 1, seen from inside: H = 1/2."""
    return tube(lambda s: (1 + 0 * s, s), np.linspace(0, length, across + 1), 2 * across, order, inwards=True)


def catenoid(distance: float, *, thin: bool, rows: int, order: int = 4):
    """Between unit rings."""
    neck = catenoid_neck(distance, thin=thin)
    u = distance / 2 / neck
    return tube(lambda s: (neck * np.cosh(s), neck * s), np.linspace(-u, u, rows), 16, order)


def catenoid_eigenvalue(distance: float, *, thin: bool) -> float:
    """Lowest eigenvalue by shooting: phi'' = -(2 / cosh^2 u + lambda c^2 cosh^2 u) phi, even, phi = 0 at the rings.

    The metric is c^2 cosh^2 u (du^2 + dv^2) and |A|^2 = 2 / (c cosh^2 u)^2.
    """
    neck = catenoid_neck(distance, thin=thin)
    end = distance / 2 / neck

    def at_ring(eigenvalue):
        def derivative(u, y):
            return [y[1], -(2 / np.cosh(u) ** 2 + eigenvalue * neck**2 * np.cosh(u) ** 2) * y[0]]

        return solve_ivp(derivative, (0, end), [1.0, 0.0], rtol=1e-9, atol=1e-11).y[0, -1]

    # from far below upwards: the first sign change
    trial = np.concatenate([-2 / neck**2 * np.linspace(1, 0.01, 30), np.linspace(0.1, 60, 60)])
    values = [at_ring(t) for t in trial]
    k = int(np.flatnonzero(np.diff(np.sign(values)))[0])
    return brentq(at_ring, trial[k], trial[k + 1], xtol=1e-12)


@pytest.mark.parametrize("order", [2, 3, 4])
def test_flat_disc_rings_like_a_drum(order) -> None:
    """(j01 / R)^2; eigenvalues converge with h^(2 p), less what the curved rim's area is off."""
    errors = []
    for rings in (2, 4, 8) if order == 4 else (3, 6, 12):
        result = stability_of(disc_film(order, rings), 0.0)
        assert result.verdict == "stable"
        assert result.negative == 0
        errors.append(abs(result.lowest - J01**2))
    assert slope(errors) > order + 0.5, errors
    assert np.abs(result.mode).max() == pytest.approx(1)


@pytest.mark.parametrize("order", [2, 3, 4])
def test_cylinder(order) -> None:
    """(pi / L)^2 - 1 / R^2 of the mode sin(pi z / L)."""
    length = 2.0
    errors = [
        abs(stability_of(cylinder(length, order, n), 0.5).lowest - ((np.pi / length) ** 2 - 1)) for n in (3, 6, 12)
    ]
    assert slope(errors) > 2 * order - 2.2, errors
    assert errors[-1] < 1e-3


def test_spherical_cap() -> None:
    """nu (nu + 1) - 2 over R^2, with P_nu(cos alpha) = 0 at the rim (Laplace's operator in polar angle)."""
    from scipy.special import eval_legendre

    alpha = np.pi / 4  # of a sphere of radius sqrt(2) over the unit circle
    nu = brentq(lambda nu: eval_legendre(nu, np.cos(alpha)), 1.5, 4)
    assert lpmv(0, nu, np.cos(alpha)) == pytest.approx(0, abs=1e-10)
    exact = (nu * (nu + 1) - 2) / 2
    errors = [
        abs(stability_of(disc_film(4, rings, lambda r2: -np.sqrt(2 - r2)), 1 / np.sqrt(2)).lowest - exact)
        for rings in (2, 4, 8)
    ]
    assert slope(errors) > 4, errors
    assert errors[-1] < 1e-5


@pytest.mark.parametrize(("factor", "sign"), [(0.995, 1), (1.005, -1)])
def test_cylinder_turns_unstable_at_pi_times_its_radius(factor, sign) -> None:
    """At fixed H (DESIGN section 9): Newton's method stays on the cylinder on either side."""
    length = factor * np.pi
    found = find_equilibrium(cylinder(length, 4, 8), 0.5, FixedH(stable=False))
    radius = np.hypot(found.film.nodes[:, 0], found.film.nodes[:, 1])
    assert np.abs(radius - 1).max() < 1e-4
    result = stability_of(found.film, 0.5)
    assert np.sign(result.lowest) == sign
    assert result.lowest == pytest.approx((np.pi / length) ** 2 - 1, rel=0.05)
    assert result.negative == (sign < 0)
    assert found.negative == (sign < 0)


def test_cylinder_at_pi_times_its_radius_is_at_the_fold() -> None:
    assert stability_of(cylinder(np.pi, 4, 8), 0.5).verdict == "fold"
    assert stability_of(cylinder(0.9 * np.pi, 4, 8), 0.5).verdict == "stable"
    assert stability_of(cylinder(1.1 * np.pi, 4, 8), 0.5).verdict == "unstable"


@pytest.mark.parametrize("thin", [False, True])
@pytest.mark.parametrize("distance", [0.5, 0.9, 1.2, 1.3254868387 * 0.995])
@pytest.mark.few(4)
def test_catenoids_between_rings(distance, thin) -> None:
    """Both films: the thick one is stable, the thin one has one negative eigenvalue, far from nought when very thin."""
    film = catenoid(distance, thin=thin, rows=25 if thin else 9)
    found = find_equilibrium(film, condition=FixedH(stable=False))
    result = stability_of(found.film, 0.0)
    exact = catenoid_eigenvalue(distance, thin=thin)
    assert np.sign(exact) == (-1 if thin else 1)
    assert result.lowest == pytest.approx(exact, rel=0.01)
    assert result.negative == found.negative == int(thin)
    assert result.verdict in (("unstable", "fold") if thin else ("stable", "fold"))
    # the mode is one bump around the neck
    radius = np.hypot(film.nodes[:, 0], film.nodes[:, 1])
    assert radius[np.abs(result.mode).argmax()] < radius.min() * 1.3


def test_several_negative_eigenvalues_are_counted() -> None:
    """A cylinder of length L has as many negative modes as whole half waves longer than pi fit: floor(L / pi)."""
    for length, count in ((1.5 * np.pi, 1), (2.5 * np.pi, 2), (3.5 * np.pi, 3)):
        result = stability_of(cylinder(length, 3, 14), 0.5)
        assert result.negative == count
        assert result.lowest == pytest.approx((np.pi / length) ** 2 - 1, rel=0.01)
