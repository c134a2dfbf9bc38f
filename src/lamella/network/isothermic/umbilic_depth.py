"""How near umbilics are to the rim, and how that changes with the surface.

An umbilic is a zero of the deviator D. Where D changes by d at a place of the surface, the zero next to it moves over
the surface by -D'^-1 d, D' the derivative of D.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from lamella.base.arrays import Complexes, Floats, Integers
from lamella.surface.element.places import Places
from lamella.surface.element.surface import ElementSurface
from lamella.surface.element.umbilics import deviator_error

# of an element: over which D is differentiated
DIFFERENCE_STEP = 1e-3


@dataclass(frozen=True)
class UmbilicDepths:
    """Distances of simple umbilics from the rim.

    Attributes
    ----------
    places : Places
        Of the umbilics, (z,).
    depth : (z,)
        Along the surface's chord to the nearest node of the rim, m.
    by_deviator : (z, 2)
        Change of the depth with the real and the imaginary part of D there, m^2.
    rim_node : (z,) int
        The nearest node of the rim.
    inwards : (z, 3)
        Unit vectors from there to the umbilics.
    """

    places: Places
    depth: Floats
    by_deviator: Floats
    rim_node: Integers
    inwards: Floats

    @classmethod
    def of(cls, surface: ElementSurface) -> UmbilicDepths:
        """Of a surface's umbilics of order 1: one of higher order splits where D changes."""
        umbilics = surface.umbilics
        places = umbilics.places[np.flatnonzero(umbilics.orders == 1)]
        d_x, along_x = _slopes(surface, places, 0)
        d_y, along_y = _slopes(surface, places, 1)
        # the zero moves by (x, y) with d_x x + d_y y = -d
        turned = d_x.real * d_y.imag - d_x.imag * d_y.real
        turned = np.where(np.abs(turned) > 0, turned, np.inf)
        x = np.stack([-d_y.imag, d_y.real], 1) / turned[:, None]
        y = np.stack([d_x.imag, -d_x.real], 1) / turned[:, None]
        position = surface.frames(places).position
        rim = np.unique(surface.connectivity.rim_nodes)
        depth, nearest = cKDTree(surface.nodes[rim]).query(position)
        inwards = (position - surface.nodes[rim[nearest]]) / np.maximum(depth, 1e-300)[:, None]
        by_deviator = (inwards * along_x).sum(1)[:, None] * x + (inwards * along_y).sum(1)[:, None] * y
        return cls(places, np.asarray(depth), by_deviator, rim[nearest], inwards)


def depth_errors(surface: ElementSurface) -> Floats:
    """How far the umbilics of a surface may lie from where they are found, across the rim, m, (z,).

    Of simple ones, by the error of the deviator there. The middle of one of higher order is found as well as the
    surface itself: 0.
    """
    umbilics = surface.umbilics
    errors, simple = np.zeros(len(umbilics.orders)), umbilics.orders == 1
    if simple.any():
        depths = UmbilicDepths.of(surface)
        errors[simple] = np.linalg.norm(depths.by_deviator, axis=1) * deviator_error(surface, depths.places.element)
    return errors


def _slopes(surface: ElementSurface, places: Places, axis: int) -> tuple[Complexes, Floats]:
    """Derivatives of the deviator, 1/m, (n,), and of the position, m, (n, 3), by a local coordinate."""
    beside = DIFFERENCE_STEP * np.eye(2)[axis]
    ahead, behind = (surface.at(Places(places.element, places.local + direction * beside)) for direction in (1.0, -1.0))
    return (
        np.asarray((ahead.deviator - behind.deviator) / (2 * DIFFERENCE_STEP)),
        np.asarray((ahead.position - behind.position) / (2 * DIFFERENCE_STEP)),
    )
