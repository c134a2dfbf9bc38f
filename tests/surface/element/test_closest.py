"""Closest points against a search through thousands of samples, and the conditions a closest point has to meet."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import cKDTree

from lamella.surface.element.closest import ClosestPoint
from lamella.surface.element.lagrange import subdivision
from lamella.surface.element.places import Places
from surface.element.exact_elements import catenoid_patch, sphere_cap, whole_catenoid

SURFACES = {"patch": catenoid_patch, "cap": sphere_cap, "whole": whole_catenoid}


def position(surface, places: Places) -> np.ndarray:
    basis = surface.connectivity.basis.basis(places.local)
    return np.einsum("nk,nkc->nc", basis, surface.nodes[surface.connectivity.elements[places.element]])


def samples(surface, parts: int) -> np.ndarray:
    local, _ = subdivision(parts)
    corners = surface.nodes[surface.connectivity.elements]
    return np.matmul(surface.connectivity.basis.basis(local), corners).reshape(-1, 3)


def queries(surface, rng, count: int = 400) -> np.ndarray:
    """Near the surface, near vertices and edges, near and outside the border, and far away."""
    mesh = surface.connectivity
    local = rng.random((count, 2))
    local = np.where((local.sum(1) > 1)[:, None], 1 - local, local)
    inside = position(surface, Places(rng.integers(0, len(mesh.elements), count), local))
    vertices = surface.nodes[rng.integers(0, mesh.faces.max() + 1, count)]
    edges = surface.nodes[mesh.elements[rng.integers(0, len(mesh.elements), count), rng.integers(3, 6, count)]]
    border = surface.nodes[mesh.rim_nodes[rng.integers(0, len(mesh.rim_nodes), count)].ravel()[:count]]
    size = np.linalg.norm(np.ptp(surface.nodes, axis=0))
    return np.concatenate(
        [
            inside + 0.03 * rng.normal(size=inside.shape),
            vertices + 1e-3 * rng.normal(size=vertices.shape),
            vertices + 1e-9 * rng.normal(size=vertices.shape),
            edges + 1e-4 * rng.normal(size=edges.shape),
            border + 0.1 * rng.normal(size=border.shape),
            inside[:50] + 0.3 * size * rng.normal(size=(50, 3)),
        ]
    )


@pytest.mark.parametrize("order", [2, 3, 4])
@pytest.mark.parametrize("name", SURFACES)
class TestAgainstSamples:
    def test_no_sample_is_nearer(self, name, order) -> None:
        surface = SURFACES[name](order)
        points = queries(surface, np.random.default_rng(order))
        places, found = surface.closest(points)
        distance = np.linalg.norm(found - points, axis=1)
        nearest, _ = cKDTree(samples(surface, 30)).query(points)
        size = np.linalg.norm(np.ptp(surface.nodes, axis=0))
        # far points may have two feet of nearly the same distance, and samples tell them apart; near ones may not
        near = nearest < 0.15 * size
        assert near.sum() > 0.9 * len(points)
        assert (distance - nearest)[near].max() < 1e-9 * size
        assert (distance - nearest)[~near].max() < 0.02 * size
        assert found == pytest.approx(position(surface, places), abs=1e-13 * size)
        assert places.local.min() >= -1e-12
        assert places.local.sum(1).max() <= 1 + 1e-12

    def test_the_way_to_a_place_inside_is_normal(self, name, order) -> None:
        surface = SURFACES[name](order)
        points = queries(surface, np.random.default_rng(10 + order))
        places, found = surface.closest(points)
        barycentric = np.column_stack([1 - places.local.sum(1), places.local])
        near = np.linalg.norm(points - found, axis=1) < 0.5
        inside = near & (barycentric.min(1) > 1e-9)
        assert inside.sum() > 0.3 * len(points)
        corners = surface.nodes[surface.connectivity.elements[places.element]]
        for d in ((1, 0), (0, 1)):
            tangent = np.einsum("nk,nkc->nc", surface.connectivity.basis.basis(places.local, *d), corners)
            tangent /= np.linalg.norm(tangent, axis=1)[:, None]
            assert np.abs(((points - found) * tangent).sum(1))[inside].max() < 1e-9

    def test_points_of_the_surface_are_their_own(self, name, order) -> None:
        surface = SURFACES[name](order)
        points = samples(surface, 7)  # vertices, edges and border among them
        _, found = surface.closest(points)
        assert found == pytest.approx(points, abs=1e-10)


def test_sphere_projects_along_its_radius() -> None:
    """The closest point of a sphere lies on the radius: off by the elements' own O(h^(p+1)) only."""
    rng = np.random.default_rng(1)
    direction = rng.uniform(-0.25, 0.25, (300, 3)) * [1, 1, 0] + [0, 0, 1]
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    errors = []
    for rings in (3, 6, 12):
        _, found = sphere_cap(4, rings).closest(direction * rng.uniform(1.7, 2.3, 300)[:, None])
        errors.append(np.abs(found - 2 * direction).max())
    assert errors[-1] < 1e-6
    assert -np.polyfit(range(3), np.log2(errors), 1)[0] > 3.5


def test_border_holds_points_outside() -> None:
    """Beyond the edge of a flat square the closest point is the square's own: clipped coordinates."""
    from surface.element.exact_elements import on_map

    side = np.linspace(0, 1, 4)
    uv = np.array([(x, y) for x in side for y in side])
    faces = np.array(
        [f for i in range(3) for j in range(3) for a in [4 * i + j] for f in ((a, a + 4, a + 5), (a, a + 5, a + 1))]
    )
    flat = on_map(lambda q: np.concatenate([q, 0 * q[..., :1]], -1), uv[faces], faces, 3, 0.0)
    rng = np.random.default_rng(2)
    points = rng.uniform(-1, 2, (500, 3))
    _, found = ClosestPoint(flat.connectivity, flat.nodes)(points)
    expected = np.column_stack([np.clip(points[:, :2], 0, 1), np.zeros(500)])
    assert found == pytest.approx(expected, abs=1e-9)
