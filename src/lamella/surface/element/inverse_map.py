"""Places of elements where two polynomials have given values: Newton's method that goes on from element to element."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.surface.element.connectivity import Connectivity
from lamella.surface.element.places import Places

Jet = Callable[[Places], Floats]
# Is told which targets go over which edges of which elements, and may change these targets.
Cross = Callable[[Integers, Integers, Integers], None]

INVERSE_STEPS_MAX, INVERSE_HOPS_MAX = 40, 20
# of the wanted values; nearer is there
INVERSE_TOLERANCE = 1e-12
# local coordinates: the step after one as small as this is rounding, since the steps' sizes are squared
INVERSE_LAST_STEP = 1e-6
# local coordinates; a place this far beyond an edge is on it
ON_EDGE = 1e-6
# values this near are there as well when the steps have run out
INVERSE_ACCEPTED = 1e-9


def find_places(
    connectivity: Connectivity, jet: Jet, start: Places, target: Floats, cross: Cross, beyond_rim: float = ON_EDGE
) -> tuple[Places, Booleans]:
    """Places near given ones where the polynomials have their targets.

    Parameters
    ----------
    connectivity : Connectivity
    jet : callable
        Values and derivatives by both local coordinates at places, (3, 2, n), as `Polynomials.jet`.
    start : Places
        Where to begin.
    target : (2, n)
        Wanted values; `cross` may change them.
    cross : callable
        Is called with targets (k,), elements and local edges, before the search goes on beyond these edges.
    beyond_rim : float
        Local coordinates; as far beyond an edge of the rim a place still counts, on the element's own polynomials.

    Returns
    -------
    places : Places
    found : (n,) bool
        Whether the place was reached; else it is the starting one.
    """
    count = len(start)
    result, found = Places(start.element.copy(), start.local.copy()), np.zeros(count, bool)
    # those not yet found, one column each
    active, hops = np.arange(count), np.zeros(count, np.int64)
    element, local = start.element.copy(), np.array(start.local.T)

    def settle(index: Integers, at: Integers, place: Floats) -> None:
        barycentric = np.stack([1 - place[0] - place[1], *place])
        # the edge opposite a corner begins at the next one
        rim = connectivity.neighbours.take(at, 0).T[[1, 2, 0]] < 0
        inside = (barycentric > np.where(rim, -beyond_rim, -ON_EDGE)).all(0)
        if not inside.all():
            index, at, place = index[inside], at[inside], place[:, inside]
        found[index], result.element[index], result.local[index] = True, at, place.T

    for _ in range(INVERSE_STEPS_MAX):
        value, by_x, by_y = jet(Places(element, local.T))
        residual = target.take(active, 1) - value
        there = np.maximum(np.abs(residual[0]), np.abs(residual[1])) < INVERSE_TOLERANCE
        determinant = by_x[0] * by_y[1] - by_x[1] * by_y[0]
        step = np.stack([residual[0] * by_y[1] - residual[1] * by_y[0], by_x[0] * residual[1] - by_x[1] * residual[0]])
        step /= np.where(np.abs(determinant) < 1e-300, 1.0, determinant)
        size = np.maximum(np.abs(step[0]), np.abs(step[1]))
        step *= np.where(there, 0.0, np.minimum(1, 0.5 / np.maximum(size, 1e-300)))
        moved = local + step
        third = 1 - moved[0] - moved[1]
        done = there | (size < INVERSE_LAST_STEP)
        local = np.minimum(np.maximum(moved, -0.3), 1.3)
        # beyond an edge by more than rounding: go on in the neighbour
        beyond = np.flatnonzero((np.minimum(np.minimum(moved[0], moved[1]), third) < -1e-9) & ~there)
        if len(beyond):
            barycentric = np.stack([third[beyond], *moved[:, beyond]])
            # a place beyond the rim may be beyond the edge next to it as well
            there_is = connectivity.neighbours.take(element[beyond], 0).T[[1, 2, 0]] >= 0
            depth = np.where(there_is, barycentric, np.inf)
            edge = (depth.argmin(0) + 1) % 3
            goes = (depth.min(0) < -1e-9) & (hops[active[beyond]] < INVERSE_HOPS_MAX)
            beyond, edge, barycentric = beyond[goes], edge[goes], barycentric[:, goes]
            cross(active[beyond], element[beyond], edge)
            element[beyond], local[:, beyond] = _entered(connectivity, element[beyond], edge, barycentric)
            hops[active[beyond]] += 1
            done[beyond] = False
        settled, left = np.flatnonzero(done), np.flatnonzero(~done)
        settle(active[settled], element[settled], local.take(settled, 1))
        active, element, local = active[left], element[left], local.take(left, 1)
        if not len(active):
            return result, found
    near = (np.abs(target[:, active] - jet(Places(element, local.T))[0]) < INVERSE_ACCEPTED).all(0)
    settle(active[near], element[near], local[:, near])
    return result, found


def _entered(
    connectivity: Connectivity, element: Integers, edge: Integers, barycentric: Floats
) -> tuple[Integers, Floats]:
    """The neighbours across edges, and the local coordinates (2, n) there of the nearest places of the edges."""
    rows = np.arange(len(element))
    other = connectivity.neighbour_edges[element, edge]
    share = np.clip(barycentric[(edge + 1) % 3, rows], 0, 1)
    entered = np.zeros((3, len(element)))
    entered[other, rows], entered[(other + 1) % 3, rows] = share, 1 - share
    return connectivity.neighbours[element, edge], entered[1:]
