"""Vertices on a surface or on its parallel surface."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Self

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.projection.constraint import Constraint
from lamella.projection.foot_points import FootSurface
from lamella.projection.unknowns import Slot, Values, dot


@dataclass(frozen=True, kw_only=True)
class Closeness(Constraint):
    r"""A vertex stays on a surface, free to slide (paper: 0 = (m_i^T (v_i - p_i))^2 + eps |v_i - p_i|^2).

    .. math:: (m_i \cdot (v_i - p_i) - h) / e = 0, \qquad \sqrt\varepsilon (v_i - p_i - h m_i) / e = 0

    The sum of squares of these is the paper's term. p_i is the foot point of v_i and m_i the normal there, constants
    between two iterations. With h the vertex stays on the parallel surface at that distance: the upper border of a
    strip of constant width, whose lower border stays on the surface itself.

    ========== ======== ===========
    variable   symbol   count
    ========== ======== ===========
    vertices   v_i      3 each
    equations           4 a vertex
    ========== ======== ===========

    Attributes
    ----------
    index : (m,) int
        Vertices.
    surface : FootSurface
    edge : float
        e, m.
    offset : float
        h, m, on the side of the surface's normal.
    epsilon : float
        How much sliding costs; 0: nothing.
    block : str
        Of the vertices.
    """

    index: Integers
    surface: FootSurface
    edge: float
    offset: float = 0.0
    epsilon: float = 0.0
    block: str = "vertices"
    _foot: Floats = field(default_factory=lambda: np.zeros((0, 3)), repr=False)
    _normal: Floats = field(default_factory=lambda: np.zeros((0, 3)), repr=False)

    def slots(self) -> tuple[Slot, ...]:
        return (Slot(self.block, self.index),)

    def refreshed(self, values: Values) -> Self:
        foot = self.surface.foot(values[self.block][self.index])
        return replace(self, _foot=foot.position, _normal=foot.normal)

    def residual(self, *arguments: Floats) -> Floats:
        off = arguments[0] - self._foot - self.offset * self._normal
        return np.concatenate([dot(self._normal, off), np.sqrt(self.epsilon) * off], 1) / self.edge

    def jacobian(self, *arguments: Floats) -> tuple[Floats, ...]:
        slide = np.broadcast_to(np.sqrt(self.epsilon) * np.eye(3), (len(self.index), 3, 3))
        return (np.concatenate([self._normal[:, None], slide], 1) / self.edge,)
