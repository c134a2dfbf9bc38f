"""Whole numbers of cells for the pieces of a cut, such that a net can go on across all of them.

Where pieces of the cut meet in an ordinary point of the surface, going around it changes nothing: the shifts of these
pieces depend on each other. Those at the ends of the cut can be chosen, and the rest follows with them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lamella.network.holonomy import tip_vertices, vertex_relations
from lamella.network.isothermic import Isothermic
from lamella.surface.points import Complexes

Integers = NDArray[np.int64]


def nearest_whole(iso: Isothermic, shifts: Complexes, *, singular_nodes: bool) -> Complexes:
    """Whole shifts near to the given ones that do not contradict each other.

    Parameters
    ----------
    iso : Isothermic
        Its transitions say how the pieces hang together.
    shifts : (t,) complex
        Of the pieces, in cells; a lattice point is at 0.
    singular_nodes : bool
        Put umbilics where the cut ends on nodes of the lattice: their shifts, twice their places, are even then.

    Returns
    -------
    (t,) complex
    """
    tips = [tip_vertices(iso.mesh, piece) for piece in iso.transitions]
    relations = vertex_relations(iso.mesh, iso.transitions, iso.across, iso.odd)
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
