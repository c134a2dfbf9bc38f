"""Vertices at given points."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.projection.constraint import Constraint
from lamella.projection.unknowns import Slot


@dataclass(frozen=True, kw_only=True)
class Fixed(Constraint):
    r"""A vertex is at a point: where it was (supports), or where it is driven to.

    .. math:: (v_i - p_i) / e = 0

    ========== ======== ===========
    variable   symbol   count
    ========== ======== ===========
    vertices   v_i      3 each
    equations           3 a vertex
    ========== ======== ===========

    Attributes
    ----------
    index : (m,) int
        Vertices.
    points : (m, 3)
        p_i, m.
    edge : float
        e, m.
    block : str
        Of the vertices.
    """

    linear: ClassVar[bool] = True

    index: Integers
    points: Floats
    edge: float
    block: str = "vertices"

    def slots(self) -> tuple[Slot, ...]:
        return (Slot(self.block, self.index),)

    def residual(self, *arguments: Floats) -> Floats:
        return (arguments[0] - self.points) / self.edge

    def jacobian(self, *arguments: Floats) -> tuple[Floats, ...]:
        return (np.broadcast_to(np.eye(3) / self.edge, (len(self.index), 3, 3)),)
