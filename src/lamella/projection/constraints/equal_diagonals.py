"""Faces with diagonals of one length."""

from __future__ import annotations

from dataclasses import dataclass

from lamella.base.arrays import Floats, Integers
from lamella.projection.constraint import Constraint
from lamella.projection.unknowns import Slot, dot


@dataclass(frozen=True, kw_only=True)
class EqualDiagonals(Constraint):
    r"""Both diagonals of a quad are equally long: the lines between the middles of opposite sides are perpendicular.

    .. math:: (|v_3 - v_1|^2 - |v_4 - v_2|^2) / (4 e^2) = 0

    The residual is the cosine between those lines, over their lengths' product e^2: the right angle between the two
    families of polylines, measured in the faces instead of at the vertices.

    ========== ============ ===========
    variable   symbol       count
    ========== ============ ===========
    vertices   v_1 ... v_4  3 each
    equations               1 a face
    ========== ============ ===========

    Attributes
    ----------
    faces : (f, 4) int
        Corners in order.
    edge : float
        e, m.
    block : str
        Of the vertices.
    """

    faces: Integers
    edge: float
    block: str = "vertices"

    def slots(self) -> tuple[Slot, ...]:
        return tuple(Slot(self.block, self.faces[:, j]) for j in range(4))

    def residual(self, *arguments: Floats) -> Floats:
        v1, v2, v3, v4 = arguments
        a, b = v3 - v1, v4 - v2
        return (dot(a, a) - dot(b, b)) / (4 * self.edge**2)

    def jacobian(self, *arguments: Floats) -> tuple[Floats, ...]:
        v1, v2, v3, v4 = arguments
        by_a, by_b = ((x[:, None] / (2 * self.edge**2)) for x in (v3 - v1, v4 - v2))
        return -by_a, by_b, by_a, -by_b
