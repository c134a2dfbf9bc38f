"""Geodesic curvature of a sampled curve on a surface, from the turning of its tangents."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lamella.surface.points import Floats
from lamella.surface.vectors import dots

# samples to either side over which a lamella turns by its geodesic curvature: the kinks at elements average out
WIDE = 3


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
    turned = tangents.take(after, 0) - tangents.take(before, 0)
    return np.asarray(dots(turned, sideways) / (arclengths[after] - arclengths[before]))
