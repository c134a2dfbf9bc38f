"""A flat chart of the surface to be found: a disc with holes whose rims are the boundary loops.

Where the loops lie inside one another in plan, the plan is the chart. Everywhere else (two rings one above the other,
a loop that winds, an upright saddle) it is an abstract disc: the outer loop goes around the unit circle by arc
length; each hole becomes a circle at the place of the harmonic disc over the outer loop that is nearest to it, turned
so that the harmonic surface between the loops has the least energy.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Protocol

import numpy as np
import pythoncdt

from lamella.base.arrays import Booleans, Complexes, Floats, Integers
from lamella.base.errors import InputError
from lamella.base.ties import MARGIN, grid_of, least_axis, nearest_whole, rounded
from lamella.surface.remesh.topology import scattered

# smallest angle of the chart's triangles, deg; Ruppert's refinement ends for certain below about 20.7
CHART_ANGLE_MIN = 20.0
MOST_VERTICES = 20_000
# a plan serves where its curves keep this far apart, over its size, and run at least this much of their length in it
LEAST_GAP, LEAST_RUN = 0.02, 0.2
# of the distance to its neighbours, by which a vertex on a rim of the chart is moved
CHART_UNEVEN = 1e-3
# Fourier modes of a loop that place a hole in the abstract disc
CHART_MODES = 24


class Curve(Protocol):
    """A closed curve parametrised by its arc length fraction."""

    @property
    def length(self) -> float:
        """m."""

    @property
    def corners(self) -> Floats:
        """Parameters of the corners, sorted."""

    def at(self, t: Floats) -> Floats:
        """Points (n, 3), m."""


@dataclass(frozen=True)
class Chart:
    """A triangulated disc with holes.

    Attributes
    ----------
    kind : str
        "plan" or "disc".
    points : (v, 2)
        Vertices in the chart.
    faces : (m, 3) int
        Counter-clockwise.
    loop, parameter : (v,)
        Boundary loop (-1: inside) and parameter there.
    """

    kind: str
    points: Floats
    faces: Integers
    loop: Integers
    parameter: Floats


def vector_area(points: Floats) -> Floats:
    """Vector area of a closed polygon (n, 3), m^2."""
    centred = points - points.mean(0)
    return np.asarray(np.cross(centred, np.roll(centred, -1, 0)).sum(0) / 2)


def samples_of(curve: Curve, count: int) -> Floats:
    """Parameters of about `count` samples, corners included."""
    even = np.arange(count) / count
    if not len(curve.corners):
        return np.asarray(even)
    off = np.abs((even[:, None] - curve.corners + 0.5) % 1 - 0.5).min(1)
    return np.sort(np.concatenate([even[off > 0.501 / count], curve.corners]))


def make_chart(loops: Sequence[Curve], count: int = 64) -> Chart:
    """Chart of loops, the outer one first.

    Parameters
    ----------
    loops : sequence of Curve
    count : int
        Boundary vertices of the longest loop.

    Raises
    ------
    InputError
        No chart could be triangulated.
    """
    longest = max(loop.length for loop in loops)
    counts = [max(12, int(nearest_whole(count * np.sqrt(loop.length / longest)))) for loop in loops]
    parameters = [samples_of(loop, number) for loop, number in zip(loops, counts, strict=True)]
    rims = _plan(loops, parameters)
    kind = "plan"
    if rims is None:
        kind, rims = "disc", _disc(loops, parameters)
    return _triangulated(kind, rims, parameters)


def _plan(loops: Sequence[Curve], parameters: Sequence[Floats]) -> list[Complexes] | None:
    """The loops in plan, if that is a disc with holes."""
    fine = [loop.at(samples_of(loop, 240)) for loop in loops]
    axis = vector_area(fine[0])
    length = np.linalg.norm(np.roll(fine[0], -1, 0) - fine[0], axis=1).sum()
    if np.linalg.norm(axis) < 0.01 * length**2:
        return None
    axis /= np.linalg.norm(axis)
    first = np.cross(axis, np.eye(3)[least_axis(axis)])
    first /= np.linalg.norm(first)
    frame = np.stack([first, np.cross(axis, first)], 1) @ np.array([1, 1j])
    flat = [points @ frame for points in fine]
    for points, plan in zip(fine, flat, strict=True):
        run = np.abs(np.roll(plan, -1) - plan) / np.linalg.norm(np.roll(points, -1, 0) - points, axis=1)
        if run.min() < LEAST_RUN:
            return None
    size = np.abs(flat[0] - flat[0].mean()).max()
    if any(not _inside(flat[0], hole).all() for hole in flat[1:]):
        return None
    for i, hole in enumerate(flat):
        for j, other in enumerate(flat):
            if j > 0 and i > 0 and i != j and _inside(other, hole).any():
                return None
            if i < j and np.abs(hole[:, None] - other).min() < LEAST_GAP * size:
                return None
        if _crosses(hole, LEAST_GAP * size):
            return None
    result = []
    for index, (loop, t) in enumerate(zip(loops, parameters, strict=True)):
        del index
        result.append(np.asarray(loop.at(t) @ frame))
    return result


def _inside(polygon: Complexes, points: Complexes) -> Booleans:
    """Which points are inside a polygon: the winding number."""
    to = polygon[None, :] - points[:, None]
    turn = np.angle(np.roll(to, -1, 1) * to.conj()).sum(1)
    return np.asarray(np.abs(turn) > np.pi)


def _crosses(polygon: Complexes, gap: float) -> bool:
    """Whether a closed polygon crosses itself, or comes nearer to itself than a gap where it is far along the curve."""
    n = len(polygon)
    a, b = polygon, np.roll(polygon, -1)

    size = np.abs(polygon - polygon[0]).max()

    def side(p: Complexes, q: Complexes, r: Complexes) -> Floats:
        # a point on the line through two others lies to neither side
        area = ((q - p).conj() * (r - p)).imag
        return np.asarray(np.where(np.abs(area) > MARGIN * size * np.abs(q - p), area, 0))

    a1, b1, a2, b2 = a[:, None], b[:, None], a[None, :], b[None, :]
    cross = (side(a1, b1, a2) * side(a1, b1, b2) < 0) & (side(a2, b2, a1) * side(a2, b2, b1) < 0)
    if cross.any():
        return True
    step = np.abs(b - a)
    at = np.cumsum(step) - step
    along = np.abs(at[:, None] - at)
    along = np.minimum(along, step.sum() - along)
    return bool((np.abs(a1 - a2)[(along > 4 * gap) & (n > 0)] < gap).any())


def _disc(loops: Sequence[Curve], parameters: Sequence[Floats]) -> list[Complexes]:
    """Circles of the abstract disc."""
    fine = np.arange(256) / 256
    outer = np.fft.fft(loops[0].at(fine), axis=0) / len(fine)
    circles = [(0j, 1.0, 0.0, 1)]
    if len(loops) > 1:
        r = np.sqrt((np.arange(24) + 0.5) / 24) * 0.8
        grid = (r[:, None] * np.exp(2j * np.pi * np.arange(48) / 48)).ravel()
        surface = _harmonic_disc(outer, grid)
        centres, radii = [], []
        for loop in loops[1:]:
            points = loop.at(fine)
            middle = points.mean(0)
            distance = np.linalg.norm(surface - middle, axis=1)
            near = np.exp(-((distance - distance.min()) / (0.05 * distance.max() + 1e-12)))
            centre = complex((near * grid).sum() / near.sum())
            step = 1e-3
            local = np.linalg.norm(
                _harmonic_disc(outer, np.array([centre + step, centre + 1j * step]))
                - _harmonic_disc(outer, np.array([centre])),
                axis=1,
            ).mean()
            radius = np.linalg.norm(points - middle, axis=1).mean() / max(local / step, 1e-9)
            centres.append(centre)
            radii.append(radius)
        for loop, centre, radius in zip(loops[1:], *_apart(np.array(centres), np.array(radii)), strict=True):
            circles.append((centre, radius, *_turned(outer, centre, radius, loop.at(fine))))
    return [
        centre + radius * np.exp(1j * (sense * 2 * np.pi * t + turn))
        for (centre, radius, turn, sense), t in zip(circles, parameters, strict=True)
    ]


def _harmonic_disc(coefficients: Complexes, places: Complexes) -> Floats:
    """Harmonic map of the unit disc with given Fourier coefficients (256, 3) on the rim, at places (n,), (n, 3)."""
    k = np.arange(1, CHART_MODES + 1)
    powers = places[:, None] ** k
    return np.asarray(coefficients[0].real + 2 * (powers @ coefficients[1 : CHART_MODES + 1]).real)


def _apart(centres: Complexes, radii: Floats) -> tuple[Complexes, Floats]:
    """Circles moved apart and made small enough to lie in the disc clear of each other."""
    n = len(centres)
    centres = centres * np.minimum(1, 0.75 / np.maximum(np.abs(centres), 1e-9))
    wanted = min(0.5, 0.9 / np.sqrt(n + 1)) if n > 1 else 0.0
    for _ in range(200):
        gap = centres[:, None] - centres + np.diag(np.full(n, 9.0))
        near = np.abs(gap) < wanted * 0.8
        if not near.any():
            break
        # coincident circles part along directions of their own
        gap = np.where(np.abs(gap) < 1e-9, 1e-3 * np.exp(1j * np.arange(n))[:, None], gap)
        centres = centres + 0.1 * (np.where(near, gap / np.abs(gap) * (wanted - np.abs(gap)), 0)).sum(1)
        centres = centres * np.minimum(1, 0.75 / np.maximum(np.abs(centres), 1e-9))
    room = np.minimum(1 - np.abs(centres), (np.abs(centres[:, None] - centres) + np.diag(np.full(n, 9.0))).min(1) / 2)
    return centres, np.clip(radii, 0.15 * room, 0.5 * room)


def _turned(outer: Complexes, centre: complex, radius: float, points: Floats) -> tuple[float, int]:
    """Turn and sense of a hole's parameter on its circle, of least energy against the harmonic disc there."""
    n = len(points)
    around = _harmonic_disc(outer, centre + radius * np.exp(2j * np.pi * np.arange(n) / n))
    there = np.fft.fft(around, axis=0)
    k = np.minimum(np.arange(n), n - np.arange(n))
    best = (-np.inf, 0.0, 1)
    for sense in (1, -1):
        mine = np.fft.fft(points[::1] if sense == 1 else np.roll(points[::-1], 1, 0), axis=0)
        # sum over modes of |k| Re(there conj(mine e^{-ik turn})), for all turns at once
        match = np.fft.ifft((k[:, None] * there * mine.conj()).sum(1)).real
        # the first of equal ones; the given sense unless the other is better
        size = np.abs(k[:, None] * there * mine).sum()
        at = int(nearest_whole(match * len(match) / max(size * MARGIN, 1e-300)).argmax())
        if match[at] * len(match) > best[0] + MARGIN * size:
            best = (float(match[at]) * len(match), 2 * np.pi * at / n, sense)
    return best[1], best[2]


def _uneven(rim: Complexes, size: float) -> Complexes:
    """A rim (n,) of the chart with its vertices moved a little, the same way on every machine.

    Even ones lie on circles and lines, where four in a circle or an angle of just so many degrees are decided by
    rounding.
    """
    grid = grid_of(size)
    rim = rounded(rim.real, grid) + 1j * rounded(rim.imag, grid)
    step = np.minimum(np.abs(rim - np.roll(rim, 1)), np.abs(rim - np.roll(rim, -1)))
    share = np.stack([scattered(len(rim)), scattered(2 * len(rim))[len(rim) :]], 1) / 2.0**32 - 0.5
    return np.asarray(rim + CHART_UNEVEN * step * (share @ np.array([1, 1j])))


def _triangulated(kind: str, rims: Sequence[Complexes], parameters: Sequence[Floats]) -> Chart:
    size = max(float(np.abs(rim - rim[0]).max()) for rim in rims)
    corners = np.concatenate([_uneven(rim, size) for rim in rims])
    starts = np.cumsum([0, *map(len, rims)])
    edges = np.concatenate(
        [np.column_stack([np.arange(a, b), np.r_[np.arange(a + 1, b), a]]) for a, b in pairwise(starts)]
    )
    mesh = pythoncdt.Triangulation(
        pythoncdt.VertexInsertionOrder.AUTO, pythoncdt.IntersectingConstraintEdges.NOT_ALLOWED, 0.0
    )
    try:
        mesh.insert_vertices([pythoncdt.V2d(float(z.real), float(z.imag)) for z in corners])
        mesh.insert_edges([pythoncdt.Edge(a, b) for a, b in edges.tolist()])
        mesh.refine_triangles(
            MOST_VERTICES,
            pythoncdt.RefinementCriterion.SMALLEST_ANGLE,
            np.radians(CHART_ANGLE_MIN),
            mesh.collect_outer_triangles_and_holes(),
        )
        mesh.erase_outer_triangles_and_holes()
    except Exception as error:
        raise InputError(
            f"the boundary loops cannot be meshed: {error}", "check the loops for crossings", "loops"
        ) from None
    found = mesh.vertices_array()
    points = np.column_stack([found["x"], found["y"]])
    faces = mesh.triangles_array()["vertices"].astype(np.int64)
    used, faces = np.unique(faces, return_inverse=True)
    points, faces = points[used], faces.reshape(-1, 3)
    e = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), 1)
    keys, count = np.unique(e[:, 0] * len(points) + e[:, 1], return_counts=True)
    on_rim = np.unique(np.stack(np.divmod(keys[count == 1], len(points))))
    loop = np.full(len(points), -1)
    parameter = np.full(len(points), np.nan)
    # vertices on the rim lie on the loops' polygons: at their corners, or where refinement split an edge
    z = points[on_rim] @ np.array([1, 1j])
    a, b = corners[edges[:, 0]], corners[edges[:, 1]]
    share = np.clip(((z[:, None] - a) * (b - a).conj()).real / np.abs(b - a) ** 2, 0, 1)
    off = np.abs(z[:, None] - a - share * (b - a))
    edge = off.argmin(1)
    of_loop = np.searchsorted(starts, edges[edge, 0], side="right") - 1
    t = np.concatenate(parameters)
    start, end = t[edges[edge, 0]], t[edges[edge, 1]]
    loop[on_rim] = of_loop
    parameter[on_rim] = (start + ((end - start + 0.5) % 1 - 0.5) * share[np.arange(len(edge)), edge]) % 1
    return Chart(kind, points, faces, loop, parameter)
