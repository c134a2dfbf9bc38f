"""Zeros of the deviator beyond the rim, next to which elements to integrate on have to be small as well.

The isothermic coordinates are the integral of sqrt(D), which has a branch point in a zero of D = c (z - z_0)^m. Where
the surface would go on to one just beyond its rim, or runs into a corner in which D is 0, no polynomial on a larger
element is like that. D is holomorphic, and so the gradient of ln |D| points away from the zero and is m over the
distance.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from lamella.base.arrays import Booleans, Floats
from lamella.base.triangle import CORNERS
from lamella.base.vectors import lengths
from lamella.surface.element.places import Places
from lamella.surface.element.surface import ElementSurface

# a zero nearer to a place of the rim than this many longest edges of the element there
RIM_EDGES = 1.5
# barycentric coordinate below which a place is on an edge of its element
ON_EDGE = 1e-6
# places along an edge of the rim
SHARES = np.array([0.1, 0.5, 0.9])


def zeros_beyond_rim(surface: ElementSurface, apart: float) -> Floats:
    """Estimated positions (n, 3) of zeros just beyond the rim, m, no two nearer to each other than `apart` (m)."""
    connectivity = surface.connectivity
    corners = CORNERS
    element, edge = np.nonzero(connectivity.neighbours < 0)
    first, second = corners[edge], corners[(edge + 1) % 3]
    local = first[:, None] + SHARES[:, None] * (second - first)[:, None]
    where = Places(np.repeat(element, len(SHARES)), local.reshape(-1, 2))
    there = surface.at(where)
    # grad ln |D| = 2 grad ln mu
    rise = 2 * there.log_mu_gradient
    vertices = surface.nodes[connectivity.faces[where.element]]
    longest = lengths(vertices - np.roll(vertices, 1, 1)).max(1)
    close = np.abs(rise) * RIM_EDGES * longest > 1
    rise, where = rise[close], where[close]
    step = -rise / np.abs(rise) ** 2
    target = there.position[close] + step.real[:, None] * there.e_u[close] + step.imag[:, None] * there.e_v[close]
    places, nearest = surface.closest_near(target, where)
    # one within the surface is an umbilic, or the way from a corner in which D has no bound; where the surface bends
    # such a one is off it all the same
    beyond = (lengths(target - nearest) > 0.1 * np.abs(step)) & _on_rim(surface, places)
    target = target[beyond]
    kept: list[int] = []
    for number, near in enumerate(cKDTree(target).query_ball_point(target, apart) if len(target) else []):
        if not set(near) & set(kept):
            kept.append(number)
    return np.asarray(target[kept])


def _on_rim(surface: ElementSurface, places: Places) -> Booleans:
    """Which of n places are on the rim, (n,)."""
    barycentric = np.column_stack([1 - places.local.sum(1), places.local])
    # opposite to the corners 2, 0, 1 are the edges 0, 1, 2
    at_edge = np.roll(barycentric, -2, 1) < ON_EDGE
    return np.asarray((at_edge & (surface.connectivity.neighbours[places.element] < 0)).any(1))
