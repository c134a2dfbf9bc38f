"""Elements to integrate on: rosettes, cuts inside elements, and what w does on them."""

from __future__ import annotations

import numpy as np
import pytest

from lamella.network.isothermic.mesh_layout import make_integration_mesh
from lamella.network.isothermic.umbilic_patch import PATCH_RINGS, umbilic_patch
from lamella.surface.element.bisect import bisect, whole
from lamella.surface.element.lagrange import lagrange
from lamella.surface.element.quadrature import triangle_rule
from network.elements.test_element_network import FORMS
from surface.element.exact_elements import catenoid_patch


@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_rosette_is_a_disc_of_wedges_between_the_principal_lines(order: int) -> None:
    """Where D = e^(i a) z^m the forms sqrt(D) dz are real or imaginary along the edges from the zero."""
    argument, radius = 0.7, 2.0
    rose = umbilic_patch(order, argument, radius, 4)
    wedges = 2 * (order + 2)
    assert len(rose.faces) == wedges * PATCH_RINGS**2
    ends = np.sort(np.stack([rose.faces, np.roll(rose.faces, -1, 1)], 2).reshape(-1, 2), 1)
    edges, times = np.unique(ends, axis=0, return_counts=True)
    assert len(rose.vertices) - len(edges) + len(rose.faces) == 1
    assert set(edges[times == 1].ravel().tolist()) == set(rose.rim.tolist())
    # corner nodes are the vertices, from either side
    assert np.allclose(rose.nodes[:, :3], rose.vertices[rose.faces])
    inner = rose.vertices[np.unique(edges[(edges == 0).any(1)])][1:]
    phase = (argument + (order + 2) * np.angle(inner)) / np.pi
    assert np.abs(phase - np.round(phase)).max() < 1e-12
    # counter-clockwise, and as large as its polygon in the end
    a, b, c = rose.vertices[rose.faces].T
    assert (((b - a).conj() * (c - a)).imag > 0).all()
    around = rose.vertices[rose.rim]
    assert np.allclose(np.abs(around[::PATCH_RINGS]), radius)
    assert (np.diff(np.unwrap(np.angle(around))) > 0).all()


@pytest.mark.parametrize("order", [1, 2])
def test_coordinates_are_polynomials_on_a_rosette(order: int) -> None:
    """w = z^(1 + m/2) through the nodes of the elements is w everywhere on them, up to a sign between elements."""
    rose = umbilic_patch(order, 0.0, 1.0, 4)
    basis = lagrange(4)
    local = np.random.default_rng(3).dirichlet([1, 1, 1], 40)[:, 1:]
    table = basis.basis(local)
    z = rose.nodes @ table.T
    exact = z ** (order + 2)
    # the square is single valued: w itself follows along each element from its middle
    root = rose.nodes ** (1 + order / 2)
    middle = (rose.nodes.mean(1) ** (1 + order / 2))[:, None]
    root = np.where((root * middle.conj()).real < 0, -root, root)
    assert np.abs((root @ table.T) ** 2 - exact).max() < 1e-12


def test_bisection_keeps_the_surface_and_bounds_the_angles() -> None:
    """Parts of an element lie on it; areas add up; the smallest angle is at least half the start's (Rivara 1984)."""
    surface = catenoid_patch(4)
    start = whole(surface.connectivity, surface.nodes, surface.rim_loop)
    centre = surface.nodes[surface.connectivity.faces[20, 0]]

    def too_large(corners: np.ndarray, longest: np.ndarray) -> np.ndarray:
        return longest > np.maximum(0.5 * np.linalg.norm(corners - centre, axis=2).min(1), 0.01)

    parts = bisect(start, surface.connectivity, surface.nodes, too_large)
    assert len(parts.faces) > 2 * len(start.faces)
    corners = parts.points[parts.faces]
    edges = np.roll(corners, -1, 1) - corners
    assert not too_large(corners, np.linalg.norm(edges, axis=2).max(1)).any()
    # each edge in two triangles, or on the rim
    ends = np.sort(np.stack([parts.faces, np.roll(parts.faces, -1, 1)], 2).reshape(-1, 2), 1)
    pairs, times = np.unique(ends, axis=0, return_counts=True)
    assert times.max() == 2
    assert (parts.loop[pairs[times == 1]] >= 0).all()
    # a vertex is where each of its triangles says
    where = parts.places(np.arange(len(parts.faces)), np.array([[0.0, 0], [1, 0], [0, 1]]))
    assert np.abs(surface.measured(where).position.reshape(-1, 3, 3) - corners).max() < 1e-12
    one, two = (parts.corners[:, k] - parts.corners[:, 0] for k in (1, 2))
    share = np.bincount(parts.parent, one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0])
    assert np.allclose(share, 1)

    def least_angle(corners: np.ndarray) -> float:
        along = np.roll(corners, -1, 1) - corners
        along /= np.linalg.norm(along, axis=2)[..., None]
        return float(np.arccos(-(along * np.roll(along, 1, 1)).sum(2)).min())

    assert least_angle(corners) > 0.45 * least_angle(start.points[start.faces])


@pytest.mark.parametrize("name", ["hexagonal node", "eight rays"])
def test_net_mesh_covers_the_surface(name: str) -> None:
    """The elements around umbilics are as large as those they replace; nothing is folded."""
    _, surface = FORMS[name]()
    mesh = make_integration_mesh(surface, surface.umbilics)
    basis = mesh.connectivity.basis
    points, weights = triangle_rule(8)
    corners = mesh.nodes[mesh.connectivity.elements]
    normal = np.cross(np.matmul(basis.basis(points, 1, 0), corners), np.matmul(basis.basis(points, 0, 1), corners))
    middle = mesh.normals[mesh.connectivity.elements].mean(1)
    assert (np.einsum("eqc,ec->eq", normal, middle) > 0).all()
    area = float((np.linalg.norm(normal, axis=2) * weights).sum())
    assert area == pytest.approx(surface.area(), rel=1e-6)
    assert len(mesh.connectivity.rim_nodes) == len(surface.connectivity.rim_nodes)
    assert np.linalg.norm(mesh.nodes[mesh.umbilics[0]] - surface.umbilics.position[0]) < 1e-12
    assert np.linalg.norm(mesh.normals, axis=1) == pytest.approx(1)
