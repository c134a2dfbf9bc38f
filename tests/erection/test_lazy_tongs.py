"""The planar lattice of straight strips, an exact mechanism, driven by its joints' angles."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from lamella import find_material
from lamella.erection.driver import Driver
from lamella.structure.beam.beams import make_beams
from lamella.structure.beam.cross_section import flat_strip
from lamella.structure.beam.poses import Poses
from lamella.structure.equilibrium import Equilibrium
from lamella.structure.joint_springs import make_joint_springs
from lamella.structure.loads import no_loads
from lamella.structure.static import displacement_path
from lamella.structure.structure import Structure, make_structure

STRIP = flat_strip(find_material("1.4301"), 0.1, 0.0015)


def lattice(rows: int, angle: float, side: float) -> Structure:
    """Straight strips upright in a plane, rows x rows, that cross at an angle; free to turn but for weak springs."""
    count = np.arange(rows)
    along, across = np.array([1.0, 0, 0]), np.array([np.cos(angle), np.sin(angle), 0])
    points = side * (count[:, None, None] * along + count[None, :, None] * across).reshape(-1, 3)
    turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    number = np.arange(rows * rows).reshape(rows, rows)
    a = np.stack((number[:-1].ravel(), number[1:].ravel()), 1)
    b = np.stack((number[:, :-1].ravel(), number[:, 1:].ravel()), 1)
    turns = np.concatenate((np.tile(np.eye(3), (len(a), 2, 1, 1)), np.tile(turn, (len(b), 2, 1, 1))))
    joints = np.concatenate((np.full_like(a, -1), b))
    poses = Poses(points, np.tile(np.eye(3), (len(points), 1, 1)), np.zeros(len(points)))
    beams = make_beams(np.concatenate((a, b)), side, STRIP, turns=turns, joints=joints)
    free = make_structure(poses, beams, {0: "all"})
    return replace(free, joint_springs=make_joint_springs(poses, 1e-3))


def test_lazy_tongs() -> None:
    """A planar lattice of straight strips turns as a parallelogram does, to rounding."""
    structure = lattice(5, np.radians(60), 0.5)
    turned = Poses(structure.poses.points, structure.poses.frames, structure.poses.angles + np.radians(40))
    driver = Driver.between(structure.poses, turned)
    loads = replace(no_loads(structure), forces=driver.weights)
    start = Equilibrium(structure, loads, 0.0, structure.poses, 0, 0)
    *_, last = displacement_path(start, driver.weights, driver.span, steps=4)
    goal = lattice(5, np.radians(100), 0.5).poses.points
    assert np.abs(last.poses.points - goal).max() < 1e-12 * structure.size
    assert driver.share(last.poses) == pytest.approx(1, abs=1e-12)
