"""Beam elements: forces and tangent stiffness are the derivatives of the energy, for every way of hanging on nodes."""

from dataclasses import replace

import numpy as np
import pytest

from lamella import InputError
from lamella.structure.beam.beams import make_beams
from lamella.structure.beam.cross_section import CrossSection, flat_strip
from lamella.structure.beam.poses import Poses
from lamella.structure.beam.rotations import exponential
from lamella.structure.beam.turning import turning
from lamella.structure.structure import Structure
from structure.strips import STEEL, STRIP, rod

RANDOM = np.random.default_rng(5)
# every term counts for as much as the others
SECTION = CrossSection(
    3e3, 2e3, 1e3, 50.0, 300.0, 40.0, gyration=0.4, helix=30.0, poisson=0.3, plate_rate=5.0, mass=1.0
)


def tangle(turn: bool = False) -> tuple[Structure, np.ndarray]:
    """Five elements of large strain between four nodes: direct, turned, eccentric, with joints at one end or both.

    `turn`: they know how they turn along themselves in another pose.
    """
    poses = Poses(RANDOM.normal(size=(4, 3)), exponential(0.5 * RANDOM.normal(size=(4, 3))), RANDOM.normal(size=2))
    offsets = np.zeros((5, 2, 3))
    offsets[2:] = 0.3 * RANDOM.normal(size=(3, 2, 3))
    beams = make_beams(
        [[0, 1], [1, 2], [2, 3], [0, 2], [3, 1]],
        [1.0, 1.2, 0.9, 1.3, 1.1],
        SECTION,
        natural=0.3 * RANDOM.normal(size=(5, 3)),
        turns=exponential(0.4 * RANDOM.normal(size=(5, 2, 3))),
        offsets=offsets,
        joints=[[-1, -1], [-1, 1], [0, -1], [1, 0], [-1, -1]],
    )
    if turn:
        beams = turning(beams, poses.moved(0.1 * RANDOM.normal(size=poses.unknowns)))
    return Structure(poses, beams, np.zeros((4, 6), bool), np.zeros(2, bool)), 20 * RANDOM.normal(size=(5, 3))


def energy(structure: Structure, poses: Poses, lines: np.ndarray) -> float:
    """Elastic energy and potential of line loads by Hermite's cubic, integrated anew."""
    state = structure.beams.at(poses)
    points, frames = structure.beams.attachment.ends(poses)
    place, weight = np.polynomial.legendre.leggauss(3)
    potential = 0.0
    for s, w in zip((1 + place) / 2, weight / 2, strict=True):
        length = structure.beams.law.length[:, None]
        cubic = (1 - 3 * s**2 + 2 * s**3) * points[:, 0] + (3 * s**2 - 2 * s**3) * points[:, 1]
        cubic += length * ((s - 2 * s**2 + s**3) * frames[:, 0, :, 0] + (s**3 - s**2) * frames[:, 1, :, 0])
        potential -= (w * length * lines * cubic).sum()
    return float(state.energy.sum() + potential)


def central(function, size: int, step: float) -> np.ndarray:
    """Derivatives by differences of the fourth order."""
    unit = step * np.eye(size)
    return np.array(
        [(8 * (function(u) - function(-u)) - (function(2 * u) - function(-2 * u))) / (12 * step) for u in unit]
    )


@pytest.mark.parametrize("turn", [False, True])
def test_forces_are_the_derivative_of_the_energy(turn):
    structure, lines = tangle(turn)
    poses = structure.poses
    forces = structure.vector(structure.beams.at(poses, lines).forces())
    by_differences = central(lambda q: energy(structure, poses.moved(q), lines), poses.unknowns, 1e-3)
    assert np.abs(forces - by_differences).max() < 1e-8 * np.abs(forces).max()


@pytest.mark.parametrize("turn", [False, True])
def test_tangent_stiffness_is_the_second_derivative_of_the_energy(turn):
    """Along exp(w) R; off equilibrium the derivative of the forces also has a part that is not symmetric."""
    structure, lines = tangle(turn)
    poses = structure.poses
    state = structure.beams.at(poses, lines)
    blocks = state.stiffness(state.stress)
    stiffness = np.array([structure.multiplied(blocks, q) for q in np.eye(poses.unknowns)])
    assert np.abs(stiffness - stiffness.T).max() < 1e-14 * np.abs(stiffness).max()

    def forces(q):
        return structure.vector(structure.beams.at(poses.moved(q), lines).forces())

    by_differences = central(forces, poses.unknowns, 1e-3)
    both = (by_differences + by_differences.T) / 2
    assert np.abs(stiffness - both).max() < 1e-8 * np.abs(stiffness).max()


def test_strain_rate_is_the_derivative_of_the_strains():
    structure, _ = tangle()
    motion = RANDOM.normal(size=structure.poses.unknowns)
    rate = structure.beams.at(structure.poses).strain_rate(structure.gathered(motion))
    (by_differences,) = central(lambda q: structure.beams.at(structure.poses.moved(q * motion)).strains.values, 1, 1e-3)
    assert np.abs(rate - by_differences).max() < 1e-8 * np.abs(rate).max()


def test_the_stiffness_is_linear_in_the_stress_it_is_given():
    structure, _ = tangle()
    state = structure.beams.at(structure.poses)
    other = RANDOM.normal(size=state.stress.shape)
    whole, parts = state.stiffness(state.stress + other), state.stiffness(state.stress)
    for one, two, three in zip(whole, parts, state.geometric_stiffness(other), strict=True):
        assert np.allclose(one, two + three, rtol=0, atol=1e-11)


@pytest.mark.parametrize("turn", [False, True])
def test_rigid_motions_change_nothing(turn):
    """Frame indifference: strains, and forces that turn with the structure."""
    structure, _ = tangle(turn)
    poses = structure.poses
    turn, shift = exponential(np.array([[1.1, -0.7, 2.0]]))[0], np.array([30.0, -20.0, 10.0])
    moved = Poses(poses.points @ turn.T + shift, turn @ poses.frames, poses.angles)
    one, other = structure.beams.at(poses), structure.beams.at(moved)
    assert np.allclose(one.strains.values, other.strains.values, rtol=0, atol=1e-13)
    forces = one.on_ends(one.stress).T.reshape(-1, 4, 3) @ turn.T
    assert np.allclose(other.on_ends(other.stress).T.reshape(-1, 4, 3), forces, rtol=0, atol=1e-9)


def test_forces_on_an_element_balance():
    structure, _ = tangle()
    state = structure.beams.at(structure.poses)
    points, _ = structure.beams.attachment.ends(structure.poses)
    force_a, moment_a, force_b, moment_b = np.moveaxis(state.on_ends(state.stress).T.reshape(-1, 4, 3), 1, 0)
    moments = moment_a + moment_b + np.cross(points[:, 1] - points[:, 0], force_b)
    assert np.abs(force_a + force_b).max() < 1e-12 * np.abs(force_a).max()
    assert np.abs(moments).max() < 1e-12 * np.abs(moment_a).max()


@pytest.mark.parametrize(
    ("make", "parameter"),
    [
        (lambda: make_beams([[0, 1]], 0.0, STRIP), "lengths"),
        (lambda: make_beams([[0, 1], [1, 2]], [1.0, np.nan], STRIP), "lengths"),
        (lambda: make_beams([[2, 2]], 1.0, STRIP), "nodes"),
        (lambda: make_beams([[0, 1]], 1.0, [STRIP, STRIP], section=2), "section"),
        (lambda: flat_strip(STEEL, 0.1, 0.1), "thickness"),
        (lambda: flat_strip(STEEL, -0.1, 0.001), "height"),
        (lambda: rod(torsion=0.0), "torsion"),
        (lambda: replace(STRIP, shear_n=np.nan), "shear_n"),
    ],
)
def test_refusals(make, parameter):
    with pytest.raises(InputError) as refused:
        make()
    assert refused.value.where == parameter
