"""Whole numbers of cells for the pieces of a cut, such that a net can go on across all of them.

Where pieces of the cut meet in an ordinary point of the surface, going around it changes nothing: the shifts of these
pieces depend on each other. Those at the ends of the cut can be chosen, and the rest follows with them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lamella.network.holonomy import tip_vertices
from lamella.network.isothermic import Isothermic
from lamella.surface.element.connectivity import Connectivity
from lamella.surface.points import Complexes

Integers = NDArray[np.int64]


def nearest_whole(iso: Isothermic, signs: Integers, shifts: Complexes, *, singular_nodes: bool) -> Complexes:
    """Whole shifts near to the given ones that do not contradict each other.

    Parameters
    ----------
    iso : Isothermic
        Its transitions say how the pieces hang together.
    signs, shifts : (t,)
        Of the pieces, in cells; a lattice point is at 0.
    singular_nodes : bool
        Put umbilics where the cut ends on nodes of the lattice: their shifts, twice their places, are even then.

    Returns
    -------
    (t,) complex
    """
    tips = [tip_vertices(iso.mesh, piece) for piece in iso.transitions]
    relations = _relations(iso, signs, tips)
    count = np.bincount(np.array(tips, np.int64).ravel(), minlength=1) if tips else np.zeros(1, np.int64)
    step = np.ones(len(tips))
    if singular_nodes:
        alone = [(a in iso.odd and count[a] == 1) or (b in iso.odd and count[b] == 1) for a, b in tips]
        step[alone] = 2
    free: Complexes = np.asarray(
        step * np.round(shifts.real / step) + 1j * step * np.round(shifts.imag / step), np.complex128
    )
    result = free.copy()
    for group in _groups(tips, relations):
        # what follows from the others had better be at the rim: umbilics stay on nodes
        at_rim = [piece for piece in group if (iso.mesh.loop[list(tips[piece])] >= 0).any()]
        ways = [_settled(piece, group, tips, relations, free) for piece in at_rim or group]
        result[group] = min(
            (way for way in ways if way is not None), key=lambda way: float(np.abs(way - shifts[group]).max())
        )
    return result


def _groups(tips: list[tuple[int, int]], relations: dict[int, Integers]) -> list[list[int]]:
    """Pieces that hang together by ordinary vertices."""
    left = set(range(len(tips)))
    result = []
    while left:
        group, stack = [], [min(left)]
        left.discard(stack[0])
        while stack:
            piece = stack.pop()
            group.append(piece)
            for vertex in tips[piece]:
                for other in np.flatnonzero(relations[vertex]).tolist() if vertex in relations else []:
                    if other in left:
                        left.discard(other)
                        stack.append(other)
        if len(group) > 1:
            result.append(sorted(group))
    return result


def _relations(iso: Isothermic, signs: Integers, tips: list[tuple[int, int]]) -> dict[int, Integers]:
    """For each ordinary vertex where pieces meet: whole factors (t,) whose sum with the shifts is 0."""
    mesh = iso.mesh
    ends: dict[int, list[tuple[int, bool]]] = {}
    for number, (first, last) in enumerate(tips):
        ends.setdefault(first, []).append((number, True))
        ends.setdefault(last, []).append((number, False))
    odd = set(iso.odd.tolist())
    result = {}
    for vertex, meeting in ends.items():
        if vertex in odd or mesh.loop[vertex] >= 0 or len(meeting) < 2:
            continue
        sign, factors = 1, np.zeros(len(tips), np.int64)
        for number, leaves in _around(mesh.connectivity, iso.across, vertex):
            s = int(signs[number])
            # a piece that leaves the vertex is crossed from its right side to its left
            if leaves:
                factors = s * factors
                factors[number] -= s
            else:
                factors = s * factors
                factors[number] += 1
            sign *= s
        if sign != 1:
            raise ValueError("the signs around an ordinary vertex of the cut do not agree")
        result[vertex] = factors
    return result


def _around(connectivity: Connectivity, across: Integers, vertex: int) -> list[tuple[int, bool]]:
    """Pieces crossed once around a vertex counter-clockwise, each with whether it leaves the vertex."""
    element, corner = (int(part[0]) for part in np.nonzero(connectivity.faces == vertex))
    first = element
    passed = []
    while True:
        # out of the triangle over the edge that ends in the vertex: counter-clockwise around it
        edge = (corner + 2) % 3
        through = int(across[element, edge])
        if through:
            # over a transition from its left to its right: the piece leads to the vertex
            passed.append((abs(through) - 1, through < 0))
        element, other = (
            int(connectivity.neighbours[element, edge]),
            int(connectivity.neighbour_edges[element, edge]),
        )
        corner = other
        if element == first:
            return passed


def _settled(
    root: int, group: list[int], tips: list[tuple[int, int]], relations: dict[int, Integers], free: Complexes
) -> Complexes | None:
    """Shifts of a group when those on the way to one of its ends follow from the others; none: it has no end."""
    ends = [tip for tip in tips[root] if tip not in relations]
    if not ends:
        return None
    result = free.copy()
    order: list[tuple[int, int]] = []
    stack = [(root, tips[root][1] if tips[root][0] == ends[0] else tips[root][0])]
    seen = {root}
    while stack:
        piece, vertex = stack.pop()
        if vertex not in relations:
            continue
        order.append((piece, vertex))
        for number in np.flatnonzero(relations[vertex]).tolist():
            if number not in seen:
                seen.add(number)
                stack.append((number, tips[number][1] if tips[number][0] == vertex else tips[number][0]))
    for piece, vertex in reversed(order):
        factors = relations[vertex]
        rest = (factors * result).sum() - factors[piece] * result[piece]
        result[piece] = -rest / factors[piece]
    return np.asarray(result[group])
