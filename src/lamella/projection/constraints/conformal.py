"""Conformal parametrisations as packings of circles."""

from __future__ import annotations

from dataclasses import dataclass

from lamella.base.arrays import Floats, Integers
from lamella.projection.constraint import Constraint
from lamella.projection.unknowns import Slot, dot


@dataclass(frozen=True, kw_only=True)
class Conformal(Constraint):
    r"""Circles about neighbouring vertices touch (paper: 0 = |v_i - v_j|^2 - (l_i + l_j)^2).

    .. math:: (|v_i - v_j|^2 - (l_i + l_j)^2) / (2 e^2) = 0

    ========== ========= ==============
    variable   symbol    count
    ========== ========= ==============
    vertices   v_i, v_j  3 each
    circles    l_i, l_j  1 a vertex
    equations            1 an edge
    ========== ========= ==============

    Attributes
    ----------
    edges : (m, 2) int
    edge : float
        e, m: the residual is the gap of the circles in mean edges.
    vertices, circles : str
        Names of the blocks; circle i is about vertex i.
    """

    edges: Integers
    edge: float
    vertices: str = "vertices"
    circles: str = "circles"

    def slots(self) -> tuple[Slot, ...]:
        i, j = self.edges.T
        return Slot(self.vertices, i), Slot(self.vertices, j), Slot(self.circles, i), Slot(self.circles, j)

    def residual(self, *arguments: Floats) -> Floats:
        first, second, one, other = arguments
        d = first - second
        return (dot(d, d) - (one + other) ** 2) / (2 * self.edge**2)

    def jacobian(self, *arguments: Floats) -> tuple[Floats, ...]:
        first, second, one, other = arguments
        along = (first - second)[:, None] / self.edge**2
        both = -(one + other)[:, None] / self.edge**2
        return along, -along, both, both
