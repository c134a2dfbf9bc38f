"""Curved triangles whose nodes lie on a closed form: surfaces as form finding gives them, known exactly."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.spatial import Delaunay

from lamella.base.arrays import Floats, Integers
from lamella.surface.element.connectivity import connect
from lamella.surface.element.surface import ElementSurface


def catenoid_map(uv: Floats) -> Floats:
    """Catenoid of neck radius 1; its normal u x v points away from the axis."""
    u, v = uv[..., 0], uv[..., 1]
    return np.stack([np.cosh(v) * np.cos(u), np.cosh(v) * np.sin(u), v], -1)


def sphere_map(uv: Floats) -> Floats:
    """Sphere of radius 2 about the origin by stereographic parameters; its normal u x v points outwards, H = -1/2."""
    square = (uv**2).sum(-1, keepdims=True)
    return 2 * np.concatenate([2 * uv, 1 - square], -1) / (1 + square)


def on_map(
    surface: Callable[[Floats], Floats],
    corners: Floats,
    faces: Integers,
    order: int,
    mean_curvature: float,
    loops: Callable[[Floats], Integers] = lambda middles: np.zeros(len(middles), np.int64),
) -> ElementSurface:
    """Elements of an order with nodes at the images of the nodes of flat triangles.

    Parameters
    ----------
    surface : callable
        Points (..., 3) of parameters (..., 2).
    corners : (m, 3, 2)
        Parameters of the corners of each triangle.
    faces : (m, 3) int
        Vertices of the triangles: where parameters wrap around, one vertex has several.
    order : int
    mean_curvature : float
    loops : callable
        Boundary loops (b,) of boundary edges by their midpoints in space (b, 3).
    """
    connectivity = connect(faces, int(faces.max()) + 1, order)
    x, y = connectivity.basis.nodes.T
    weights = np.stack([1 - x - y, x, y], 1)
    nodes = np.empty((connectivity.node_count, 3))
    nodes[connectivity.elements] = surface(np.einsum("kc,mcd->mkd", weights, corners))
    middles = nodes[connectivity.rim_nodes[:, [0, -1]]].mean(1)
    return ElementSurface("form-found", mean_curvature, connectivity, nodes, loops(middles))


def catenoid_patch(order: int, count: int = 60) -> ElementSurface:
    """u from 0 to 2, v from -1 to 1, in irregular triangles."""
    rng = np.random.default_rng(5)
    side = np.linspace(-1, 1, 7)
    frame = np.array([(s, t) for s in side for t in side if max(abs(s), abs(t)) == 1])
    # no vertex so near to a side that a triangle there becomes a sliver
    inside = rng.uniform(-0.85, 0.85, (count, 2))
    uv = np.vstack([frame, inside]) + np.array([1.0, 0.0])
    return on_map(catenoid_map, *_triangulated(uv), order, 0.0)


def sphere_cap(order: int, rings: int = 4) -> ElementSurface:
    """The cap above 60 degrees of latitude."""
    radius = np.sin(np.pi / 6) / (1 + np.cos(np.pi / 6))
    uv = [np.zeros((1, 2))]
    for ring in range(1, rings + 1):
        angle = 2 * np.pi * np.arange(6 * ring) / (6 * ring)
        uv.append(radius * ring / rings * np.column_stack([np.cos(angle), np.sin(angle)]))
    return on_map(sphere_map, *_triangulated(np.concatenate(uv)), order, -0.5)


def whole_catenoid(order: int, around: int = 12, up: int = 5) -> ElementSurface:
    """All around the axis, v from -0.8 to 1.1: loop 0 is the upper ring, loop 1 the lower one."""
    i, j = (x.ravel() for x in np.meshgrid(np.arange(around), np.arange(up), indexing="ij"))
    u, v = 2 * np.pi * np.arange(around + 1) / around, np.linspace(-0.8, 1.1, up + 1)
    quad = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    columns, rows = i[:, None] + quad[:, 0], j[:, None] + quad[:, 1]
    halves = ([0, 1, 2], [0, 2, 3])
    corners = np.concatenate([np.stack([u[columns[:, h]], v[rows[:, h]]], -1) for h in halves])
    faces = np.concatenate([columns[:, h] % around * (up + 1) + rows[:, h] for h in halves])
    return on_map(catenoid_map, corners, faces, order, 0.0, lambda m: (m[:, 2] < 0).astype(np.int64))


def _triangulated(uv: Floats) -> tuple[Floats, Integers]:
    faces = Delaunay(uv).simplices.astype(np.int64)
    a, b, c = (uv[faces[:, k]] for k in range(3))
    area = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    faces = np.where((area > 0)[:, None], faces, faces[:, ::-1])[np.abs(area) > 1e-9]
    return uv[faces], faces
