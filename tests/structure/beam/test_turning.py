"""Elements of a strip that is twisted and bent by nature: its linear flexibility, by integrals along it."""

import numpy as np
import pytest
from scipy.linalg import expm

from lamella.structure.beam.beams import make_beams
from lamella.structure.beam.poses import Poses
from lamella.structure.beam.turning import turning
from lamella.structure.loads import make_loads
from lamella.structure.static import equilibrium
from lamella.structure.structure import make_structure
from structure.strips import orders, rod

LENGTH = 0.6
SECTION = rod(axial=1e10)


def frames_along(curvature, places) -> tuple[np.ndarray, np.ndarray]:
    """Points and frames of a helix."""
    screw = np.zeros((4, 4))
    screw[:3, :3] = np.cross(np.eye(3), -np.array(curvature)).T
    screw[0, 3] = 1
    poses = np.array([expm(s * screw) for s in places])
    return poses[:, :3, 3], poses[:, :3, :3]


def exact(curvature, moment, force) -> np.ndarray:
    """Shift and rotation of the free end of a cantilever, to first order: the integral of what each section adds."""
    place, weight = np.polynomial.legendre.leggauss(40)
    s = LENGTH * (1 + place) / 2
    points, frames = frames_along(curvature, s)
    (end,), _ = frames_along(curvature, [LENGTH])
    total = np.zeros(6)
    flexible = np.diag([1 / SECTION.torsion, 1 / SECTION.bending_u, 1 / SECTION.bending_n])
    for point, frame, w in zip(points, frames, LENGTH * weight / 2, strict=True):
        bent = w * frame @ flexible @ frame.T @ (moment + np.cross(end - point, force))
        total += np.concatenate((np.cross(bent, end - point), bent))
    return total


def error(curvature, elements: int, moment, force, turn: bool) -> float:
    points, frames = frames_along(curvature, np.linspace(0, LENGTH, elements + 1))
    poses = Poses(points, frames, np.zeros(0))
    nodes = np.stack((np.arange(elements), np.arange(1, elements + 1)), 1)
    beams = make_beams(nodes, LENGTH / elements, SECTION, natural=curvature)
    structure = make_structure(poses, turning(beams, poses) if turn else beams, {0: "all"})
    small = 1e-7
    there = equilibrium(structure, make_loads(structure, forces={elements: (*(small * force), *(small * moment))}))
    frame = there.poses.frames[-1] @ frames[-1].T
    spin = np.array([frame[2, 1] - frame[1, 2], frame[0, 2] - frame[2, 0], frame[1, 0] - frame[0, 1]]) / 2
    found = np.concatenate((there.displacements[-1], spin)) / small
    wanted = exact(curvature, moment, force)
    return float(np.abs(found - wanted).max() / np.abs(wanted).max())


@pytest.mark.parametrize("curvature", [(0.9, 0.0, 0.0), (0.0, 0.0, 0.5), (0.9, 0.0, 0.5)])
@pytest.mark.parametrize(
    ("moment", "force"),
    [((0.0, 1.0, 0.0), (0.0, 0.0, 0.0)), ((0.0, 0.3, 0.1), (0.0, 0.2, 1.0)), ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0))],
)
def test_flexibility_of_a_turning_strip(curvature, moment, force):
    """A strip 4,400 times as stiff about one axis as about the other, twisted by 31 degrees and bent by 17 over its
    length: one element does; where it is both, errors are of the fourth order. Rounding leaves 1e-6."""
    errors = [error(curvature, elements, np.array(moment), np.array(force), True) for elements in (1, 2, 4)]
    assert errors[0] < 2e-3
    if all(curvature[::2]):
        assert orders(errors).min() > 3.7
    else:
        assert max(errors) < 1e-5


def test_plain_elements_are_stiffer():
    """Without that a twisted strip is stiffer about its strong axis, to the second order in its elements' length."""
    moment, force = np.array((0.0, 1.0, 0.0)), np.zeros(3)
    errors = [error((0.9, 0.0, 0.0), elements, moment, force, False) for elements in (1, 2, 4)]
    assert orders(errors) == pytest.approx(2.0, abs=0.1)
    assert errors[0] > 0.1
