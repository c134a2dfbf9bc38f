"""Nets driven as people do on site: cables, a ring, moved supports, a crane over a floor."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.optimize import brentq

import lamella
from lamella import InputError, Section
from lamella.erection.device_states import device_states
from lamella.erection.driven_by import driven_by
from lamella.erection.erection import Erection
from lamella.erection.ground import Ground
from lamella.erection.moved_nodes import Lift, Ring, Together
from lamella.erection.rigid_holds import rigid_holds
from lamella.erection.rigid_motion import moved_onto
from lamella.erection.rigid_turn import RigidTurn
from lamella.erection.ropes import Ropes
from lamella.network.network import Network
from lamella.structure.beam.beams import make_beams
from lamella.structure.beam.poses import Poses
from lamella.structure.beam.rotations import exponential
from lamella.structure.loads import make_loads
from lamella.structure.node_springs import floor_springs
from lamella.structure.static import at_rest, loaded
from lamella.structure.structure import make_structure
from structure.strips import STRIP, rod, strip

LAYER = Section(0.1, 0.0015, layers=1)
STIFF = replace(STRIP, shear_n=np.inf)
CORNERS = ([-1.2, 1.5, 0.3], [1.5, -1.2, 0.3])


@cache
def patch() -> Network:
    return lamella.net(lamella.Enneper(2, 0.6, 3.0), spacing=0.9)


def corners() -> np.ndarray:
    points = patch().node_points
    return np.array([np.linalg.norm(points - corner, axis=1).argmin() for corner in CORNERS])


@cache
def pulled(states: int, by: float = 0.6, diameter: float = 0.012) -> Erection:
    """By a cable between two corners."""
    ropes = Ropes(corners()[None], np.array([by]), np.array([diameter]))
    return driven_by(patch().strips(LAYER), ropes, states=states, elements=1)


def spans(made: Erection) -> np.ndarray:
    one, other = corners()
    return np.array([np.linalg.norm(s.poses.points[one] - s.poses.points[other]) for s in made.states])


def test_work_of_a_cable() -> None:
    """Its tension times the way of its ends is the change of energy: Simpson's rule, of 4th order."""
    gap = []
    for states in (5, 9):
        made = pulled(states)
        tension = made.way.forces[:, 0]
        assert tension[0] == 0
        assert np.all(np.diff(tension) > 0)
        assert spans(made) == pytest.approx(spans(made)[0] - np.linspace(0, 0.6, states), abs=1e-6)
        step = 0.6 / (states - 1)
        work = step / 3 * (tension[0] + 4 * tension[1:-1:2].sum() + 2 * tension[2:-1:2].sum() + tension[-1])
        gap.append(abs(work - (made.states[-1].energy - made.states[0].energy)))
    assert gap[0] / gap[1] > 10


def test_supports_moved_together_are_a_cable_that_does_not_stretch() -> None:
    """Two of them by half of what the cable is shortened by: the same states; the driver counts both."""
    moved = driven_by(patch().strips(LAYER), Together(corners(), 0.3), states=5, elements=1)
    rope = pulled(5, diameter=0.3)
    for one, other in zip(moved.states, rope.states, strict=True):
        assert one.energy == pytest.approx(other.energy, rel=1e-6)
        assert one.driver == pytest.approx(2 * other.driver, rel=1e-4, abs=1e-6)
        np.testing.assert_allclose(one.angles, other.angles, atol=1e-3)
    assert np.abs(moved.way.forces - rope.way.forces).max() < 1e-4 * rope.way.forces.max()


def test_a_ring_keeps_its_symmetry() -> None:
    """Nodes of the waist of an unduloid all take the same force, and nothing else holds the net: what is held against
    moving as a body carries nothing."""
    net = lamella.net(lamella.Unduloid(1.0, 1.6, (-1.6, 1.6)), cells=8)
    ring = np.flatnonzero(np.abs(net.node_points[:, 2]) < 1e-6)
    made = driven_by(net.strips(LAYER), Ring(ring, 0.9), states=3, elements=1, start="designed")
    for state, forces in zip(made.states, made.way.forces, strict=True):
        assert np.ptp(forces) < 1e-6 * np.abs(forces).max()
        assert state.driver == pytest.approx(forces.sum())
        radii = np.linalg.norm(state.poses.points[ring] - state.poses.points[ring].mean(0), axis=1)
        assert radii == pytest.approx(1 - 0.1 * state.share, abs=1e-9)
    # it is held back: let go, it would close by itself
    assert made.way.forces[0].max() < 0


@pytest.mark.slow
def test_ring_against_the_exact_mechanism() -> None:
    """Rotational nets deform with edge lengths and stars kept (paper, Figure 8): `lamella.deform`.

    Strips differ from that as they are bent between nodes, where the mesh has straight edges (third order in the
    cells), and as they resist: less the thinner they are, as bending about the weak axis goes with the cube of the
    thickness and about the strong one with the thickness.
    """

    def gaps(cells: int, thickness: float, factor: float) -> float:
        net = lamella.net(lamella.Unduloid(1.0, 1.6, (-1.6, 1.6)), cells=cells)
        points = net.node_points
        ring = np.flatnonzero(np.abs(points[:, 2]) < 1e-6)
        ring = ring[np.argsort(np.arctan2(points[ring, 1], points[ring, 0]))]
        quads = net.face_nodes[net.face_offsets[:-1][np.diff(net.face_offsets) == 4][:, None] + np.arange(4)]
        used, numbers = np.unique(quads, return_inverse=True)
        mesh = lamella.quad_mesh(points[used], numbers.reshape(-1, 4))
        exact = lamella.deform(mesh, np.searchsorted(used, ring), factor, step=0.05)[-1]
        assert exact.solution.solved
        strips = net.strips(Section(0.1, thickness, layers=1))
        made = driven_by(strips, Ring(ring, factor), states=3, elements=1, start="designed")
        return float(moved_onto(made.states[-1].poses.points[used], exact.mesh.vertices).max())

    for factor in (0.9, 0.8):
        by_cells = [gaps(cells, 0.0015, factor) for cells in (10, 20)]
        assert by_cells[0] / by_cells[1] > 6
    by_thickness = [gaps(20, thickness, 0.9) for thickness in (0.006, 0.003, 0.0015)]
    assert by_thickness[0] > 1.5 * by_thickness[1] > 1.5 * by_thickness[2]


def test_a_floor_pushes_and_does_not_pull() -> None:
    """A cantilever above a floor: F l^3 / 3 E I down to it, then the floor takes the rest; upwards it is not there."""
    free = strip(4, 1.0, STIFF, {0: "all"})
    gap, stiffness = 0.002, 1e9
    poses = free.poses
    at = poses.points[[-1]] - [0, 0, gap]
    floor = floor_springs(np.array([4]), float(at[0, 2]), stiffness, at, poses.frames[[-1]])
    over = replace(free, node_springs=floor)
    soft = 3 * STIFF.bending_u / 1.0**3
    for force, expected in ((0.5 * gap * soft, 0.0), (-0.5 * gap * soft, 0.0), (-3 * gap * soft, 2 * gap * soft)):
        loads = make_loads(over, forces={4: (0, 0, force, 0, 0, 0)})
        end = loaded(at_rest(over, loads), steps=4)
        pushed = -end.whole.node_springs.forces()[2, 0]
        assert pushed == pytest.approx(expected, rel=2e-3, abs=1e-9)


def test_weight_on_the_floor_and_in_the_crane() -> None:
    """A flat net on the floor is pressed down by its weight; a node lifted takes at most that."""
    strips = patch().strips(LAYER)
    weight = 9.81 * float(strips.network.lengths.sum()) * 0.1 * 0.0015 * strips.material.density
    middle = np.linalg.norm(patch().node_points - patch().node_points.mean(0), axis=1).argmin()
    made = driven_by(strips, Lift(np.array([middle]), 0.02), states=2, elements=1, ground=Ground(gravity=True))
    force = made.way.forces[:, 0]
    assert 0 < force[0] < force[1] < weight
    assert made.way.gravity
    assert made.states[0].height < 1e-3


def test_a_lift_needs_a_weight() -> None:
    with pytest.raises(InputError) as caught:
        driven_by(patch().strips(LAYER), Lift(np.array([3]), 0.1), states=2, elements=1)
    assert caught.value.where == "gravity"


@pytest.mark.parametrize(
    ("device", "where"),
    [
        (Ropes(np.array([[3, 3]]), np.array([0.1]), np.array([0.01])), "cable"),
        (Ropes(np.array([[0, 9]]), np.array([90.0]), np.array([0.01])), "cable.by"),
        (Together(np.array([0, 9]), 50.0), "supports.by"),
    ],
)
def test_devices_that_do_not_suit_the_net(device: Ropes | Together, where: str) -> None:
    with pytest.raises(InputError) as caught:
        driven_by(patch().strips(LAYER), device, states=2, elements=1, start="designed")
    assert caught.value.where == where


def toggle_load(z: float) -> float:
    """Of von Mises' truss of stiffness 1e3 and rise 0.3 on a base of 1."""
    return 1e3 * z * (1 / np.hypot(1, z) - 1 / np.hypot(1, 0.3))


def test_a_limit_point_is_named() -> None:
    """A toggle pushed over its limit load snaps to where P = E A z (1/l - 1/l0) again (R. von Mises 1923)."""
    states = 7
    limit = brentq(lambda z: 1 / np.hypot(1, z) ** 3 - 1 / np.hypot(1, 0.3), 0.0, 0.3)
    beams = make_beams([[0, 1]], np.hypot(1, 0.3), rod(axial=1e3, about_u=1e6))
    frames = np.tile(exponential(np.array([[0.0, -np.arctan2(0.3, 1.0), 0.0]])), (2, 1, 1))
    poses = Poses(np.array([[0.0, 0, 0], [1, 0, 0.3]]), frames, np.zeros(0))
    structure = make_structure(poses, beams, {0: "x y z rx rz", 1: "x y rx rz"})
    whole = 1.4 * toggle_load(limit)
    begin = at_rest(structure, make_loads(structure, forces={1: (0, 0, -whole, 0, 0, 0)}))
    found = list(device_states(begin, states, poses.points, 2))
    snaps = [one.snap for one in found if one.snap is not None]
    assert len(found) == states
    (snap,) = snaps
    assert snap.node == 1
    # the first state beyond the limit load
    assert snap.state == np.ceil((states - 1) / 1.4)
    for one in found:
        z = one.here.poses.points[1, 2]
        assert toggle_load(z) == pytest.approx(one.share * whole, rel=1e-6, abs=1e-9)
        assert (z < 0) == (one.share >= snap.share)


def test_holds_of_a_rigid_body() -> None:
    """Six shifts, or what held ones leave; together they resist every rigid motion."""
    rng = np.random.default_rng(4)
    points = 5 * rng.standard_normal((30, 3)) + 100
    able = rng.random(30) < 0.5
    for held_nodes, expected in (([], 6), ([3], 3), ([3, 7], 1), ([3, 7, 9], 0)):
        held = np.zeros((30, 3), bool)
        held[held_nodes] = True
        more = rigid_holds(points, held, able, np.array(held_nodes, int))
        assert more.sum() == expected
        assert not more[~able].any()
        at = points - points.mean(0)
        motions = np.concatenate([np.tile(np.eye(3), (30, 1)), *[np.cross(a, at).reshape(-1, 1) for a in np.eye(3)]], 1)
        assert np.linalg.matrix_rank(motions[(held | more).ravel()]) == 6


def test_upright_and_back() -> None:
    rng = np.random.default_rng(2)
    poses = Poses(rng.standard_normal((5, 3)), exponential(rng.standard_normal((5, 3))), np.zeros(0))
    for up in ([0, 0, 1], [0, 0, -1], [0.3, -0.5, 0.2], [1, 0, 0]):
        turn = RigidTurn.upright(np.array(up, float), poses.points[0])
        np.testing.assert_allclose(turn.turned @ up, [0, 0, np.linalg.norm(up)], atol=1e-15)
        assert np.linalg.det(turn.turned) == pytest.approx(1)
        back = turn.back.of(turn.of(poses))
        np.testing.assert_allclose(back.points, poses.points, atol=1e-14)
        np.testing.assert_allclose(back.frames, poses.frames, atol=1e-14)
