"""Lengths of what a laser cuts."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats


def segment_lengths(vertices: Floats) -> Floats:
    """Length in m of each line or arc of a closed outline, (v, 3), see `lamella.fabrication.axis.outline`."""
    x, y, bulge = vertices.T
    chord = np.hypot(np.roll(x, -1) - x, np.roll(y, -1) - y)
    half = 2 * np.arctan(bulge)
    return np.asarray(chord / np.sinc(half / np.pi))


def outline_length(vertices: Floats) -> float:
    """Length in m of a closed outline of straight lines and arcs."""
    return float(segment_lengths(vertices).sum())
