"""Cubic B-splines through densely sampled curves, with no more control points than a tolerance needs.

Many curves at once: their equations are one tridiagonal system in which they do not meet.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import BSpline
from scipy.linalg import solve_banded

from lamella.base.arrays import Floats, Integers
from lamella.base.ragged import ragged_ranges

DEGREE = 3
SPLINE_TOLERANCE = 1e-7
"""Largest distance of a written curve from its samples, as a share of the curve's length."""

COARSEST = 16
# samples of curves that are worked on together
TOGETHER = 16_000


@dataclass(frozen=True)
class Spline:
    """A clamped cubic B-spline.

    Attributes
    ----------
    knots : (n + 4,)
        Knots, the end ones four times.
    controls : (n, d)
        Control points.
    """

    knots: Floats
    controls: Floats


@dataclass(frozen=True)
class _Curves:
    """Sampled curves, see `fit_splines`; `places` are parameters from the start of each curve, (k,)."""

    first: Integers
    last: Integers
    places: Floats
    values: Floats
    ends: Floats

    def take(self, some: Integers) -> _Curves:
        """Some of the curves."""
        return _Curves(self.first[some], self.last[some], self.places, self.values, self.ends[some])


def fit_splines(
    parameters: Floats, values: Floats, spans: Integers, ends: Floats, tolerances: Floats
) -> Iterator[Spline]:
    """Interpolate every s-th sample of each curve, with the largest power of two s that keeps all of them in tolerance.

    Parameters
    ----------
    parameters : (k,)
        Increasing along each curve; arc lengths of the samples, say. A spline's begin with 0.
    values : (k, d)
        Samples; for d = 6 two curves of three coordinates each, which then share their knots.
    spans : (m, 2) int
        First sample of each curve, and the one after its last; two samples at least.
    ends : (m, 2, d)
        Derivatives by the parameter at the first and the last sample.
    tolerances : (m,)
        Largest difference in any coordinate at the samples left out.

    Yields
    ------
    Spline
        Of one curve after the other. Passes through first and last sample exactly and through the others within the
        tolerance.
    """
    counts = np.diff(spans, axis=1)[:, 0]
    group = (np.cumsum(counts) - counts) // TOGETHER
    for number in np.unique(group).tolist():
        some = np.flatnonzero(group == number)
        first, last = spans[some, 0], counts[some] - 1
        samples = _indices(first, counts[some])
        own = np.r_[0, np.cumsum(counts[some])[:-1]]
        places = parameters[samples] - np.repeat(parameters[first], counts[some])
        yield from _fitted(_Curves(own, last, places, values[samples], ends[some]), tolerances[some])


def _fitted(curves: _Curves, tolerances: Floats) -> list[Spline]:
    # the largest power of two up to the number of pieces
    stride = np.minimum(COARSEST, 1 << (np.frexp(curves.last)[1] - 1).astype(np.int64))
    fitted: dict[int, Spline] = {}
    left = np.arange(len(stride))
    while len(left):
        splines = _Splines(curves.take(left), stride[left])
        error, most = splines.errors(), tolerances[left]
        done = (stride[left] == 1) | (error <= most)
        for place in np.flatnonzero(done).tolist():
            fitted[int(left[place])] = splines.one(place)
        left, error, most = left[~done], error[~done], most[~done]
        # the error falls with the fourth power of the stride; aim a little below the tolerance
        steps = np.ceil(np.log2(1.25 * error / most) / 4).astype(np.int64)
        stride[left] = np.maximum(1, stride[left] >> np.maximum(1, steps))
    return [fitted[k] for k in range(len(stride))]


class _Splines:
    """Splines through every so many samples of curves, the knots of each one behind the other's.

    A curve of n pieces has n + 1 sites, n + 7 knots and n + 3 control points, behind which four are left unused.
    """

    def __init__(self, curves: _Curves, stride: Integers) -> None:
        self.curves = curves
        self.pieces = pieces = -(-curves.last // stride)
        site = ragged_ranges(pieces + 1)
        of = np.repeat(np.arange(len(pieces)), pieces + 1)
        self.kept = np.rint(site * (curves.last / pieces)[of]).astype(np.int64)
        ends = np.cumsum(pieces + 1)
        self.kept[ends - 1] = curves.last
        sites = curves.places[curves.first[of] + self.kept]
        knot = ragged_ranges(pieces + 7)
        of_knot = np.repeat(np.arange(len(pieces)), pieces + 7)
        self.knots = sites[(ends - pieces - 1)[of_knot] + np.clip(knot - DEGREE, 0, pieces[of_knot])]
        self.begin = np.cumsum(pieces + 7) - pieces - 7
        self.controls = self._solved(site, of)

    def one(self, place: int) -> Spline:
        """The spline of a curve."""
        pieces, begin = self.pieces[place], self.begin[place]
        return Spline(self.knots[begin : begin + pieces + 7], self.controls[begin : begin + pieces + 3])

    def errors(self) -> Floats:
        """Largest difference in any coordinate at the samples of each curve, (m,)."""
        curves = self.curves
        # one spline of them all, each a way behind the one before; its end, which is exact, would be the next one's
        lengths = curves.places[curves.first + curves.last]
        shifts = np.cumsum(lengths + 1) - (lengths + 1)
        whole = BSpline.construct_fast(self.knots + np.repeat(shifts, self.pieces + 7), self.controls, DEGREE)
        samples = _indices(curves.first, curves.last)
        off = whole(curves.places[samples] + np.repeat(shifts, curves.last))
        off -= curves.values.take(samples, 0)
        largest = np.abs(off, out=off).max(1)
        return np.asarray(np.maximum.reduceat(largest, np.cumsum(curves.last) - curves.last))

    def _solved(self, site: Integers, of: Integers) -> Floats:
        """Control points, (sum of n + 7, d), of splines through the sites with given derivatives at the ends."""
        curves, pieces, knots = self.curves, self.pieces, self.knots
        values = curves.values[curves.first[of] + self.kept]
        controls = np.zeros((len(knots), values.shape[1]))
        start, end = self.begin, self.begin + pieces + 2
        first, last = self.begin + DEGREE, self.begin + DEGREE + pieces
        controls[start] = curves.values[curves.first]
        controls[end] = curves.values[curves.first + curves.last]
        controls[start + 1] = controls[start] + curves.ends[:, 0] * ((knots[first + 1] - knots[first]) / 3)[:, None]
        controls[end - 1] = controls[end] - curves.ends[:, 1] * ((knots[last] - knots[last - 1]) / 3)[:, None]
        inner = np.flatnonzero((site > 0) & (site < pieces[of]))
        if not len(inner):
            return controls
        of, site = of[inner], site[inner]
        base = self.begin[of] + site + DEGREE
        two_back, back, own, ahead, two_ahead = (knots[base + k] for k in range(-2, 3))
        # the three cubic basis functions that are not zero at a knot
        below = (ahead - own) ** 2 / ((ahead - two_back) * (ahead - back))
        above = (own - back) ** 2 / ((two_ahead - back) * (ahead - back))
        diagonals = np.stack((np.zeros(len(inner)), 1 - below - above, np.zeros(len(inner))))
        right = values[inner].copy()
        begins, stops = site == 1, site == pieces[of] - 1
        right[begins] -= below[begins, None] * controls[start[of[begins]] + 1]
        right[stops] -= above[stops, None] * controls[end[of[stops]] - 1]
        diagonals[0, 1:] = np.where(stops, 0.0, above)[:-1]
        diagonals[2, :-1] = np.where(begins, 0.0, below)[1:]
        controls[start[of] + site + 1] = solve_banded((1, 1), diagonals, right, check_finite=False)
        return controls


def _indices(first: Integers, count: Integers) -> Integers:
    """Indices first, first + 1, ... of so many items each."""
    return np.asarray(np.repeat(first, count) + ragged_ranges(count), np.int64)
