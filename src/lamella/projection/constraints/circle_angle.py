"""Right angles between the vertex circles of both polylines through a vertex."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Self

import numpy as np

from lamella.projection.constraint import Constraint
from lamella.projection.unknowns import Floats, Integers, Slot, Values, dot


@dataclass(frozen=True, kw_only=True)
class CircleAngle(Constraint):
    r"""The circles through previous, own and next vertex cross at a right angle: `RightAngle` to the last digit.

    .. math::

        t_1 \cdot t_2 / (4 e^2) = 0, \qquad
        t_1 = s_1 (v_1 - v_i) - s_3 (v_3 - v_i), \quad t_2 = s_2 (v_2 - v_i) - s_4 (v_4 - v_i)

    With s_j = e^2 / |v_j - v_i|^2 the sums are the tangents of the circles at v_i: inversion at v_i turns a circle
    through it into a straight line along its tangent, and v_j - v_i into a multiple of s_j (v_j - v_i). The s_j are
    constants between two iterations; what a step misses by that is the angle of a leg to its circle, e kg / 2, times
    the change of its length, a small share of the error. Where legs are equally long it is `RightAngle`.

    ========== ================ ===========
    variable   symbol           count
    ========== ================ ===========
    vertices   v_i, v_1 ... v_4 3 each
    equations                   1 a star
    ========== ================ ===========

    Attributes
    ----------
    middles : (s,) int
    stars : (s, 4) int
        Neighbours in counter-clockwise order.
    edge : float
        e, m.
    block : str
        Of the vertices.
    """

    middles: Integers
    stars: Integers
    edge: float
    block: str = "vertices"
    _shares: Floats = field(default_factory=lambda: np.zeros((0, 4)), repr=False)

    def slots(self) -> tuple[Slot, ...]:
        return (Slot(self.block, self.middles), *(Slot(self.block, self.stars[:, j]) for j in range(4)))

    def refreshed(self, values: Values) -> Self:
        v = values[self.block]
        legs = v[self.stars] - v[self.middles][:, None]
        return replace(self, _shares=self.edge**2 / np.einsum("sjc,sjc->sj", legs, legs))

    def _tangents(self, arguments: tuple[Floats, ...]) -> tuple[Floats, Floats]:
        own, v1, v2, v3, v4 = arguments
        s1, s2, s3, s4 = self._shares.T[:, :, None]
        return s1 * (v1 - own) - s3 * (v3 - own), s2 * (v2 - own) - s4 * (v4 - own)

    def residual(self, *arguments: Floats) -> Floats:
        return dot(*self._tangents(arguments)) / (4 * self.edge**2)

    def jacobian(self, *arguments: Floats) -> tuple[Floats, ...]:
        t1, t2 = (t[:, None] / (4 * self.edge**2) for t in self._tangents(arguments))
        s1, s2, s3, s4 = self._shares.T[:, :, None, None]
        by_own = (s3 - s1) * t2 + (s4 - s2) * t1
        return by_own, s1 * t2, s2 * t1, -s3 * t2, -s4 * t1
