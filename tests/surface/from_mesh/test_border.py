"""Border loops: corners kept, coarse circles smooth, near vertices thinned, zigzags smoothed."""

import numpy as np
import pytest

from lamella.surface.boundary.corners import find_corners, turning_angles
from lamella.surface.from_mesh.border import border_curve, border_curves
from lamella.surface.from_mesh.border_zigzag import is_zigzag
from lamella.surface.from_mesh.clean import clean
from lamella.surface.from_mesh.raw_mesh import RawMesh
from surface.from_mesh.meshes import disc, grid, triangles

UP = np.array([0.0, 0.0, 1.0])


def polygon(corners, parts):
    """A closed polyline over plane corners, each side in `parts` pieces."""
    corners = np.asarray(corners, dtype=float)
    after = np.roll(corners, -1, axis=0)
    rows = [a + (b - a) * k / parts for a, b in zip(corners, after, strict=True) for k in range(parts)]
    return np.column_stack((np.array(rows), np.zeros(len(rows))))


def circle(count, radius=1.0):
    angle = 2 * np.pi * np.arange(count) / count
    return radius * np.column_stack((np.cos(angle), np.sin(angle), 0 * angle))


def curve(points, **options):
    return border_curve(points, np.broadcast_to(UP, points.shape), **options)


def test_turning_angles_of_a_regular_polygon():
    for count in (3, 4, 7, 100):
        np.testing.assert_allclose(turning_angles(circle(count)), 2 * np.pi / count, rtol=1e-12)


@pytest.mark.parametrize("count", [7, 8, 9, 12, 20, 60])
@pytest.mark.parametrize("corner_angle", [5.0, 20.0, 40.0])
def test_coarse_circles_have_no_corners(count, corner_angle):
    assert not find_corners(circle(count), corner_angle).any()


@pytest.mark.parametrize("seed", range(5))
def test_uneven_circles_and_ellipses_have_no_corners(seed):
    rng = np.random.default_rng(seed)
    angle = 2 * np.pi * (np.arange(16) + rng.uniform(-0.25, 0.25, 16)) / 16
    loop = np.column_stack((12 * np.cos(angle), 9 * np.sin(angle), 2.5 - 2.5 * np.cos(2 * angle)))
    assert not find_corners(loop).any()


@pytest.mark.parametrize("parts", [1, 2, 3, 10])
def test_corners_of_polygons_stay(parts):
    for corners in (
        [[0, 0], [1, 0], [1, 1], [0, 1]],
        [[0, 0], [3, 0], [2, 1], [1, 1]],
        [[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]],
        circle(6)[:, :2],
    ):
        if parts == 1 and len(corners) == 4 and corners[1] == [3, 0]:
            continue  # two turns of 45 degrees, an edge apart: that may be a coarse curve
        found = curve(polygon(corners, parts))
        assert np.flatnonzero(found.corner).tolist() == list(range(0, len(corners) * parts, parts))
        assert found.notes == ()


def test_corners_between_arcs_stay():
    # A half disc of a coarse arc, and a lens whose tips turn by 60 degrees over arcs of 15 degree turns.
    arc = circle(16)[:9]
    assert np.flatnonzero(find_corners(arc)).tolist() == [0, 8]
    angle = np.linspace(-np.pi / 3, np.pi / 3, 9)
    right = np.column_stack((np.cos(angle) - 0.5, np.sin(angle), 0 * angle))
    lens = np.vstack((right[:-1], -right[:-1]))
    assert np.flatnonzero(find_corners(lens)).tolist() == [0, 8]
    # The same with a corner sharper than the user calls one.
    assert not find_corners(lens, 100.0).any()


def test_a_corner_of_a_saddle_loop_in_space():
    loop = polygon([[0, 0], [1, 0], [1, 1], [0, 1]], 6)
    loop[:, 2] = loop[:, 0] * loop[:, 1]
    assert np.flatnonzero(find_corners(loop)).tolist() == [0, 6, 12, 18]


def test_vertices_too_near_go_and_corners_stay():
    square = polygon([[0, 0], [1, 0], [1, 1], [0, 1]], 5)
    # One vertex just beside a corner, off the side by a hair, and one in the middle of a side.
    loop = np.insert(square, [1, 8], [[0.01, -0.002, 0], [1.001, 0.51, 0]], axis=0)
    loop = np.insert(loop, 10, loop[9] + [0, 0.02, 0], axis=0)
    found = curve(loop)
    assert np.flatnonzero(found.corner).tolist() == [int(np.flatnonzero((found.points == c).all(axis=1))[0]) for c in
                                                     ([0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0])]  # fmt: skip
    steps = np.linalg.norm(np.roll(found.points, -1, axis=0) - found.points, axis=1)
    assert steps.min() >= 0.2 * 0.19
    assert found.notes == ("2 of 23 vertices left out, closer than 40 mm",)


@pytest.mark.parametrize("spacing", [0.05, 0.11, 0.4])
def test_thinning_to_a_spacing(spacing):
    below = polygon([[-1, 0], [0, -0.5], [1, 0]], 60)[1:120]
    loop = np.vstack((circle(400)[:201], below))
    found = curve(loop, spacing=spacing)
    steps = np.linalg.norm(np.roll(found.points, -1, axis=0) - found.points, axis=1)
    assert steps.min() > 0.6 * spacing
    assert np.median(steps) < 2.5 * spacing
    assert found.corner.sum() == 3
    for corner in ([1, 0, 0], [-1, 0, 0], [0, -0.5, 0]):
        assert np.abs(found.points[found.corner] - corner).max(axis=1).min() < 1e-12


@pytest.mark.parametrize("cells", [12, 24, 48])
def test_the_border_of_a_disc_of_squares_is_smoothed(cells):
    """Squares whose middles are in the unit circle: the border is a staircase about a circle of that radius."""
    points, quads = grid(2 * cells + 1, 2 * cells + 1, lambda x, y: 0 * x, size=2)
    points = points - [1, 1, 0]
    inside = np.linalg.norm(points[quads].mean(axis=1), axis=1) < 1
    mesh = clean(RawMesh(points, triangles(quads[inside])))
    loop = mesh.points[mesh.borders[0]]
    assert is_zigzag(loop, np.broadcast_to(UP, loop.shape))
    (found,) = border_curves(mesh)
    assert not found.corner.any()
    raw = np.abs(np.linalg.norm(loop, axis=1) - 1)
    smooth = np.abs(np.linalg.norm(found.points, axis=1) - 1)
    assert smooth.max() < 0.75 * raw.max()
    assert np.sqrt(np.mean(smooth**2)) < 0.6 * np.sqrt(np.mean(raw**2))
    assert np.degrees(turning_angles(found.points)).max() < 45
    assert "the border: its edges turn to and fro" in found.notes[0]


def test_squares_circles_and_gears_of_few_teeth_are_no_zigzags():
    for loop in (circle(12), circle(100), polygon([[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]], 4)):
        assert not is_zigzag(loop, np.broadcast_to(UP, loop.shape))


def test_a_triangle_zigzag_is_smoothed():
    loop = circle(60)
    loop[::2] *= 1.06
    found = curve(loop)
    assert np.abs(np.linalg.norm(found.points, axis=1) - 1.03).max() < 0.01
    assert "moves vertices by up to 3" in found.notes[0]


def test_curves_of_an_annulus_are_named():
    points, faces = disc(4, 24, hole=0.3)
    points[24 * 4 + 3] = 0.97 * points[24 * 4 + 4] + 0.03 * points[24 * 4 + 3]
    curves = border_curves(clean(RawMesh(points, faces)))
    assert [len(found.points) for found in curves] == [23, 24]
    assert curves[0].notes[0].startswith("the outer border: 1 of 24 vertices left out")
