"""Lagrange polynomials on the triangle (0, 0), (1, 0), (0, 1).

Local node numbering: the three corners; then the inner nodes of the edges 0-1, 1-2, 2-0, each in the direction from
its first corner to its second; then the nodes inside.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import perm

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.result import Lean

EDGES = ((0, 1), (1, 2), (2, 0))
"""Corners of the local edges."""


@dataclass(frozen=True)
class Lagrange(Lean):
    """The basis of one order.

    Attributes
    ----------
    order : int
    nodes : (k, 2)
        Local coordinates (x, y) of the nodes; the barycentric ones are (1 - x - y, x, y).
    edge_nodes : (3, order + 1) int
        Local nodes along each edge, corners included.
    """

    order: int
    nodes: Floats
    edge_nodes: Integers

    @cached_property
    def _exponents(self) -> Integers:
        return np.array([(i, j) for j in range(self.order + 1) for i in range(self.order + 1 - j)])

    @cached_property
    def to_monomials(self) -> Floats:
        """Coefficients (k, k) of the monomials in each polynomial of the basis, one in a column."""
        i, j = self._exponents.T
        return np.linalg.inv(self.nodes[:, 0, None] ** i * self.nodes[:, 1, None] ** j)

    def basis(self, local: Floats, x_order: int = 0, y_order: int = 0) -> Floats:
        """Derivative d^(i+j) / dx^i dy^j of the basis at local coordinates (n, 2), as (n, k)."""
        return np.asarray(self.monomials(local).T @ self._derived(x_order, y_order))

    def _derived(self, x_order: int, y_order: int) -> Floats:
        """Coefficients (k, k) of the monomials in a derivative of each polynomial of the basis, one in a column."""
        return np.asarray(self.derivative(x_order, y_order) @ self.to_monomials)

    def monomials(self, local: Floats) -> Floats:
        """x^i y^j at local coordinates (n, 2), (k, n): all powers of x, then all but the last times y, and so on."""
        x, y = np.ascontiguousarray(local.T)
        result = np.empty((len(self.nodes), len(local)))
        result[0] = 1
        row, width = 0, self.order + 1
        for j in range(self.order + 1):
            if j:
                np.multiply(result[row], y, out=result[row + width])
                row, width = row + width, width - 1
            for i in range(1, width):
                np.multiply(result[row + i - 1], x, out=result[row + i])
        return result

    def derivative(self, x_order: int, y_order: int) -> Floats:
        """Coefficients (k, k) of the monomials in a derivative of each monomial, one in a column."""
        return _derivative(self.order, x_order, y_order)

    def second_jet(self, local: Floats) -> tuple[Floats, Floats, Floats, Floats, Floats, Floats]:
        """Values and derivatives x, y, xx, xy, yy of the basis at local coordinates (n, 2), each (n, k)."""
        monomials = self.monomials(local).T
        value, x, y, xx, xy, yy = (
            np.asarray(monomials @ self._derived(*d)) for d in ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2))
        )
        return value, x, y, xx, xy, yy


@lru_cache
def _derivative(order: int, x_order: int, y_order: int) -> Floats:
    """See `Lagrange.derivative`."""
    exponents = lagrange(order)._exponents
    number = {(i, j): index for index, (i, j) in enumerate(exponents.tolist())}
    result = np.zeros((len(exponents), len(exponents)))
    for source, (i, j) in enumerate(exponents.tolist()):
        if i >= x_order and j >= y_order:
            # x^i y^j becomes this multiple of x^(i - x_order) y^(j - y_order)
            result[number[i - x_order, j - y_order], source] = perm(i, x_order) * perm(j, y_order)
    return result


@lru_cache
def lagrange(order: int) -> Lagrange:
    """Equidistant Lagrange basis of an order; above about 10 its nodes alone are of use."""
    p = order
    corners = np.array([[0, 0], [p, 0], [0, p]])
    inner = [corners[a] + (corners[b] - corners[a]) * step // p for a, b in EDGES for step in range(1, p)]
    inside = [(i, j) for j in range(1, p) for i in range(1, p - j)]
    nodes = np.array([*corners.tolist(), *[point.tolist() for point in inner], *inside], float).reshape(-1, 2) / p
    edge_nodes = np.array([[a, *range(3 + e * (p - 1), 3 + (e + 1) * (p - 1)), b] for e, (a, b) in enumerate(EDGES)])
    return Lagrange(p, nodes, edge_nodes)


@lru_cache
def subdivision(parts: int) -> tuple[Floats, Integers]:
    """Local coordinates of a regular subdivision into `parts`^2 triangles, and their corners, counter-clockwise."""
    index: dict[tuple[int, int], int] = {}
    for j in range(parts + 1):
        for i in range(parts + 1 - j):
            index[i, j] = len(index)
    faces = []
    for i, j in index:
        if i + j < parts:
            faces.append((index[i, j], index[i + 1, j], index[i, j + 1]))
        if i + j < parts - 1:
            faces.append((index[i + 1, j], index[i + 1, j + 1], index[i, j + 1]))
    return np.array(list(index), float) / parts, np.array(faces)


@lru_cache
def local_faces(parts: int) -> Integers:
    """Small triangles of a subdivided triangle, by the numbers of the nodes of ``lagrange(parts)``, (parts^2, 3)."""
    local, faces = subdivision(parts)
    nodes = np.rint(lagrange(parts).nodes * parts).astype(int)
    number = {tuple(node): index for index, node in enumerate(nodes.tolist())}
    order = np.array([number[tuple(place)] for place in np.rint(local * parts).astype(int).tolist()])
    return np.asarray(order[faces])
