"""Buckling loads against their closed forms, with the order in which errors fall."""

import numpy as np
import pytest
from scipy.optimize import brentq

from lamella import InputError
from lamella.structure.beam.beams import make_beams
from lamella.structure.beam.poses import Poses, straight_poses
from lamella.structure.buckling import critical_point, linear_buckling
from lamella.structure.loads import make_loads
from lamella.structure.static import at_rest, equilibrium
from lamella.structure.structure import make_structure
from structure.strips import STRIP, orders, rod, strip

LENGTH = 2.0


@pytest.mark.parametrize(
    ("first", "last", "share"),
    [
        ("all", "", 0.25),
        ("x y z rx", "y z rx", 1.0),
        # tan(x) = x
        ("all", "y z rx", (4.493409457909064 / np.pi) ** 2),
        ("all", "y z rx ry rz", 4.0),
    ],
)
def test_euler_columns(first, last, share):
    """share pi^2 E I / L^2 (S. P. Timoshenko, J. M. Gere, Theory of Elastic Stability, section 2.1): fourth order."""
    section = rod(axial=1e10)
    errors = []
    for elements in (8, 16, 32):
        structure = strip(elements, LENGTH, section, {0: first, -1: last})
        found = linear_buckling(at_rest(structure, make_loads(structure, forces={elements: (-1, 0, 0, 0, 0, 0)})))
        errors.append(found.factors[0] / (share * np.pi**2 * section.bending_n / LENGTH**2) - 1)
    assert np.allclose(orders(errors), 4.0, atol=0.1)
    assert abs(errors[-1]) < 1e-4


def test_several_modes_of_a_column():
    """n^2 pi^2 E I / L^2, and the modes are sine waves."""
    section, elements = rod(axial=1e10), 24
    structure = strip(elements, LENGTH, section, {0: "x y z rx", -1: "y z rx"})
    loads = make_loads(structure, forces={elements: (-1, 0, 0, 0, 0, 0)})
    found = linear_buckling(at_rest(structure, loads), 4)
    waves = np.arange(1, 5)
    assert found.factors == pytest.approx(waves**2 * np.pi**2 * section.bending_n / LENGTH**2, rel=1e-3)
    shape = found.modes[1].reshape(-1, 6)[:, 1]
    sine = np.sin(2 * np.pi * np.linspace(0, 1, elements + 1))
    assert np.abs(shape / np.abs(shape).max()) == pytest.approx(np.abs(sine), abs=1e-3)


def test_many_columns_that_are_nearly_alike():
    """Forty columns side by side, each longer by 1e-5 than the one before: the three longest buckle first, at the loads
    that each of them has alone."""
    section, elements, count = rod(), 4, 40
    lengths = LENGTH * (1 + 1e-5 * np.arange(count))
    alone = []
    for length in lengths[-3:]:
        column = strip(elements, length, section, {0: "all"})
        start = at_rest(column, make_loads(column, forces={elements: (-1, 0, 0, 0, 0, 0)}))
        alone.append(linear_buckling(start).factors[0])
    poses = [straight_poses(length, elements) for length in lengths]
    points = np.concatenate([p.points + np.array([0, k, 0]) for k, p in enumerate(poses)])
    frames = np.concatenate([p.frames for p in poses])
    first = (elements + 1) * np.arange(count)
    nodes = first[:, None, None] + np.stack((np.arange(elements), np.arange(1, elements + 1)), 1)
    beams = make_beams(nodes.reshape(-1, 2), np.repeat(lengths / elements, elements), section)
    structure = make_structure(Poses(points, frames, np.zeros(0)), beams, dict.fromkeys(first.tolist(), "all"))
    loads = make_loads(structure, forces=dict.fromkeys((first + elements).tolist(), (-1, 0, 0, 0, 0, 0)))
    found = linear_buckling(at_rest(structure, loads), 3)
    assert found.factors == pytest.approx(sorted(alone), rel=1e-8)


def test_column_under_its_own_weight():
    """q L^3 / E I = 7.83734744 (A. G. Greenhill 1881; Timoshenko and Gere, section 2.12)."""
    section = rod(axial=1e10)
    errors = []
    for elements in (4, 8, 16):
        structure = strip(elements, LENGTH, section, {0: "all"})
        found = linear_buckling(at_rest(structure, make_loads(structure, lines=(-1, 0, 0))))
        errors.append(found.factors[0] * LENGTH**3 / section.bending_n / 7.837347438943 - 1)
    assert np.allclose(orders(errors), 4.0, atol=0.4)


def test_about_a_loaded_state():
    """Half of the critical load on: the same critical load is left."""
    section, elements = rod(), 8
    structure = strip(elements, LENGTH, section, {0: "all"})
    loads = make_loads(structure, forces={elements: (-1, 0, 0, 0, 0, 0)})
    first = linear_buckling(at_rest(structure, loads)).factors[0]
    half = equilibrium(structure, loads, factor=first / 2)
    assert linear_buckling(half).factors[0] == pytest.approx(first, rel=1e-7)
    assert critical_point(half).factors[0] == pytest.approx(first, rel=1e-6)
    beyond = equilibrium(structure, loads, factor=1.1 * first)
    assert beyond.negative == 1
    with pytest.raises(InputError) as refused:
        linear_buckling(beyond)
    assert refused.value.where == "equilibrium"


def end_moments(elements: int, section):
    """A beam between forks, under equal moments about its strong axis."""
    structure = strip(elements, LENGTH, section, {0: "x y z rx", -1: "y z rx"})
    loads = make_loads(structure, forces={0: (0, 0, 0, 0, -1, 0), elements: (0, 0, 0, 0, 1, 0)})
    return at_rest(structure, loads)


def test_strip_under_end_moments():
    """pi / L sqrt(E I_n G J): lateral-torsional buckling (A. G. M. Michell, L. Prandtl 1899; Timoshenko and Gere,
    section 6.2), second order: the moment bends in one element and twists in the next."""
    errors = []
    for elements in (8, 16, 32):
        found = linear_buckling(end_moments(elements, STRIP))
        errors.append(found.factors[0] / (np.pi / LENGTH * np.sqrt(STRIP.bending_n * STRIP.torsion)) - 1)
    assert np.allclose(orders(errors), 2.0, atol=0.1)
    assert abs(errors[-1]) < 1e-3


def test_bending_before_lateral_buckling():
    """The critical moment with all motion before it, of a beam that is not much stiffer about its strong axis.

    Kirchhoff's rod bent to a circle by M about a fixed axis; small curvatures k3 and twist k1 beside it obey
    G J k1' = M a k3, E I_n k3' = -M b k1 with a = 1 - E I_n / E I_u, b = 1 - G J / E I_u. The forks leave a torque T
    about their axis, so that at the end, turned by theta = M L / (2 E I_u), E I_n k3 = tan(theta) G J k1: with
    omega^2 = M^2 a b / (E I_n G J) that is cot(omega L / 2) = tan(theta) M a / (omega E I_n).
    """
    torsion, about_u, about_n = 8.0, 250.0, 5.6
    a, b = 1 - about_n / about_u, 1 - torsion / about_u

    def condition(moment):
        omega = moment * np.sqrt(a * b / (about_n * torsion))
        turned = np.tan(moment * LENGTH / (2 * about_u))
        return np.cos(omega * LENGTH / 2) - turned * moment * a / (omega * about_n) * np.sin(omega * LENGTH / 2)

    plain = np.pi / LENGTH * np.sqrt(about_n * torsion)
    exact = brentq(condition, 0.5 * plain, 1.2 * plain)
    errors = []
    for elements in (8, 16, 32):
        start = end_moments(elements, rod(axial=1e10, torsion=torsion, about_u=about_u, about_n=about_n))
        errors.append(critical_point(start, 1e-7).factors[0] / exact - 1)
    assert np.allclose(orders(errors), 2.0, atol=0.1)
    assert abs(errors[-1]) < 2e-3


def test_no_critical_load_in_tension():
    structure = strip(4, LENGTH, STRIP, {0: "all"})
    start = at_rest(structure, make_loads(structure, forces={4: (1, 0, 0, 0, 0, 0)}))
    assert len(linear_buckling(start).factors) == 0
    with pytest.raises(InputError) as refused:
        critical_point(start)
    assert refused.value.where == "loads"
