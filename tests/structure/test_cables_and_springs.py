"""Cables and springs: derivatives against an energy of their own by complex steps, closed forms, slack and gaps."""

from dataclasses import replace

import numpy as np
import pytest

from lamella import InputError
from lamella.structure.beam.beams import make_beams
from lamella.structure.beam.poses import Poses
from lamella.structure.beam.rotations import exponential, logarithm
from lamella.structure.buckling import linear_buckling
from lamella.structure.cables import make_cables
from lamella.structure.joint_springs import make_joint_springs
from lamella.structure.loads import make_loads, no_loads
from lamella.structure.node_springs import make_node_springs
from lamella.structure.static import at_rest, equilibrium
from lamella.structure.structure import Structure
from lamella.structure.vibration import vibration
from structure.strips import STRIP, orders, rod, strip

RANDOM = np.random.default_rng(11)
NO_BEAMS = make_beams([], [], STRIP)


def turned(vector) -> np.ndarray:
    """exp of a rotation vector that may be complex, by its power series."""
    x, y, z = vector
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    term, total = np.eye(3, dtype=complex), np.eye(3, dtype=complex)
    for k in range(1, 30):
        term = term @ cross / k
        total = total + term
    return total


def knot() -> Structure:
    """Three cables beside their nodes, one of them slack, springs of nodes that are turned and joints beyond gaps."""
    rest = Poses(RANDOM.normal(size=(3, 3)), exponential(0.5 * RANDOM.normal(size=(3, 3))), np.array([0.1, -0.2]))
    offsets = 0.2 * RANDOM.normal(size=(3, 2, 3))
    cables = make_cables(rest, [[0, 1], [1, 2], [2, 0]], [9.0, 7.0, 5.0], prestress=[3.0, 2.0, 0.0], offsets=offsets)
    cables = replace(cables, length=cables.length * [1.0, 1.0, 2.0])
    springs = make_node_springs(rest, [[1, 2, 3, 4, 5, 6], [0] * 6, [3, 0, 0, 0, 2, 0]])
    joints = make_joint_springs(rest, [8.0, 6.0], gap=[0.05, 1.0])
    poses = rest.moved(0.3 * RANDOM.normal(size=rest.unknowns))
    return Structure(poses, NO_BEAMS, np.zeros((3, 6), bool), np.zeros(2, bool), cables, springs, joints)


def own_energy(structure: Structure, motion) -> complex:
    """Of cables, shifts on springs and joints after a motion, written anew."""
    nodes = motion[:18].reshape(3, 6)
    points = structure.poses.points + nodes[:, :3]
    frames = [turned(w) @ frame for w, frame in zip(nodes[:, 3:], structure.poses.frames, strict=True)]
    total = 0j
    cables = structure.cables
    for (a, b), offsets, length, axial in zip(
        cables.attachment.nodes, cables.attachment.offsets, cables.length, cables.axial, strict=True
    ):
        span = points[b] + frames[b] @ offsets[1] - points[a] - frames[a] @ offsets[0]
        stretch = np.sqrt((span * span).sum()) - length
        total += axial / length * stretch**2 / 2 if stretch.real > 0 else 0
    springs = structure.node_springs
    for node, stiffness, point in zip(springs.nodes, springs.stiffness, springs.points, strict=True):
        total += (stiffness[:3] * (points[node] - point) ** 2).sum() / 2
    joints = structure.joint_springs
    for joint, stiffness, gap, rest in zip(joints.joints, joints.stiffness, joints.gap, joints.rest, strict=True):
        turn = structure.poses.angles[joint] + motion[18 + joint] - rest
        more = turn - gap if turn.real > gap else turn + gap if turn.real < -gap else 0
        total += stiffness * more**2 / 2
    return total


def forces(structure: Structure, motion) -> np.ndarray:
    poses = structure.poses.moved(motion)
    return structure.vector(structure.at(poses, structure.beams.at(poses)).forces())


def central(function, size: int, step: float) -> np.ndarray:
    unit = step * np.eye(size)
    return np.array(
        [(8 * (function(u) - function(-u)) - (function(2 * u) - function(-2 * u))) / (12 * step) for u in unit]
    )


def test_forces_are_the_derivative_of_the_energy():
    structure = knot()
    shifts = replace(structure, node_springs=replace(structure.node_springs, stiffness=_shifts_only(structure)))
    by_steps = np.array([own_energy(shifts, 1e-30j * u).imag / 1e-30 for u in np.eye(20)])
    assert np.abs(forces(shifts, np.zeros(20)) - by_steps).max() < 1e-13 * np.abs(by_steps).max()
    assert structure.at(structure.poses, structure.beams.at(structure.poses)).cables.tension[2] == 0
    # rotations of springs: the energy is in terms of the logarithm

    def energy(q):
        frames = structure.poses.moved(q).frames
        springs = structure.node_springs
        theta = logarithm(frames[springs.nodes] @ np.swapaxes(springs.frames, 1, 2))
        return float((springs.stiffness[:, 3:] * theta**2).sum() / 2)

    turns = forces(structure, np.zeros(20)) - forces(shifts, np.zeros(20))
    assert np.abs(turns - central(energy, 20, 1e-3)).max() < 1e-9


def _shifts_only(structure: Structure) -> np.ndarray:
    stiffness = structure.node_springs.stiffness.copy()
    stiffness[:, 3:] = 0
    return stiffness


def test_tangent_stiffness_is_the_second_derivative_of_the_energy():
    structure = knot()
    state = structure.at(structure.poses, structure.beams.at(structure.poses))
    stiffness = np.array([structure.multiplied(state.stiffness(state.stress), q) for q in np.eye(20)])
    assert np.abs(stiffness - stiffness.T).max() < 1e-14 * np.abs(stiffness).max()
    by_differences = central(lambda q: forces(structure, q), 20, 1e-3)
    both = (by_differences + by_differences.T) / 2
    assert np.abs(stiffness - both).max() < 1e-8 * np.abs(stiffness).max()
    other = RANDOM.uniform(size=3)
    geometric = state.cables.geometric_stiffness(other)
    assert np.allclose(state.cables.geometric_stiffness(3 * other), 3 * geometric, rtol=1e-13, atol=0)


def test_force_rate_and_energy_of_a_rigid_motion():
    structure = knot()
    motion = RANDOM.normal(size=20)
    state = structure.cables.at(structure.poses)
    (by_differences,) = central(lambda q: structure.cables.at(structure.poses.moved(q * motion)).force, 1, 1e-3)
    assert state.force_rate(structure.gathered(motion)[2]) == pytest.approx(by_differences, rel=1e-8)
    turn = exponential(np.array([[1.1, -0.7, 2.0]]))[0]
    moved = Poses(structure.poses.points @ turn.T + 5.0, turn @ structure.poses.frames, structure.poses.angles)
    assert structure.cables.at(moved).energy == pytest.approx(state.energy, rel=1e-13)


def string(elements: int, pull: float) -> Structure:
    """A cable of 2 m along x in pieces, under a prestress; its nodes' rotations are nobody's."""
    points = np.zeros((elements + 1, 3))
    points[:, 0] = np.linspace(0, 2.0, elements + 1)
    poses = Poses(points, np.tile(np.eye(3), (elements + 1, 1, 1)), np.zeros(0))
    nodes = np.stack((np.arange(elements), np.arange(1, elements + 1)), 1)
    cables = make_cables(poses, nodes, 2.1e6, prestress=pull, mass=0.13)
    mask = np.zeros((elements + 1, 6), bool)
    mask[:, 3:] = True
    mask[[0, -1], :3] = True
    return Structure(poses, NO_BEAMS, mask, np.zeros(0, bool), cables)


def test_a_prestressed_string():
    """omega = pi / L sqrt(N / mu); the sag of a load q along it, q L^2 / 8 N where that is small."""
    pull = 800.0
    # mass is per natural length
    exact = np.sqrt(pull * (1 + pull / 2.1e6) / 0.13) / 4.0
    errors = []
    for elements in (4, 8, 16):
        structure = string(elements, pull)
        errors.append(vibration(at_rest(structure, no_loads(structure)), 2).frequencies[0] / exact - 1)
    assert orders(errors)[-1] == pytest.approx(2.0, abs=0.05)
    load = 1e-3
    forces = dict.fromkeys(range(1, 16), (0, 0, -load * 2.0 / 16, 0, 0, 0))
    sagged = equilibrium(structure, make_loads(structure, forces=forces))
    assert -sagged.displacements[8, 2] == pytest.approx(load * 2.0**2 / (8 * pull), rel=1e-6)
    assert sagged.reactions[:, 2].sum() == pytest.approx(load * 2.0 * 15 / 16, rel=1e-9)


def test_a_cable_takes_no_compression():
    """A strut on two cables: one carries a force sideways, the other is slack, and the other way round."""
    points = np.array([[0.0, 0, 0], [0, 0, 1.0], [1.0, 0, 0], [-1.0, 0, 0]])
    poses = Poses(points, np.tile(np.eye(3), (4, 1, 1)), np.zeros(0))
    mask = np.ones((4, 6), bool)
    mask[1, 0] = False
    cables = make_cables(poses, [[1, 2], [1, 3]], 1e5)
    structure = Structure(poses, NO_BEAMS, mask, np.zeros(0, bool), cables)
    for sign in (1, -1):
        # slack at first: both have their length and no force
        there = equilibrium(structure, make_loads(structure, forces={1: (sign * 20.0, 0, 0, 0, 0, 0)}))
        tight, slack = (1, 0) if sign > 0 else (0, 1)
        state = there.whole.cables
        assert state.tension[slack] == 0
        assert state.tension[tight] * abs(state.direction[0, tight]) == pytest.approx(20.0, rel=1e-9)
        assert there.reactions.sum(0)[0] == pytest.approx(-sign * 20.0, rel=1e-9)


def test_a_beam_on_springs():
    """A stiff beam on k at either end and a load at a third: shares of lever arms; a spring about the beam's end."""
    structure = strip(6, 3.0, rod(axial=1e9, about_u=1e8, about_n=1e8), {0: "x y rx rz"})
    stiffness = np.zeros((7, 6))
    stiffness[[0, 6], 2] = 4e3
    stiffness[0, 2] = 1e3
    on_springs = replace(structure, node_springs=make_node_springs(structure.poses, stiffness))
    there = equilibrium(on_springs, make_loads(on_springs, forces={2: (0, 0, -9.0, 0, 0, 0)}))
    assert there.displacements[[0, 6], 2] == pytest.approx([-6e-3, -0.75e-3], rel=1e-5)
    assert there.reactions[[0, 6], 2] == pytest.approx([6.0, 3.0], rel=1e-5)
    stiffness = np.zeros((7, 6))
    stiffness[0, 4] = 250.0
    clamped = replace(strip(6, 3.0, rod(axial=1e9, about_u=1e8, about_n=1e8), {0: "x y z rx rz"}))
    clamped = replace(clamped, node_springs=make_node_springs(clamped.poses, stiffness))
    moment = 250.0 * 1.2
    there = equilibrium(clamped, make_loads(clamped, forces={6: (0, 0, 0, 0, moment, 0)}), steps=3)
    # turned by 1.2 rad about y, whatever the size
    assert there.displacements[6] == pytest.approx([3 * (np.cos(1.2) - 1), 0, -3 * np.sin(1.2)], abs=1e-4)
    assert there.reactions[0, 4] == pytest.approx(-moment, rel=1e-8)


def test_a_joint_with_play_turns_freely_and_then_resists():
    """A weak spring all along and a strong one beyond the gap: M = k0 phi + k (phi - gap), either way."""
    points = np.array([[0.0, 0, 0], [1.0, 0, 0], [2.0, 0, 0]])
    poses = Poses(points, np.tile(np.eye(3), (3, 1, 1)), np.zeros(1))
    beams = make_beams([[0, 1], [1, 2]], 1.0, rod(axial=1e9, about_n=1e9), joints=[[-1, -1], [0, -1]])
    mask = np.zeros((3, 6), bool)
    mask[0] = True
    springs = make_joint_springs(poses, [2.0, 40.0], gap=[0.0, 0.02], joints=[0, 0])
    structure = Structure(poses, beams, mask, np.zeros(1, bool), joint_springs=springs)
    for moment in (3.0, -3.0, 0.03):
        there = equilibrium(structure, make_loads(structure, joints={0: moment}))
        beyond = (abs(moment) + 40 * 0.02) / 42
        assert there.poses.angles[0] == pytest.approx(np.sign(moment) * beyond if abs(moment) > 1 else moment / 2)


def test_a_strut_on_a_spring_buckles():
    """Two bars with a joint between them, a spring k across it: N = k L / 4, with L of both bars."""
    poses = Poses(np.array([[0.0, 0, 0], [1.0, 0, 0], [2.0, 0, 0]]), np.tile(np.eye(3), (3, 1, 1)), np.zeros(1))
    bar = rod(axial=1e9, about_u=1e9, about_n=1e9)
    beams = make_beams([[0, 1], [1, 2]], 1.0, bar, joints=[[-1, -1], [0, -1]])
    mask = np.zeros((3, 6), bool)
    mask[0, :5] = mask[2, 1:5] = True
    stiffness = np.zeros((3, 6))
    stiffness[1, 1] = 500.0
    on_spring = Structure(poses, beams, mask, np.zeros(1, bool), node_springs=make_node_springs(poses, stiffness))
    pushed = equilibrium(on_spring, make_loads(on_spring, forces={2: (-1.0, 0, 0, 0, 0, 0)}))
    assert linear_buckling(pushed).factors[0] == pytest.approx(500.0 * 2.0 / 4, rel=1e-5)


@pytest.mark.parametrize(
    ("make", "parameter", "number"),
    [
        (lambda poses: make_cables(poses, [[0, 1]], 0.0), "axial", "0.0"),
        (lambda poses: make_cables(poses, [[0, 1]], 1.0, prestress=-3.0), "prestress", "-3.0"),
        (lambda poses: make_cables(poses, [[0, 1]], 1.0, mass=np.nan), "mass", "nan"),
        (lambda poses: make_cables(poses, [[1, 1]], 1.0), "nodes", "0"),
        (lambda poses: make_node_springs(poses, np.zeros((1, 6))), "stiffness", "(1, 6)"),
        (lambda poses: make_node_springs(poses, -np.ones((2, 6))), "stiffness", "-1.0"),
        (lambda poses: make_joint_springs(poses, 0.0), "stiffness", "0.0"),
        (lambda poses: make_joint_springs(poses, 1.0, gap=-0.1), "gap", "-0.1"),
        (lambda poses: make_joint_springs(poses, 1.0, joints=[4]), "joints", "4"),
    ],
)
def test_refused(make, parameter, number):
    poses = Poses(np.array([[0.0, 0, 0], [1.0, 0, 0]]), np.tile(np.eye(3), (2, 1, 1)), np.zeros(1))
    with pytest.raises(InputError) as refused:
        make(poses)
    assert refused.value.where == parameter
    assert number in refused.value.message


def test_cables_on_nodes_that_are_not_there():
    structure = strip(2, 1.0, STRIP, {0: "all"})
    cables = make_cables(structure.poses, [[0, 2]], 1.0)
    with pytest.raises(InputError) as refused:
        replace(structure, cables=replace(cables, attachment=replace(cables.attachment, nodes=np.array([[0, 5]]))))
    assert refused.value.where == "cables"
