"""Unit vectors."""

from __future__ import annotations

from dataclasses import dataclass

from lamella.base.arrays import Floats, Integers
from lamella.projection.constraint import Constraint
from lamella.projection.unknowns import Slot, dot


@dataclass(frozen=True, kw_only=True)
class UnitLength(Constraint):
    """A vector has length 1 (paper: 1 = n^T n).

    .. math:: (n_j \\cdot n_j - 1) / 2 = 0

    ========== ======= =========
    variable   symbol  count
    ========== ======= =========
    vectors    n_j     3 an item
    equations          1 an item
    ========== ======= =========
    """

    block: str
    index: Integers

    def slots(self) -> tuple[Slot, ...]:
        return (Slot(self.block, self.index),)

    def residual(self, *arguments: Floats) -> Floats:
        (n,) = arguments
        return (dot(n, n) - 1) / 2

    def jacobian(self, *arguments: Floats) -> tuple[Floats, ...]:
        (n,) = arguments
        return (n[:, None],)
