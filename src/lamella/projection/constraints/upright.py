"""Faces that stand upright on a surface."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Self

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.projection.constraint import Constraint
from lamella.projection.foot_points import FootSurface
from lamella.projection.unknowns import Slot, Values, dot


@dataclass(frozen=True, kw_only=True)
class Upright(Constraint):
    r"""The plane of a face holds the surface normal at one of its edges: the strip is orthogonal to the surface.

    .. math:: n_j \cdot m_j = 0

    m_j is the unit normal at the foot point of the edge's middle, a constant between two iterations.

    ============ ======== ===========
    variable     symbol   count
    ============ ======== ===========
    face normals n_j      3 a face
    equations             1 a face
    ============ ======== ===========

    Attributes
    ----------
    edges : (f, 2) int
        Of each face, on the surface; normal j belongs to face j.
    surface : FootSurface
    vertices, normals : str
        Names of the blocks.
    """

    edges: Integers
    surface: FootSurface
    vertices: str = "vertices"
    normals: str = "face normals"
    _normal: Floats = field(default_factory=lambda: np.zeros((0, 3)), repr=False)

    def slots(self) -> tuple[Slot, ...]:
        return (Slot(self.normals, np.arange(len(self.edges))),)

    def refreshed(self, values: Values) -> Self:
        return replace(self, _normal=self.surface.foot(values[self.vertices][self.edges].mean(1)).normal)

    def residual(self, *arguments: Floats) -> Floats:
        return dot(arguments[0], self._normal)

    def jacobian(self, *arguments: Floats) -> tuple[Floats, ...]:
        return (self._normal[:, None],)
