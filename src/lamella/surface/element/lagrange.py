"""Lagrange polynomials on the triangle (0, 0), (1, 0), (0, 1).

Local node numbering: the three corners; then the inner nodes of the edges 0-1, 1-2, 2-0, each in the direction from
its first corner to its second; then the nodes inside.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import perm

import numpy as np
from numpy.typing import NDArray

from lamella.surface.points import Floats

EDGES = ((0, 1), (1, 2), (2, 0))
"""Corners of the local edges."""

# numbers an array has that is worked on at a time
CACHED = 20_000


@dataclass(frozen=True)
class Lagrange:
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
    edge_nodes: NDArray[np.int64]

    @cached_property
    def _exponents(self) -> NDArray[np.int64]:
        return np.array([(i, j) for j in range(self.order + 1) for i in range(self.order + 1 - j)])

    @cached_property
    def _coefficients(self) -> Floats:
        i, j = self._exponents.T
        return np.linalg.inv(self.nodes[:, 0, None] ** i * self.nodes[:, 1, None] ** j)

    def basis(self, local: Floats, x_order: int = 0, y_order: int = 0) -> Floats:
        """Derivative d^(i+j) / dx^i dy^j of the basis at local coordinates (n, 2), as (n, k)."""
        return np.asarray(self._monomials(local) @ _derivative(self.order, x_order, y_order))

    def _monomials(self, local: Floats) -> Floats:
        """x^i y^j at local coordinates (n, 2), (n, k)."""
        i, j = self._exponents.T
        x, y = np.ones((2, self.order + 1, len(local)))
        for power in range(1, self.order + 1):
            x[power], y[power] = x[power - 1] * local[:, 0], y[power - 1] * local[:, 1]
        return np.asarray((x[i] * y[j]).T)

    def coefficients(self, values: Floats) -> Floats:
        """Coefficients (k, c, m) of the monomials x^i y^j, of c polynomials an element with nodal values (m, k, c)."""
        return np.ascontiguousarray(np.tensordot(self._coefficients, values, (1, 1)).transpose(0, 2, 1))

    def jet(self, coefficients: Floats, element: NDArray[np.int64], local: Floats) -> Floats:
        """Values and derivatives by x and y of polynomials of elements at places, (3, c, n).

        Parameters
        ----------
        coefficients : (k, c, m)
            See `coefficients`.
        element : (n,) int
        local : (n, 2)
        """
        return self._in_portions(coefficients, element, local, 3)

    def values(self, coefficients: Floats, element: NDArray[np.int64], local: Floats) -> Floats:
        """Values of polynomials of elements at places, (c, n), see `jet`."""
        return np.asarray(self._in_portions(coefficients, element, local, 1)[0])

    def values_everywhere(self, coefficients: Floats, local: Floats, x_order: int = 0, y_order: int = 0) -> Floats:
        """Values or derivatives at the same local coordinates (q, 2) of every element, element by element, (c, m q)."""
        # of the monomials at these places
        table = self.basis(local, x_order, y_order) @ self._monomials(self.nodes)
        values = np.tensordot(coefficients, table, (0, 1))
        return values.reshape(len(values), -1)

    def _in_portions(self, coefficients: Floats, element: NDArray[np.int64], local: Floats, parts: int) -> Floats:
        result = np.empty((parts, coefficients.shape[1], len(element)))
        # as many places at a time as stay in the processor's cache
        portion = max(CACHED // coefficients.shape[1], 1)
        for begin in range(0, len(element), portion):
            here = slice(begin, begin + portion)
            x, y = np.ascontiguousarray(local[here].T)
            self._horner(coefficients, element[here], x, y, result[:, :, here])
        return result

    def _horner(self, coefficients: Floats, element: NDArray[np.int64], x: Floats, y: Floats, result: Floats) -> None:
        """sum_j y^j (sum_i c_ij x^i), and its derivatives where `result` has room for them, by Horner's scheme."""
        row, slope, term = np.empty((3, coefficients.shape[1], len(x)))
        result[:] = 0
        value, *derivatives = result
        end = len(coefficients)
        for j in range(self.order, -1, -1):
            top, end = end - 1, end - (self.order + 1 - j)
            coefficients[top].take(element, 1, out=row, mode="clip")
            slope[:] = 0
            for i in range(top - 1, end - 1, -1):
                if derivatives:
                    slope *= x
                    slope += row
                row *= x
                row += coefficients[i].take(element, 1, out=term, mode="clip")
            if derivatives:
                by_x, by_y = derivatives
                by_x *= y
                by_x += slope
                by_y *= y
                by_y += value
            value *= y
            value += row

    def second_jet(self, local: Floats) -> tuple[Floats, Floats, Floats, Floats, Floats, Floats]:
        """Values and derivatives x, y, xx, xy, yy of the basis at local coordinates (n, 2), each (n, k)."""
        monomials = self._monomials(local)
        value, x, y, xx, xy, yy = (
            np.asarray(monomials @ _derivative(self.order, *d))
            for d in ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2))
        )
        return value, x, y, xx, xy, yy


@lru_cache
def _derivative(order: int, x_order: int, y_order: int) -> Floats:
    """Coefficients of the monomials in a derivative of each polynomial of the basis, (k, k)."""
    basis = lagrange(order)
    exponents = basis._exponents
    number = {(i, j): index for index, (i, j) in enumerate(exponents.tolist())}
    result = np.zeros((len(exponents), len(exponents)))
    for source, (i, j) in enumerate(exponents.tolist()):
        if i >= x_order and j >= y_order:
            # x^i y^j becomes this multiple of x^(i - x_order) y^(j - y_order)
            result[number[i - x_order, j - y_order], source] = perm(i, x_order) * perm(j, y_order)
    return result @ basis._coefficients


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
def subdivision(parts: int) -> tuple[Floats, NDArray[np.int64]]:
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
def local_faces(parts: int) -> NDArray[np.int64]:
    """Small triangles of a subdivided triangle, by the numbers of the nodes of ``lagrange(parts)``, (parts^2, 3)."""
    local, faces = subdivision(parts)
    nodes = np.rint(lagrange(parts).nodes * parts).astype(int)
    number = {tuple(node): index for index, node in enumerate(nodes.tolist())}
    order = np.array([number[tuple(place)] for place in np.rint(local * parts).astype(int).tolist()])
    return np.asarray(order[faces])
