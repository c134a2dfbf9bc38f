"""Stresses of twisted strips.

1. the reference strip 100 x 1.5 mm of steel at kg = tg = 1/m; 2. the helix stress from the lengths of the fibres of
a twisted strip, to fourth order; 3. timber by normal and shear strength.
"""

import numpy as np
import pytest

from lamella import find_material
from lamella.strip.material import MATERIALS, Material
from lamella.strip.stress import bending, helix, restraint, shortening, stresses, torsion

STEEL = Material(7850, 200e9, 77e9, 235e6)
ONE = np.ones(1)


def test_reference_strip():
    """150, 116, +167 and -83 MPa; +83 more (0 in the centre, 250 at the edge) where the nodes hold the length.

    Timoshenko, Strength of Materials II (torsion of thin strips); figures of the Asymptotic Gridshell's section.
    """
    assert bending(STEEL, 0.0015, ONE)[0] / 1e6 == pytest.approx(150, abs=0.5)
    assert torsion(STEEL, 0.0015, ONE)[0] / 1e6 == pytest.approx(116, abs=0.6)
    assert helix(STEEL, 0.1, ONE, 0.05)[0] / 1e6 == pytest.approx(167, abs=0.5)
    assert helix(STEEL, 0.1, ONE, 0.0)[0] / 1e6 == pytest.approx(-83, abs=0.5)
    held = stresses(STEEL, 0.1, 0.0015, 0 * ONE, ONE, ONE, True)
    assert (held.helix_edge + held.restraint)[0] / 1e6 == pytest.approx(250, abs=0.5)
    assert (held.helix_centre + held.restraint)[0] == pytest.approx(0, abs=1)
    free = stresses(STEEL, 0.1, 0.0015, 0 * ONE, ONE, ONE, False)
    assert free.restraint[0] == 0
    assert free.von_mises[0] / 1e6 == pytest.approx(np.sqrt((150 + 166.667) ** 2 + 3 * 115.5**2), rel=1e-4)
    assert held.von_mises[0] / 1e6 == pytest.approx(np.sqrt((150 + 250) ** 2 + 3 * 115.5**2), rel=1e-4)
    assert held.utilisation[0] == pytest.approx(held.von_mises[0] / 235e6)
    assert shortening(0.1, ONE)[0] == pytest.approx(0.42e-3, abs=0.005e-3)


def test_strong_axis_bending_costs_ten_megapascal_per_thousandth():
    off = stresses(STEEL, 0.1, 0.0015, 1e-3 * ONE, 0 * ONE, 0 * ONE, False)
    assert off.von_mises[0] / 1e6 == pytest.approx(10)


def test_helix_stress_is_the_strain_of_helical_fibres():
    """A fibre at height z of a strip twisted by tg and shortened by e has length sqrt((1 - e)^2 + z^2 tg^2).

    With e chosen so that the mean strain vanishes its strain differs from the formula at fourth order in h tg.
    """
    h = 0.1
    z, weight = np.polynomial.legendre.leggauss(20)
    z, weight = z * h / 2, weight / 2

    def miss(tg):
        from scipy.optimize import brentq

        def strain(e):
            return np.sqrt((1 - e) ** 2 + (z * tg) ** 2) - 1

        e = brentq(lambda e: weight @ strain(e), 0, 0.1, xtol=1e-16)
        formula = np.array([helix(STEEL, h, np.array([tg]), zi)[0] for zi in z]) / STEEL.youngs_modulus
        assert e == pytest.approx(shortening(h, np.array([tg]))[0], rel=0.1)
        assert weight @ formula == pytest.approx(0, abs=1e-15)  # no resultant
        return np.abs(strain(e) - formula).max()

    assert 14 < miss(2.0) / miss(1.0) < 18


def test_restraint_cancels_the_shortening():
    assert restraint(STEEL, 0.08, 2 * ONE)[0] == pytest.approx(STEEL.youngs_modulus * 0.08**2 * 4 / 24)


def test_timber_is_judged_by_normal_and_shear_stress():
    timber = find_material("C24")
    s = stresses(timber, 0.12, 0.02, 0 * ONE, 0.1 * ONE, 0.5 * ONE, False)
    normal = s.bending + s.helix_edge
    assert s.utilisation[0] == pytest.approx(max(normal[0] / 24e6, s.torsion[0] / 4e6))


def test_every_material_is_plausible_and_sourced():
    for name, material in MATERIALS.items():
        assert material.source, name
        # isotropic metals: E / 2 (1 + nu) with nu from 0.25 to 0.35; timber's shear modulus is far lower
        ratio = material.youngs_modulus / material.shear_modulus
        assert 2.5 <= ratio <= 2.7 if material.shear_strength is None else 14 < ratio < 19, name
