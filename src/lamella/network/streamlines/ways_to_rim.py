"""What lets lines end that wind around: another normal curvature whose lines reach the rim, or a cut across them.

On a surface whose mean curvature varies few normal curvatures have lines everywhere that cross well; where none has, a
net of them would break off inside the surface, and is not offered. A cut along a line of the other family, from rim to
rim, is met by the lines that wind, by principal ones at a right angle.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from lamella.base.arrays import Floats
from lamella.base.ties import MARGIN
from lamella.network.charts.charts import Charts
from lamella.network.streamlines.direction_field import LineField
from lamella.network.streamlines.probing import HALF_LENGTH_MAX, SPACING_STEPS, probes, wound
from lamella.network.streamlines.streamlines import RIM, UNREAL, Streamlines, finished, joined, trace

# normal curvatures that are looked at: so many between the principal curvatures; those lines are offered that cross at
# no less than these degrees on all but this share of the area
LOOKED_AT, CROSSING, LEFT_OUT = 61, 30.0, 0.005
# of them are tried, those that cross best first
CURVATURES_TRIED_MAX = 4
# places spread over the surface through which cuts are tried, and lines that have to be cut
FINER_SAMPLES = 60
# of the polyline that describes a cut, and points of its course: whole multiples of that
CUT_SIDES_MAX, DENSE = 8, 64
# of the size: ends of lines that are as near to each other are at one umbilic
SAME_UMBILIC = 0.1
# on each loop
CUT_RIM_POINTS = 400


def reaching_curvature(charts: Charts, field: LineField, spacing: float, size: float) -> float | None:
    """A normal curvature, 1/m, whose lines cover the surface, cross well and end on the rim; None: none was found."""
    where, area = charts.samples()
    sample = charts.evaluate(where)
    half = np.abs(sample.deviator)
    lowest, highest = float((sample.mean - half).max()), float((sample.mean + half).min())
    if not lowest < highest:
        # no value lies between the principal curvatures everywhere
        return None
    values = {float(f"{value:.2g}") for value in [*np.linspace(lowest, highest, LOOKED_AT), 0.0]}
    choices = []
    for value in sorted(values):
        other = LineField(value, field.scale)
        sines = np.where(
            other.is_real(sample.mean, sample.deviator), other.crossing_sine(sample.mean, sample.deviator), 0.0
        )
        well = sines >= np.sin(np.radians(CROSSING))
        if area[~well].sum() <= LEFT_OUT * area.sum():
            choices.append((-np.rint(np.average(sines, weights=area) / MARGIN), abs(value), value))
    for _, _, value in sorted(choices)[:CURVATURES_TRIED_MAX]:
        few = probes(charts, LineField(value, field.scale), where, sample, spacing, size)
        if not few.endless.any() and (finished(few).ends == RIM).all():
            return value
    return None


@dataclass(frozen=True)
class Cut:
    """A line from rim to rim along which a surface is cut.

    Attributes
    ----------
    points : (n, 3)
        At equal lengths from its beginning to its end, m: as many as a polyline needs that follows it.
    divides : bool
        Whether it leaves two parts: on a surface without holes.
    """

    points: Floats
    divides: bool


def cut_across(charts: Charts, field: LineField, winding: Streamlines, spacing: float, size: float) -> Cut | None:
    """A line of the other family that crosses all lines that wind.

    Parameters
    ----------
    charts : Charts
    field : LineField
    winding : Streamlines
        Lines of `field` that do not end.
    spacing, size : float
        Of the net and of the surface, m.

    Returns
    -------
    Cut or None
        From one loop of the rim to another, the shortest one; on a surface without holes that with its ends farthest
        apart, which passes between the two umbilics that the lines go around, or through the one.
    """
    step, family = spacing / SPACING_STEPS, bool(winding.is_a[0])
    where, _ = charts.samples()
    sample = charts.evaluate(where)
    usable = np.flatnonzero(field.margin(sample.mean, sample.deviator) > 0)
    seeds = where[usable[np.unique(np.linspace(0, len(usable) - 1, FINER_SAMPLES).astype(np.int64))]]
    finer = wound(charts, field, seeds, np.full(len(seeds), family), spacing=spacing, size=size)
    winding = joined([winding, finer.take(np.flatnonzero(finer.endless))])
    trees = [cKDTree(winding.position[winding.half // 2 == k]) for k in range(winding.count)]
    lines = finished(
        trace(charts, field, seeds, np.full(len(seeds), not family), step=step, longest=HALF_LENGTH_MAX * size)
    )
    disc = charts.hole(1) is None
    courses = [_course(lines, k) for k in np.flatnonzero((lines.ends == RIM).reshape(-1, 2).all(1)).tolist()]
    if disc:
        courses += _through_umbilics(lines, SAME_UMBILIC * size)
        worth = [-float(np.linalg.norm(course[-1] - course[0])) for course in courses]
    else:
        rim = cKDTree(charts.evaluate(charts.rim_points(CUT_RIM_POINTS)).position)
        loop = charts.rim_places(charts.rim_points(CUT_RIM_POINTS)).loop
        ends = [loop[rim.query(course[[0, -1]])[1]] for course in courses]
        courses = [course for course, (first, last) in zip(courses, ends, strict=True) if first != last]
        worth = [float(np.linalg.norm(np.diff(course, axis=0), axis=1).sum()) for course in courses]
    # of equally good ones on a symmetric surface the first
    for k in np.argsort(np.rint(np.array(worth) / (MARGIN * size)), kind="stable").tolist():
        if all(tree.query(courses[k])[0].min() < step for tree in trees):
            return Cut(_polyline(courses[k], spacing / 2), disc)
    return None


def _course(lines: Streamlines, line: int) -> Floats:
    """Points (n, 3) at equal lengths along a line, closer together than the steps it was traced by."""
    count = np.count_nonzero(lines.half // 2 == line) + DENSE
    s = np.linspace(0, 1, count - count % DENSE + 1) * lines.lengths[line]
    return lines.at(np.full(len(s), line), s)[1].position


def _through_umbilics(lines: Streamlines, near: float) -> list[Floats]:
    """From rim to rim by two lines that end at one umbilic, of which nothing else is known than that they end there."""
    ends = lines.ends.reshape(-1, 2)
    found = []
    for k in np.flatnonzero((ends == RIM).any(1) & (ends == UNREAL).any(1)).tolist():
        course = _course(lines, k)
        found.append(course if ends[k, 0] == RIM else course[::-1])
    joint: list[Floats] = []
    for course in found:
        others = [other for other in found if np.linalg.norm(other[-1] - course[-1]) < near]
        opposite = max(others, key=lambda other: float(np.linalg.norm(other[0] - course[0])))
        both = np.vstack([course, opposite[::-1]])
        t = np.linspace(0, len(both) - 1, 4 * DENSE + 1)
        joint.append(np.column_stack([np.interp(t, np.arange(len(both)), x) for x in both.T]))
    return joint


def _polyline(course: Floats, off: float) -> Floats:
    """Some of the points of a course, evenly, so that the polyline through them is off by no more than that, m."""
    share = np.arange(len(course)) / (len(course) - 1)
    count = 2
    while True:
        points: Floats = course[:: (len(course) - 1) // count]
        through = np.column_stack([np.interp(share * count, np.arange(count + 1), x) for x in points.T])
        if np.linalg.norm(course - through, axis=1).max() <= off or count == CUT_SIDES_MAX:
            return points
        count *= 2
