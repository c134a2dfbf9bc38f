"""A surface of curved elements as tangent planes, to bring the vertices of a new mesh back to it, and its nodes."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from lamella.base.arrays import Floats
from lamella.base.ties import grid_of, rounded
from lamella.base.vectors import diagonal, dots, lengths
from lamella.surface.element.connectivity import Connectivity
from lamella.surface.element.geometry import normal_and_area, tangents
from lamella.surface.element.lagrange import subdivision

# samples along an element's edge that the remesher's vertices are brought back to
PLANE_SAMPLES = 8


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
        self._local, self._connectivity, self._nodes = local, connectivity, nodes
        self._grid = grid_of(diagonal(nodes))
        corners = nodes[connectivity.elements]
        self._points = np.matmul(basis.basis(local), corners).reshape(-1, 3)
        first, second = tangents(basis.basis(local, 1, 0), basis.basis(local, 0, 1), corners)
        normals, _ = normal_and_area(first, second)
        self._normals, self._first, self._second = (x.reshape(-1, 3) for x in (normals, first, second))
        self._tree = cKDTree(rounded(self._points, self._grid))

    def __call__(self, points: Floats) -> Floats:
        """Points (n, 3) brought to the nearest sample's tangent plane, m."""
        _, near = self._tree.query(rounded(points, self._grid))
        normal = self._normals[near]
        return np.asarray(points - dots(points - self._points[near], normal)[:, None] * normal)

    @cached_property
    def _bends(self) -> Floats:
        """Second fundamental forms of the samples in their tangents, (s, 3): 11, 12, 22, m."""
        basis, corners = self._connectivity.basis, self._nodes[self._connectivity.elements]
        orders = ((2, 0), (1, 1), (0, 2))
        second = (np.matmul(basis.basis(self._local, *order), corners).reshape(-1, 3) for order in orders)
        return np.stack([dots(vectors, self._normals) for vectors in second], 1)

    def curved(self, points: Floats) -> Floats:
        """Points (n, 3) brought to the surface along its normals, m.

        Beside its nearest sample the surface is followed to second order: what is left goes with the third power of
        the samples' distance.
        """
        _, near = self._tree.query(rounded(points, self._grid))
        normal, first, second = self._normals[near], self._first[near], self._second[near]
        e, f, g = dots(first, first), dots(first, second), dots(second, second)
        determinant = e * g - f * f
        off = points - self._points[near]

        def raised(one: Floats, other: Floats) -> tuple[Floats, Floats]:
            return (g * one - f * other) / determinant, (e * other - f * one) / determinant

        along, across = raised(dots(off, first), dots(off, second))
        b_11, b_12, b_22 = self._bends[near].T
        turn = b_11 * along + b_12 * across, b_12 * along + b_22 * across
        height = dots(off, normal) - (turn[0] * along + turn[1] * across) / 2
        back, aside = raised(*turn)
        normal = normal - back[:, None] * first - aside[:, None] * second
        return np.asarray(points - (height / lengths(normal))[:, None] * normal)
