"""Normal curvature of centre lines as they are written: from the points of their samples alone.

On elements a centre line has a small kink wherever it goes over from one element to the next, by as much as the
elements' tangent planes differ there. The surface's second derivatives, inside the elements, know nothing of it; who
builds or measures the line meets it as a normal curvature over the samples beside it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lamella.network.network import Network
from lamella.surface.points import Floats
from lamella.surface.vectors import dots

Integers = NDArray[np.int64]

# samples at either end of an open line that are left out: where one ends at an umbilic or the rim, its last samples
# may be at other distances
ENDS = 3


def inner_samples(network: Network) -> Integers:
    """Samples of which `sampled_bend` tells, (i,) int: all but those at open lines' ends."""
    count = np.diff(network.sample_offsets)
    begin, last = np.repeat(network.sample_offsets[:-1], count), np.repeat(count - 1, count)
    place = np.arange(len(begin)) - begin
    closed = np.repeat(network.closed, count) & (last > 2 * ENDS)
    return np.flatnonzero(closed | ((place >= ENDS) & (place <= last - ENDS)))


def sampled_bend(network: Network) -> Floats:
    """Second derivatives by the arc length of the sampled points along the normals, 1/m, but for open lines' ends.

    That of the polynomial of degree four through five neighbouring samples: off by about h^4 / 90 of the sixth
    derivative at samples a distance h apart, and by 0.5 to 1.2 j / h next to a kink of an angle j.

    Parameters
    ----------
    network : Network

    Returns
    -------
    (i,)
    """
    count = np.diff(network.sample_offsets)
    begin, last = np.repeat(network.sample_offsets[:-1], count), np.repeat(count - 1, count)
    closed = np.repeat(network.closed, count) & (last > 2 * ENDS)
    place = np.arange(len(begin)) - begin
    samples = inner_samples(network)
    begin, last, place = begin[samples], last[samples], place[samples]
    length = network.sample_arclengths[begin + last]
    middle, arc = network.sample_points[samples], network.sample_arclengths[samples]
    steps, ways = [], []
    for k in (-2, -1, 1, 2):
        turn, there = np.divmod(place + k, last)
        # the end of an open line is its last sample, not its first one
        over = ~closed[samples] & (turn > 0)
        turn, there = np.where(over, 0, turn), np.where(over, last, there)
        steps.append(network.sample_arclengths[begin + there] + turn * length - arc)
        ways.append(dots(network.sample_points[begin + there] - middle, network.sample_normals[samples]))
    bend = np.zeros(len(samples))
    for i, (step, way) in enumerate(zip(steps, ways, strict=True)):
        a, b, c = (other for j, other in enumerate(steps) if j != i)
        # second derivative at 0 of the polynomial that is 1 at this step and 0 at the others and at 0
        bend += way * 2 * (a * b + a * c + b * c) / (step * (step - a) * (step - b) * (step - c))
    return bend
