"""Two strips that cross on a saddle: residual stress, load, and the order of the element in between."""

import numpy as np
import pytest

from lamella.structure.beam.beams import make_beams
from lamella.structure.beam.fibre_stress import strip_stresses
from lamella.structure.beam.poses import Poses
from lamella.structure.loads import make_loads
from lamella.structure.static import at_rest, loaded
from lamella.structure.structure import Structure, make_structure
from structure.strips import HEIGHT, STEEL, STRIP, THICKNESS, orders

ARM, SADDLE = 0.6, 1.2


def frame(tangent, normal) -> np.ndarray:
    normal = np.array(normal) / np.linalg.norm(normal)
    tangent = np.array(tangent) / np.linalg.norm(tangent)
    return np.stack((tangent, np.cross(normal, tangent), normal), 1)


def cross(per_arm: int) -> Structure:
    """The two straight lines of z = x y / SADDLE through the origin, strips upright on it and clamped at their ends:
    they are twisted by 1 / SADDLE in the middle and less further out."""
    points, frames, elements, turns = [np.zeros(3)], [np.eye(3)], [], []
    own = []
    steps = np.linspace(-ARM, ARM, 2 * per_arm + 1)
    for family in (0, 1):
        numbers = []
        for s in steps:
            x, y = (s, 0.0) if family == 0 else (0.0, s)
            normal = (-y / SADDLE, -x / SADDLE, 1.0)
            tangent = (1, 0, y / SADDLE) if family == 0 else (0, 1, x / SADDLE)
            numbers.append(0 if s == 0 else len(points))
            own.append(frame(tangent, normal))
            if s != 0:
                points.append(np.array([x, y, x * y / SADDLE]))
                frames.append(own[-1])
        mine = own[-len(steps) :]
        for a in range(len(steps) - 1):
            ends = numbers[a], numbers[a + 1]
            elements.append(ends)
            turns.append([frames[end].T @ mine[a + k] for k, end in enumerate(ends)])
    points, frames = np.array(points), np.array(frames)
    beams = make_beams(elements, ARM / per_arm, STRIP, turns=turns)
    rim = np.flatnonzero(np.abs(points[:, :2]).max(1) > ARM - 1e-9)
    return make_structure(Poses(points, frames, np.zeros(0)), beams, dict.fromkeys(rim.tolist(), "all"))


def test_a_cross_on_a_saddle_converges():
    """Load on top of residual stress, with 4 to 32 elements an arm: deflection with the fourth order, the largest
    stress (at the node under the load, where bending under tension dies out within 3 cm) with the second."""
    deflections, stresses, residual = [], [], []
    for per_arm in (4, 8, 16, 32):
        structure = cross(per_arm)
        loads = make_loads(structure, forces={0: (3.0, -5.0, -200.0, 2.0, 1.0, 0.3)})
        rest = at_rest(structure, loads)
        found = loaded(rest)
        assert found.negative == 0
        deflections.append(np.linalg.norm(found.displacements[0]))
        stresses.append(strip_stresses(found.state, STEEL, HEIGHT, THICKNESS).von_mises.max())
        residual.append(rest.energy)
    assert orders(np.diff(deflections))[-1] > 3.5
    assert orders(np.diff(stresses))[-1] == pytest.approx(2.0, abs=0.3)
    # held at its ends the twist is even out between them, whatever the elements
    assert residual == pytest.approx([residual[0]] * 4, rel=1e-9)


def test_residual_stress_of_a_held_cross():
    """Each arm has the twist atan(ARM / SADDLE) / ARM, evened out, and the tension E A i^2 tg^2 / 2 of its length."""
    structure = cross(6)
    rest = at_rest(structure, make_loads(structure))
    tg = np.arctan(ARM / SADDLE) / ARM
    assert rest.state.motion.local_theta[0] * 6 / ARM == pytest.approx(np.repeat([tg, -tg], 12), rel=1e-9)
    assert rest.resultants[0] == pytest.approx(STRIP.axial * STRIP.gyration * tg**2 / 2, rel=1e-6)
