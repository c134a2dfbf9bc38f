"""The ruler of star nets: spheres and planes to rounding, angles that are known.

1. Points on spheres and planes of any size give the curvature exactly, with its sign. 2. A point off the sphere is
seen. 3. Circles on a sphere that cross at a known angle, sampled unevenly, are measured exactly.
"""

import numpy as np
import pytest

from lamella.projection.quad_mesh import QuadMesh, quad_mesh
from lamella.projection.star_measures import chord_angles, circle_angles, star_spheres

FACES = np.array([[0, 1, 5, 2], [0, 2, 6, 3], [0, 3, 7, 4], [0, 4, 8, 1]])
CENTRE = np.array([0])


def star(legs: np.ndarray) -> QuadMesh:
    """A vertex in the origin with four neighbours; outer corners are of no account."""
    far = (legs + np.roll(legs, -1, axis=0)) * 1.1
    return quad_mesh(np.vstack([np.zeros(3), legs, far]), FACES)


def circles(radius: float, angle: float, rng: np.random.Generator) -> np.ndarray:
    """Neighbours on two circles of the sphere through the origin about (0, 0, radius) that cross there at the angle."""
    found = np.empty((4, 3))
    for k, turn in enumerate((0.0, np.radians(angle))):
        tangent, sideways = np.array([np.cos(turn), np.sin(turn), 0]), np.array([-np.sin(turn), np.cos(turn), 0])
        # centre of the circle: in the plane across the tangent, on the sphere's Meusnier circle
        lean = rng.uniform(-0.5, 0.5)
        inwards = np.cos(lean) * np.array([0, 0, 1]) + np.sin(lean) * sideways
        r = radius * np.cos(lean)
        for sign, leg in ((1, k), (-1, k + 2)):
            way = sign * rng.uniform(0.1, 0.3)
            found[leg] = r * np.sin(way) * tangent + r * (1 - np.cos(way)) * inwards
    return found


@pytest.mark.parametrize("radius", [1.0, 40.0, 1e4])
@pytest.mark.parametrize("angle", [90.0, 60.0, 135.0])
def test_circles_on_a_sphere(radius: float, angle: float) -> None:
    mesh = star(circles(radius, angle, np.random.default_rng(0)))
    found = star_spheres(mesh, CENTRE)
    assert found.deviation[0] < 1e-14 * radius
    assert found.curvature[0] == pytest.approx(1 / radius, rel=1e-10)
    assert found.planarity[0] > 1e-3 * radius
    assert circle_angles(mesh, CENTRE)[0] == pytest.approx(angle, abs=1e-9)
    assert abs(chord_angles(mesh, CENTRE)[0] - angle) > 1e-3
    below = star(circles(radius, angle, np.random.default_rng(0)) * [1, 1, -1])
    assert star_spheres(below, CENTRE).curvature[0] == pytest.approx(-1 / radius, rel=1e-10)


def test_plane() -> None:
    legs = np.array([[1.0, 0, 0], [0.1, 1, 0], [-1, 0.1, 0], [0, -1.2, 0]])
    turn = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    found = star_spheres(star(legs @ turn), CENTRE)
    # singular vectors of five rows of numbers about 1: some tens of units in the last place
    rounding = 50 * np.finfo(float).eps
    assert found.planarity[0] < rounding
    assert found.deviation[0] < rounding
    assert abs(found.curvature[0]) < rounding


def test_a_neighbour_off_the_sphere_is_seen() -> None:
    """Root mean square distance from the best sphere: proportional to how far one of five points is off."""
    rng = np.random.default_rng(2)
    legs = circles(1.0, 90.0, rng)
    off = []
    for way in (1e-4, 1e-5):
        moved = legs.copy()
        moved[0] *= 1 + way
        off.append(star_spheres(star(moved), CENTRE).deviation[0])
    assert off[0] == pytest.approx(10 * off[1], rel=1e-2)
    assert off[1] > 1e-8
