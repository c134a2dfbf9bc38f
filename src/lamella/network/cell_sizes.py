"""Where the cells of a net are much larger than elsewhere: a cell edge is l0 / (sqrt2 mu), and mu is small where the
surface is nearly umbilic, in planar regions above all."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lamella.network.network import Network

Floats = NDArray[np.float64]

# a cell edge this many times as long as the median one of its family is told of
MOST_RATIO = 4.0
# places told at once, and how far apart they are, in lengths of their cell edges
MOST_PLACES, APART = 3, 2.0


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


def large_cells(network: Network, most: float = MOST_RATIO) -> tuple[int, tuple[LargeCell, ...]]:
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
    left = large[np.argsort(-ratio[large], kind="stable")]
    begin, end = (network.node_points[network.stop_nodes[first[left] + k]] for k in (0, 1))
    middle = (begin + end) / 2
    places: list[LargeCell] = []
    for k, number in enumerate(left.tolist()):
        if all(np.linalg.norm(middle[k] - told.point) > APART * told.edge for told in places):
            places.append(LargeCell(middle[k], float(edges[number]), float(ratio[number])))
            if len(places) == MOST_PLACES:
                break
    return len(large), tuple(places)
