"""Derivatives along sampled curves on a surface: geodesic curvature, and the change of the geodesic torsion."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.vectors import dots
from lamella.surface.darboux import Darboux

# samples to either side over which a lamella turns by its geodesic curvature: the kinks at elements average out
STENCIL_WIDTH = 3
# of the distance of the outer samples: how far the middle one may be off the middle of them
STENCIL_EVEN = 0.1


def turning(tangents: Floats, sideways: Floats, arclengths: Floats, offsets: Integers, closed: Booleans) -> Floats:
    """kg = t' . u at the samples of curves, 1/m, (k,): of second order in their distance, at a curve's ends too.

    Parameters
    ----------
    tangents, sideways : (k, 3)
        Unit t and u = n x t.
    arclengths, offsets, closed
        See `derivative`.
    """
    return np.asarray(dots(derivative(tangents, arclengths, offsets, closed), sideways))


def derivative(
    values: Floats, arclengths: Floats, offsets: Integers, closed: Booleans, at: Integers | None = None
) -> Floats:
    """Derivatives by the arc length of values along curves, (k, c): of second order in the samples' distance.

    That of the parabola through three samples: this one and those about `STENCIL_WIDTH` to either side of it; next to
    an end the end itself and those once and twice as far away.

    Parameters
    ----------
    values : (k, c)
    arclengths : (k,)
        From each curve's start, m.
    offsets : (m + 1,) int
        Where each curve's samples begin.
    closed : (m,) bool
        Curves that go on from their last sample, which is the first one once more, to the second.
    at : (s,) int, optional
        Samples at which they are wanted; all when not given.

    Returns
    -------
    (s, c)
    """
    if not len(arclengths):
        return np.zeros_like(values)
    owner, middle = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets)), np.arange(len(arclengths))
    if at is not None:
        owner, middle = owner[at], at.copy()
    begin, end, own = offsets[owner], offsets[owner + 1] - 1, arclengths[middle]
    before, after = np.maximum(middle - STENCIL_WIDTH, begin), np.minimum(middle + STENCIL_WIDTH, end)
    a, c = arclengths[before], arclengths[after]
    even = (after - before == 2 * STENCIL_WIDTH) & (np.abs(a + c - 2 * own) < STENCIL_EVEN * (c - a))
    uneven = np.flatnonzero(~even)
    curve = owner[uneven]
    three = _three(arclengths, offsets, middle[uneven], curve, closed[curve])
    before[uneven], middle[uneven], after[uneven] = three.samples
    a, b, c = (arclengths[k] for k in (before, middle, after))
    a[uneven], b[uneven], c[uneven] = three.places
    v_a, v_b, v_c = (values.take(k, 0) for k in (before, middle, after))
    first, second = (v_b - v_a) / (b - a)[:, None], (v_c - v_b) / (c - b)[:, None]
    # Newton's form of the parabola through (a, v_a), (b, v_b), (c, v_c), derived
    return np.asarray(first + (second - first) * ((2 * own - a - b) / (c - a))[:, None])


def sideways_slopes(
    darboux: Darboux, mean_curvature: Floats | float, arclengths: Floats, offsets: Integers, closed: Booleans
) -> Floats:
    """d kn / d u towards u = n x t, 1/m^2, (k,): tg' + 2 kg (kn - H), see `lamella.surface.darboux.sideways_slope`.

    Parameters
    ----------
    darboux : Darboux
        Of the curves at their samples.
    mean_curvature : (k,) or float
        H, 1/m.
    arclengths, offsets, closed
        See `derivative`.
    """
    torsion = derivative(darboux.tg[:, None], arclengths, offsets, closed)[:, 0]
    return np.asarray(torsion + 2 * darboux.kg * (darboux.kn - mean_curvature))


class _Three(NamedTuple):
    """Three samples of each parabola, and their arc lengths, m, which go on beyond a closed curve's ends: (3, n)."""

    samples: Integers
    places: Floats


def _three(arclengths: Floats, offsets: Integers, some: Integers, curve: Integers, around: Booleans) -> _Three:
    """Samples for the parabolas of some samples (n,) of curves (n,), by arc length."""
    all_lengths = arclengths[offsets[1:] - 1]
    stride = 2 * float(all_lengths.max())
    keys = np.repeat(np.arange(len(all_lengths)), np.diff(offsets)) * stride + arclengths
    length, s = all_lengths[curve], arclengths[some]
    begin, end = offsets[curve], offsets[curve + 1] - 1
    reach = STENCIL_WIDTH * _steps(arclengths, some, begin, end)
    half = np.minimum(reach, length / 2)
    middle = np.where(around, s, s.clip(half, length - half))
    samples, places = np.empty((3, len(some)), np.int64), np.empty((3, len(some)))
    for row, way in enumerate((-1, 0, 1)):
        wanted = middle + way * reach
        place = np.where(around, wanted % length, wanted.clip(0, length))
        after = np.searchsorted(keys, curve * stride + place).clip(begin + 1, end)
        found = after - (place - arclengths[after - 1] <= arclengths[after] - place)
        samples[row], places[row] = found, wanted - place + arclengths[found]
    # beyond an open curve's end is the end itself
    return _Three(samples, np.where(around, places, arclengths[samples]))


def _steps(arclengths: Floats, some: Integers, begin: Integers, end: Integers) -> Floats:
    """Largest distance of neighbouring samples within a few of some samples (n,) of curves from begin to end, m, (n,).

    In a stub between two stops next to each other samples are so close that their tangents differ by their errors.
    """
    step = np.zeros(len(some))
    for k in range(-STENCIL_WIDTH - 1, STENCIL_WIDTH + 1):
        one = np.clip(some + k, begin, end - 1)
        np.maximum(step, arclengths[one + 1] - arclengths[one], out=step)
    return step
