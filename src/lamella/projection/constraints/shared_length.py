"""Vectors of one length, which is to be found."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.projection.constraint import Constraint
from lamella.projection.unknowns import Slot, dot


@dataclass(frozen=True, kw_only=True)
class SharedLength(Constraint):
    r"""Vectors have one length, an unknown: `UnitLength` with a free right side.

    .. math:: (n_j \cdot n_j - l^2) / 2 = 0

    With `CurvedStar` of curvature k these are stars on spheres of one free radius r = l / k: the centre is
    v_i + n_i / k, and |v_i - c_i|^2 = r^2 for all. `SphericalStar` says the same with the centres as unknowns, whose
    distance from the vertices loses digits where r is many edges.

    ========== ======= =========
    variable   symbol  count
    ========== ======= =========
    vectors    n_j     3 an item
    length     l       1
    equations          1 an item
    ========== ======= =========

    Attributes
    ----------
    block, length : str
        Names of the blocks of the vectors, and of the length.
    index : (m,) int
        Vectors.
    """

    block: str
    length: str
    index: Integers

    def slots(self) -> tuple[Slot, ...]:
        return Slot(self.block, self.index), Slot(self.length, np.zeros(len(self.index), np.int64))

    def residual(self, *arguments: Floats) -> Floats:
        n, length = arguments
        return (dot(n, n) - length**2) / 2

    def jacobian(self, *arguments: Floats) -> tuple[Floats, ...]:
        n, length = arguments
        return n[:, None], -length[:, None]
