"""Planar faces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.projection.constraint import Constraint
from lamella.projection.unknowns import Slot, dot


@dataclass(frozen=True, kw_only=True)
class PlanarFace(Constraint):
    r"""A normal is perpendicular to all edges of its face (paper: 0 = n_j^T (v_i2 - v_i1)); with `UnitLength`.

    .. math:: n_j \cdot (v_{i_2} - v_{i_1}) / e = 0

    ============ ========== ==================
    variable     symbol     count
    ============ ========== ==================
    vertices     v_i1, v_i2 3 each
    face normals n_j        3 a face
    equations               1 an edge of a face
    ============ ========== ==================

    Attributes
    ----------
    faces : (f, k) int
        Corners in order.
    edge : float
        e, m.
    vertices, normals : str
        Names of the blocks; normal j belongs to face j.
    """

    faces: Integers
    edge: float
    vertices: str = "vertices"
    normals: str = "face normals"

    def slots(self) -> tuple[Slot, ...]:
        count, corners = self.faces.shape
        return (
            Slot(self.normals, np.repeat(np.arange(count), corners)),
            Slot(self.vertices, self.faces.ravel()),
            Slot(self.vertices, np.roll(self.faces, -1, axis=1).ravel()),
        )

    def residual(self, *arguments: Floats) -> Floats:
        n, first, second = arguments
        return dot(n, second - first) / self.edge

    def jacobian(self, *arguments: Floats) -> tuple[Floats, ...]:
        n, first, second = arguments
        along = n[:, None] / self.edge
        return (second - first)[:, None] / self.edge, -along, along
