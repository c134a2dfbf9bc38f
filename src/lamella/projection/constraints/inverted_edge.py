"""Edges inverted at their ends: circles through a vertex become straight lines."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.projection.constraint import Constraint
from lamella.projection.unknowns import Slot, dot


@dataclass(frozen=True, kw_only=True)
class InvertedEdge(Constraint):
    r"""A vector q_ij is the edge over its squared length, q = e (v_j - v_i) / |v_j - v_i|^2.

    .. math:: q_{ij} \cdot (v_j - v_i) / e - 1 = 0, \qquad q_{ij} \times (v_j - v_i) / e = 0

    Inversion at v_i turns the circle through its previous and next neighbour into a straight line along the circle's
    tangent at v_i, and neighbours into v_i + q e: so q_1 - q_3 is the tangent of the vertex circle, and `RightAngle` or
    `NodeAngle` on these vectors is the angle at which vertex circles cross.

    ========== ========= ==========================
    variable   symbol    count
    ========== ========= ==========================
    vertices   v_i, v_j  3 each
    inverses   q_ij      3 an edge
    equations            4 an edge, of which 3 count
    ========== ========= ==========================

    Attributes
    ----------
    edges : (m, 2) int
        i and j; inverse k belongs to edge k. An edge may come from both its ends.
    edge : float
        e, m.
    vertices, inverses : str
        Names of the blocks.
    """

    edges: Integers
    edge: float
    vertices: str = "vertices"
    inverses: str = "inverse edges"

    def slots(self) -> tuple[Slot, ...]:
        i, j = self.edges.T
        return Slot(self.vertices, i), Slot(self.vertices, j), Slot(self.inverses, np.arange(len(self.edges)))

    def residual(self, *arguments: Floats) -> Floats:
        first, second, q = arguments
        d = (second - first) / self.edge
        return np.concatenate([dot(q, d) - 1, np.cross(q, d)], 1)

    def jacobian(self, *arguments: Floats) -> tuple[Floats, ...]:
        first, second, q = arguments
        d = (second - first) / self.edge
        by_second = np.concatenate([q[:, None], _cross_matrix(q)], 1) / self.edge
        return -by_second, by_second, np.concatenate([d[:, None], -_cross_matrix(d)], 1)


def inverses(vertices: Floats, edges: Integers, edge: float) -> Floats:
    """The vectors q of edges, (m, 3)."""
    d = vertices[edges[:, 1]] - vertices[edges[:, 0]]
    return np.asarray(edge * d / dot(d, d))


def _cross_matrix(vectors: Floats) -> Floats:
    """Matrices (m, 3, 3) that take x to vector x x."""
    x, y, z = vectors.T
    none = np.zeros_like(x)
    return np.stack([np.stack(r, 1) for r in ((none, -z, y), (z, none, -x), (-y, x, none))], 1)
