"""Fair polylines."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.projection.constraint import Constraint
from lamella.projection.quad_mesh import QuadMesh
from lamella.projection.unknowns import Slot

SECOND, THIRD = np.array([1.0, -2.0, 1.0]), np.array([-1.0, 3.0, -3.0, 1.0])


@dataclass(frozen=True, kw_only=True)
class Fairness(Constraint):
    r"""Weighted sums of vertices vanish, component by component.

    .. math:: \sum_a w_a v_{i_a} / e = 0

    With w = (1, -2, 1) along polylines it is the paper's 2 v_ij = v_i-1,j + v_i+1,j, which pulls every net flat; third
    differences w = (-1, 3, -3, 1) leave curvature alone and only ask it to change slowly.

    ========== ========= ==================
    variable   symbol    count
    ========== ========= ==================
    vertices   v_i       3 each
    equations            3 a stencil
    ========== ========= ==================

    Attributes
    ----------
    stencils : (s, k) int
    coefficients : (k,)
    edge : float
        e, m.
    block : str
        Of the vertices.
    """

    linear: ClassVar[bool] = True

    stencils: Integers
    coefficients: Floats
    edge: float
    block: str = "vertices"
    hard: bool = False

    def slots(self) -> tuple[Slot, ...]:
        component = np.tile(np.arange(3), len(self.stencils))
        return tuple(Slot(self.block, np.repeat(vertex, 3), component) for vertex in self.stencils.T)

    def residual(self, *arguments: Floats) -> Floats:
        return np.asarray(sum(w * v for w, v in zip(self.coefficients, arguments, strict=True))) / self.edge

    def jacobian(self, *arguments: Floats) -> tuple[Floats, ...]:
        count = len(arguments[0])
        return tuple(np.full((count, 1, 1), w / self.edge) for w in self.coefficients)


def fairness(
    mesh: QuadMesh, order: int, *, weight: float, fade: float = 1.0, boundary: bool = True
) -> tuple[Fairness, ...]:
    """Fairness of a whole mesh.

    Differences along polylines through regular vertices and, if `boundary`, along the boundary; at vertices of other
    valence, where no polyline goes straight on, the vertex is the mean of its neighbours.

    Parameters
    ----------
    mesh : QuadMesh
    order : 2 or 3
        Of the differences.
    weight, fade : float
        See `Constraint`.
    boundary : bool
    """
    rim: Booleans = mesh.on_boundary
    runs = mesh.runs(order + 1)
    along_rim = rim[runs[:, 1:-1]].all(1)
    name = "second differences" if order == 2 else "third differences"
    edge = mesh.mean_edge
    found = [
        Fairness(
            name=name,
            stencils=runs[boundary | ~along_rim],
            coefficients=SECOND if order == 2 else THIRD,
            edge=edge,
            weight=weight,
            fade=fade,
        )
    ]
    for valence in np.unique(mesh.face_count[mesh.singular]):
        middle = mesh.singular[mesh.face_count[mesh.singular] == valence]
        found.append(
            Fairness(
                name=f"singular vertices of valence {valence}",
                stencils=np.column_stack([middle, mesh.stars(middle)]),
                coefficients=np.concatenate([[1.0], np.full(valence, -1 / valence)]),
                edge=edge,
                weight=weight,
                fade=fade,
            )
        )
    return tuple(found)
