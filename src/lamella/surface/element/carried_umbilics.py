"""Umbilics of a surface that has changed a little, from where they were among its elements."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.vectors import lengths
from lamella.surface.element.inverse_map import find_places
from lamella.surface.element.places import Places
from lamella.surface.element.surface import ElementSurface
from lamella.surface.element.umbilics import Umbilics, turned_deviators

# of an element: over which the deviator is differentiated
SLOPE_STEP = 1e-5


def carried_umbilics(surface: ElementSurface, before: Umbilics, inside: Booleans) -> Umbilics | None:
    """The umbilics of a surface of the same elements, in the same order; None: they are not the same ones.

    Parameters
    ----------
    surface : ElementSurface
    before : Umbilics
        Those of a surface near by.
    inside : (z,) bool
        Which matter; others may stay where they were.
    """
    if (before.orders[inside] == 1).all():
        places, found = _zeros_near(surface, before.places)
        if not found[inside].all():
            return None
    else:
        # errors split zeros of higher order: they are found by their turns alone
        there = surface.umbilics
        which = _matched(before, there, inside)
        if which is None:
            return None
        places = Places(before.places.element.copy(), before.places.local.copy())
        places.element[inside], places.local[inside] = there.places.element[which], there.places.local[which]
    return replace(before, places=places, position=surface.frames(places).position)


def _zeros_near(surface: ElementSurface, start: Places) -> tuple[Places, Booleans]:
    """Zeros of the deviator by Newton's method, and which were found."""
    if not len(start):
        return start, np.zeros(0, bool)
    ahead = SLOPE_STEP * np.array([[[0.0, 0.0]], [[1.0, 0.0]], [[0.0, 1.0]]])

    def deviators(where: Places) -> Floats:
        axes = np.tile(surface.frames(where).e_u, (3, 1))
        every = Places(np.tile(where.element, 3), (where.local + ahead).reshape(-1, 2))
        value = turned_deviators(surface.at(every), axes).reshape(3, -1)
        value[1:] = (value[1:] - value[0]) / SLOPE_STEP
        return np.stack([value.real, value.imag], 1)

    target = np.zeros((2, len(start)))
    return find_places(surface.connectivity, deviators, start, target, lambda *_: None)


def _matched(before: Umbilics, there: Umbilics, inside: Booleans) -> Integers | None:
    """Which of the umbilics there each of those inside before is; None: other ones, or of other orders."""
    wanted = np.flatnonzero(inside)
    if not len(there.orders):
        return None
    near = np.array([int(lengths(there.position - before.position[number]).argmin()) for number in wanted])
    alike = len(set(near.tolist())) == len(wanted) and (there.orders[near] == before.orders[wanted]).all()
    return near if alike else None
