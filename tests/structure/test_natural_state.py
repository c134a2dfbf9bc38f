"""Strips that are bent and twisted by nature, and flat strips that are forced: closed forms of uniform states."""

import numpy as np
import pytest
from scipy.linalg import expm

from lamella.strip.stress import stresses
from lamella.structure.beam.beams import make_beams
from lamella.structure.beam.fibre_stress import curvatures_at_ends, strip_stresses
from lamella.structure.beam.poses import Poses, straight_poses
from lamella.structure.beam.rotations import exponential
from lamella.structure.construction import continued
from lamella.structure.loads import make_loads, no_loads
from lamella.structure.static import at_rest, equilibrium
from lamella.structure.structure import make_structure
from structure.strips import HEIGHT, STEEL, STIFF_ACROSS, STRIP, THICKNESS, rod, strip

CIRCLE = 2 * np.pi / 3


def helix(curvature, places) -> tuple[np.ndarray, np.ndarray]:
    """Points and frames at arc lengths of a curve whose frame turns by (tg, -kn, kg): the exponential of one screw."""
    screw = np.zeros((4, 4))
    screw[:3, :3] = np.cross(np.eye(3), -np.array(curvature)).T
    screw[0, 3] = 1
    poses = np.array([expm(s * screw) for s in places])
    return poses[:, :3, 3], poses[:, :3, :3]


@pytest.mark.parametrize("section", [STRIP, STIFF_ACROSS])
@pytest.mark.parametrize("elements", [8, 32])
@pytest.mark.parametrize("natural", [(0, 0, CIRCLE), (0, CIRCLE, 0), (0.9, 0, 1.2), (0.9, 0.2, 1.2)])
def test_imposed_natural_curvature(section, elements, natural):
    """A flat strip of 3 m that gets a natural curvature takes it, whatever it is: circles, helices, and helices with
    strong-axis curvature. The centre line is the exponential of one screw."""
    structure = strip(elements, 3.0, section, {0: "all"})
    found = equilibrium(structure, make_loads(structure, natural=natural), steps=16)
    assert np.abs(found.poses.points - helix(natural, np.linspace(0, 3.0, elements + 1))[0]).max() <= 1e-10
    assert found.negative == 0
    assert abs(found.energy) < 1e-12


def plate_moment(kg: float) -> float:
    """Of a strip bent to kg, N m: E I kg and the rest of the energy D b (nu kg)^2 (1 - Phi) / 2 of a plate between
    beam and cylinder (Ashwell 1950), differentiated by complex steps."""
    nu = STRIP.poisson
    k = complex(kg, 1e-30)
    x = HEIGHT / 2 * np.sqrt(np.sqrt(3 * (1 - nu**2)) * k / THICKNESS)
    phi = (np.cosh(2 * x) - np.cos(2 * x)) / (x * (np.sinh(2 * x) + np.sin(2 * x)))
    plate = STEEL.youngs_modulus * THICKNESS**3 / (12 * (1 - nu**2))
    return STRIP.bending_n * kg + float((plate * HEIGHT * (nu * k) ** 2 * (1 - phi) / 2).imag / 1e-30)


@pytest.mark.parametrize("kg", [0.1, 0.7, np.pi / 4])
def test_flat_strip_bent_to_an_arc(kg):
    """Its end turned by kg L and free to shift: M = E I kg, and with plate action the moment of the plate."""
    length, ends = 2.0, []
    for section, moment in ((STIFF_ACROSS, STIFF_ACROSS.bending_n * kg), (STRIP, plate_moment(kg))):
        structure = strip(16, length, section, {0: "all", -1: "rx ry rz"})
        loads = make_loads(structure, motions={16: (0, 0, 0, 0, 0, kg * length)})
        found = equilibrium(structure, loads, steps=6)
        assert found.reactions[-1, 5] == pytest.approx(moment, rel=1e-10)
        assert found.reactions[0, 5] == pytest.approx(-moment, rel=1e-10)
        ends.append(found.poses.points[-1])
    arc = [np.sin(kg * length) / kg, (1 - np.cos(kg * length)) / kg, 0]
    assert np.abs(np.array(ends) - arc).max() <= 1e-10


def test_arc_that_is_drawn_is_bent():
    """The curved shape modelled, the natural state flat: residual stress is there, and is let go with the clamp."""
    kg, elements, length = 0.8, 12, 2.0
    s = np.linspace(0, length, elements + 1)
    points = np.stack((np.sin(kg * s) / kg, (1 - np.cos(kg * s)) / kg, 0 * s), 1)
    frames = exponential(np.stack((0 * s, 0 * s, kg * s), 1))
    nodes = np.stack((np.arange(elements), np.arange(1, elements + 1)), 1)
    poses, beams = Poses(points, frames, np.zeros(0)), make_beams(nodes, length / elements, STIFF_ACROSS)
    held = make_structure(poses, beams, {0: "all", elements: "all"})
    clamped = at_rest(held, no_loads(held))
    assert np.abs(clamped.displacements).max() < 1e-12
    assert clamped.reactions[-1, 5] == pytest.approx(STIFF_ACROSS.bending_n * kg, rel=1e-10)
    loose = make_structure(poses, beams, {0: "all"})
    flat = at_rest(loose, no_loads(loose))
    assert np.abs(flat.poses.points[-1] - [length, 0, 0]).max() < 1e-10


def test_signs():
    """t' = kg u + kn n and u' = tg n - ...: kg > 0 bends to the left (u = n x t), kn > 0 upwards, tg > 0 turns u up. A
    pull is positive, and a reaction is what the support does to the node."""
    structure = strip(4, 1.0, STRIP, {0: "all"})

    def end(*natural):
        found = equilibrium(structure, make_loads(structure, natural=natural))
        return found.poses.points[-1], found.poses.frames[-1]

    assert end(0, 0, 0.5)[0][1] > 0.1
    assert end(0, -0.5, 0)[0][2] > 0.1
    assert end(0.5, 0, 0)[1][2, 1] > 0.1
    pulled = equilibrium(structure, make_loads(structure, forces={4: (7.0, 0, 0, 0, 0, 0)}))
    assert pulled.resultants[0] == pytest.approx([7.0] * 4, rel=1e-6)
    assert pulled.reactions[0, 0] == pytest.approx(-7.0, rel=1e-6)


@pytest.mark.parametrize("section", [STRIP, STIFF_ACROSS])
def test_a_coil_unrolls(section):
    """A flat strip drawn as a coil of one and a half turns, with twist, held at one end: far too much for one step, so
    its residual stress is let go little by little."""
    elements, length, curvature = 24, 3.0, (0.4, 0.0, np.pi)
    points, frames = helix(curvature, np.linspace(0, length, elements + 1))
    nodes = np.stack((np.arange(elements), np.arange(1, elements + 1)), 1)
    beams = make_beams(nodes, length / elements, section)
    structure = make_structure(Poses(points, frames, np.zeros(0)), beams, {0: "all"})
    flat = at_rest(structure, no_loads(structure))
    assert flat.factor == 0.0
    assert flat.loads.natural.any() == np.False_
    assert np.abs(flat.poses.points[-1] - [length, 0, 0]).max() < 1e-10
    assert flat.energy < 1e-12


@pytest.mark.parametrize("tg", [0.2, 0.8])
@pytest.mark.parametrize("section", [STRIP, STIFF_ACROSS])
def test_twisted_strip(section, tg):
    """Torque G J tg + E t b^5 tg^3 / 360 and shortening (b^2 + t^2) tg^2 / 24 a length of a strip that is free to
    shorten; held, the tension E A of that strain makes the torque larger by it times the polar radius of gyration."""
    length = 2.0
    square = (HEIGHT**2 + THICKNESS**2) / 12
    torque = section.torsion * tg + STEEL.youngs_modulus * THICKNESS * HEIGHT**5 * tg**3 / 360
    for held, pull in (("y z rx ry rz", 0.0), ("all", section.axial * square * tg**2 / 2)):
        structure = strip(8, length, section, {0: "all", -1: held})
        loads = make_loads(structure, motions={8: (0, 0, 0, tg * length, 0, 0)})
        found = equilibrium(structure, loads, steps=4)
        assert found.reactions[-1, 3] == pytest.approx(torque + pull * square * tg, rel=1e-10)
        if held == "all":
            assert found.reactions[-1, 0] == pytest.approx(pull, rel=1e-10)
        else:
            assert length - found.poses.points[-1, 0] == pytest.approx(length * square * tg**2 / 2, abs=1e-10)


def test_pair_of_layers_beside_their_nodes():
    """Two layers at +-d/2 on rigid arms, bent to an arc by turning the end: M = (2 E I + E A d^2 / 2) kg, at any angle,
    and the layers' strains are -+ d kg / 2."""
    section, distance, kg, length, elements = rod(axial=1e5), 0.05, 0.9, 2.0, 8
    one = np.stack((np.arange(elements), np.arange(1, elements + 1)), 1)
    offsets = np.zeros((2 * elements, 2, 3))
    offsets[:elements, :, 1], offsets[elements:, :, 1] = distance / 2, -distance / 2
    beams = make_beams(np.concatenate((one, one)), length / elements, section, offsets=offsets)
    structure = make_structure(straight_poses(length, elements), beams, {0: "all", elements: "rx ry rz"})
    loads = make_loads(structure, motions={elements: (0, 0, 0, 0, 0, kg * length)})
    found = equilibrium(structure, loads, steps=4)
    moment = (2 * section.bending_n + section.axial * distance**2 / 2) * kg
    assert found.reactions[-1, 5] == pytest.approx(moment, rel=1e-10)
    strains = found.state.strains.values[0]
    assert strains == pytest.approx(np.repeat([-distance * kg / 2, distance * kg / 2], elements), rel=1e-9)


def test_tension_resists_twist():
    """Stiffness against twist under a pull N: G J + N (I_p / A), to first order in the twist (Wagner's term)."""
    structure = strip(4, 2.0, STRIP, {0: "all", -1: "y z ry rz"})
    pull, twist = 5e3, 1e-3
    loads = make_loads(structure, forces={4: (pull, 0, 0, twist, 0, 0)})
    found = equilibrium(structure, loads)
    angle = np.arcsin(found.poses.frames[-1, 2, 1])
    assert angle == pytest.approx(2 * twist / (STRIP.torsion + pull * STRIP.gyration), rel=1e-6)


def test_stresses_are_those_of_the_strip():
    """Of a strip bent and twisted by supports, free to shorten, at every node those of `lamella.strip.stress`."""
    kg, tg, length, elements = 0.6, 0.4, 1.5, 6
    points, frames = helix((tg, 0, kg), np.linspace(0, length, elements + 1))
    nodes = np.stack((np.arange(elements), np.arange(1, elements + 1)), 1)
    # the length that leaves no axial force
    shortened = length / elements * (1 + STRIP.gyration * tg**2 / 2)
    beams = make_beams(nodes, shortened, STRIP)
    state = beams.at(Poses(points, frames, np.zeros(0)))
    assert np.abs(state.stress[0]).max() < 1e-3 * STRIP.axial * STRIP.gyration * tg**2
    curvature = np.array([tg, 0, kg]) * length / elements / shortened
    # to the second order of an element's twist, here 0.1
    assert np.allclose(curvatures_at_ends(state), curvature, rtol=0, atol=1e-3)
    found = strip_stresses(state, STEEL, HEIGHT, THICKNESS)
    one, zero = np.ones(1), np.zeros(1)
    axial = state.stress[0, :1] / shortened / (HEIGHT * THICKNESS)
    expected = stresses(
        STEEL,
        HEIGHT,
        THICKNESS,
        curvature_error=zero,
        layer_curvature=zero,
        kg=curvature[2] * one,
        tg=curvature[0] * one,
        held=False,
        axial=axial,
    )
    for name in ("bending", "torsion", "helix_edge", "helix_centre", "von_mises", "utilisation"):
        assert np.allclose(getattr(found, name), getattr(expected, name), rtol=1e-3), name


def test_curvature_changes_linearly_along_an_element():
    """Under a tip force the bending moments at both ends of each element are those of the lever, P (L - s)."""
    section, elements, length = rod(), 3, 2.0
    structure = strip(elements, length, section, {0: "all"})
    found = equilibrium(structure, make_loads(structure, forces={elements: (0, 1e-6, 2e-6, 0, 0, 0)}))
    curvature = curvatures_at_ends(found.state)
    s = np.linspace(0, length, elements + 1)
    lever = length - np.stack((s[:-1], s[1:]), 1)
    assert np.allclose(curvature[..., 2] * section.bending_n, 1e-6 * lever, rtol=1e-6, atol=1e-13)
    assert np.allclose(curvature[..., 1] * section.bending_u, -2e-6 * lever, rtol=1e-6, atol=1e-13)


def test_a_held_strip_that_gets_warm():
    """Between rigid ends: N = -E A alpha T; free to grow: longer by that, without force."""
    strain = 16e-6 * 40
    held = strip(4, 2.0, STIFF_ACROSS, {0: "all", -1: "all"})
    warm = equilibrium(held, make_loads(held, swelling=strain))
    assert warm.resultants[0] == pytest.approx(-STIFF_ACROSS.axial * strain, rel=1e-9)
    assert warm.reactions[0, 0] == pytest.approx(STIFF_ACROSS.axial * strain, rel=1e-9)
    free = strip(4, 2.0, STIFF_ACROSS, {0: "all"})
    warm = equilibrium(free, make_loads(free, swelling=strain))
    assert warm.displacements[-1, 0] == pytest.approx(2.0 * strain, rel=1e-9)
    assert np.abs(warm.resultants).max() < 1e-6
    # and stays so where the next stage begins
    after = continued(warm, no_loads(free))
    assert np.abs(after.whole.stress.beams).max() < 1e-6
