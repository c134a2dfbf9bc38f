"""A surface of curved elements as tangent planes, to bring the vertices of a new mesh back to it."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from lamella.base.arrays import Floats
from lamella.base.ties import grid_of, rounded
from lamella.base.vectors import diagonal, dots
from lamella.surface.element.connectivity import Connectivity
from lamella.surface.element.geometry import normal_and_area, tangents
from lamella.surface.element.lagrange import subdivision

# samples along an element's edge that the remesher's vertices are brought back to
PLANE_SAMPLES = 8
# flat triangles along the edge of a curved one that new elements start from
FACETS = 2


class TangentPlanes:
    """A surface as the tangent planes of a dense set of its points: near enough for vertices that are moved again.

    Parameters
    ----------
    connectivity : Connectivity
    nodes : (n, 3)
        m.
    """

    def __init__(self, connectivity: Connectivity, nodes: Floats) -> None:
        basis = connectivity.basis
        local, _ = subdivision(PLANE_SAMPLES)
        corners = nodes[connectivity.elements]
        self._grid = grid_of(diagonal(nodes))
        self._points = np.matmul(basis.basis(local), corners).reshape(-1, 3)
        normals, _ = normal_and_area(*tangents(basis.basis(local, 1, 0), basis.basis(local, 0, 1), corners))
        self._normals = normals.reshape(-1, 3)
        self._tree = cKDTree(rounded(self._points, self._grid))

    def __call__(self, points: Floats) -> Floats:
        """Points (n, 3) brought to the nearest sample's tangent plane, m."""
        _, near = self._tree.query(rounded(points, self._grid))
        normal = self._normals[near]
        return np.asarray(points - dots(points - self._points[near], normal)[:, None] * normal)
