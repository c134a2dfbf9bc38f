"""Umbilics: the zeros of the trace-free shape operator, where lamellas meet in singular nodes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from lamella.surface.element.lagrange import subdivision
from lamella.surface.element.places import Places
from lamella.surface.element.rim import rim_marks
from lamella.surface.points import Complexes, Floats, SurfacePoints
from lamella.surface.vectors import diagonal, dots

if TYPE_CHECKING:
    from lamella.surface.element.surface import ElementSurface

Integers = NDArray[np.int64]

# small triangles along an element's edge in which a zero is looked for
PARTS = 4
# Newton steps from a small triangle's middle
MOST_STEPS = 30
# zeros nearer to each other than this part of the surface's size are one of higher order; the least that serves
REACHES = (2e-3, 6e-3, 2e-2, 6e-2)
# of the size: umbilics whose distances from the rim differ by less are alike
DEPTH = 0.01
# shares of the outer loop from its start on: of umbilics that are alike the one nearest to the first of these places
# goes first, to the next one where that does not tell them apart
MARKS = np.array([0.0, 0.25, 0.125])


@dataclass(frozen=True)
class Umbilics:
    """Zeros of the Hopf differential, the one farthest from the rim first.

    Attributes
    ----------
    places : Places
    position : (n, 3)
        m.
    orders : (n,) int
        Order m of each zero; 2 (m + 2) lamella rays leave it.
    """

    places: Places
    position: Floats
    orders: Integers

    @property
    def rays(self) -> Integers:
        """Lamella rays of each, (n,)."""
        return 2 * (self.orders + 2)


def find_umbilics(surface: ElementSurface) -> Umbilics:
    """All zeros of the trace-free shape operator of a surface of elements, to Newton precision.

    A zero of order m turns the deviator m times around it. Every small triangle whose corners turn it, and its
    neighbours, is a place to begin from; zeros closer together than `REACHES` times the size count as one of the sum of
    their orders, since the surface cannot tell them apart.
    """
    local, faces = subdivision(PARTS)
    m = len(surface.connectivity.elements)
    axes = surface.frames_everywhere(np.full((1, 2), 1 / 3)).e_u
    value = _turned(surface.at_everywhere(local), np.repeat(axes, len(local), 0)).reshape(m, -1)
    corners = value[:, faces]
    turn = np.angle(np.roll(corners, -1, 2) / np.where(corners == 0, 1, corners)).sum(2) / (2 * np.pi)
    # a small value beside the corners' differences may hide a zero next to the triangle's edge
    spread = np.abs(corners - np.roll(corners, 1, 2)).max(2)
    start = (np.rint(turn) != 0) | (np.abs(corners).min(2) < 0.5 * spread)
    element, small = np.nonzero(start)
    found, inside = _newton(surface, Places(element, local[faces[small]].mean(1)), axes[element])
    found = found[inside]
    size = diagonal(surface.nodes)
    if not len(found):
        return Umbilics(found, np.zeros((0, 3)), np.zeros(0, np.int64))
    places, position = found, surface.frames(found).position
    for reach in REACHES:
        places, position, orders = _gathered(surface, places, position, reach * size)
        # the Hopf differential is holomorphic: a negative turn is noise next to a zero of higher order
        if (orders >= 0).all():
            break
    kept = np.flatnonzero(orders > 0)
    kept = kept[_deepest_first(surface, position[kept], DEPTH * size)]
    return Umbilics(places[kept], position[kept], orders[kept])


def _deepest_first(surface: ElementSurface, position: Floats, step: float) -> Integers:
    """Order of places (n, 3) by their distance from the rim, the farthest first: nets begin there on whatever elements.

    Of those about as far, within a step (m), the one nearest to a mark on the outer loop goes first: marks are turned,
    mirrored and scaled with the surface.
    """
    connectivity = surface.connectivity
    depth, _ = cKDTree(surface.nodes[np.unique(connectivity.rim_nodes)]).query(position)
    marks = rim_marks(connectivity, surface.nodes, surface.rim_loop, surface.rim_starts[0], MARKS)
    measures = [-depth, *np.linalg.norm(marks[:, None] - position, axis=2)]
    left, order = np.arange(len(position)), []
    while len(left):
        alike = left
        for measure in measures:
            alike = alike[measure[alike] < measure[alike].min() + step]
        order.append(int(alike[0]))
        left = left[left != alike[0]]
    return np.array(order, np.int64)


def _gathered(
    surface: ElementSurface, places: Places, position: Floats, reach: float
) -> tuple[Places, Floats, Integers]:
    """Zeros nearer to each other than `reach` (m) as one, with the turns of the deviator around them."""
    pairs = np.array(list(cKDTree(position).query_pairs(reach)), np.int64).reshape(-1, 2)
    graph = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), (len(position), len(position)))
    _, group = connected_components(graph, directed=False)
    centre = np.stack([np.bincount(group, position[:, c]) for c in range(3)], 1) / np.bincount(group)[:, None]
    _, first = np.unique(group, return_index=True)
    places, position = surface.closest_near(centre, places[first])
    return places, position, _turns(surface, places, position, reach)


def _turned(at: SurfacePoints, axes: Floats) -> Complexes:
    """Trace-free shape operators, 1/m, (n,), in frames along the tangents nearest to given directions (n, 3)."""
    turn = dots(axes, at.e_u) + 1j * dots(axes, at.e_v)
    return np.asarray(at.deviator * (turn / np.abs(turn)) ** 2)


def _newton(surface: ElementSurface, start: Places, axes: Floats) -> tuple[Places, NDArray[np.bool_]]:
    """Zeros from starting places, by the deviator in frames along axes (n, 3); which ended inside their element."""
    element, local = start.element, start.local.copy()

    # at a place and a little ahead of it in both local coordinates
    step = 1e-5
    ahead = step * np.array([[[0.0, 0.0]], [[1.0, 0.0]], [[0.0, 1.0]]])
    every, each = np.tile(element, 3), np.tile(axes, (3, 1))
    for _ in range(MOST_STEPS):
        there = Places(every, (local + ahead).reshape(-1, 2))
        value, *further = _turned(surface.at(there), each).reshape(3, -1)
        change = (np.stack(further, 1) - value[:, None]) / step
        slope = np.stack([change.real, change.imag], 1)
        determinant = np.linalg.det(slope)
        slope[np.abs(determinant) < 1e-300] = np.eye(2)
        move = -np.linalg.solve(slope, np.stack([value.real, value.imag], 1)[..., None])[..., 0]
        move *= np.minimum(1, 0.3 / np.maximum(np.abs(move).max(1), 1e-300))[:, None]
        local = np.clip(local + move, -0.2, 1.2)
        if np.abs(move).max(initial=0.0) < 1e-12:
            break
    # a zero on an edge is found from either side
    inside = (local.min(1) > -1e-6) & (local.sum(1) < 1 + 1e-6)
    inside &= np.abs(move).max(1) < 1e-6
    return Places(element, np.clip(local, 0, 1)), inside


def _turns(surface: ElementSurface, places: Places, centre: Floats, radius: float) -> Integers:
    """Turns of the deviator once around places of the surface, at a radius (m), (n,)."""
    count = 48
    frame = surface.at(places)
    angle = 2 * np.pi * np.arange(count) / count
    ring = (
        centre[:, None]
        + radius * np.cos(angle)[:, None] * frame.e_u[:, None]
        + radius * np.sin(angle)[:, None] * frame.e_v[:, None]
    )
    around, _ = surface.closest_near(ring.reshape(-1, 3), places[np.repeat(np.arange(len(places)), count)])
    value = _turned(surface.at(around), np.repeat(frame.e_u, count, axis=0)).reshape(-1, count)
    turns = np.angle(np.roll(value, -1, 1) / value).sum(1) / (2 * np.pi)
    return np.asarray(np.rint(turns), np.int64)
