"""Straightening (paper, Figure 6): principal rectangles become squares, their middles a net of lamellas.

1. Around an unduloid: conditions are met to the tolerance; the middles' stars have the surface's curvature and right
angles up to O(e^2). 2. On a patch without rotational symmetry: the remainder is told, and the net is as good as O(e^2)
allows. 3. Middles of edges on a plane.
"""

import numpy as np
import pytest

from lamella import Catenoid, Enneper, Unduloid
from lamella.projection.foot_points import foot_surface
from lamella.projection.problems.straighten import edge_middles, straighten
from lamella.projection.quad_mesh import QuadMesh, quad_mesh
from lamella.projection.star_measures import circle_angles, star_spheres
from projection.nets import grid_faces
from refusals import refused
from surface.form_finding.films import surface, tube

UNDULOID = Unduloid(0.6, 1.4, (-8.0, 8.0))


def principal_ring(around: int, rows: int) -> QuadMesh:
    """Meridians and parallels of the unduloid, the parallels 30 % too far apart and unevenly spread."""
    i, j = (x.ravel() for x in np.meshgrid(np.arange(rows), np.arange(around), indexing="ij"))
    u = np.linspace(-1, 1, rows)
    u = 1.3 * u * (rows - 1) * np.pi / around + 0.1 * np.sin(3 * u)
    at = UNDULOID.at(u[i] + 2j * np.pi * j / around)
    return quad_mesh(at.position, grid_faces(rows, around, True)[:, ::-1])


def squareness(mesh: QuadMesh) -> np.ndarray:
    """Means of opposite sides over those of the others, a face."""
    v = mesh.vertices[mesh.faces]
    side = np.linalg.norm(np.roll(v, -1, axis=1) - v, axis=2)
    return (side[:, 0] + side[:, 2]) / (side[:, 1] + side[:, 3])


def test_ring_of_an_unduloid() -> None:
    angles, curvatures = [], []
    for around, rows in ((20, 9), (40, 17)):
        mesh = principal_ring(around, rows)
        assert np.abs(squareness(mesh) - 1).max() > 0.2
        found = straighten(mesh, foot_surface(UNDULOID))
        assert found.solution.solved
        assert np.abs(squareness(found.isothermic) - 1).max() < 3 * (2 * np.pi / around) ** 2
        foot = foot_surface(UNDULOID).foot(found.isothermic.vertices).position
        assert np.abs(found.isothermic.vertices - foot).max() < 1e-7
        net = found.lamellas
        angles.append(np.abs(circle_angles(net, net.inner) - 90).max())
        curvatures.append(np.abs(np.abs(star_spheres(net, net.inner).curvature) - 0.5).max())
    assert angles[1] < 0.2
    assert np.log2(angles[0] / angles[1]) > 1.7
    assert np.log2(curvatures[0] / curvatures[1]) > 1.7


def test_a_mesh_that_grows_beyond_its_surface_is_told() -> None:
    """Squares of 24 around take twice the height: over the border of elements there are tangent planes only."""
    angle, height = np.meshgrid(np.arange(24) * np.pi / 12, np.linspace(-1.2, 1.0, 14))
    points = np.stack([np.cosh(height) * np.cos(angle), np.cosh(height) * np.sin(angle), height], -1)
    mesh = quad_mesh(points.reshape(-1, 3), grid_faces(14, 24, True)[:, ::-1])
    film = tube(lambda s: (np.cosh(s), s), np.linspace(-1.2, 1.0, 9), 16, 4)
    assert straighten(mesh, foot_surface(surface(film)), tolerance=1e-6).solution.verdict == "left the surface"
    assert straighten(mesh, foot_surface(Catenoid(1.0, (-1.6, 1.6)))).solution.solved


def test_patch_without_symmetry() -> None:
    """Enneper's surface: four conditions on three unknowns a vertex, the remainder is small and is told."""
    surface = Enneper(2, 1.2)
    angles = []
    for count in (9, 17):
        i, j = (x.ravel() for x in np.meshgrid(np.linspace(0, 1, count), np.linspace(0, 1, count), indexing="ij"))
        where = 0.1 + 0.5 * (i + 0.15 * i**2) + 1j * (0.05 + 0.45 * j)
        # parameter lines are principal, squares are squares of the parameters
        mesh = quad_mesh(surface.at(where).position, grid_faces(count, count))
        found = straighten(mesh, foot_surface(surface))
        assert found.solution.verdict in ("solved", "settled", "stagnated")
        assert max(found.solution.last.residual[c] for c in ("on the surface", "principal directions")) < 1e-3
        assert np.abs(squareness(found.isothermic) - 1).max() < np.abs(squareness(mesh) - 1).max() / 3
        net = found.lamellas
        angles.append(np.abs(circle_angles(net, net.inner) - 90).max())
    assert angles[1] < angles[0] / 2
    assert angles[1] < 0.5


def test_middles_of_edges() -> None:
    i, j = (x.ravel() for x in np.meshgrid(np.arange(4), np.arange(5), indexing="ij"))
    mesh = quad_mesh(np.column_stack([i, j, 0 * i]), grid_faces(4, 5))
    middles = edge_middles(mesh)
    assert len(middles.vertices) == 3 * 5 + 4 * 4
    assert len(middles.faces) == 3 * 4 + 2 * 3
    v = middles.vertices[middles.faces]
    assert np.linalg.norm(np.roll(v, -1, axis=1) - v, axis=2) == pytest.approx(np.sqrt(0.5))
    assert np.cross(v[:, 1] - v[:, 0], v[:, 2] - v[:, 1])[:, 2] == pytest.approx(0.5)


def test_single_face_is_refused() -> None:
    square = quad_mesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], np.arange(4)[None])
    with refused():
        straighten(square, foot_surface(UNDULOID))
