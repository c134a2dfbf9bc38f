"""Seeds of lines: evenly spaced, by arc length along guides.

A guide of a simply connected surface is a line of the other family through the middle of the surface: its lamella has
nodes at equal distances. Where there is a hole, the guide of both families is the rim of the first one, so that the net
closes around it. Where no line passes within a spacing (two lines have drawn apart by two, or no guide is crossed
there), a line of the other family through the widest gap is a further guide.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.errors import InputError
from lamella.base.ragged import ragged_ranges
from lamella.base.ties import MARGIN, nearest_whole
from lamella.network.charts.charts import Charts, ChartSample
from lamella.network.streamlines.direction_field import LineField
from lamella.network.streamlines.probing import HALF_LENGTH_MAX, wound
from lamella.network.streamlines.streamlines import Streamlines, finished, joined, trace
from lamella.surface.element.places import Places

# share of the seeds around a hole that must have directions, and sine of the angle to the rim they must have
SEEDING_AROUND, ACROSS = 0.98, 0.17
# of the spacing across: a line passes this near to a seed that is not used then, and no nearer than this to a gap
CLOSE, GAP_WIDTH = 0.6, 1.0
SEEDING_ROUNDS_MAX = 60
# gaps filled at once, and how far apart they are, in spacings
MOST_GAPS, GAPS_APART = 24, 4.0
# points of the rim that tell how deep inside a place is
SEEDING_RIM_POINTS = 200
# of the size: what a place loses for being this far from the middle
OFF_MIDDLE = 0.25


@dataclass(frozen=True)
class Guide:
    """Where the seeds are counted.

    Attributes
    ----------
    around_hole : bool
        Whether it is the rim of the first hole; else lines through the middle.
    where : Places
        Seeds (m,) around the hole, or the middle (1,).
    length : float
        Around the hole, or of the longer one of the two lines through the middle, m.
    share : float
        Node distance over distance along the guide.
    """

    around_hole: bool
    where: Places
    length: float
    share: float


def choose_guide(charts: Charts, field: LineField, size: float) -> Guide:
    """The first guide of a surface, whose size is the diagonal of its bounding box (m)."""
    hole = charts.hole(SEEDING_RIM_POINTS)
    if hole is not None:
        where, length = hole
        sample = charts.evaluate(where)
        usable = field.margin(sample.mean, sample.deviator) > 0
        sines = _sines_to_rim(charts, field, where, sample)
        if usable.mean() >= SEEDING_AROUND and np.median(sines) > ACROSS:
            crossing = field.crossing_sine(sample.mean, sample.deviator)
            return Guide(True, where, length, float(np.median((sines / crossing)[usable])))
    middle = _middle(charts, field, size)
    twice, families = middle[np.zeros(2, np.int64)], np.array([True, False])
    lines = finished(trace(charts, field, twice, families, step=size / 50, longest=HALF_LENGTH_MAX * size))
    return Guide(False, middle, float(lines.lengths.max()), 1.0)


def _sines_to_rim(charts: Charts, field: LineField, where: Places, sample: ChartSample) -> Floats:
    """Sine of the angle between the rim and the nearer of the two families, (n,)."""
    rim = charts.rim_places(where).tangent
    sines = []
    for family in (True, False):
        heading = field.heading(sample.mean, sample.deviator, np.full(len(where), family))
        tangent = heading.real[:, None] * sample.e_u + heading.imag[:, None] * sample.e_v
        sines.append(np.sqrt(np.maximum(1 - (tangent * rim).sum(1) ** 2, 0)))
    return np.asarray(np.minimum(*sines))


def _middle(charts: Charts, field: LineField, size: float) -> Places:
    """The sample deepest inside of where the directions are, of those as deep the one nearest to the middle."""
    where, area = charts.samples()
    sample = charts.evaluate(where)
    usable = field.margin(sample.mean, sample.deviator) > 0
    rim = charts.evaluate(charts.rim_points(SEEDING_RIM_POINTS)).position
    tree = cKDTree(np.concatenate([rim, sample.position[~usable]]))
    depth = tree.query(sample.position)[0]
    centre = (sample.position[usable] * area[usable, None]).sum(0) / area[usable].sum()
    off = np.linalg.norm(sample.position - centre, axis=1) / size
    score = np.where(usable, depth / depth[usable].max() - off / OFF_MIDDLE, -np.inf)
    # of equally good ones on a symmetric surface the first
    return where[np.array([np.rint(score / MARGIN).argmax()])]


@dataclass(frozen=True)
class Seeded:
    """Lines from even seeds.

    Attributes
    ----------
    streamlines : Streamlines
        A before B.
    guides : int
        How many guides they took, over both families.
    count : int
        Seeds of a family on the first guide.
    """

    streamlines: Streamlines
    guides: int
    count: int


def seeded_lines(charts: Charts, field: LineField, guide: Guide, distance: float, size: float) -> Seeded:
    """Lines of both families.

    Parameters
    ----------
    charts : Charts
    field : LineField
    guide : Guide
    distance : float
        Of seeds along the first guide, m; around a hole the nearest whole number of them is taken.
    size : float
        Of the surface, m.
    """
    spacing = distance * guide.share
    how = _How(charts, field, spacing, size)
    both = np.array([True, False])
    if guide.around_hole:
        count = max(round(guide.length / distance), 3)
        around = charts.hole(count)
        assert around is not None
        index = np.tile(np.arange(count), 2)
        lines = how.accepted(around[0][index], np.repeat(both, count), None)
    else:
        seeds, family = how.along(guide.where[np.zeros(2, np.int64)], both, distance, centred=True)
        lines = how.accepted(seeds, family, None)
        count = int(max(family.sum(), (~family).sum()))
    guides = 1 if guide.around_hole else 2
    samples, _ = charts.samples()
    sample = charts.evaluate(samples)
    usable = field.margin(sample.mean, sample.deviator) > 0
    samples, position = samples[usable], sample.position[usable]
    across = spacing * field.crossing_sine(sample.mean, sample.deviator)[usable]
    for _ in range(SEEDING_ROUNDS_MAX):
        # lines that do not end are refused: more of them tell nothing
        if lines is None or lines.endless.any():
            break
        gaps = [
            _gaps(position, how.distances(position, lines, one) / across, GAPS_APART * spacing) for one in (True, False)
        ]
        found = np.concatenate(gaps)
        if not len(found):
            break
        seeds, family = how.along(samples[found], np.repeat(both, [len(gap) for gap in gaps]), spacing)
        more = how.accepted(seeds, family, lines)
        if more is None:
            break
        lines = joined([lines, more])
        guides += len(found)
    if lines is None:
        raise InputError(
            "no line could be traced on this surface", "choose another normal_curvature", "normal_curvature"
        )
    return Seeded(finished(lines.take(np.argsort(~lines.is_a, kind="stable"))), guides, count)


def _gaps(position: Floats, wide: Floats, apart: float) -> Integers:
    """The widest gaps, away from each other: rows of points (n, 3) whose share of a gap is above `GAP_WIDTH`."""
    chosen: list[int] = []
    # of gaps as wide as each other on a symmetric surface the first
    wide = np.rint(wide / MARGIN)
    left = np.flatnonzero(wide > GAP_WIDTH / MARGIN)
    while len(left) and len(chosen) < MOST_GAPS:
        row = left[wide[left].argmax()]
        chosen.append(int(row))
        left = left[np.linalg.norm(position[left] - position[row], axis=1) > apart]
    return np.array(chosen, np.int64)


@dataclass(frozen=True)
class _How:
    """How lines are traced and kept apart."""

    charts: Charts
    field: LineField
    spacing: float
    size: float

    def lines(self, seeds: Places, is_a: Booleans) -> Streamlines:
        return wound(self.charts, self.field, seeds, is_a, spacing=self.spacing, size=self.size)

    def along(
        self, places: Places, is_a: Booleans, distance: float, *, centred: bool = False
    ) -> tuple[Places, Booleans]:
        """Seeds of families on lines of the other ones through places, from these outwards on both sides.

        Centred ones leave the same rest at both ends of a line, a quarter to three quarters of a distance, instead.
        """
        guides = finished(self.lines(places, ~is_a))
        back, ahead = guides.length.reshape(-1, 2).T
        if centred:
            count = np.maximum(nearest_whole((back + ahead) / distance), 1).astype(np.int64)
            first = (back + ahead - (count - 1) * distance) / 2
            middle = (back + ahead) / 2
        else:
            before = np.floor(back / distance + MARGIN).astype(np.int64)
            count = before + np.floor(ahead / distance + MARGIN).astype(np.int64) + 1
            first, middle = back - before * distance, back
        guide = np.repeat(np.arange(len(places)), count)
        s = first[guide] + ragged_ranges(count) * distance
        # seeds on both sides are as far away as each other
        order = np.lexsort((np.rint(np.abs(s - middle[guide]) / (MARGIN * distance)), guide))
        guide, s = guide[order], s[order]
        where, _, _ = guides.at(guide, s)
        return where, is_a[guide]

    def accepted(self, seeds: Places, is_a: Booleans, others: Streamlines | None) -> Streamlines | None:
        """Lines from those seeds that no line of an earlier one, nor another line, of their family passes close by."""
        sample = self.charts.evaluate(seeds)
        near = CLOSE * self.spacing * self.field.crossing_sine(sample.mean, sample.deviator)
        usable = self.field.margin(sample.mean, sample.deviator) > 0
        if others is not None:
            for one in (True, False):
                usable &= (is_a != one) | (self.distances(sample.position, others, one) >= near)
        if not usable.any():
            return None
        is_a, near, position = is_a[usable], near[usable], sample.position[usable]
        lines = self.lines(seeds[usable], is_a)
        kept = np.zeros(len(is_a), bool)
        for one in (True, False):
            # which lines pass by which seeds
            points, owner = _dense(lines, one)
            mine = np.flatnonzero(is_a == one)
            if not len(mine):
                continue
            passing = cKDTree(points).query_ball_point(position[mine], near[mine])
            for k, close in zip(mine.tolist(), passing, strict=True):
                kept[k] = not kept[owner[np.asarray(close, np.int64)]].any()
        return lines.take(np.flatnonzero(kept))

    def distances(self, points: Floats, lines: Streamlines, is_a: bool) -> Floats:
        """Distances of points from the lines of a family, m, (n,)."""
        dense, _ = _dense(lines, is_a)
        if not len(dense):
            return np.full(len(points), np.inf)
        return np.asarray(cKDTree(dense).query(points)[0])


def _dense(lines: Streamlines, is_a: bool) -> tuple[Floats, Integers]:
    """Points along the lines of a family, a step from each other, and the line of each."""
    line = lines.half // 2
    mine = lines.is_a[line] == is_a
    return lines.position[mine], line[mine]
