"""Directions of a star's legs, seen along its normal."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.projection.constraint import Constraint
from lamella.projection.unknowns import Slot, dot


@dataclass(frozen=True, kw_only=True)
class LegDirections(Constraint):
    r"""Unit directions p_j of the neighbours projected onto the tangent plane at the vertex (paper, Figure 5 right).

    .. math:: (v_j - v_i - h_j n_i) / e - s_j p_j = 0, \qquad p_j \cdot n_i = 0, \qquad (p_j \cdot p_j - 1) / 2 = 0

    `RightAngle` or `NodeAngle` on the directions is then the paper's condition on sums of opposite angles.

    ========== ========== ===============
    variable   symbol     count
    ========== ========== ===============
    vertices   v_i v_j    3 each
    normals    n_i        3 a star
    directions p_j        3 a leg
    reaches    s_j, h_j   2 a leg
    equations             5 a leg
    ========== ========== ===============

    Attributes
    ----------
    middles : (s,) int
        Vertices in the middle; normal i belongs to star i.
    neighbours : (s, j) int
        Direction and reach of leg j of star i have index i j_count + j.
    edge : float
        e, m.
    vertices, normals, directions, reaches : str
        Names of the blocks; a reach is (s_j in edges, h_j in m).
    """

    middles: Integers
    neighbours: Integers
    edge: float
    vertices: str = "vertices"
    normals: str = "normals"
    directions: str = "directions"
    reaches: str = "reaches"

    def slots(self) -> tuple[Slot, ...]:
        count, legs = self.neighbours.shape
        leg = np.arange(count * legs)
        return (
            Slot(self.vertices, np.repeat(self.middles, legs)),
            Slot(self.vertices, self.neighbours.ravel()),
            Slot(self.normals, np.repeat(np.arange(count), legs)),
            Slot(self.directions, leg),
            Slot(self.reaches, leg),
        )

    def residual(self, *arguments: Floats) -> Floats:
        middle, other, n, p, reach = arguments
        s, h = reach[:, :1], reach[:, 1:]
        level = dot(p, n)
        unit = (dot(p, p) - 1) / 2
        return np.concatenate([(other - middle - h * n) / self.edge - s * p, level, unit], 1)

    def jacobian(self, *arguments: Floats) -> tuple[Floats, ...]:
        _, _, n, p, reach = arguments
        count = len(n)
        s, h = reach[:, :1, None], reach[:, 1:, None]
        identity, none = np.eye(3)[None], np.zeros((count, 1, 3))
        by_other = np.concatenate([np.broadcast_to(identity / self.edge, (count, 3, 3)), none, none], 1)
        by_normal = np.concatenate([-h * identity / self.edge, p[:, None], none], 1)
        by_direction = np.concatenate([-s * identity, n[:, None], p[:, None]], 1)
        by_reach = np.zeros((count, 5, 2))
        by_reach[:, :3, 0], by_reach[:, :3, 1] = -p, -n / self.edge
        return -by_other, by_other, by_normal, by_direction, by_reach
