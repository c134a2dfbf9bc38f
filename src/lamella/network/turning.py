"""Geodesic curvature of a sampled curve on a surface, from the turning of its tangents."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lamella.surface.points import Floats
from lamella.surface.vectors import dots

Integers = NDArray[np.int64]

# samples to either side over which a lamella turns by its geodesic curvature: the kinks at elements average out
WIDE = 3


def turning(
    tangents: Floats, sideways: Floats, arclengths: Floats, offsets: Integers, closed: NDArray[np.bool_]
) -> Floats:
    """kg = t' . u at the samples of curves, 1/m, (k,): of second order in their distance, at a curve's ends too.

    t' is that of the parabola through t at three samples: at this one and those about `WIDE` to either side of it; next
    to an end at the end itself and those once and twice as far away.

    Parameters
    ----------
    tangents, sideways : (k, 3)
        Unit t and u = n x t.
    arclengths : (k,)
        From each curve's start, m.
    offsets : (m + 1,) int
        Where each curve's samples begin.
    closed : (m,) bool
        Curves that go on from their last sample, which is the first one once more, to the second.
    """
    if not len(arclengths):
        return np.zeros(0)
    curve = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))
    length, around = arclengths[offsets[1:] - 1][curve], closed[curve]
    reach = WIDE * _steps(arclengths, curve)
    half = np.minimum(reach, length / 2)
    middle = np.where(around, arclengths, arclengths.clip(half, length - half))
    stride = 2 * float(length.max())
    keys = curve * stride + arclengths

    def nearest(wanted: Floats) -> tuple[Floats, Floats]:
        """Arc lengths and tangents of the samples nearest to arc lengths."""
        place = np.where(around, wanted % length, wanted.clip(0, length))
        after = np.searchsorted(keys, curve * stride + place).clip(offsets[curve] + 1, offsets[curve + 1] - 1)
        found = after - (place - arclengths[after - 1] <= arclengths[after] - place)
        return wanted - place + arclengths[found], tangents.take(found, 0)

    (a, t_a), (b, t_b), (c, t_c) = (nearest(middle + way * reach) for way in (-1, 0, 1))
    first, second = dots(t_b - t_a, sideways) / (b - a), dots(t_c - t_b, sideways) / (c - b)
    # Newton's form of the parabola through (a, t_a), (b, t_b), (c, t_c), derived
    return np.asarray(first + (second - first) / (c - a) * (2 * arclengths - a - b))


def _steps(arclengths: Floats, curve: Integers) -> Floats:
    """Largest distance of neighbouring samples within a few of each, m, (k,).

    In a stub between two stops next to each other samples are so close that their tangents differ by their errors.
    """
    step = np.zeros(len(arclengths))
    for k in range(-WIDE - 1, WIDE + 1):
        near = np.arange(len(arclengths)) + k
        there = near[(near >= 0) & (near + 1 < len(curve))]
        here, apart = there - k, arclengths[there + 1] - arclengths[there]
        mine = (curve[there] == curve[here]) & (curve[there + 1] == curve[here])
        step[here[mine]] = np.maximum(step[here[mine]], apart[mine])
    return step
