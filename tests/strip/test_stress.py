"""Stresses of twisted strips.

1. the reference strip 100 x 1.5 mm of steel; 2. the helix stress of a strip that is not bent from the lengths of the
fibres of a twisted strip, to fourth order; 3. net section at slots; 4. timber by normal and shear strength.
"""

import numpy as np
import pytest

from lamella import find_material
from lamella.base.material import MATERIALS, Material
from lamella.strip.plate import Plate
from lamella.strip.stress import Stresses, bending, net_section, shortening, stresses, torsion

STEEL = Material(7850, 200e9, 77e9, 235e6)
ONE, ZERO = np.ones(1), np.zeros(1)


def strip(
    kg: float,
    tg: float,
    *,
    off: float = 0.0,
    layer: float = 0.0,
    held: bool = False,
    size=(0.1, 0.0015),
    material=STEEL,
) -> Stresses:
    return stresses(
        material, *size, curvature_error=off * ONE, layer_curvature=layer * ONE, kg=kg * ONE, tg=tg * ONE, held=held
    )


def test_reference_strip():
    """150 and 116 MPa at kg = tg = 1/m; +167 and -83 MPa of helix stress at kg = 0, +83 more where nodes hold the
    length.

    Timoshenko, Strength of Materials II (torsion of thin strips); figures of the Asymptotic Gridshell's section.
    """
    assert bending(STEEL, 0.0015, ONE)[0] / 1e6 == pytest.approx(150, abs=0.5)
    assert torsion(STEEL, 0.0015, ONE)[0] / 1e6 == pytest.approx(116, abs=0.6)
    assert shortening(0.1, ONE)[0] == pytest.approx(0.42e-3, abs=0.005e-3)
    held, free = strip(0.0, 1.0, held=True), strip(0.0, 1.0)
    assert free.helix_edge[0] / 1e6 == pytest.approx(166.667, abs=0.001)
    assert free.helix_centre[0] / 1e6 == pytest.approx(-83.333, abs=0.001)
    assert (held.helix_edge + held.restraint)[0] / 1e6 == pytest.approx(250, abs=0.001)
    assert (held.helix_centre + held.restraint)[0] == pytest.approx(0, abs=1)
    assert free.restraint[0] == 0
    assert free.von_mises[0] / 1e6 == pytest.approx(np.sqrt(166.667**2 + 3 * 115.5**2), rel=1e-4)
    assert held.von_mises[0] / 1e6 == pytest.approx(np.sqrt(250**2 + 3 * 115.5**2), rel=1e-4)
    assert held.utilisation[0] == pytest.approx(held.von_mises[0] / 235e6)


def test_strong_axis_bending_costs_ten_megapascal_per_thousandth():
    off = strip(0.0, 0.0, off=1e-3)
    assert off.von_mises[0] / 1e6 == pytest.approx(10)
    assert off.layer[0] == 0


def test_a_layer_beside_adds_to_the_strong_axis():
    """E h/2 d |tg'| at the edge, where it meets the helix stress and, on one face, weak-axis bending."""
    s = strip(0.0, 1.0, layer=2e-3)
    assert s.layer[0] / 1e6 == pytest.approx(20)
    assert s.von_mises[0] / 1e6 == pytest.approx(np.hypot(166.667 + 20, np.sqrt(3) * 115.5), rel=1e-5)
    bent = strip(0.1, 0.0, layer=2e-3)
    assert bent.von_mises[0] / 1e6 == pytest.approx(15 + 20, rel=0.02)


def test_helix_stress_is_the_strain_of_helical_fibres():
    """A fibre at height z of a strip twisted by tg and shortened by e has length sqrt((1 - e)^2 + z^2 tg^2).

    With e chosen so that the mean strain vanishes its strain differs from the stress of a strip that is not bent, over
    E, at fourth order in h tg.
    """
    from scipy.optimize import brentq

    h = 0.1
    share, weight = np.polynomial.legendre.leggauss(20)
    z, weight = share * h / 2, weight / 2

    def miss(tg):
        def strain(e):
            return np.sqrt((1 - e) ** 2 + (z * tg) ** 2) - 1

        e = brentq(lambda e: weight @ strain(e), 0, 0.1, xtol=1e-16)
        told = [Plate(STEEL, h, 0.0015, ZERO, tg * ONE).across(abs(x), False).stress[0] for x in share.tolist()]
        formula = np.array(told) / STEEL.youngs_modulus
        assert e == pytest.approx(shortening(h, tg * ONE)[0], rel=0.1)
        assert weight @ formula == pytest.approx(0, abs=1e-15)  # no resultant
        return np.abs(strain(e) - formula).max()

    assert 14 < miss(2.0) / miss(1.0) < 18


def test_net_section_is_half_of_the_height():
    """A strip h high that carries N and M: sigma = N / (t h/2) + M / (t (h/2)^2 / 6) on the half that is left."""
    h, t, force, moment = 0.1, 0.0015, 3e3, 40.0
    whole_tension, whole_bending = force / (h * t), moment / (t * h**2 / 6)
    half = force / (t * h / 2) + moment / (t * (h / 2) ** 2 / 6)
    assert net_section(0 * ONE, whole_tension * ONE, whole_bending * ONE)[0] == pytest.approx(half)
    s = strip(0.0, 0.5, layer=1e-3, held=True)
    tension = Plate(STEEL, h, t, ZERO, 0.5 * ONE).mean_tension()[0]
    assert tension == pytest.approx(200e9 * h**2 * 0.25 / 24)
    expected = np.hypot(2 * tension + 4 * s.layer[0], np.sqrt(3) * s.torsion[0]) / 235e6
    assert s.net_utilisation[0] == pytest.approx(expected)
    # a strip free to shorten carries no axial force
    assert strip(0.0, 0.5).net_utilisation[0] == pytest.approx(np.sqrt(3) * s.torsion[0] / 235e6)


def test_timber_is_judged_by_normal_and_shear_stress():
    timber = find_material("C24")
    s = strip(0.0, 0.5, size=(0.12, 0.02), material=timber)
    assert s.utilisation[0] == pytest.approx(max(s.helix_edge[0] / 24e6, s.torsion[0] / 4e6))
    bent = strip(0.1, 0.0, size=(0.12, 0.02), material=timber)
    assert bent.utilisation[0] == pytest.approx(bent.bending[0] / 24e6)


def test_every_material_is_plausible_and_sourced():
    for name, material in MATERIALS.items():
        assert material.source, name
        # isotropic metals: E / 2 (1 + nu) with nu from 0.25 to 0.35; timber's shear modulus is far lower
        ratio = material.youngs_modulus / material.shear_modulus
        assert 2.5 <= ratio <= 2.7 if material.shear_strength is None else 14 < ratio < 19, name
