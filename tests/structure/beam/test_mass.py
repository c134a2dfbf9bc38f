"""Consistent mass: that of a rigid body in rigid motions, and Hermite's of a bar."""

import numpy as np
import pytest

from lamella.structure.beam.mass import consistent_mass
from structure.strips import STRIP, strip


def mass_matrix(structure) -> np.ndarray:
    blocks = consistent_mass(structure.beams.at(structure.poses))
    return np.array([structure.multiplied(blocks, q) for q in np.eye(structure.poses.unknowns)])


def test_rigid_motions_have_the_energy_of_a_rigid_body():
    """Mass, and moments of inertia about the end: m l^2 / 3 and the section's own; joints and levers carry it over."""
    length = 1.7
    structure = strip(3, length, STRIP, {}, offsets=(0.0, 0.4, 0.0))
    mass = mass_matrix(structure)
    points = structure.poses.points
    motions = np.zeros((6, len(points), 6))
    for axis in range(3):
        motions[axis, :, axis] = 1
        motions[3 + axis, :, 3 + axis] = 1
        motions[3 + axis, :, :3] = np.cross(np.eye(3)[axis], points)
    rigid = motions.reshape(6, -1)
    found = rigid @ mass @ rigid.T
    whole, arm = STRIP.mass * length, 0.4**2 * STRIP.mass * length
    third = whole * length**2 / 3
    own = length * np.array([STRIP.inertia_t, STRIP.inertia_u, STRIP.inertia_n])
    assert np.diag(found) == pytest.approx(
        [whole] * 3 + [own[0] + arm, own[1] + third, own[2] + third + arm], rel=1e-12
    )
    # of the line through the elements' centroids, 0.4 m to the side
    assert found[0, 5] == pytest.approx(-0.4 * whole, rel=1e-12)
    assert np.abs(mass - mass.T).max() < 1e-15


def test_entries_of_a_slender_bar():
    """mu l / 420 (156, 22 l, 54, -13 l, 4 l^2, -3 l^2), Przemieniecki (1968) table 11.1; rotary inertia and shear left
    out."""
    slender = STRIP.__class__(1.0, np.inf, np.inf, 1.0, 1.0, 1.0, mass=4.2)
    mass = mass_matrix(strip(1, 2.0, slender, {}))
    unit = 4.2 * 2.0 / 420
    assert mass[1, [1, 5, 7, 11]] == pytest.approx(unit * np.array([156, 44, 54, -26]), rel=1e-12)
    assert mass[5, [5, 11]] == pytest.approx(unit * np.array([16, -12]), rel=1e-12)
    assert mass[2, 4] == pytest.approx(-44 * unit, rel=1e-12)
