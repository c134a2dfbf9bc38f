"""A mechanism of scissor joints, exact: straight rods on a hyperboloid.

n rods a family are tangent to the waist circle of radius RHO cos b and tilted by b; they cross at the distances
RHO tan(pi m / n) from the waist, whatever b is. Opened, rods stay straight and are twisted by tg = c / (c^2 + s^2),
c = RHO sin b: between joints, where the torsion moment is constant, by the mean of that.
"""

import numpy as np
import pytest
from scipy.optimize import brentq

from lamella.structure.beam.beams import make_beams
from lamella.structure.beam.poses import Poses
from lamella.structure.loads import make_loads
from lamella.structure.static import at_rest, displacement_path
from lamella.structure.structure import make_structure
from structure.strips import rod

RHO, RODS, REACH, TORSION = 1.5, 9, 2, 1.0
CROSSINGS = np.pi / RODS * np.arange(-REACH, REACH + 1)


def directions(azimuth, place, tilt):
    """Point, unit tangents of both rods and normal where they cross at an azimuth, `place` = atan(s / RHO)."""
    s, waist = RHO * np.tan(place), RHO * np.cos(tilt)
    tangents = []
    for sign in (1.0, -1.0):
        own = azimuth - sign * place
        tangents.append(np.array([-sign * np.sin(own) * np.cos(tilt), sign * np.cos(own) * np.cos(tilt), np.sin(tilt)]))
    own = azimuth - place
    point = np.array([waist * np.cos(own), waist * np.sin(own), 0.0]) + s * tangents[0]
    normal = np.cross(*tangents)
    return point, *tangents, normal / np.linalg.norm(normal)


def angles(tilt: float) -> np.ndarray:
    """From the first family's rod to the second's, at the crossings of a rod."""
    found = []
    for place in CROSSINGS:
        _, one, other, normal = directions(0.0, place, tilt)
        found.append(np.arctan2(np.cross(one, other) @ normal, one @ other))
    return np.array(found)


def twist_energy(tilt: float) -> float:
    """Of all rods."""
    s, c = RHO * np.tan(CROSSINGS), RHO * np.sin(tilt)
    twist = np.diff(np.arctan(s / c))
    return float(2 * RODS * (TORSION * twist**2 / (2 * np.diff(s))).sum())


def lattice(tilt: float, bending: float):
    """All crossings; the number of a node is 2 REACH + 1 times that of its first rod, plus the crossing's."""
    each = 2 * REACH + 1
    points, frames = [], []
    for k in range(RODS):
        for place in CROSSINGS:
            azimuth = 2 * np.pi * k / RODS + place
            point, one, _, normal = directions(azimuth, place, tilt)
            points.append(point)
            frames.append(np.stack((one, np.cross(normal, one), normal), 1))
    elements, joints = [], []
    for k in range(RODS):
        for m in range(2 * REACH):
            elements.append((each * k + m, each * k + m + 1))
            joints.append((-1, -1))
            # the second family's rod through the crossing m of the rod k meets the rod before it at the next one
            elements.append((each * k + m, each * ((k - 1) % RODS) + m + 1))
            joints.append(elements[-1])
    lengths = np.repeat(np.tile(np.diff(RHO * np.tan(CROSSINGS)), RODS), 2)
    section = rod(axial=1e3 * bending, torsion=TORSION, about_u=bending, about_n=bending)
    beams = make_beams(elements, lengths, section, joints=joints)
    poses = Poses(np.array(points), np.array(frames), np.tile(angles(tilt), RODS))
    # no more than a body needs
    return make_structure(poses, beams, {REACH: "all"})


@pytest.mark.parametrize("bending", [1e5, 1e9])
def test_hyperboloid_opens_as_a_mechanism(bending):
    """From 30 to 65 degrees, driven by the sum of all joints' angles. Torsion that joints pass on bends the rods a
    little: distances and energy are off by less than the ratio of torsion to bending stiffness, at 1e9 by 1e-9."""
    start_tilt, end_tilt = np.radians((30.0, 65.0))
    structure = lattice(start_tilt, bending)
    count = len(structure.poses.angles)
    weights = np.zeros(structure.poses.unknowns)
    weights[-count:] = 1.0
    # the load factor is the moment that holds each joint there
    free = at_rest(structure, make_loads(structure, joints=dict.fromkeys(range(count), 1.0)))
    back = angles(start_tilt).sum() * RODS - free.poses.angles.sum()
    (*_, begin) = displacement_path(free, weights, back, steps=8)
    whole, steps = RODS * (angles(end_tilt).sum() - angles(start_tilt).sum()), 12
    path = [begin, *displacement_path(begin, weights, whole, steps=steps)]
    for there in path:
        total = there.poses.angles.sum() / RODS
        tilt = brentq(lambda b, total=total: angles(b).sum() - total, 0.2, 1.4)
        exact = np.array([directions(2 * np.pi * k / RODS + p, p, tilt)[0] for k in range(RODS) for p in CROSSINGS])
        found, expected = (np.linalg.norm(x[:, None] - x, axis=2) for x in (there.poses.points, exact))
        assert np.abs(found - expected).max() < 1 / bending
        assert there.energy == pytest.approx(twist_energy(tilt), rel=1 / bending)
        assert there.negative == 0
    assert tilt == pytest.approx(end_tilt, abs=1e-9)
    # the driver's work, by Simpson's rule over equal steps of the sum
    force = np.array([there.factor for there in path])
    work = whole / steps / 3 * (force[0] + 4 * force[1:-1:2].sum() + 2 * force[2:-1:2].sum() + force[-1])
    assert path[-1].energy - path[0].energy == pytest.approx(work, rel=1e-4)
