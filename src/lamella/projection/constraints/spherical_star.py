"""Vertex stars on spheres of unknown radius."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.projection.constraint import Constraint
from lamella.projection.unknowns import Slot, dot


@dataclass(frozen=True, kw_only=True)
class SphericalStar(Constraint):
    r"""A vertex and its neighbours have one distance r from a centre (paper: 0 = |v_j - c_i|^2 - r_i^2).

    .. math:: (|v_j - c_i|^2 - r_i^2) / (2 R e) = 0

    The radius is an unknown, one for all stars or one for each; where it is given, `CurvedStar` says the same.

    ========== ============== =======================
    variable   symbol         count
    ========== ============== =======================
    vertices   v_i and v_j    3 each
    centres    c_i            3 a star
    radii      r_i            1, or 1 a star
    equations                 1 + neighbours, a star
    ========== ============== =======================

    Attributes
    ----------
    middles : (s,) int
        Vertices in the middle; centre i belongs to star i.
    neighbours : (s, j) int
    radius_of : (s,) int
        Which radius each star has: all 0 for a shared one.
    size, edge : float
        R, about the radius, and e, m: the residual is a distance from the sphere in edges.
    vertices, centres, radii : str
        Names of the blocks.
    """

    middles: Integers
    neighbours: Integers
    radius_of: Integers
    size: float
    edge: float
    vertices: str = "vertices"
    centres: str = "centres"
    radii: str = "radii"

    def slots(self) -> tuple[Slot, ...]:
        points = np.column_stack([self.middles, self.neighbours])
        count, each = points.shape
        return (
            Slot(self.vertices, points.ravel()),
            Slot(self.centres, np.repeat(np.arange(count), each)),
            Slot(self.radii, np.repeat(self.radius_of, each)),
        )

    def residual(self, *arguments: Floats) -> Floats:
        v, c, r = arguments
        arm = v - c
        return (dot(arm, arm) - r * r) / (2 * self.size * self.edge)

    def jacobian(self, *arguments: Floats) -> tuple[Floats, ...]:
        v, c, r = arguments
        arm = (v - c)[:, None] / (self.size * self.edge)
        return arm, -arm, -r[:, None] / (self.size * self.edge)
