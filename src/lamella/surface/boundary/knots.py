"""Whether a closed curve is knotted: no disc without crossing itself spans a knot.

From a projection of the curve: at each crossing the arc above and the arcs to its left and right give one row of
Alexander's matrix, (1 - t, t, -1); any minor of order n - 1 is the knot's Alexander polynomial, times plus or minus a
power of t (J. W. Alexander, Topological invariants of knots and links, 1928). That of the unknot is 1, so that any
other value proves a knot. The matrix is taken at one t and modulo a prime, so that its minor is exact; that a
polynomial other than 1 has such a power of t for its value there has odds of one in millions. There are knots whose
polynomial is 1, from eleven crossings on: these are not found.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.surface.boundary.curve import Loop

KNOT_SAMPLES = 600
"""Points of the curve, besides its corners: more than any boundary's knot needs, whose strands keep apart."""

MOST_CROSSINGS = 400
"""Of a projection; the minor takes 0.2 s then."""

KNOT_BLOCK = 200
"""Edges of a polygon that are compared at once with all others, for memory."""

PRIME = 2**31 - 1
"""Two numbers below it have a product that 64 bits hold."""

AT = 1_103_515_245
"""The value of t."""

_VIEW = np.array([0.4, 0.3, 1.0])
"""Direction of the projection: nearly plan view, and along no axis that a drawing is parallel to."""


class Crossings(NamedTuple):
    """Crossings of a projection.

    Attributes
    ----------
    over, under : (c,)
        Parameters of the strand above and of the one below.
    from_left : (c,) bool
        Whether the strand below comes from the left of the one above.
    """

    over: Floats
    under: Floats
    from_left: Booleans


def is_knotted(loop: Loop) -> bool:
    """Whether the Alexander polynomial of the loop, from one projection of it, proves a knot."""
    # a strand may pass within a corner
    t = np.unique(np.concatenate([np.arange(KNOT_SAMPLES) / KNOT_SAMPLES, loop.corners[~loop.smooth]]))
    crossings = find_crossings(loop.at(t))
    count = len(crossings.over)
    if not 3 <= count <= MOST_CROSSINGS:
        return False
    power, value = 1, alexander(crossings)
    for _ in range(count):
        if value in (power, PRIME - power):
            return False
        power = power * AT % PRIME
    return True


def alexander(crossings: Crossings) -> int:
    """The Alexander polynomial at `AT` modulo `PRIME`, times plus or minus a power of `AT`.

    The exponent is below the number of crossings.
    """
    # arc k runs from the k-th passage below to the next one
    order = np.argsort(crossings.under)
    over, under, from_left = (part[order] for part in crossings)
    count = len(order)
    above = (np.searchsorted(under, over) - 1) % count
    rows = np.arange(count)
    before, after = (rows - 1) % count, rows
    matrix = np.zeros((count, count), np.int64)
    np.add.at(matrix, (rows, above), 1 - AT)
    np.add.at(matrix, (rows, np.where(from_left, before, after)), AT)
    np.add.at(matrix, (rows, np.where(from_left, after, before)), -1)
    return _determinant(matrix[:-1, :-1] % PRIME)


def _determinant(matrix: Integers) -> int:
    """Determinant of a matrix (n, n) modulo `PRIME`, by elimination; the matrix is overwritten."""
    value = 1
    for k in range(len(matrix)):
        found = np.flatnonzero(matrix[k:, k])
        if not len(found):
            return 0
        if found[0]:
            matrix[[k, k + found[0]]] = matrix[[k + found[0], k]]
            value = -value
        pivot = int(matrix[k, k])
        value = value * pivot % PRIME
        share = matrix[k + 1 :, k] * pow(pivot, -1, PRIME) % PRIME
        # most rows have a zero there
        some = np.flatnonzero(share)
        below = k + 1 + some
        matrix[below, k + 1 :] = (matrix[below, k + 1 :] - share[some, None] * matrix[k, k + 1 :]) % PRIME
    return value % PRIME


def find_crossings(points: Floats) -> Crossings:
    """Crossings of a closed polygon's projection, by parameters that count its points (n, 3)."""
    z = _VIEW / np.linalg.norm(_VIEW)
    x = np.cross([0.0, 1.0, 0.0], z)
    x /= np.linalg.norm(x)
    # x, y and the view are right-handed: left is left for who looks down
    plan, height = points @ np.stack([x, np.cross(z, x)], 1), points @ z
    n = len(points)
    step, rise = np.roll(plan, -1, 0) - plan, np.roll(height, -1) - height
    blocks = [_meetings(plan, step, first) for first in range(0, n, KNOT_BLOCK)]
    i, j, s, t, turn = (np.concatenate(parts) for parts in zip(*blocks, strict=True))
    first_above = height[i] + s * rise[i] > height[j] + t * rise[j]
    one, other = i + s, j + t
    # the strand below turns to the right of the one above
    from_left = (turn < 0) == first_above
    return Crossings(np.where(first_above, one, other), np.where(first_above, other, one), from_left)


def _meetings(plan: Floats, step: Floats, first: int) -> tuple[Integers, Integers, *tuple[Floats, ...]]:
    """Edges i of a block and later ones j that meet in plan, shares of them, and the product of their directions."""
    n = len(plan)
    i, j = np.triu_indices(min(KNOT_BLOCK, n - first), first + 2, n)
    i += first
    apart = plan[j] - plan[i]
    turn = step[i, 0] * step[j, 1] - step[i, 1] * step[j, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        s = (apart[:, 0] * step[j, 1] - apart[:, 1] * step[j, 0]) / turn
        t = (apart[:, 0] * step[i, 1] - apart[:, 1] * step[i, 0]) / turn
    # half open: a crossing at a point of the polygon belongs to one of its edges
    meet = (s >= 0) & (s < 1) & (t >= 0) & (t < 1) & ~((i == 0) & (j == n - 1))
    return i[meet], j[meet], s[meet], t[meet], turn[meet]
