"""Plate action of bent and twisted strips, against the strip solved anew with all of its strain (`plate_strip`)."""

import numpy as np
import pytest

from lamella.base.material import Material
from lamella.strip.plate import Plate, poisson_ratio
from lamella.strip.stress import stresses
from strip.plate_strip import plate_strip

E, NU = 200e9, 0.3
STEEL = Material(7850, E, E / (2 * (1 + NU)), 235e6)
ONE = np.ones(1)
SECTIONS = ((0.1, 0.0015), (0.06, 0.004), (0.08, 0.001), (0.2, 0.003))


def von_mises(h: float, t: float, kg: float, tg: float, held: bool) -> float:
    s = stresses(STEEL, h, t, curvature_error=0 * ONE, layer_curvature=0 * ONE, kg=kg * ONE, tg=tg * ONE, held=held)
    return float(s.von_mises[0])


def membrane(h: float, t: float, kg: float, tg: float, held: bool, share: float = 1.0) -> float:
    return float(Plate(STEEL, h, t, kg * ONE, tg * ONE).across(share, held).stress[0])


def test_edge_stress_over_that_of_a_strip_flat_across():
    """R(q) of E h^2/12 (tg^2 + nu kg^2), q = h^2 kg / t, as a least-squares solution of the same strip has it."""
    h, t = 0.1, 0.0015
    for q, ratio in zip((1, 2, 4, 8, 16, 32), (0.98, 0.93, 0.77, 0.48, 0.23, 0.11), strict=True):
        kg = q * t / h**2
        flat = E * h**2 / 12 * (kg**2 + NU * kg**2)
        assert membrane(h, t, kg, kg, False) / flat == pytest.approx(ratio, abs=0.006)


def test_strips_that_are_not_bent_stay_flat_across():
    """E tg^2 (z^2/2 - h^2/24), exactly, and R = 1 - q^2/53 on towards it."""
    h, t, tg = 0.1, 0.0015, 0.8
    for share in (0.0, 0.3, 1.0):
        flat = E * tg**2 * (share**2 * h**2 / 8 - h**2 / 24)
        assert membrane(h, t, 0.0, tg, False, share) == pytest.approx(flat, rel=1e-12)
        assert membrane(h, t, 1e-9, tg, False, share) == pytest.approx(flat, rel=1e-9)
        assert membrane(h, t, 1e-9, tg, True, share) == pytest.approx(flat + E * tg**2 * h**2 / 24, abs=1)
    q = 0.5
    kg = q * t / h**2
    assert membrane(h, t, kg, tg, False) / (E * h**2 / 12 * (tg**2 + NU * kg**2)) == pytest.approx(
        1 - q**2 / 53, abs=3e-4
    )


@pytest.mark.parametrize("held", [False, True])
@pytest.mark.parametrize(("h", "t"), SECTIONS)
def test_against_the_strip_solved_anew(h: float, t: float, held: bool):
    """Membrane stress across, and von Mises, of strips that steel could stand: within 1 % of the largest stress."""
    checked = 0
    for kg in (0.03, 0.3, 1.0, 2.0):
        for tg in (0.1, 0.4, 0.85, 1.5):
            exact = plate_strip(h, t, kg, tg, held=held, youngs_modulus=E, nu=NU)
            largest = exact.von_mises.max()
            if largest > 700e6:
                continue
            checked += 1
            assert von_mises(h, t, kg, tg, held) == pytest.approx(largest, rel=0.01)
            for row in (0, 37, 74, 100):
                found = membrane(h, t, kg, tg, held, exact.z[row] / (h / 2))
                assert found == pytest.approx(exact.stress[row], abs=0.015 * largest)
    assert checked >= 7


def test_beyond_what_strips_stand_the_error_grows():
    """The strain that is left out, tg^2 f^2 / 2, shows at several times that stress."""
    h, t = 0.2, 0.003
    exact = plate_strip(h, t, 0.9, 2.2, held=True)
    assert exact.von_mises.max() > 2e9
    assert 0.002 < abs(von_mises(h, t, 0.9, 2.2, True) / exact.von_mises.max() - 1) < 0.05


@pytest.mark.parametrize("kg", [0.0, 0.05, 0.6, 4.0])
def test_resultants(kg: float):
    """A strip free to shorten carries no axial force; one that is held what `mean_tension` says."""
    h, t, tg = 0.1, 0.0015, 0.9
    x, weight = np.polynomial.legendre.leggauss(30)
    for held in (False, True):
        stress = [membrane(h, t, kg, tg, held, share) for share in ((x + 1) / 2).tolist()]
        expected = Plate(STEEL, h, t, kg * ONE, tg * ONE).mean_tension()[0] if held else 0.0
        assert weight / 2 @ stress == pytest.approx(expected, abs=1e-9 * E * h**2 * tg**2)


def test_the_equation_and_its_edges():
    """D f^(4) = t kg sigma, and at free edges f^(2) = -nu kg and f^(3) = 0: by differences of f^(2)."""
    h, t, kg, tg = 0.08, 0.001, 0.7, 0.5
    stiffness = E * t**3 / (12 * (1 - NU**2))
    share = np.linspace(0.2, 1.0, 401)
    step = (share[1] - share[0]) * h / 2
    for held in (False, True):
        told = [Plate(STEEL, h, t, kg * ONE, tg * ONE).across(s, held) for s in share.tolist()]
        stress, curvature = (np.array([getattr(a, name)[0] for a in told]) for name in ("stress", "curvature"))
        balance = stiffness * np.diff(curvature, 2) / step**2 - t * kg * stress[1:-1]
        assert np.abs(balance).max() < 1e-4 * np.abs(t * kg * stress).max()
        assert curvature[-1] == pytest.approx(-NU * kg, rel=1e-9)
        third = (3 * curvature[-1] - 4 * curvature[-2] + curvature[-3]) / (2 * step)
        assert abs(third) < 1e-3 * np.abs(np.diff(curvature) / step).max()


def test_poisson_ratio():
    assert poisson_ratio(STEEL) == pytest.approx(0.3)
    # timber's E / 2G - 1 is no Poisson ratio
    assert poisson_ratio(Material(420, 11e9, 0.69e9, 24e6, 4e6)) == 0


def test_very_wide_thin_strips_do_not_overflow():
    for kg in (50.0, 1e4, 1e6):
        for held in (False, True):
            a = Plate(STEEL, 1.0, 1e-4, kg * ONE, ONE).across(0.5, held)
            assert np.isfinite(a.stress).all()
            assert np.isfinite(a.curvature).all()
