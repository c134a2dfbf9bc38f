"""Whether a closed curve is knotted: no disc without crossing itself spans a knot.

From a projection of the curve: at each crossing the arc that goes over and the two arcs that go under give one row of
Fox's colouring matrix (2, -1, -1); any minor of order n - 1 is the knot's determinant, |Alexander polynomial at -1|.
It is 1 for the unknot, so that any other value proves a knot (R. H. Fox, A quick trip through knot theory, 1962). There
are knots of determinant 1, from ten crossings on: these are not told.
"""

from __future__ import annotations

import numpy as np

from lamella.surface.boundary.curve import Loop
from lamella.surface.boundary.pieces import Floats

SAMPLES = 600
"""Points of the curve: more than any boundary's knot needs, whose strands keep apart."""

MOST_CROSSINGS = 120
"""Of a projection; with more the determinant has no digits left."""

_VIEW = np.array([0.4, 0.3, 1.0])
"""Direction of the projection: nearly plan view, and along no axis that a drawing is parallel to."""


def is_knotted(loop: Loop) -> bool:
    """Whether the determinant of the loop, from one projection of it, proves a knot."""
    over, under = _crossings(loop.at(np.arange(SAMPLES) / SAMPLES))
    count = len(over)
    if not 3 <= count <= MOST_CROSSINGS:
        return False
    # arc k runs from the k-th passage below to the next one
    order = np.argsort(under)
    over, under = over[order], under[order]
    above = (np.searchsorted(under, over) - 1) % count
    matrix = np.zeros((count, count))
    rows = np.arange(count)
    np.add.at(matrix, (rows, above), 2)
    np.add.at(matrix, (rows, (rows - 1) % count), -1)
    np.add.at(matrix, (rows, rows), -1)
    _, size = np.linalg.slogdet(matrix[:-1, :-1])
    # a whole odd number
    return bool(size > np.log(2))


def _crossings(points: Floats) -> tuple[Floats, Floats]:
    """Parameters of the strand above and of the one below at each crossing of the projection, (c,) each."""
    z = _VIEW / np.linalg.norm(_VIEW)
    x = np.cross([0.0, 1.0, 0.0], z)
    x /= np.linalg.norm(x)
    plan, height = points @ np.stack([x, np.cross(z, x)], 1), points @ z
    n = len(points)
    step, rise = np.roll(plan, -1, 0) - plan, np.roll(height, -1) - height
    i, j = np.triu_indices(n, 2)
    apart = plan[j] - plan[i]
    turn = step[i, 0] * step[j, 1] - step[i, 1] * step[j, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        s = (apart[:, 0] * step[j, 1] - apart[:, 1] * step[j, 0]) / turn
        t = (apart[:, 0] * step[i, 1] - apart[:, 1] * step[i, 0]) / turn
    # half open: a crossing at a point of the polygon belongs to one of its edges
    meet = (s >= 0) & (s < 1) & (t >= 0) & (t < 1) & ~((i == 0) & (j == n - 1))
    i, j, s, t = i[meet], j[meet], s[meet], t[meet]
    first_above = height[i] + s * rise[i] > height[j] + t * rise[j]
    one, other = i + s, j + t
    return np.where(first_above, one, other), np.where(first_above, other, one)
