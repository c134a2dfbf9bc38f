"""Vertices on a curve."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Self

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.projection.constraint import Constraint
from lamella.projection.curve_feet import FootCurve
from lamella.projection.unknowns import Slot, Values, dot


@dataclass(frozen=True, kw_only=True)
class Gliding(Constraint):
    r"""A vertex stays on a curve, free to slide along it.

    .. math:: (v_i - p_i - (t_i \cdot (v_i - p_i)) t_i) / e = 0

    p_i is the foot point of v_i and t_i the unit tangent there, constants between two iterations.

    ========== ======== ==============================
    variable   symbol   count
    ========== ======== ==============================
    vertices   v_i      3 each
    equations           3 a vertex, of which 2 count
    ========== ======== ==============================

    Attributes
    ----------
    index : (m,) int
        Vertices.
    curve : FootCurve
    edge : float
        e, m.
    block : str
        Of the vertices.
    """

    index: Integers
    curve: FootCurve
    edge: float
    block: str = "vertices"
    _foot: Floats = field(default_factory=lambda: np.zeros((0, 3)), repr=False)
    _tangent: Floats = field(default_factory=lambda: np.zeros((0, 3)), repr=False)

    def slots(self) -> tuple[Slot, ...]:
        return (Slot(self.block, self.index),)

    def refreshed(self, values: Values) -> Self:
        foot, tangent = self.curve.foot(values[self.block][self.index])
        return replace(self, _foot=foot, _tangent=tangent)

    def residual(self, *arguments: Floats) -> Floats:
        off = arguments[0] - self._foot
        return (off - dot(off, self._tangent) * self._tangent) / self.edge

    def jacobian(self, *arguments: Floats) -> tuple[Floats, ...]:
        return ((np.eye(3) - self._tangent[:, :, None] * self._tangent[:, None]) / self.edge,)
