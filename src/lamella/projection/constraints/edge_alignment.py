"""Edges along given directions."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Self

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.projection.constraint import Constraint
from lamella.projection.foot_points import DirectedSurface
from lamella.projection.unknowns import Slot, Values, dot


@dataclass(frozen=True, kw_only=True)
class EdgeAlignment(Constraint):
    r"""An edge runs along one of the two principal directions (paper: 0 = d_1^T (v_i - v_j) d_2^T (v_i - v_j)).

    .. math:: (d_1 \cdot (v_i - v_j)) (d_2 \cdot (v_i - v_j)) / e^2 = 0

    d_1 and d_2 are those at the foot point of the edge's middle, constants between two iterations.

    ========== ========= ===========
    variable   symbol    count
    ========== ========= ===========
    vertices   v_i, v_j  3 each
    equations            1 an edge
    ========== ========= ===========

    Attributes
    ----------
    edges : (m, 2) int
    surface : DirectedSurface
    edge : float
        e, m.
    block : str
        Of the vertices.
    """

    edges: Integers
    surface: DirectedSurface
    edge: float
    block: str = "vertices"
    _first: Floats = field(default_factory=lambda: np.zeros((0, 3)), repr=False)
    _second: Floats = field(default_factory=lambda: np.zeros((0, 3)), repr=False)

    def slots(self) -> tuple[Slot, ...]:
        return Slot(self.block, self.edges[:, 0]), Slot(self.block, self.edges[:, 1])

    def refreshed(self, values: Values) -> Self:
        first, second = self.surface.principal_directions(values[self.block][self.edges].mean(1))
        return replace(self, _first=first, _second=second)

    def residual(self, *arguments: Floats) -> Floats:
        d = arguments[0] - arguments[1]
        return dot(self._first, d) * dot(self._second, d) / self.edge**2

    def jacobian(self, *arguments: Floats) -> tuple[Floats, ...]:
        d = arguments[0] - arguments[1]
        along, across = dot(self._first, d), dot(self._second, d)
        by_first = (across * self._first + along * self._second)[:, None] / self.edge**2
        return by_first, -by_first
