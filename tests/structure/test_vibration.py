"""Natural frequencies against closed forms, with the order in which errors fall."""

import numpy as np
import pytest

from lamella.structure.loads import make_loads, no_loads
from lamella.structure.static import at_rest, equilibrium
from lamella.structure.vibration import vibration
from structure.strips import orders, rod, strip

LENGTH = 2.0
# cos x cosh x = -1 (W. Weaver, S. P. Timoshenko, D. H. Young, Vibration Problems in Engineering, 5th ed., section 5.11)
CANTILEVER = np.array([1.875104068711961, 4.694091132974175, 7.854757438237613])


def unloaded(structure):
    return at_rest(structure, no_loads(structure))


def test_cantilever():
    section = rod(axial=1e10, mass=1.185)
    exact = CANTILEVER**2 * np.sqrt(section.bending_n / section.mass) / LENGTH**2 / (2 * np.pi)
    errors = [
        vibration(unloaded(strip(elements, LENGTH, section, {0: "all"})), 3).frequencies / exact - 1
        for elements in (4, 8, 16, 32)
    ]
    assert np.allclose([orders(mode)[-1] for mode in np.transpose(errors)], 4.0, atol=0.1)
    assert np.abs(errors[-1]).max() < 1e-5


def test_torsion_and_stretch():
    """Quarter waves of a bar: sqrt(G J / I_p) / 4 L and sqrt(E A / mu) / 4 L; second order."""
    for moved, section, speed in (
        ("rx", rod(mass=1.0, inertia_t=0.02), np.sqrt(8.0 / 0.02)),
        ("x", rod(axial=50.0, mass=2.0), np.sqrt(50.0 / 2.0)),
    ):
        others = " ".join(name for name in ("x", "y", "z", "rx", "ry", "rz") if name != moved)
        errors = []
        for elements in (4, 8, 16):
            held = dict.fromkeys(range(1, elements + 1), others) | {0: "all"}
            found = vibration(unloaded(strip(elements, LENGTH, section, held)))
            errors.append(found.frequencies[0] / (speed / (4 * LENGTH)) - 1)
        assert np.allclose(orders(errors), 2.0, atol=0.1)


def test_a_pull_tightens_a_string():
    """Between hinges, omega^2 = (pi / L)^2 (E I (pi / L)^2 + N) / mu."""
    section, pull, elements = rod(axial=1e10, mass=1.185), 30.0, 16
    structure = strip(elements, LENGTH, section, {0: "x y z rx", -1: "y z rx"})
    found = vibration(equilibrium(structure, make_loads(structure, forces={elements: (pull, 0, 0, 0, 0, 0)})))
    wave = np.pi / LENGTH
    exact = np.sqrt(wave**2 * (section.bending_n * wave**2 + pull) / section.mass) / (2 * np.pi)
    assert found.frequencies[0] == pytest.approx(exact, rel=1e-4)
