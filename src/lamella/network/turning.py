"""Geodesic curvature of a sampled curve on a surface, from the turning of its tangents."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lamella.surface.points import Floats
from lamella.surface.vectors import dots

# samples to either side over which a lamella turns by its geodesic curvature: the kinks at elements average out
WIDE = 3
# of the median distance over which turning is measured: shorter ones tell nothing
STUB = 0.02


def turning(tangents: Floats, sideways: Floats, arclengths: Floats, offsets: NDArray[np.int64]) -> Floats:
    """kg = t' . u at the samples of curves, 1/m, (k,).

    Parameters
    ----------
    tangents, sideways : (k, 3)
        Unit t and u = n x t.
    arclengths : (k,)
        m.
    offsets : (m + 1,) int
        Where each curve's samples begin.
    """
    index = np.arange(len(tangents))
    count = np.diff(offsets)
    before = np.maximum(index - WIDE, np.repeat(offsets[:-1], count))
    after = np.minimum(index + WIDE, np.repeat(offsets[1:] - 1, count))
    span = arclengths[after] - arclengths[before]
    turned = tangents.take(after, 0) - tangents.take(before, 0)
    result = np.asarray(dots(turned, sideways) / span)
    # in a stub between two stops next to each other the tangents differ by their errors: as at the sample next to it
    enough = span > STUB * np.median(span)
    stub, long = np.flatnonzero(~enough), np.flatnonzero(enough)
    right = np.searchsorted(long, stub).clip(0, len(long) - 1)
    left = (right - 1).clip(0)
    near = np.where(stub - long[left] < long[right] - stub, long[left], long[right])
    other = np.where(near == long[left], long[right], long[left])
    curve = np.repeat(np.arange(len(count)), count)
    near = np.where(curve[near] == curve[stub], near, other)
    mine = curve[near] == curve[stub]
    result[stub[mine]] = result[near[mine]]
    return result
