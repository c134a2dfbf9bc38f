"""Largest measures: closed forms on a cylinder, and utilisations computed anew elsewhere."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import lamella
from lamella import Material, Section
from lamella.base.material import MATERIALS
from lamella.strip.lamellas import largest_utilisation
from lamella.strip.sizing import LARGEST_SHARE, LEAST_SHARE_TRIED, STEP, STEP_HALVINGS, Sizing, largest_measures
from lamella.strip.stress import torsion_shape

# of what is found: the last step
FOUND = STEP ** (0.5**STEP_HALVINGS) - 1
RADIUS = 1.2
TWIST = 1 / (2 * RADIUS)
SECTION = Section(height=0.12, thickness=0.0015, layers=1, marks="relaxed")
STEEL = MATERIALS["1.4301"]


@pytest.fixture(scope="module")
def cylinder() -> lamella.Network:
    """Its lamellas are helices at 45 deg: kg = 0, tg = 1 / 2R everywhere."""
    return lamella.net(lamella.Cylinder(RADIUS, (0.0, 2.0)), cells=8)


@pytest.mark.parametrize("safety", [0.7, 1.0, 1.5])
def test_thickness_and_height_of_a_cylinder(cylinder: lamella.Network, safety: float) -> None:
    # von Mises at the edge: (E tg^2 h^2 / 12)^2 + 3 (G t tg)^2 (Timoshenko, Strength of Materials II, art. 54)
    sizing = largest_measures(cylinder, SECTION, STEEL, safety)
    limit = STEEL.strength / safety
    helix = STEEL.youngs_modulus * TWIST**2 * SECTION.height**2 / 12
    shear = STEEL.shear_modulus * SECTION.thickness * TWIST
    thickness = np.sqrt((limit**2 - helix**2) / 3) / (STEEL.shear_modulus * TWIST)
    height = np.sqrt(12 / STEEL.youngs_modulus * np.sqrt(limit**2 - 3 * shear**2)) / TWIST
    assert sizing.thickness == pytest.approx(thickness, rel=2 * FOUND)
    assert sizing.height == pytest.approx(height, rel=2 * FOUND)
    assert np.all(sizing.thickness <= thickness * (1 + 1e-9))
    assert np.all(np.isinf(sizing.offset))


def test_timber_by_design_values(cylinder: lamella.Network) -> None:
    # EN 1995-1-1: k_mod f / gamma_M, k_shape of the torsion strength; bending and torsion by the sum of squares
    timber = replace(MATERIALS["C24"], k_mod=0.6, gamma_m=1.3)
    section = replace(SECTION, height=0.1, thickness=0.004)
    assert torsion_shape(25.0) == 1.3
    assert torsion_shape(2.0) == pytest.approx(1.1)
    helix = timber.youngs_modulus * TWIST**2 * section.height**2 / 12
    left = np.sqrt((0.6 / 1.3) ** 2 - (helix / timber.strength) ** 2)
    thickness = left * 1.3 * timber.shear_strength / (timber.shear_modulus * TWIST)
    assert section.height / thickness > 6
    assert largest_measures(cylinder, section, timber, 1.0).thickness == pytest.approx(thickness, rel=2 * FOUND)
    # GFRP: the user's limits, each by itself
    gfrp = Material(1850, 28e9, 3e9, 240e6, 25e6)
    alone = gfrp.shear_strength / (gfrp.shear_modulus * TWIST)
    found = largest_measures(cylinder, replace(section, height=0.3), gfrp, 1.0).thickness
    assert found == pytest.approx(alone, rel=2 * FOUND)


def test_what_is_found_is_at_the_limit_on_a_net_with_all_stresses() -> None:
    network = lamella.net(lamella.Catenoid(1.0, (-0.6, 0.8)), cells=8)
    section, safety = Section(height=0.06, thickness=0.001, layers=2, offset=0.03), 1.3
    sizing = largest_measures(network, section, STEEL, safety)
    for measure, values in sizing.measures().items():
        least = float(values.min())
        at, beyond = (
            largest_utilisation(network, replace(section, **{measure: least * factor}), STEEL) * safety
            for factor in (1.0, 1 + 4 * FOUND)
        )
        assert at <= 1 + 1e-12
        assert beyond > 1
        # all smaller ones are elastic too
        for share in np.linspace(0.1, 1.0, 7):
            smaller = replace(section, **{measure: least * share})
            if smaller.offset > smaller.thickness and smaller.thickness < smaller.height:
                assert largest_utilisation(network, smaller, STEEL) * safety <= 1 + 1e-12
    assert sizing.thickness.shape == (len(network.ids),)


def test_none_does_and_all_do(cylinder: lamella.Network) -> None:
    never = largest_measures(cylinder, replace(SECTION, height=1.0), STEEL, 1.0)
    assert np.all(never.thickness == 0.0)
    always = largest_measures(cylinder, SECTION, replace(STEEL, strength=1e12), 1.0)
    assert np.all(np.isinf(always.thickness))
    assert isinstance(always, Sizing)
    assert LEAST_SHARE_TRIED < 1 < LARGEST_SHARE
