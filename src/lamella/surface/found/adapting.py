"""Elements as small as a tolerance of the curvature asks for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lamella.surface.element.curvature import element_points
from lamella.surface.element.lagrange import lagrange
from lamella.surface.element.quadrature import triangle_rule
from lamella.surface.element.size_field import SizeField
from lamella.surface.found.film import Film
from lamella.surface.points import Floats

# around a corner of the boundary the curvature of a film itself may be unbounded: parts of the size (or of
# the loop) left out there
CORNER_PART = 0.03
# order of the regular places in each element at which H is checked
CHECKED = 8
# least |D| over the curvature scale that an error is weighed by
LEAST_WEIGHED = 0.1
# of the tolerance that a new mesh aims at, and the rings of neighbours that share their largest error
AIM, RINGS = 0.6, 2
# most an element's edge shrinks or grows at once; once the sizes have settled none grows
SHRINK, GROW = 0.3, 1.3


@dataclass(frozen=True)
class Deviation:
    """How far from the wanted mean curvature a film of elements is, over its curvature scale.

    Attributes
    ----------
    of_element : (m,)
        Largest |H - H0| in each element, over the scale, times the weight of curvatures there; 0 where all its check
        points lie next to a corner.
    weighted : float
        Its maximum.
    largest, typical : float
        Maximum and root mean square of |H - H0|, over the scale.
    scale : float
        Root mean square of sqrt((k1^2 + k2^2) / 2), at least 0.01 / size, 1/m.
    """

    of_element: Floats
    weighted: float
    largest: float
    typical: float
    scale: float


def deviation_of(film: Film, mean_curvature: float) -> Deviation:
    """Measured from the second derivatives of the positions, inside each element and at its nodes.

    The curvature of a polynomial is farthest off at the element's rim, most of all at its vertices.
    """
    inside, weights = triangle_rule(6)
    # many more places than the nodes can be moved for: between too few of them H would be worse
    points = np.concatenate([inside, lagrange(CHECKED).nodes])
    weights = np.append(weights, np.zeros(len(points) - len(inside)))
    corners = film.nodes[film.connectivity.elements]
    there = element_points(film.connectivity, corners, points, False)
    m = len(corners)
    off = np.abs(there.mean_curvature - mean_curvature).reshape(m, -1)
    bend = (there.mean_curvature**2 + np.abs(there.deviator) ** 2).reshape(m, -1)
    flat = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    weight = flat[:, None] * weights
    counted = away_from_corners(film, there.position).reshape(m, -1)
    weight = np.where(counted, weight, 0)
    off = np.where(counted, off, 0)
    total = max(weight.sum(), 1e-300)
    scale = max(float(np.sqrt((weight * bend).sum() / total)), 0.01 / film.size)
    # an error d of the shape operator turns principal directions by d / (2 |D|) and changes isothermic coordinates,
    # the integral of sqrt |D|, by d / (2 sqrt |D|): where |D| is small, next to umbilics, elements have to be better
    least = np.abs(there.deviator).reshape(m, -1).min(1)
    of_element = off.max(1) / scale / np.sqrt(np.clip(least / scale, LEAST_WEIGHED, 1))
    return Deviation(
        of_element,
        float(of_element.max()),
        float(off.max()) / scale,
        float(np.sqrt((weight * off**2).sum() / total)) / scale,
        scale,
    )


def away_from_corners(film: Film, points: Floats) -> NDArray[np.bool_]:
    """Which points (n, 3) are not next to a corner of the boundary."""
    result = np.ones(len(points), bool)
    for loop in film.loops:
        corners = np.sort(np.asarray(loop.corners)[~np.asarray(loop.smooth, bool)])
        if not len(corners):
            continue
        # no more than a part of the way to the next corner: a loop of many corners is checked between them
        gap = np.diff(np.append(corners, corners[0] + 1)) * loop.length
        reach = np.minimum(CORNER_PART * min(film.size, loop.length), np.minimum(gap, np.roll(gap, 1)) / 4)
        for corner, radius in zip(loop.at(corners), reach, strict=True):
            result &= np.linalg.norm(points - corner, axis=1) > radius
    return result


def refined_sizes(
    film: Film, deviation: Deviation, tolerance: float, most_nodes: int, *, coarsen: bool
) -> tuple[SizeField, bool]:
    """Sizes with which the tolerance should be kept, and whether a limit of nodes allows them.

    The curvature of elements of order p is off by h^(p - 1); next to a knot, where the derivative of the boundary's
    curvature jumps and the surface goes like r^3 log r, by h.
    """
    order = film.connectivity.basis.order
    corners = film.nodes[film.connectivity.faces]
    edges = np.linalg.norm(corners - np.roll(corners, 1, 1), axis=2).mean(1)
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
    # an element counts with its neighbours: among alike ones the largest error sits in any of them
    knots = _near_knots(film, corners.mean(1), edges)
    worst = np.where(knots, 0, deviation.of_element)
    for _ in range(RINGS):
        of_node = np.zeros(len(film.mesh.points))
        np.maximum.at(of_node, film.connectivity.faces, worst[:, None])
        worst = of_node[film.connectivity.faces].max(1)
    factor = (AIM * tolerance / np.maximum(worst, 1e-300)) ** (1 / (order - 1))
    factor[knots] = np.minimum(factor, AIM * tolerance / np.maximum(deviation.of_element, 1e-300))[knots]
    factor = np.clip(factor, SHRINK, GROW if coarsen else 1.0)
    wanted = np.maximum(edges * factor, CORNER_PART / 4 * film.size * _near_corner(film, corners.mean(1)))
    wanted = np.minimum(wanted, film.size / 6)
    field = SizeField(corners.mean(1), wanted)
    # nodes of order p: p^2 / 2 an element of area sqrt(3) / 4 h^2
    nodes = order**2 / 2 * (area / (np.sqrt(3) / 4 * field(corners.mean(1)) ** 2)).sum()
    if nodes <= most_nodes:
        return field, True
    return field.scaled(float(np.sqrt(nodes / most_nodes) * 1.02)), False


def _near_knots(film: Film, points: Floats, sizes: Floats) -> NDArray[np.bool_]:
    """Which elements, by their middles (n, 3) and sizes (n,), are next to a smooth corner of a loop."""
    result = np.zeros(len(points), bool)
    for loop in film.loops:
        for knot in loop.at(np.asarray(loop.corners)[np.asarray(loop.smooth, bool)]):
            result |= np.linalg.norm(points - knot, axis=1) < sizes
    return result


def _near_corner(film: Film, points: Floats) -> Floats:
    """1 next to a corner, 0 elsewhere: no size is asked for where no error is counted."""
    return np.asarray(~away_from_corners(film, points), float)
