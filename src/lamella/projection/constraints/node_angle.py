"""A given angle between the two polylines through a vertex."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.projection.constraint import Constraint
from lamella.projection.constraints.right_angle import chords
from lamella.projection.unknowns import Slot, dot


@dataclass(frozen=True, kw_only=True)
class NodeAngle(Constraint):
    r"""The chords between opposite neighbours meet at the angle w; their lengths a, b are unknowns of their own.

    .. math::

        ((x_1 - x_3) \cdot (x_2 - x_4) - a b \cos w) / (4 e^2) = 0, \\
        (|x_1 - x_3|^2 - a^2) / (4 e^2) = 0, \qquad (|x_2 - x_4|^2 - b^2) / (4 e^2) = 0

    The points are those of `RightAngle`, which needs no lengths.

    ============= ============ ===========
    variable      symbol       count
    ============= ============ ===========
    points        x_1 ... x_4  3 each
    chord lengths a, b         2 a star
    equations                  3 a star
    ============= ============ ===========

    Attributes
    ----------
    stars : (s, 4) int
        Points in counter-clockwise order; the angle runs from x_3 x_1 to x_4 x_2.
    angle : float
        w, degrees.
    edge : float
        e, m.
    block, lengths : str
        Names of the points' block and of the chord lengths', (s, 2).
    """

    stars: Integers
    angle: float
    edge: float
    block: str = "vertices"
    lengths: str = "chords"

    def slots(self) -> tuple[Slot, ...]:
        points = tuple(Slot(self.block, self.stars[:, j]) for j in range(4))
        return (*points, Slot(self.lengths, np.arange(len(self.stars))))

    def residual(self, *arguments: Floats) -> Floats:
        *points, length = arguments
        p, q = chords(tuple(points))
        a, b = length[:, :1], length[:, 1:]
        met = dot(p, q) - np.cos(np.radians(self.angle)) * a * b
        return np.concatenate([met, dot(p, p) - a * a, dot(q, q) - b * b], 1) / (4 * self.edge**2)

    def jacobian(self, *arguments: Floats) -> tuple[Floats, ...]:
        *points, length = arguments
        p, q = chords(tuple(points))
        a, b = length.T
        cosine = np.cos(np.radians(self.angle))
        none = np.zeros_like(p)
        by_p = np.stack([q, 2 * p, none], 1) / (4 * self.edge**2)
        by_q = np.stack([p, none, 2 * q], 1) / (4 * self.edge**2)
        zero = np.zeros_like(a)
        by_length = [np.stack(row, 1) for row in ((-cosine * b, -cosine * a), (-2 * a, zero), (zero, -2 * b))]
        return by_p, by_q, -by_p, -by_q, np.stack(by_length, 1) / (4 * self.edge**2)
