"""Vertices in a plane."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.projection.constraint import Constraint
from lamella.projection.unknowns import Slot


@dataclass(frozen=True, kw_only=True)
class InPlane(Constraint):
    r"""A vertex stays in a plane, free to slide: the ground, or a plane of symmetry.

    .. math:: (m \cdot v_i - d) / e = 0

    ========== ======== ===========
    variable   symbol   count
    ========== ======== ===========
    vertices   v_i      3 each
    equations           1 a vertex
    ========== ======== ===========

    Attributes
    ----------
    index : (m,) int
        Vertices.
    normal : (3,)
        Unit vector m.
    distance : float
        d, m, of the plane from the origin.
    edge : float
        e, m.
    block : str
        Of the vertices.
    """

    linear: ClassVar[bool] = True

    index: Integers
    normal: Floats
    distance: float
    edge: float
    block: str = "vertices"

    def slots(self) -> tuple[Slot, ...]:
        return (Slot(self.block, self.index),)

    def residual(self, *arguments: Floats) -> Floats:
        return (arguments[0] @ self.normal - self.distance)[:, None] / self.edge

    def jacobian(self, *arguments: Floats) -> tuple[Floats, ...]:
        return (np.broadcast_to(self.normal / self.edge, (len(self.index), 1, 3)),)
