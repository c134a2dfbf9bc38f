"""Lines of a field of directions on a surface, all of them a step at a time.

The lines solve dx/ds = t(x) by the classical Runge-Kutta method of order four in local coordinates. A line consists of
two halves that leave its seed in opposite senses. The state before every step is kept: a point anywhere on a line is
one more step, a shorter one, from the last state before it, and as exact as the line itself.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.network.charts.charts import Charts, ChartSample
from lamella.network.streamlines.direction_field import LineField
from lamella.surface.element.places import Places

RIM, UNREAL, ENDLESS = range(3)
"""How a half ends: on the rim, where its direction stops being real, or not: it comes back, or gets too long."""

TRACE_STEPS_MAX = 20_000
# halvings of the step in which a line ends: rounding is left
TRACE_HALVINGS = 46
# turn of a line in a step, rad; steps are halved for it up to so often: at an umbilic no step is short enough
MOST_TURN, MOST_HALVED = 0.1, 8
# a half comes back where it passes its seed in its own sense, cosine of the angle between at least, after it was this
# many times farther away
SAME_SENSE, AWAY = 0.5, 4.0
# of the way on which directions would stop being real if they went on as in the last step; least step over the longest
APPROACH, SLOWEST = 0.5, 8


@dataclass(frozen=True)
class Streamlines:
    """Lines through seeds; half 2 k leaves seed k against its direction, half 2 k + 1 along it.

    Attributes
    ----------
    is_a : (m,) bool
        Family of each line.
    length : (2 m,)
        Of each half, m.
    ends : (2 m,) int
        `RIM`, `UNREAL` or `ENDLESS`.
    tail : (2 m,)
        Step beyond `length` within which a half ends, m: see `finished`.
    half : (k,) int
        Half of each kept state, in order.
    way : (k,)
        Arc length of the state from the seed, m.
    where : Places
    tangent, position : (k, 3)
        Unit tangents outwards from the seed; m.
    """

    charts: Charts
    field: LineField
    is_a: Booleans
    length: Floats
    ends: Integers
    tail: Floats
    half: Integers
    way: Floats
    where: Places
    tangent: Floats
    position: Floats

    @property
    def count(self) -> int:
        """Number of lines."""
        return len(self.is_a)

    @property
    def lengths(self) -> Floats:
        """Of the lines, m, (m,)."""
        return np.asarray(self.length[::2] + self.length[1::2])

    @property
    def endless(self) -> Booleans:
        """Lines that do not end, (m,): those that end have the step in which they do, or are finished."""
        return np.asarray(((self.ends == ENDLESS) & (self.tail == 0)).reshape(-1, 2).any(1))

    def at(self, line: Integers, s: Floats) -> tuple[Places, ChartSample, Floats]:
        """Places, what is seen there, and unit tangents (n, 3), at arc lengths s (n,) from the starts of lines (n,)."""
        back = self.length[2 * line]
        forward = s >= back
        half = 2 * line + forward
        way = np.clip(np.abs(s - back), 0, self.length[half])
        state = _last_before(self.half, self.way, half, way)
        rest = way - self.way[state]
        start = self.where[state]
        moved = _step(self.charts, self.field, start, self.tangent[state], self.is_a[line], rest)
        where = self.charts.settle(moved)
        sample = self.charts.evaluate(where)
        tangent = _tangent(self.field, sample, self.is_a[line], self.tangent[state])
        return where, sample, np.where(forward, 1.0, -1.0)[:, None] * tangent

    def take(self, lines: Integers) -> Streamlines:
        """Some of the lines, in a given order."""
        halves = np.column_stack([2 * lines, 2 * lines + 1]).ravel()
        first, last = (np.searchsorted(self.half, halves, side=side) for side in ("left", "right"))
        count = last - first
        state = np.repeat(first - np.cumsum(count) + count, count) + np.arange(count.sum())
        return Streamlines(
            self.charts,
            self.field,
            self.is_a[lines],
            self.length[halves],
            self.ends[halves],
            self.tail[halves],
            np.repeat(np.arange(len(halves)), count),
            self.way[state],
            self.where[state],
            self.tangent[state],
            self.position[state],
        )


def joined(line_sets: list[Streamlines]) -> Streamlines:
    """Lines of several flows on one surface, one after the other."""
    first = line_sets[0]
    offsets = np.cumsum([0, *[2 * streamlines.count for streamlines in line_sets[:-1]]])
    element, local, tangent, position, way, half = (
        np.concatenate(parts)
        for parts in zip(
            *(
                (f.where.element, f.where.local, f.tangent, f.position, f.way, f.half + offset)
                for f, offset in zip(line_sets, offsets.tolist(), strict=True)
            ),
            strict=True,
        )
    )
    is_a, length, ends, tail = (
        np.concatenate(parts) for parts in zip(*((f.is_a, f.length, f.ends, f.tail) for f in line_sets), strict=True)
    )
    return Streamlines(
        first.charts, first.field, is_a, length, ends, tail, half, way, Places(element, local), tangent, position
    )


def trace(
    charts: Charts,
    field: LineField,
    seeds: Places,
    is_a: Booleans,
    *,
    step: float,
    longest: float,
    beside: float = 0.0,
) -> Streamlines:
    """Trace lines both ways from seeds, up to the step in which they end (see `finished`).

    Parameters
    ----------
    charts : Charts
    field : LineField
    seeds : Places
        (m,) places.
    is_a : (m,) bool
        Family of each line.
    step : float
        Longest step, m.
    longest : float
        Length of a half at which it is given up, m.
    beside : float
        Distance from its seed within which a half has come back and is given up, m.
    """
    m = len(seeds)
    line = np.repeat(np.arange(m), 2)
    family = is_a[line]
    where = seeds[line]
    sample = charts.evaluate(where)
    outwards = np.tile([-1.0, 1.0], m)[:, None]
    heading = field.heading(sample.mean, sample.deviator, family)
    tangent = outwards * (heading.real[:, None] * sample.e_u + heading.imag[:, None] * sample.e_v)
    origin, sense, away = sample.position, tangent, np.zeros(2 * m, bool)
    way, length, tail = np.zeros(2 * m), np.zeros(2 * m), np.zeros(2 * m)
    ends = np.full(2 * m, ENDLESS)
    left = np.arange(2 * m)
    kept: list[tuple[Integers, Floats, Places, Floats, Floats]] = []
    margin, most = field.margin(sample.mean, sample.deviator), np.full(2 * m, step / SLOWEST)
    for _ in range(TRACE_STEPS_MAX):
        velocity = _velocity(field, sample, family[left], tangent)
        ds = _step_length(charts, where, sample, velocity, np.minimum(most, step))
        kept.append((left, way, where, tangent, sample.position))
        ahead, seen, ds = _gentle_step(charts, field, where, tangent, family[left], ds, velocity)
        before, margin = margin, field.margin(seen.mean, seen.deviator)
        # a step must not pass over a place without directions, around a flat point for instance
        fall = np.maximum(before - margin, 1e-300) / ds
        most = np.maximum(APPROACH * margin / fall, step / SLOWEST)
        on = (charts.gap(ahead) >= 0) & (margin >= 0)
        length[left], tail[left[~on]] = way, ds[~on]
        tangent = _tangent(field, seen, family[left], tangent)
        back = away[left] & (_from_chord(origin[left], sample.position, seen.position) < beside)
        on &= (way + ds < longest) & ~(back & ((tangent * sense[left]).sum(1) > SAME_SENSE))
        away[left] |= np.linalg.norm(seen.position - origin[left], axis=1) > AWAY * beside
        tangent = tangent[on]
        left, way, where, sample = left[on], (way + ds)[on], ahead[on], seen.take(on)
        margin, most = margin[on], most[on]
        if not len(left):
            break
    length[left] = way
    return Streamlines(charts, field, is_a, length, ends, tail, *_by_half(kept))


def _step_length(charts: Charts, where: Places, sample: ChartSample, velocity: Floats, most: Floats) -> Floats:
    """Steps (n,), m, within the chart, over which a line turns little: the principal curvatures bound its turning."""
    bend = np.abs(sample.mean) + np.abs(sample.deviator)
    within = charts.reach(where) / np.linalg.norm(velocity, axis=1)
    return np.asarray(np.minimum(np.minimum(within, most), MOST_TURN / np.maximum(bend, 1e-300)))


def _by_half(
    kept: list[tuple[Integers, Floats, Places, Floats, Floats]],
) -> tuple[Integers, Floats, Places, Floats, Floats]:
    """Half, way, place, tangent and position of all steps, those of a half one after the other."""
    half, ways, element, local, tangents, positions = (
        np.concatenate(parts)
        for parts in zip(*((h, w, p.element, p.local, t, x) for h, w, p, t, x in kept), strict=True)
    )
    order = np.argsort(half, kind="stable")
    places = Places(element[order], local[order])
    return half[order], ways[order], places, tangents[order], positions[order]


def _gentle_step(
    charts: Charts,
    field: LineField,
    start: Places,
    tangent: Floats,
    is_a: Booleans,
    ds: Floats,
    first: Floats,
) -> tuple[Places, ChartSample, Floats]:
    """Places a step further on, what is seen there, and the steps, m, (n,), in which lines turn by `MOST_TURN` or less.

    Next to umbilics lines turn within the surface, by far more than its curvatures tell.
    """
    ahead = charts.settle(_step(charts, field, start, tangent, is_a, ds, first))
    seen, ds = charts.evaluate(ahead), ds.copy()
    again = np.arange(len(ds))
    for _ in range(MOST_HALVED):
        onwards = _tangent(field, seen.take(again), is_a[again], tangent[again])
        turned = (onwards * tangent[again]).sum(1) < np.cos(MOST_TURN)
        again = again[turned & (charts.gap(ahead[again]) >= 0)]
        if not len(again):
            break
        ds[again] /= 2
        near = charts.settle(_step(charts, field, start[again], tangent[again], is_a[again], ds[again], first[again]))
        ahead.element[again], ahead.local[again] = near.element, near.local
        for part, value in zip(seen, charts.evaluate(near), strict=True):
            part[again] = value
    return ahead, seen, ds


def _from_chord(points: Floats, begin: Floats, end: Floats) -> Floats:
    """Distances of points from chords, m, (n,); all (n, 3)."""
    chord, off = end - begin, points - begin
    square = np.maximum((chord**2).sum(1), 1e-300)
    share = np.clip((off * chord).sum(1) / square, 0, 1)
    return np.asarray(np.linalg.norm(off - share[:, None] * chord, axis=1))


def finished(streamlines: Streamlines) -> Streamlines:
    """The lines up to where they leave the surface or the field, found by halving the step in which they do."""
    charts, field = streamlines.charts, streamlines.field
    half = np.flatnonzero(streamlines.tail > 0)
    if not len(half):
        return streamlines
    state = np.searchsorted(streamlines.half, half, side="right") - 1
    start, tangent, is_a = streamlines.where[state], streamlines.tangent[state], streamlines.is_a[half // 2]
    inside, outside = np.zeros(len(half)), streamlines.tail[half]
    by_rim = np.zeros(len(half), bool)
    for number in range(TRACE_HALVINGS):
        # the whole step first, which is known to leave
        middle = (inside + outside) / 2 if number else outside
        there = charts.settle(_step(charts, field, start, tangent, is_a, middle))
        seen = charts.evaluate(there)
        beyond = charts.gap(there) < 0
        off = beyond | (field.margin(seen.mean, seen.deviator) < 0)
        by_rim = np.where(off, beyond, by_rim)
        inside, outside = np.where(off, inside, middle), np.where(off, middle, outside)
    length, ends = streamlines.length.copy(), streamlines.ends.copy()
    length[half] += inside
    ends[half] = np.where(by_rim, RIM, UNREAL)
    return replace(streamlines, length=length, ends=ends, tail=np.zeros(len(length)))


def _velocity(field: LineField, sample: ChartSample, is_a: Booleans, onwards: Floats) -> Floats:
    """d(x, y) / ds of lines that go on along tangents nearby, (n, 2)."""
    heading = field.heading(sample.mean, sample.deviator, is_a)
    along = heading.real * (sample.e_u * onwards).sum(1) + heading.imag * (sample.e_v * onwards).sum(1)
    heading = np.where(along < 0, -heading, heading)
    components = np.stack([heading.real, heading.imag], 1)[:, :, None]
    return np.asarray(np.matmul(sample.to_local, components)[:, :, 0])


def _tangent(field: LineField, sample: ChartSample, is_a: Booleans, onwards: Floats) -> Floats:
    """Unit tangents of lines that go on along tangents nearby, (n, 3)."""
    heading = field.heading(sample.mean, sample.deviator, is_a)
    tangent = heading.real[:, None] * sample.e_u + heading.imag[:, None] * sample.e_v
    return np.asarray(np.where((tangent * onwards).sum(1) < 0, -1.0, 1.0)[:, None] * tangent)


def _step(
    charts: Charts,
    field: LineField,
    start: Places,
    onwards: Floats,
    is_a: Booleans,
    ds: Floats,
    first: Floats | None = None,
) -> Places:
    """Places arc lengths ds (n,) further on, in the charts of their starts; `first`: d(x, y) / ds there, if known."""

    def rate(local: Floats) -> Floats:
        return _velocity(field, charts.evaluate(Places(start.element, local)), is_a, onwards)

    h, x = ds[:, None], start.local
    k1 = rate(x) if first is None else first
    k2 = rate(x + h / 2 * k1)
    k3 = rate(x + h / 2 * k2)
    k4 = rate(x + h * k3)
    return Places(start.element, x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4))


def _last_before(halves: Integers, ways: Floats, half: Integers, way: Floats) -> Integers:
    """The last kept state at or before given ways along halves."""
    # halves in order, and ways along each: one key for both
    stride = 2 * max(float(ways.max(initial=0.0)), float(way.max(initial=0.0)), 1e-300)
    state = np.searchsorted(halves * stride + ways, half * stride + way, side="right") - 1
    return np.clip(state, np.searchsorted(halves, half), np.searchsorted(halves, half, side="right") - 1)
