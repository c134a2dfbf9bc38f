"""Where the cells of a net are much larger than elsewhere: a cell edge is l0 / (sqrt2 mu), and mu is small where the
surface is nearly umbilic, in planar regions above all. And where they are small: where a curve ends just behind another
one, or runs along the rim."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.network.network import Network

# a cell edge this many times as long as the median one of its family is told of
EDGE_RATIO_MAX = 4.0
# places told at once, and how far apart they are, in lengths of their cell edges
MOST_PLACES, PLACES_APART = 3, 2.0


class LargeCell(NamedTuple):
    """A place where cells are large.

    Attributes
    ----------
    point : (3,)
        m.
    edge : float
        Length of the cell edge there, m.
    ratio : float
        Over the median of its family.
    """

    point: Floats
    edge: float
    ratio: float


class SmallCell(NamedTuple):
    """A place where cells are small: point (3,), m, and the length of the cell edge there, m."""

    point: Floats
    edge: float


def large_cells(network: Network, most: float = EDGE_RATIO_MAX) -> tuple[int, tuple[LargeCell, ...]]:
    """Cell edges more than `most` times as long as the median of their family, and where the longest of them are.

    Returns
    -------
    count : int
        Number of such cell edges.
    places : tuple of LargeCell
        The longest one first; the others are the longest ones that are not next to one told before.
    """
    owner = network.stop_owner
    first = np.flatnonzero(owner[1:] == owner[:-1])
    edges = network.cell_edges
    is_a = network.families[owner[first]] == "A"
    # where every other curve of one family is left out, cells are rectangles
    median = np.ones(len(edges))
    for family in (is_a, ~is_a):
        if family.any():
            median[family] = np.median(edges[family])
    ratio = edges / median
    large = np.flatnonzero(ratio > most)
    order = large[np.argsort(-ratio[large], kind="stable")]
    middle = _middles(network, first)
    places = _apart(middle, order, PLACES_APART * edges)
    return len(large), tuple(LargeCell(middle[k], float(edges[k]), float(ratio[k])) for k in places)


def small_cells(network: Network, least: float) -> tuple[int, tuple[SmallCell, ...]]:
    """Cell edges shorter than `least` (m), and where the shortest of them are.

    Returns
    -------
    count : int
        Number of such cell edges.
    places : tuple of SmallCell
        The shortest one first; the others are the shortest ones that are not next to one told before.
    """
    owner, edges = network.stop_owner, network.cell_edges
    first = np.flatnonzero(owner[1:] == owner[:-1])
    small = np.flatnonzero(edges < least)
    order = small[np.argsort(edges[small], kind="stable")]
    middle = _middles(network, first)
    apart = np.full(len(edges), PLACES_APART * float(np.median(edges)))
    return len(small), tuple(SmallCell(middle[k], float(edges[k])) for k in _apart(middle, order, apart))


def _middles(network: Network, first: Integers) -> Floats:
    """Middle of the chord of each cell edge, m, by the stops where these begin."""
    begin, end = (network.node_points[network.stop_nodes[first + k]] for k in (0, 1))
    return np.asarray((begin + end) / 2)


def _apart(middle: Floats, order: Integers, apart: Floats) -> list[int]:
    """The first edges of an order, each further from those before it than `apart` of them."""
    places: list[int] = []
    for number in order.tolist():
        if all(np.linalg.norm(middle[number] - middle[one]) > apart[one] for one in places):
            places.append(number)
            if len(places) == MOST_PLACES:
                break
    return places
