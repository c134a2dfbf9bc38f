"""A line found over flat triangles, drawn straight in the plane of w of the curved elements themselves.

Its ends on the rim go to where they are nearest to each other, and its places on the edges it passes to the straight
line between them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Complexes, Floats, Integers
from lamella.base.triangle import CORNERS
from lamella.network.isothermic.straight_walk import WALK_PARTS, FlatTriangles, cross, edges_of_element, share_of_edge
from lamella.surface.element.lagrange import EDGES, lagrange, local_faces

_AXES = np.array([CORNERS[b] - CORNERS[a] for a, b in EDGES])
# of a small edge: a line passes as far as this from its ends; of an element's edge on the rim
TIGHT_CLEAR, CLEAR_RIM = 0.01, 0.01
# steps of Newton's method, and how far one goes at most
TIGHT_NEWTON_STEPS, LONGEST_STEP = 12, 0.3
# of an element's edge: how far beyond it the end of a line is looked for
BEYOND_EDGE = 0.5


@dataclass(frozen=True)
class Passed:
    """Small edges that a line passes, as those of the triangles it leaves; one on a rim where it begins is the first.

    Attributes
    ----------
    triangle, edge : (n,) int
    share : (n,)
        Of the edge's length.
    sign, shift : (n,)
        w on the sheet where the line set out goes over into sign w + shift on the triangle's.
    """

    triangle: Integers
    edge: Integers
    share: Floats
    sign: Floats
    shift: Complexes


@dataclass(frozen=True)
class Course:
    """A straight line over elements, by the places where it passes edges of elements, and some between.

    Attributes
    ----------
    begin, end : int
        Boundary loop k as -1 - k, or the umbilic's vertex where the line begins.
    element : (n,) int
        That the line leaves there; the one that it enters at a rim where it begins.
    edge : (n,) int
        Its local edge; -1: inside.
    local : (n, 2)
        Local coordinates in the element.
    triangle : (k,) int
        Small triangles passed.
    """

    begin: int
    end: int
    element: Integers
    edge: Integers
    local: Floats
    triangle: Integers


@dataclass(frozen=True)
class Tight:
    """A line drawn straight.

    Attributes
    ----------
    course : Course
    first, last : float
        Where its ends belong on their elements' edges, as shares; below 0 or above 1: on the next element.
    goal : complex
        w where the last one belongs, on the sheet where the line sets out.
    """

    course: Course
    first: float
    last: float
    goal: complex


def tightened(flat: FlatTriangles, begin: int, end: int, passed: Passed, free: bool = True) -> Tight:
    """A line drawn straight.

    Parameters
    ----------
    flat : FlatTriangles
    begin, end : int
        See `Course`.
    passed : Passed
    free : bool
        Whether its ends on a rim go to where they are nearest to each other.
    """
    connectivity = flat.iso.mesh.connectivity
    small = lagrange(WALK_PARTS).nodes[local_faces(WALK_PARTS)]
    element, number = np.divmod(passed.triangle, len(small))
    one, other = small[number, passed.edge], small[number, (passed.edge + 1) % 3]
    edge = edges_of_element()[number, passed.edge]
    local = one + passed.share[:, None] * (other - one)

    def rim(index: int) -> tuple[np.polynomial.Polynomial, float]:
        nodes = connectivity.basis.edge_nodes[edge[index]]
        value = (flat.iso.value[element[index], nodes] - passed.shift[index]) * passed.sign[index]
        along = np.arange(len(nodes)) / (len(nodes) - 1)
        return np.polynomial.Polynomial(np.linalg.solve(np.vander(along, increasing=True), value)), share_of_edge(
            local[index], int(edge[index])
        )

    finish, last = rim(-1)
    if begin < 0:
        start, first = rim(0)
    else:
        origin = flat.w[passed.triangle[0], (passed.edge[0] + 2) % 3]
        start, first = np.polynomial.Polynomial([origin]), 0.5
    if free:
        first, last = _nearest_pair(start, finish, first, last)
    goal = complex(finish(last))
    clear = np.clip([first, last], CLEAR_RIM, 1 - CLEAR_RIM).tolist()
    ends = [complex(start(clear[0])), complex(finish(clear[1]))]
    inner = slice(1 if begin < 0 else 0, -1)
    share = passed.share.copy()
    share[inner] = _on_line(flat, passed, element, one, other, ends)[inner]
    local = one + share[:, None] * (other - one)
    for index, at in ((0, first), (-1, last)) if begin < 0 else ((-1, last),):
        local[index] = CORNERS[edge[index]] + np.clip(at, CLEAR_RIM, 1 - CLEAR_RIM) * _AXES[edge[index]]
    # a place inside that had to keep clear of the end of its small edge is not on the line
    kept = (edge >= 0) | ((share > TIGHT_CLEAR) & (share < 1 - TIGHT_CLEAR))
    return Tight(Course(begin, end, element[kept], edge[kept], local[kept], passed.triangle), first, last, goal)


def _nearest_pair(
    one: np.polynomial.Polynomial, other: np.polynomial.Polynomial, s: float, t: float
) -> tuple[float, float]:
    """Where two curves of the plane are nearest to each other, near given parameters; a constant one is a point."""
    curves = [(curve, curve.deriv(), curve.deriv(2)) for curve in (one, other)]
    at = np.array([s, t])
    begun = at.copy()
    for _ in range(TIGHT_NEWTON_STEPS):
        (a, a1, a2), (b, b1, b2) = (tuple(complex(c(x)) for c in curve) for curve, x in zip(curves, at, strict=True))
        apart = b - a
        slope = np.array([-(apart * a1.conjugate()).real, (apart * b1.conjugate()).real])
        mixed = -(a1 * b1.conjugate()).real
        bend = np.array(
            [
                [abs(a1) ** 2 - (apart * a2.conjugate()).real, mixed],
                [mixed, abs(b1) ** 2 + (apart * b2.conjugate()).real],
            ]
        )
        values, axes = np.linalg.eigh(bend)
        # downhill in any case; along what changes nothing not at all
        values = np.abs(values)
        there = values > 1e-9 * values.max()
        step = -axes[:, there] @ ((axes[:, there].T @ slope) / values[there])
        at = at + step * min(1.0, LONGEST_STEP / max(float(np.abs(step).max()), 1e-300))
        at = np.clip(at, -BEYOND_EDGE, 1 + BEYOND_EDGE)
    return (float(begun[0]) if one.degree() == 0 else float(at[0])), float(at[1])


def _on_line(
    flat: FlatTriangles, passed: Passed, element: Integers, one: Floats, other: Floats, ends: list[complex]
) -> Floats:
    """Shares (n,) of small edges at which they meet the straight line between two values of w where it sets out."""
    basis = flat.iso.mesh.connectivity.basis
    share = passed.share.copy()
    value = (flat.iso.value[element] - passed.shift[:, None]) * passed.sign[:, None]
    towards = np.asarray(ends[1] - ends[0])
    for _ in range(TIGHT_NEWTON_STEPS // 2):
        local = one + share[:, None] * (other - one)
        w, x, y = ((value * basis.basis(local, *d)).sum(1) for d in ((0, 0), (1, 0), (0, 1)))
        slope = cross(towards, x * (other - one)[:, 0] + y * (other - one)[:, 1])
        off = cross(towards, w - ends[0])
        step = np.where(slope == 0, 0.0, -off / np.where(slope == 0, 1.0, slope))
        share = np.clip(share + np.clip(step, -LONGEST_STEP, LONGEST_STEP), TIGHT_CLEAR, 1 - TIGHT_CLEAR)
    return share
