"""Vertex stars on spheres of given curvature, planes among them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.projection.constraint import Constraint
from lamella.projection.unknowns import Slot, dot


@dataclass(frozen=True, kw_only=True)
class CurvedStar(Constraint):
    r"""A vertex and its neighbours lie on a sphere of curvature k = 1 / r; k = 0 is a plane. With `UnitLength`.

    .. math:: (n_i \cdot (v_j - v_i) - \tfrac{k}{2} |v_j - v_i|^2) / e = 0

    With the centre c_i = v_i + n_i / k this is the paper's |v_j - c_i|^2 = r^2 while n_i has length 1, which is its
    |v_i - c_i|^2 = r^2. Written from the vertex it has a limit for k -> 0 and loses no digits on the way there.

    ============== ======= ==================
    variable       symbol  count
    ============== ======= ==================
    vertices       v_i v_j 3 each
    vertex normals n_i     3 a star
    equations              1 a neighbour
    ============== ======= ==================

    Attributes
    ----------
    centres : (s,) int
        Vertices in the middle; normal i belongs to star i and points to the centre of the sphere where k > 0.
    neighbours : (s, j) int
    curvature : float
        k, 1/m.
    edge : float
        e, m.
    vertices, normals : str
        Names of the blocks.
    """

    centres: Integers
    neighbours: Integers
    curvature: float
    edge: float
    vertices: str = "vertices"
    normals: str = "normals"

    def slots(self) -> tuple[Slot, ...]:
        count, legs = self.neighbours.shape
        return (
            Slot(self.normals, np.repeat(np.arange(count), legs)),
            Slot(self.vertices, np.repeat(self.centres, legs)),
            Slot(self.vertices, self.neighbours.ravel()),
        )

    def residual(self, *arguments: Floats) -> Floats:
        n, middle, other = arguments
        leg = other - middle
        return dot(n - self.curvature / 2 * leg, leg) / self.edge

    def jacobian(self, *arguments: Floats) -> tuple[Floats, ...]:
        n, middle, other = arguments
        leg = other - middle
        by_other = (n - self.curvature * leg)[:, None] / self.edge
        return leg[:, None] / self.edge, -by_other, by_other
