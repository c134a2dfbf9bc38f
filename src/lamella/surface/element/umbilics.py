"""Umbilics: the zeros of the trace-free shape operator, where lamellas meet in singular nodes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from lamella.base.arrays import Booleans, Complexes, Floats, Integers
from lamella.base.vectors import diagonal, dots, lengths
from lamella.surface.element.connectivity import Connectivity
from lamella.surface.element.curvature import ElementFrames, ElementPoints
from lamella.surface.element.lagrange import subdivision
from lamella.surface.element.places import Places
from lamella.surface.element.quadrature import triangle_rule
from lamella.surface.element.rim import rim_marks
from lamella.surface.points import SurfacePoints

# small triangles along an element's edge in which a zero is looked for
SEARCH_PARTS = 4
# Newton steps from a small triangle's middle
UMBILIC_STEPS_MAX = 30
# of the surface's size: zeros nearer to each other are one found twice, and those farther apart are never one
SAME_ZERO, ZEROS_APART = 1e-6, 0.3
# zeros are one of higher order where the deviator between them is below this many times its error; the least that
# leaves no negative order
ERRORS = (1.0, 4.0, 16.0, 64.0)
# neighbours of a zero that it may be one with, and places on the way to each
ZERO_NEIGHBOURS, ON_THE_WAY = 6, 5
# radius of the circle on which turns are counted, over the zeros' distance from its middle and of the surface's size;
# at most this part of the way to the next zeros
CIRCLE_RADIUS, CIRCLE_RADIUS_MIN, CIRCLE_TO_NEXT = 1.5, 2e-3, 0.5
# places on a circle around a zero, and times its error that a deviator is to be trusted
CIRCLE, SURE = 48, 20.0
# of the size: umbilics whose distances from the rim differ by less are alike
DEPTH = 0.01
# parts of that, one after the other, for umbilics next to each other
SHORTER = (1.0, 0.1, 0.01)
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


class SmoothElements(Protocol):
    """What is asked of a surface of elements, see `lamella.surface.element.surface.ElementSurface`."""

    @property
    def connectivity(self) -> Connectivity: ...

    @property
    def nodes(self) -> Floats: ...

    @property
    def rim_loop(self) -> Integers: ...

    @property
    def rim_starts(self) -> Floats: ...

    def at(self, where: Places) -> SurfacePoints: ...

    def at_everywhere(self, local: Floats) -> SurfacePoints: ...

    def frames(self, where: Places) -> ElementFrames: ...

    def frames_everywhere(self, local: Floats) -> ElementFrames: ...

    def shape_at(self, where: Places) -> tuple[ElementFrames, Floats, Complexes]: ...

    def measured(self, where: Places) -> ElementPoints: ...

    def closest_near(self, points: Floats, start: Places) -> tuple[Places, Floats]: ...


def find_umbilics(surface: SmoothElements) -> Umbilics:
    """All zeros of the trace-free shape operator of a surface of elements, to Newton precision.

    A zero of order m turns the deviator m times around it. Every small triangle whose corners turn it, and its
    neighbours, is a place to begin from. Errors of the surface split a zero of order m, where D = c z^m, into m of
    order 1 about (error / c)^(1/m) apart: zeros between which the deviator stays below its own error are one, of the
    sum of their orders, in their middle (the middle of the roots of z^m + a z^(m - 1) + ... is -a / m: it moves by the
    error itself, not by a root of it).
    """
    local, faces = subdivision(SEARCH_PARTS)
    m = len(surface.connectivity.elements)
    axes = surface.frames_everywhere(np.full((1, 2), 1 / 3)).e_u
    value = turned_deviators(surface.at_everywhere(local), np.repeat(axes, len(local), 0)).reshape(m, -1)
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
    places, position = _distinct(found, surface.frames(found).position, SAME_ZERO * size)
    ends, ratio = _ratios(surface, places, position, ZEROS_APART * size)
    for most in ERRORS:
        places_of, position_of, orders = _gathered(surface, places, position, ends[ratio <= most], size)
        # the Hopf differential is holomorphic: a negative turn is noise next to a zero of higher order
        if (orders >= 0).all():
            break
    places, position = places_of, position_of
    kept = np.flatnonzero(orders > 0)
    places, position = _recentred(surface, places[kept], position[kept], orders[kept])
    orders, kept = orders[kept], np.arange(len(kept))
    kept = kept[deepest_first(surface, position[kept], DEPTH * size)]
    return Umbilics(places[kept], position[kept], orders[kept])


def deepest_first(surface: SmoothElements, position: Floats, step: float) -> Integers:
    """Order of places (n, 3) by their distance from the rim, the farthest first: nets begin there on whatever elements.

    Of those about as far, within a step (m), the one nearest to a mark on the outer loop goes first: marks are turned,
    mirrored and scaled with the surface. Those that are within a step of each other are told apart by shorter ones.
    """
    connectivity = surface.connectivity
    depth, _ = cKDTree(surface.nodes[np.unique(connectivity.rim_nodes)]).query(position)
    marks = rim_marks(connectivity, surface.nodes, surface.rim_loop, surface.rim_starts[0], MARKS)
    measures = [-depth, *np.linalg.norm(marks[:, None] - position, axis=2)]
    left, order = np.arange(len(position)), []
    while len(left):
        alike = left
        for part in SHORTER:
            for measure in measures:
                alike = alike[measure[alike] < measure[alike].min() + part * step]
        order.append(int(alike[0]))
        left = left[left != alike[0]]
    return np.array(order, np.int64)


def _groups(count: int, ends: Integers) -> Integers:
    """Number of the group of each of `count` things, some of which (p, 2) are joined."""
    graph = coo_matrix((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), (count, count))
    _, group = connected_components(graph, directed=False)
    return np.asarray(group, np.int64)


def _distinct(places: Places, position: Floats, reach: float) -> tuple[Places, Floats]:
    """Zeros without those that are nearer than `reach` (m) to one before them."""
    pairs = np.array(list(cKDTree(position).query_pairs(reach)), np.int64).reshape(-1, 2)
    _, first = np.unique(_groups(len(position), pairs), return_index=True)
    return places[first], position[first]


def _ratios(surface: SmoothElements, places: Places, position: Floats, reach: float) -> tuple[Integers, Floats]:
    """Pairs (p, 2) of zeros within `reach` (m), and the largest deviator between them over its error, (p,)."""
    distance, near = cKDTree(position).query(
        position, min(ZERO_NEIGHBOURS + 1, len(position)), distance_upper_bound=reach
    )
    start, column = np.nonzero(np.isfinite(distance.reshape(len(position), -1)))
    ends = np.sort(np.stack([start, near.reshape(len(position), -1)[start, column]], 1), 1)
    ends = np.unique(ends[ends[:, 0] < ends[:, 1]], axis=0)
    if not len(ends):
        return ends, np.zeros(0)
    share = (np.arange(ON_THE_WAY)[:, None] + 1) / (ON_THE_WAY + 1)
    first, second = position[ends.T]
    way = first[:, None] + share * (second - first)[:, None]
    between, _ = surface.closest_near(way.reshape(-1, 3), places[np.repeat(ends[:, 0], ON_THE_WAY)])
    largest = np.abs(surface.shape_at(between)[2]).reshape(-1, ON_THE_WAY).max(1)
    elements, number = np.unique(between.element, return_inverse=True)
    error = deviator_error(surface, elements)[number]
    return ends, np.asarray(largest / error.reshape(-1, ON_THE_WAY).max(1))


def deviator_error(surface: SmoothElements, elements: Integers) -> Floats:
    """Bound of the deviator's error on elements (n,), 1/m, (n,).

    How far the continuous deviator is from that of the elements' own second derivatives, which are one order less
    accurate (Zienkiewicz and Zhu, Int. J. Numer. Methods Eng. 33 (1992), 1331-1364, doi:10.1002/nme.1620330702).
    """
    checked = triangle_rule(2 * surface.connectivity.basis.order)[0]
    where = Places(np.repeat(elements, len(checked)), np.tile(checked, (len(elements), 1)))
    # both are in the frames of the elements
    off = surface.shape_at(where)[2] - surface.measured(where).deviator
    return np.asarray(np.abs(off).reshape(len(elements), -1).max(1))


def _gathered(
    surface: SmoothElements, places: Places, position: Floats, ends: Integers, size: float
) -> tuple[Places, Floats, Integers]:
    """Zeros that are joined (p, 2) as one in their middle, with the turns of the deviator around them."""
    group = _groups(len(position), ends)
    centre = np.stack([np.bincount(group, position[:, c]) for c in range(3)], 1) / np.bincount(group)[:, None]
    _, first = np.unique(group, return_index=True)
    extent = np.zeros(len(centre))
    np.maximum.at(extent, group, lengths(position - centre[group]))
    radius = np.maximum(CIRCLE_RADIUS * extent, CIRCLE_RADIUS_MIN * size)
    for number in range(len(centre)):
        others = position[group != number]
        if len(others):
            free = lengths(others - centre[number]).min() - extent[number]
            radius[number] = min(radius[number], extent[number] + CIRCLE_TO_NEXT * max(free, 0))
    places, position = surface.closest_near(centre, places[first])
    return places, position, _turns(surface, places, position, radius)


def _recentred(surface: SmoothElements, places: Places, position: Floats, orders: Integers) -> tuple[Places, Floats]:
    """Zeros of order 2 and above moved to where a circle around them, on which the deviator is sure, has them.

    D = c (z - z_0)^m on it has the Fourier coefficients c r^m and -m z_0 c r^(m - 1) of the orders m and m - 1.
    """
    moved = position.copy()
    tree = cKDTree(surface.nodes[np.unique(surface.connectivity.rim_nodes)])
    for number in np.flatnonzero(orders > 1).tolist():
        m, here = int(orders[number]), slice(number, number + 1)
        free = lengths(np.delete(position, number, 0) - position[number]).min(initial=np.inf)
        most = CIRCLE_TO_NEXT * min(free, float(tree.query(position[number])[0]))
        value = _circle(surface, places[here], position[here], np.array([most]))[0]
        error = float(deviator_error(surface, places.element[here])[0])
        radius = most * min(1.0, (SURE * error / np.abs(value).mean()) ** (1 / m))
        value = _circle(surface, places[here], position[here], np.array([radius]))[0]
        modes = np.fft.fft(value)
        shift = -radius * modes[m - 1] / (m * modes[m])
        if abs(shift) < CIRCLE_TO_NEXT * radius:
            frame = surface.frames(places[here])
            moved[number] += shift.real * frame.e_u[0] + shift.imag * frame.e_v[0]
    return surface.closest_near(moved, places) if len(moved) else (places, position)


def turned_deviators(at: SurfacePoints, axes: Floats) -> Complexes:
    """Trace-free shape operators, 1/m, (n,), in frames along the tangents nearest to given directions (n, 3)."""
    turn = dots(axes, at.e_u) + 1j * dots(axes, at.e_v)
    return np.asarray(at.deviator * (turn / np.abs(turn)) ** 2)


def _newton(surface: SmoothElements, start: Places, axes: Floats) -> tuple[Places, Booleans]:
    """Zeros from starting places, by the deviator in frames along axes (n, 3); which ended inside their element."""
    element, local = start.element, start.local.copy()

    # at a place and a little ahead of it in both local coordinates
    step = 1e-5
    ahead = step * np.array([[[0.0, 0.0]], [[1.0, 0.0]], [[0.0, 1.0]]])
    every, each = np.tile(element, 3), np.tile(axes, (3, 1))
    for _ in range(UMBILIC_STEPS_MAX):
        there = Places(every, (local + ahead).reshape(-1, 2))
        value, *further = turned_deviators(surface.at(there), each).reshape(3, -1)
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


def _circle(surface: SmoothElements, places: Places, centre: Floats, radius: Floats) -> Complexes:
    """Deviators at `CIRCLE` places around those of the surface, at a radius (m) of each, in its frame, (n, CIRCLE)."""
    frame = surface.at(places)
    angle = 2 * np.pi * np.arange(CIRCLE) / CIRCLE
    ring = (
        centre[:, None]
        + (radius[:, None] * np.cos(angle))[..., None] * frame.e_u[:, None]
        + (radius[:, None] * np.sin(angle))[..., None] * frame.e_v[:, None]
    )
    around, _ = surface.closest_near(ring.reshape(-1, 3), places[np.repeat(np.arange(len(places)), CIRCLE)])
    return turned_deviators(surface.at(around), np.repeat(frame.e_u, CIRCLE, axis=0)).reshape(-1, CIRCLE)


def _turns(surface: SmoothElements, places: Places, centre: Floats, radius: Floats) -> Integers:
    """Turns of the deviator once around places of the surface, at a radius (m) of each, (n,)."""
    value = _circle(surface, places, centre, radius)
    turns = np.angle(np.roll(value, -1, 1) / value).sum(1) / (2 * np.pi)
    return np.asarray(np.rint(turns), np.int64)
