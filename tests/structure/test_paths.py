"""Paths of equilibria: limit points, steps that find their own length, balance of forces and of energy, diagnoses."""

from dataclasses import replace
from itertools import islice

import numpy as np
import pytest
from scipy.optimize import minimize_scalar, root

from lamella import InputError
from lamella.structure.beam.beams import make_beams
from lamella.structure.beam.poses import Poses, straight_poses
from lamella.structure.beam.rotations import exponential
from lamella.structure.buckling import critical_point
from lamella.structure.construction import continued
from lamella.structure.loads import make_loads, no_loads
from lamella.structure.static import arc_length_path, at_rest, displacement_path, equilibrium, load_path, loaded
from lamella.structure.structure import make_structure
from structure.strips import STRIP, orders, rod, strip


def toggle(elements: int, section, apex: str, foot: str, rise=0.3):
    """One leg of a toggle, 1 m wide: the apex slides vertically, under a unit load."""
    angle = np.arctan2(rise, 1.0)
    share = np.linspace(0, 1, elements + 1)
    points = np.stack((share, 0 * share, rise * share), 1)
    frames = np.tile(exponential(np.array([[0.0, -angle, 0.0]])), (elements + 1, 1, 1))
    nodes = np.stack((np.arange(elements), np.arange(1, elements + 1)), 1)
    beams = make_beams(nodes, np.hypot(1, rise) / elements, section)
    structure = make_structure(Poses(points, frames, np.zeros(0)), beams, {0: foot, elements: apex})
    loads = make_loads(structure, forces={elements: (0, 0, -1, 0, 0, 0)})
    return at_rest(structure, loads)


def test_hinged_toggle():
    """P = E A z (1 / l - 1 / l0), l^2 = 1 + z^2: largest at l^3 = l0 (R. von Mises 1923), followed past it by arc
    length and by displacement."""
    section = rod(axial=1e3, about_u=1e6)
    start = toggle(1, section, "x y rx rz", "x y z rx rz")
    natural = np.hypot(1, 0.3)

    def load(z):
        return 1e3 * z * (1 / np.hypot(1, z) - 1 / natural)

    path = list(islice(arc_length_path(start, 0.05), 16))
    height = np.array([there.poses.points[1, 2] for there in path])
    factors = np.array([there.factor for there in path])
    assert height[-1] < -0.4
    assert np.abs(factors - load(height)).max() < 1e-9
    assert [there.negative for there in path] == list(np.where(np.abs(height) < np.sqrt(natural ** (2 / 3) - 1), 1, 0))
    limit = critical_point(start, 1e-8)
    assert limit.factors[0] == pytest.approx(load(np.sqrt(natural ** (2 / 3) - 1)), rel=1e-8)
    height_of_apex = np.eye(start.poses.unknowns)[8]
    driven = list(displacement_path(start, height_of_apex, -0.7, steps=7))
    assert driven[-1].poses.points[1, 2] == pytest.approx(-0.4, abs=1e-12)
    assert driven[-1].factor == pytest.approx(load(-0.4), rel=1e-9)


def rigid_toggle(axial: float, bending: float, rise: float) -> float:
    """Limit load of a leg clamped at its foot and at the apex, which slides: the extensible elastica.

    With the force (across, up) on the apex the angle obeys E I angle'' = (1 + N / E A) (across sin - up cos): solved by
    collocation on Chebyshev points, whose error falls faster than any power.
    """
    length, lean, points = np.hypot(1, rise), np.arctan2(rise, 1.0), 24
    places = np.cos(np.pi * np.arange(points + 1) / points)
    basis = np.polynomial.chebyshev
    value = basis.chebvander(places, points)
    twice = np.stack([basis.chebval(places, basis.chebder(row, 2)) for row in np.eye(points + 1)], 1)
    derive = twice @ np.linalg.inv(value) * (2 / length) ** 2
    whole = np.stack([basis.chebval(1.0, basis.chebint(row, lbnd=-1)) for row in np.eye(points + 1)])
    weights = whole @ np.linalg.inv(value) * length / 2

    def residual(unknown, height):
        angle, (across, up) = unknown[:-2], unknown[-2:]
        stretch = 1 + (across * np.cos(angle) + up * np.sin(angle)) / axial
        bend = bending * derive @ angle - stretch * (across * np.sin(angle) - up * np.cos(angle))
        bend[[0, -1]] = angle[[0, -1]] - lean
        way = weights @ (stretch * np.cos(angle)) - 1, weights @ (stretch * np.sin(angle)) - height
        return np.concatenate((bend, way))

    def load(height, guess):
        return root(residual, guess, args=(height,), tol=1e-13).x

    guess = np.append(np.full(points + 1, lean), (0.0, 0.0))
    for height in np.linspace(rise, 0.6 * rise, 5):
        guess = load(height, guess)
    found = minimize_scalar(lambda z: load(z, guess)[-1], bounds=(0.4 * rise, 0.9 * rise), options={"xatol": 1e-6})
    return -float(found.fun)


def test_rigid_toggle():
    """F. W. Williams, Quarterly Journal of Mechanics and Applied Mathematics 17 (1964) 451: rigid at apex and feet. The
    limit load against that of the extensible elastica: fourth order."""
    axial, bending, rise = 2e4, 5.0, 0.1
    exact = rigid_toggle(axial, bending, rise)
    errors = []
    for elements in (4, 8, 16):
        start = toggle(elements, rod(axial=axial, about_u=bending), "x y rx ry rz", "all", rise)
        errors.append(critical_point(start, 1e-9).factors[0] / exact - 1)
    assert np.allclose(orders(errors)[-1], 4.0, atol=0.3)
    assert abs(errors[-1]) < 1e-4


def test_load_cycle_gives_its_work_back():
    """The work of the loads is the change of elastic energy, to quadrature on Gauss points of the path; after a cycle
    of two loads, put on and off in turn, all is as it was."""
    structure = strip(8, 1.5, STRIP, {0: "all"})
    one = make_loads(structure, forces={8: (0.5, 2.0, -6.0, 0, 0, 0)})
    place, weight = np.polynomial.legendre.leggauss(8)
    here = at_rest(structure, one)
    work, start = 0.0, here.energy
    # E(1) - E(0) = f . q(1) - integral of f . q
    for s, w in zip((1 + place) / 2, weight / 2, strict=True):
        here = loaded(here, s)
        work -= w * one.forces.reshape(-1, 6)[8, :3] @ here.displacements[8]
    here = loaded(here)
    work += one.forces.reshape(-1, 6)[8, :3] @ here.displacements[8]
    assert here.energy - start == pytest.approx(work, rel=1e-9)
    other = make_loads(structure, forces={8: (0, -3.0, 2.0, 0, 0, 0)})
    for loads, factor in ((other, 1.0), (one, -1.0), (other, -1.0)):
        here = loaded(continued(here, loads), factor, steps=2)
    assert np.abs(here.displacements).max() < 1e-9
    assert abs(here.energy) < 1e-12


def test_reactions_balance_the_loads():
    """Forces and moments about the origin, to 1e-9 of the loads, of a strip far from straight."""
    structure = strip(12, 2.0, STRIP, {0: "all", 6: "z", -1: "x y"})
    forces, couple = np.array([3.0, 40.0, -25.0]), np.array([0.3, 0.0, 0.0])
    loads = make_loads(structure, forces={9: (*forces, *couple)}, lines=(0, 3.0, -11.6))
    found = equilibrium(structure, loads, steps=4)
    points, reactions = found.poses.points, found.reactions
    line = np.array([0, 3.0, -11.6]) * 2.0
    assert np.abs(reactions[:, :3].sum(0) + forces + line).max() < 1e-9 * np.linalg.norm(forces + line)
    tangents = found.poses.frames[:, :, 0]
    step = 2.0 / 12
    about = np.cross(points, reactions[:, :3]).sum(0) + reactions[:, 3:].sum(0)
    about += np.cross(points[9], forces) + couple
    # of the cubics through nodes and tangents
    centres = (points[:-1] + points[1:]) / 2 + step / 12 * (tangents[:-1] - tangents[1:])
    about += np.cross(step * centres, line / 2.0).sum(0)
    assert np.abs(about).max() < 1e-8 * np.linalg.norm(forces + line)


def test_the_model_may_be_turned_and_moved():
    """The same result to 1e-9, with the residual stress of a drawn arc."""
    s = np.linspace(0, 2.0, 11)
    points = np.stack((np.sin(0.7 * s) / 0.7, (1 - np.cos(0.7 * s)) / 0.7, 0 * s), 1)
    frames = exponential(np.stack((0 * s, 0 * s, 0.7 * s), 1))
    turn, shift = exponential(np.array([[0.4, 1.9, -1.2]]))[0], np.array([3.0, -7.0, 11.0])
    nodes = np.stack((np.arange(10), np.arange(1, 11)), 1)
    ends, stress = [], []
    for rotation, by in ((np.eye(3), np.zeros(3)), (turn, shift)):
        poses = Poses(points @ rotation.T + by, rotation @ frames, np.zeros(0))
        structure = make_structure(poses, make_beams(nodes, 0.2, STRIP), {0: "all", 10: "x y z"})
        force = rotation @ [0.5, 2.0, -4.0]
        found = equilibrium(structure, make_loads(structure, forces={6: (*force, 0, 0, 0)}), steps=3)
        ends.append((found.poses.points - by) @ rotation)
        stress.append(found.resultants)
    assert np.abs(ends[0] - ends[1]).max() < 1e-9
    difference = np.abs(stress[0] - stress[1])
    assert difference[3:].max() < 1e-9 * np.abs(stress[0][3:]).max()
    # axial and shear forces are differences of coordinates times stiffness
    rounding = np.finfo(float).eps * np.linalg.norm(shift) / 0.2
    stiffness = structure.beams.law.stiffness[:3, 0] / 0.2
    assert (difference[:3].max(1) < 1e-9 * np.abs(stress[0]).max() + 8 * rounding * stiffness).all()


def test_symmetric_structure_symmetric_answer():
    structure = strip(16, 2.0, STRIP, {0: "all", -1: "all"})
    found = equilibrium(structure, make_loads(structure, lines=(0, 4.0, -20.0)), steps=3)
    mirrored = found.displacements[::-1] * [-1, 1, 1]
    assert np.abs(found.displacements - mirrored).max() < 1e-10


def test_steps_are_halved_until_they_converge():
    """A whole turn imposed at once is too much for one step."""
    structure = strip(12, 1.0, rod(), {0: "all"})
    path = list(load_path(at_rest(structure, make_loads(structure, natural=(0, 0, 2 * np.pi)))))
    assert len(path) > 3
    assert path[-1].factor == 1.0
    assert np.abs(path[-1].poses.points[-1]).max() < 1e-10


def test_supports_and_locks_are_taken_away_in_stages():
    """A strip on two props; without them it is the cantilever that never had any."""
    held = {0: "all", 4: "z", 8: "z"}
    props, bare = strip(8, 2.0, STRIP, held), strip(8, 2.0, STRIP, {0: "all"})
    weight = {"lines": (0, 0, -11.6)}
    propped = equilibrium(props, make_loads(props, **weight), steps=2)
    assert propped.reactions[[4, 8], 2].min() > 1
    stage = continued(propped, no_loads(bare), bare)
    assert np.abs(stage.internal - stage.loads.forces_at(0.0))[6:].max() < 1e-6
    free = loaded(stage)
    direct = equilibrium(bare, make_loads(bare, **weight), steps=2)
    assert np.abs(free.poses.points - direct.poses.points).max() < 1e-10


ARM, ROD = 0.5, rod()


def scissors(held: dict[int, str], locked=()):
    """Two strips of four arms that cross at the node 0; the second one, from 3 to 4, is turned there by a joint."""
    points = ARM * np.array([[0, 0, 0], [-1, 0, 0], [1, 0, 0], [0, -1, 0], [0, 1, 0]], float)
    frames = np.tile(np.eye(3), (5, 1, 1))
    frames[3:] = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    quarter, own = frames[3], np.eye(3)
    beams = make_beams(
        [[1, 0], [0, 2], [3, 0], [0, 4]],
        ARM,
        ROD,
        turns=[[own, own], [own, own], [own, quarter], [quarter, own]],
        joints=[[-1, -1], [-1, -1], [-1, 0], [0, -1]],
    )
    return make_structure(Poses(points, frames, np.zeros(1)), beams, held, locked=locked)


def test_scissor_joint_turns_without_resistance():
    """The end of one strip is driven around: it turns as a rigid body, by asin(d / arm), and costs no energy."""
    structure = scissors({1: "all", 2: "all", 4: "x"})
    driven = equilibrium(structure, make_loads(structure, motions={4: (0.3, 0, 0, 0, 0, 0)}), steps=4)
    assert driven.poses.angles[0] == pytest.approx(-np.arcsin(0.3 / ARM), abs=1e-12)
    assert driven.energy < 1e-18
    with pytest.raises(InputError) as refused:
        at_rest(loose := scissors({1: "all", 2: "all"}), no_loads(loose))
    assert refused.value.where == "structure"


def test_locked_scissor_joint():
    """A force on the end of the second strip bends it and turns the node against the two arms of the first one:
    P a^3 / 3 E I + P a^3 / 8 E I. Locked in its turned place, it is held as well."""
    structure = scissors({1: "all", 2: "all"}, locked=[0])
    force = 1e-4
    found = equilibrium(structure, make_loads(structure, forces={4: (force, 0, 0, 0, 0, 0)}))
    moved = force * ARM**3 / ROD.bending_n * (1 / 3 + 1 / 8)
    assert found.displacements[4, 0] == pytest.approx(moved, rel=1e-6)
    assert found.poses.angles[0] == 0
    free = scissors({1: "all", 2: "all", 4: "x"})
    driven = equilibrium(free, make_loads(free, motions={4: (0.3, 0, 0, 0, 0, 0)}), steps=4)
    across = np.append(driven.poses.frames[4, :2, 1], 0.0)
    stage = continued(driven, make_loads(structure, forces={4: (*(force * across), 0, 0, 0)}), structure)
    shift = loaded(stage).poses.points[4] - driven.poses.points[4]
    # now the force also pushes the node across the first strip, clamped at both ends: F a^3 / 24 E I
    pushed = force * across[1] ** 2 * ARM**3 / (24 * ROD.bending_n)
    assert shift @ across == pytest.approx(moved + pushed, rel=1e-6)


@pytest.mark.parametrize(
    ("held", "said"),
    [({0: "x y z ry rz"}, "about x"), ({0: "y z rx ry rz"}, "along x"), ({0: "x z rx ry rz"}, "along y")],
)
def test_what_moves_freely_is_named(held, said):
    structure = strip(4, 2.0, STRIP, held)
    with pytest.raises(InputError) as refused:
        equilibrium(structure, make_loads(structure, forces={4: (1, 1, 1, 1, 0, 0)}))
    assert refused.value.where == "structure"
    assert said in refused.value.message


def test_a_soft_structure_is_no_mechanism():
    """A cantilever of a thousand elements, and one that slides: the first resists, the second does not."""
    soft = strip(1000, 20.0, STRIP, {0: "all"})
    found = equilibrium(soft, make_loads(soft, forces={1000: (0, 1e-6, 0, 0, 0, 0)}))
    assert found.displacements[-1, 1] == pytest.approx(1e-6 * 20**3 / (3 * STRIP.bending_n), rel=1e-4)
    slides = strip(1000, 20.0, STRIP, {0: "y z rx ry rz"})
    with pytest.raises(InputError) as refused:
        at_rest(slides, no_loads(slides))
    assert "along x" in refused.value.message


def test_a_part_on_its_own_is_named():
    """Two strips that are not connected; the second one has no support."""
    poses = Poses(np.array([[0, 0, 0], [1, 0, 0], [0, 5, 0], [1, 5, 0.0]]), np.tile(np.eye(3), (4, 1, 1)), np.zeros(0))
    structure = make_structure(poses, make_beams([[0, 1], [2, 3]], 1.0, STRIP), {0: "all"})
    with pytest.raises(InputError) as refused:
        equilibrium(structure, make_loads(structure, forces={3: (0, 0, -1, 0, 0, 0)}))
    assert "node 2" in refused.value.message or "node 3" in refused.value.message


def test_overload_says_how_far_it_went():
    """A toggle under load control gives way at its limit load and does not snap through unseen; kN for N is such a
    load."""
    section = rod(axial=1e3, about_u=1e6)
    start = toggle(1, section, "x y rx rz", "x y z rx rz")
    natural = np.hypot(1, 0.3)
    height = np.sqrt(natural ** (2 / 3) - 1)
    limit = 1e3 * height * (1 / np.hypot(1, height) - 1 / natural)
    with pytest.raises(InputError) as refused:
        loaded(start, 1000 * limit, steps=1000)
    assert refused.value.where == "loads"
    reached = float(refused.value.message.split("load factor ")[1].split(":")[0])
    assert 0.99 * limit < reached <= limit


@pytest.mark.parametrize(
    ("make", "parameter"),
    [
        (lambda s: make_loads(s, forces={9: (0,) * 6}), "forces"),
        (lambda s: make_loads(s, forces={1: (0, 0, np.nan, 0, 0, 0)}), "forces"),
        (lambda s: make_loads(s, motions={4: (0.1, 0, 0, 0, 0, 0)}), "motions"),
        (lambda s: make_loads(s, joints={0: 1.0}), "joints"),
        (lambda s: make_loads(s, natural=(0, 0, np.inf)), "natural"),
        (lambda s: make_structure(s.poses, s.beams, {7: "all"}), "held"),
        (lambda s: make_structure(straight_poses(1.0, 3), s.beams, {0: "all"}), "beams"),
        (lambda s: make_structure(replace(s.poses, frames=2 * s.poses.frames), s.beams, {}), "poses"),
        (lambda s: make_structure(replace(s.poses, frames=-s.poses.frames), s.beams, {}), "poses"),
        (lambda s: make_structure(replace(s.poses, points=s.poses.points * np.nan), s.beams, {}), "poses"),
        (lambda s: make_structure(s.poses, s.beams, {0: "all", 4: "rw"}), "held"),
        (lambda s: make_structure(s.poses, s.beams, {0: "all"}, locked=[0]), "locked"),
        (lambda s: continued(equilibrium(s, no_loads(s)), no_loads(s), strip(5, 1.0, STRIP, {0: "all"})), "structure"),
        (lambda s: next(arc_length_path(equilibrium(s, make_loads(s, natural=(0, 0, 1))), 0.1)), "loads"),
    ],
)
def test_refusals(make, parameter):
    structure = strip(4, 1.0, STRIP, {0: "all"})
    with pytest.raises(InputError) as refused:
        make(structure)
    assert refused.value.where == parameter
