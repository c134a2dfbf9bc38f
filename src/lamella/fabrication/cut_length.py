"""Lengths of what a laser cuts."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats


def outline_length(vertices: Floats) -> float:
    """Length in m of a closed outline of straight lines and arcs, (v, 3), see `lamella.fabrication.axis.outline`."""
    x, y, bulge = vertices.T
    chord = np.hypot(np.roll(x, -1) - x, np.roll(y, -1) - y)
    half = 2 * np.arctan(bulge)
    return float(np.sum(chord / np.sinc(half / np.pi)))
