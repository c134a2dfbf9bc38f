"""Edges of given length."""

from __future__ import annotations

from dataclasses import dataclass

from lamella.base.arrays import Floats, Integers
from lamella.projection.constraint import Constraint
from lamella.projection.unknowns import Slot, dot


@dataclass(frozen=True, kw_only=True)
class EdgeLength(Constraint):
    r"""Two vertices have a given distance.

    .. math:: (|v_j - v_i|^2 - l_{ij}^2) / (2 l_{ij} e) = 0

    ========== ========= ===========
    variable   symbol    count
    ========== ========= ===========
    vertices   v_i, v_j  3 each
    equations            1 an edge
    ========== ========= ===========

    Attributes
    ----------
    edges : (m, 2) int
    lengths : (m,)
        l_ij, m.
    edge : float
        e, m: the residual is the error of the length in mean edges.
    block : str
        Of the vertices.
    """

    edges: Integers
    lengths: Floats
    edge: float
    block: str = "vertices"

    def slots(self) -> tuple[Slot, ...]:
        return Slot(self.block, self.edges[:, 0]), Slot(self.block, self.edges[:, 1])

    def residual(self, *arguments: Floats) -> Floats:
        first, second = arguments
        d, length = second - first, self.lengths[:, None]
        return (dot(d, d) - length**2) / (2 * length * self.edge)

    def jacobian(self, *arguments: Floats) -> tuple[Floats, ...]:
        first, second = arguments
        along = (second - first)[:, None] / (self.lengths * self.edge)[:, None, None]
        return -along, along
