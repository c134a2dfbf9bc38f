"""Area and volume of a curved surface with their first and second variation along a direction field.

Every node moves along its own fixed direction: x_i = x_i(0) + s_i d_i. With tangent vectors a = x_1, b = x_2 and
N = a x b, area A = integral of |N|, volume swept dV_i = integral of phi_i d_i . N. A surface of mean curvature H for
the normal n = N / |N| is where A + 2 H V is stationary (dA = -2 H dV). With dN_i the change of N,

    d_i d_j |N| = (dN_i . dN_j - (dN_i . n)(dN_j . n)) / |N| + n . d_i d_j N,
    d_i d_j N   = (phi_i,1 phi_j,2 - phi_i,2 phi_j,1) d_i x d_j,

which is exact: Newton's method converges quadratically.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.blocks import blocks
from lamella.base.sparse import packed
from lamella.surface.element.connectivity import Connectivity
from lamella.surface.element.quadrature import triangle_rule

# worked on at a time: their tables stay in the processor's cache
VARIATION_BLOCK = 192


@dataclass(frozen=True)
class FirstVariation:
    """First variation of area and volume at one position of the nodes.

    Attributes
    ----------
    area : float
        m^2.
    area_gradient, volume_gradient : (n,)
        Derivatives by the shifts s of the nodes, m and m^2.
    tangents : (2, 3, m, q)
        a and b at the integration points.
    normals : (3, m, q)
        Unit normals there.
    elements : (m, q)
        Area elements |N| there.
    """

    area: float
    area_gradient: Floats
    volume_gradient: Floats
    tangents: Floats
    normals: Floats
    elements: Floats


def _cross(a: Floats, b: Floats) -> Floats:
    """Cross product of vectors given by components (3, ...)."""
    return np.stack([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def _across(normals: Floats, local: Floats) -> Floats:
    """Products d_i . n (m, q, k) of normals (3, m, q) and directions (3, m, k)."""
    return np.asarray(np.matmul(normals.transpose(1, 2, 0), local.transpose(1, 0, 2)))


class Variation:
    """First and second variation on one mesh and one direction field.

    Arrays are held by component, so that each sum over integration points is one matrix product.

    Parameters
    ----------
    connectivity : Connectivity
    directions : (n, 3)
        Unit directions of the nodes.

    Attributes
    ----------
    volume_points : (q, 2)
        Local coordinates at which a mean curvature that varies is given.
    """

    def __init__(self, connectivity: Connectivity, directions: Floats) -> None:
        self.connectivity, self.directions = connectivity, directions
        basis = connectivity.basis
        p, k = basis.order, len(basis.nodes)
        points, self._weights = triangle_rule(2 * p)
        self._value, self._x, self._y = (basis.basis(points, *d) for d in ((0, 0), (1, 0), (0, 1)))
        # phi_i d_i . N is a polynomial of degree 3 p - 2: its rule is exact, so that the second variation is symmetric
        self.volume_points, self._volume_weights = triangle_rule(3 * p - 2 + p % 2)
        self._volume_basis = tuple(basis.basis(self.volume_points, *d) for d in ((0, 0), (1, 0), (0, 1)))
        self._local = np.ascontiguousarray(directions[connectivity.elements].transpose(2, 0, 1))  # (3, m, k)
        # pairs i > j below the diagonal, where d_i x d_j is; the packed triangle has the diagonal as well
        i, j = np.tril_indices(k)
        self._pairs = (i, j)
        self._below = np.flatnonzero(i > j)
        i, j = i[self._below], j[self._below]
        self._cross = _cross(self._local[:, :, i], self._local[:, :, j])  # (3, m, pairs)

        def antisymmetric(f: Floats, g: Floats) -> Floats:
            return np.asarray(f[:, i] * g[:, j] - f[:, j] * g[:, i])

        self._area_table = antisymmetric(self._x, self._y) * self._weights[:, None]
        n, x, y = self._volume_basis
        n = n * self._volume_weights[:, None] / 2
        self._volume_tables = (antisymmetric(n, x), antisymmetric(n, y))

    def _gather(self, parts: Floats) -> Floats:
        return np.bincount(
            self.connectivity.elements.ravel(), (parts * self._local).sum(0).ravel(), self.connectivity.node_count
        ).astype(np.float64)

    def _tangents(self, nodes: Floats, x: Floats, y: Floats) -> tuple[Floats, Floats]:
        corners = np.ascontiguousarray(nodes[self.connectivity.elements].transpose(2, 0, 1))
        return corners @ x.T, corners @ y.T

    def first(self, nodes: Floats) -> FirstVariation:
        """First variation at nodes (n, 3)."""
        a, b = self._tangents(nodes, self._x, self._y)
        normal = _cross(a, b)
        area = np.sqrt((normal**2).sum(0))
        normal /= area
        area_gradient = self._gather(
            (_cross(b, normal) * self._weights) @ self._x + (_cross(normal, a) * self._weights) @ self._y
        )
        value, x, y = self._volume_basis
        volume_gradient = self._gather((_cross(*self._tangents(nodes, x, y)) * self._volume_weights) @ value)
        return FirstVariation(
            float((area * self._weights).sum()), area_gradient, volume_gradient, np.stack([a, b]), normal, area
        )

    def weighted_sweep(self, nodes: Floats, values: Floats) -> Floats:
        """Integrals of values (m, q) at `volume_points` times phi_i d_i . N, at nodes (n, 3), (n,)."""
        value, x, y = self._volume_basis
        normal = _cross(*self._tangents(nodes, x, y))
        return self._gather((normal * (self._volume_weights * values)) @ value)

    def across(self, first: FirstVariation) -> Floats:
        """Cosines d_i . n of each element's directions and the normals at its integration points, (m, q, k)."""
        return _across(first.normals, self._local)

    def second(self, nodes: Floats, first: FirstVariation, mean_curvature: float | Floats) -> Floats:
        """Second variation of A + 2 H V at nodes (n, 3), as packed blocks (m, k (k + 1) / 2).

        H is one number, or is given at `volume_points`, (m, q), and held.

        With e_1 = a / |a|, e_2 = n x e_1 the part of dN_i across n is D_i (-phi_i,1 |N| / |a|) along e_1 and
        D_i (phi_i,1 b . e_1 - phi_i,2 |a|) along e_2, D_i = d_i . n.
        """
        m, k = len(self.connectivity.elements), self._local.shape[2]
        result = np.empty((m, k * (k + 1) // 2))
        for some in blocks(m, VARIATION_BLOCK):
            self._second_of(some, first, result[some])
        if np.any(mean_curvature):
            _, x, y = self._volume_basis
            a, b = self._tangents(nodes, x, y)
            if np.ndim(mean_curvature):
                a, b = a * mean_curvature, b * mean_curvature
            mixed = b @ self._volume_tables[0] - a @ self._volume_tables[1]
            mixed *= 2 if np.ndim(mean_curvature) else 2 * mean_curvature
            result[:, self._below] += (mixed * self._cross).sum(0)
        return result

    def _second_of(self, some: slice, first: FirstVariation, result: Floats) -> None:
        """The area's part in some elements."""
        a, b = first.tangents[:, :, some]
        area, normals = first.elements[some], first.normals[:, some]
        length = np.sqrt((a**2).sum(0))
        root = np.sqrt(self._weights / area)
        across = _across(normals, self._local[:, some])
        m, q, k = across.shape
        changes = np.empty((m, 2, q, k))
        np.multiply(across, (root * area / length)[..., None] * self._x, out=changes[:, 0])
        slope = (root * (a * b).sum(0) / length)[..., None] * self._x
        slope -= (root * length)[..., None] * self._y
        np.multiply(across, slope, out=changes[:, 1])
        flat = changes.reshape(m, 2 * q, k)
        result[:] = packed(np.matmul(flat.transpose(0, 2, 1), flat))
        result[:, self._below] += ((normals @ self._area_table) * self._cross[:, some]).sum(0)

    def mass(self, first: FirstVariation) -> Floats:
        """Integrals of phi_i phi_j (d_i . n) (d_j . n), packed blocks (m, k (k + 1) / 2), m^2."""
        across = self.across(first) * np.sqrt(first.elements * self._weights)[..., None] * self._value
        return packed(np.matmul(across.transpose(0, 2, 1), across))
