"""Right angles between the two polylines through a vertex."""

from __future__ import annotations

from dataclasses import dataclass

from lamella.base.arrays import Floats, Integers
from lamella.projection.constraint import Constraint
from lamella.projection.unknowns import Slot, dot


@dataclass(frozen=True, kw_only=True)
class RightAngle(Constraint):
    r"""The chords between opposite neighbours are perpendicular.

    .. math:: (x_1 - x_3) \cdot (x_2 - x_4) / (4 e^2) = 0

    On neighbouring vertices x = v_j the chords are the central differences of the two polylines: both sums of squares
    of opposite sides of the star's quadrangle are then equal. On the unit directions x = p_j of `LegDirections`, with
    e = 1/2 so that the residual is a cosine, it is the paper's sum of opposite angles, w1 + w3 = w2 + w4: with p_j at
    angle a_j the chords stand at (a_1 + a_3) / 2 and (a_2 + a_4) / 2 plus 90 degrees. On the vectors of `InvertedEdge`,
    with e = 1, it is the angle between the vertex circles.

    ========== ============ ===========
    variable   symbol       count
    ========== ============ ===========
    points     x_1 ... x_4  3 each
    equations               1 a star
    ========== ============ ===========

    Attributes
    ----------
    stars : (s, 4) int
        Points in counter-clockwise order.
    edge : float
        e, m.
    block : str
        Of the points.
    """

    stars: Integers
    edge: float
    block: str = "vertices"

    def slots(self) -> tuple[Slot, ...]:
        return tuple(Slot(self.block, self.stars[:, j]) for j in range(4))

    def residual(self, *arguments: Floats) -> Floats:
        p, q = chords(arguments)
        return dot(p, q) / (4 * self.edge**2)

    def jacobian(self, *arguments: Floats) -> tuple[Floats, ...]:
        p, q = (x[:, None] / (4 * self.edge**2) for x in chords(arguments))
        return q, p, -q, -p


def chords(points: tuple[Floats, ...]) -> tuple[Floats, Floats]:
    """x_1 - x_3 and x_2 - x_4, (s, 3) each."""
    x1, x2, x3, x4 = points
    return x1 - x3, x2 - x4
