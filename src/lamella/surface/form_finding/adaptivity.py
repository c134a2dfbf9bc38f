"""Elements as small as a tolerance of the curvature asks for."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lamella.base.arrays import Booleans, Floats
from lamella.surface.element.curvature import curvature_sizes
from lamella.surface.element.lagrange import lagrange
from lamella.surface.element.quadrature import triangle_rule
from lamella.surface.element.rim import CORNER_CORE, CORNER_PART, SHARP_TURN
from lamella.surface.form_finding.film import Film, Loop
from lamella.surface.remesh.size_field import SizeField

# elements at a corner, over the size of its core
CORNER_ELEMENT = 0.25
# where the turn at a corner is measured, as a fraction of the loop
CORNER_STEP = 1e-5
# |D| next to such a corner, over the curvature scale, from which on the corner concentrates curvature
ERROR_CONCENTRATION = 1.5
# order of the regular places in each element at which H is checked
CHECKED = 8
# least |D| over the curvature scale that an error is weighed by
LEAST_WEIGHED = 0.1
# of the tolerance that a new mesh aims at, and the rings of neighbours that share their largest error
ERROR_AIM, CORNER_RINGS = 0.6, 2
# most an element's edge shrinks or grows at once; once the sizes have settled none grows
SIZE_SHRINK, GROW = 0.3, 1.3


@dataclass(frozen=True)
class Deviation:
    """How far from the wanted mean curvature a film of elements is, over its curvature scale.

    Attributes
    ----------
    of_element : (m,)
        Largest |H - H0| in each element, over the scale, times the weight of curvatures there; 0 where all its check
        points lie in the core of a corner.
    weighted : float
        Its maximum.
    largest, typical : float
        Maximum and root mean square of |H - H0|, over the scale.
    scale : float
        Root mean square of sqrt((k1^2 + k2^2) / 2), at least 0.01 / size, 1/m.
    zones : CornerZones
        Around the boundary's corners.
    """

    of_element: Floats
    weighted: float
    largest: float
    typical: float
    scale: float
    zones: CornerZones


def deviation_of(film: Film, mean_curvature: float, cosine: float = 0.0) -> Deviation:
    """Measured from the second derivatives of the positions, inside each element and at its nodes.

    The curvature of a polynomial is farthest off at the element's rim, most of all at its vertices.

    Parameters
    ----------
    film : Film
    mean_curvature : float
        H0, 1/m.
    cosine : float
        Where H + cosine |D| is to be H0 (`lamella.surface.constant_angle.relation`), whose difference from it then
        counts.
    """
    inside, weights = triangle_rule(6)
    # many more places than the nodes can be moved for: between too few of them H would be worse
    points = np.concatenate([inside, lagrange(CHECKED).nodes])
    weights = np.append(weights, np.zeros(len(points) - len(inside)))
    corners = film.nodes[film.connectivity.elements]
    position, mean, deviator = curvature_sizes(film.connectivity, corners, points)
    m = len(corners)
    places = position.reshape(-1, 3)
    off = np.abs(mean + cosine * deviator - mean_curvature)
    bend = mean**2 + deviator**2
    flat = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    weight = flat[:, None] * weights
    zones = CornerZones.of(film)
    away = ~_within(places, zones.points, zones.radius).reshape(m, -1)
    weight = np.where(away, weight, 0)
    total = max(weight.sum(), 1e-300)
    scale = max(float(np.sqrt((weight * bend).sum() / total)), 0.01 / film.size)
    # an error d of the shape operator turns principal directions by d / (2 |D|) and changes isothermic coordinates,
    # the integral of sqrt |D|, by d / (2 sqrt |D|): where |D| is small, next to umbilics, elements have to be better
    deviator = deviator / scale
    # next to a corner the curvature is what directions are taken from, however large
    zones = zones.concentrated(places, deviator.ravel())
    counted = ~_within(places, zones.points, zones.core).reshape(m, -1)
    local = np.where(counted, off / np.maximum(deviator, 1), 0)
    off = np.where(away, off, 0)
    of_element = np.where(away, off, local).max(1) / scale / np.sqrt(np.clip(deviator.min(1), LEAST_WEIGHED, 1))
    return Deviation(
        of_element,
        float(of_element.max()),
        float(off.max()) / scale,
        float(np.sqrt((weight * off**2).sum() / total)) / scale,
        scale,
        zones,
    )


@dataclass(frozen=True)
class CornerZones:
    """Corners of a film's boundary and what is around them.

    Attributes
    ----------
    points : (c, 3)
        m.
    radius : (c,)
        Of the zone next to which the curvature may be unbounded, m.
    core : (c,)
        Within which no error is counted, m: the whole zone where the boundary turns by little.
    """

    points: Floats
    radius: Floats
    core: Floats

    @classmethod
    def of(cls, film: Film) -> CornerZones:
        """Those of a film."""
        points, radii, cores = [np.zeros((0, 3))], [np.zeros(0)], [np.zeros(0)]
        for loop in film.loops:
            corners = np.sort(np.asarray(loop.corners)[~np.asarray(loop.smooth, bool)])
            if not len(corners):
                continue
            # no more than a part of the way to the next corner: a loop of many corners is checked between them
            gap = np.diff(np.append(corners, corners[0] + 1)) * loop.length
            radius = np.minimum(CORNER_PART * min(film.size, loop.length), np.minimum(gap, np.roll(gap, 1)) / 4)
            points.append(np.asarray(loop.at(corners)))
            radii.append(radius)
            cores.append(np.where(_turns(loop, corners) > SHARP_TURN, CORNER_CORE / CORNER_PART, 1) * radius)
        return cls(np.concatenate(points), np.concatenate(radii), np.concatenate(cores))

    def concentrated(self, points: Floats, deviator: Floats) -> CornerZones:
        """With cores as large as the zones where |D| at points (n,), over the curvature scale, is nowhere large."""
        large = points[deviator > ERROR_CONCENTRATION]
        some = np.array(
            [
                bool(_within(large, centre[None], radius[None]).any())
                for centre, radius in zip(self.points, self.radius, strict=True)
            ],
            bool,
        )
        return replace(self, core=np.where(some, self.core, self.radius))


def _turns(loop: Loop, corners: Floats) -> Floats:
    """Angle by which a loop turns at corners, radians, (c,)."""
    there = loop.at(corners)
    before, after = there - loop.at(corners - CORNER_STEP), loop.at(corners + CORNER_STEP) - there
    return np.asarray(np.arctan2(np.linalg.norm(np.cross(before, after), axis=1), np.einsum("ij,ij->i", before, after)))


def _within(points: Floats, centres: Floats, radii: Floats) -> Booleans:
    """Which points (n, 3) are within radii (c,) of any of centres (c, 3)."""
    result = np.zeros(len(points), bool)
    for centre, radius in zip(centres, radii, strict=True):
        result |= np.linalg.norm(points - centre, axis=1) <= radius
    return result


def away_from_corners(film: Film, points: Floats) -> Booleans:
    """Which points (n, 3) are not next to a corner of the boundary."""
    zones = CornerZones.of(film)
    return ~_within(points, zones.points, zones.radius)


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
    for _ in range(CORNER_RINGS):
        of_node = np.zeros(len(film.mesh.points))
        np.maximum.at(of_node, film.connectivity.faces, worst[:, None])
        worst = of_node[film.connectivity.faces].max(1)
    factor = (ERROR_AIM * tolerance / np.maximum(worst, 1e-300)) ** (1 / (order - 1))
    factor[knots] = np.minimum(factor, ERROR_AIM * tolerance / np.maximum(deviation.of_element, 1e-300))[knots]
    factor = np.clip(factor, SIZE_SHRINK, GROW if coarsen else 1.0)
    middles = corners.mean(1)
    zones = deviation.zones
    sharp = zones.core < zones.radius
    wanted = edges * factor
    # no size is asked for where no error is counted
    for part, kind in ((CORNER_CORE, sharp), (CORNER_PART, ~sharp)):
        in_core = _within(middles, zones.points[kind], zones.core[kind])
        wanted = np.where(in_core, np.maximum(wanted, CORNER_ELEMENT * part * film.size), wanted)
    wanted = np.minimum(wanted, film.size / 6)
    graded = sharp & _is_off(film, deviation, tolerance, zones)
    # from a corner on sizes grow with the distance: such layers follow any power of it equally well
    # (Babuska and Guo, SIAM J. Math. Anal. 19 (1988), 172-203, doi:10.1137/0519014)
    field = SizeField(
        np.concatenate([middles, zones.points[graded]]), np.append(wanted, CORNER_ELEMENT * zones.core[graded])
    )
    # nodes of order p: p^2 / 2 an element of area sqrt(3) / 4 h^2
    nodes = order**2 / 2 * (area / (np.sqrt(3) / 4 * field(corners.mean(1)) ** 2)).sum()
    if nodes <= most_nodes:
        return field, True
    return field.scaled(float(np.sqrt(nodes / most_nodes) * 1.02)), False


def _near_knots(film: Film, points: Floats, sizes: Floats) -> Booleans:
    """Which elements, by their middles (n, 3) and sizes (n,), are next to a smooth corner of a loop."""
    result = np.zeros(len(points), bool)
    for loop in film.loops:
        for knot in loop.at(np.asarray(loop.corners)[np.asarray(loop.smooth, bool)]):
            result |= np.linalg.norm(points - knot, axis=1) < sizes
    return result


def _is_off(film: Film, deviation: Deviation, tolerance: float, zones: CornerZones) -> Booleans:
    """Next to which corners an element is off by more than a tolerance, (c,)."""
    vertices = film.nodes[film.connectivity.faces[deviation.of_element > tolerance]].reshape(-1, 3)
    return np.array(
        [
            bool(_within(vertices, centre[None], radius[None]).any())
            for centre, radius in zip(zones.points, zones.radius, strict=True)
        ],
        bool,
    )
