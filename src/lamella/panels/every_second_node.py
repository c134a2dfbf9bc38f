"""The two classes of a net's nodes such that neighbours along lamellas are of different ones, as on a chessboard.

The diagonals of the cells join nodes of one class: they are a net of principal lines of its own, whose cells lie around
the nodes of the other class.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import breadth_first_order, connected_components

from lamella.base.arrays import Booleans, Integers
from lamella.network.network import SINGULAR, Network


class EverySecond(NamedTuple):
    """Every second node of a net.

    Attributes
    ----------
    corners : (n,) bool
        Nodes that are corners of panels.
    conflicts : (c, 2) int
        Neighbours of one class: around a loop there is an odd number of steps.
    """

    corners: Booleans
    conflicts: Integers


def every_second_node(network: Network) -> EverySecond:
    """Classes by the number of steps from a node of each connected part.

    Corners are the class with more singular nodes, so that panels meet there and none lies across; with as many in
    either, the class with the part's first node.
    """
    owner, nodes, count = network.stop_owner, network.stop_nodes, len(network.node_points)
    same = np.flatnonzero(owner[1:] == owner[:-1])
    edges = np.column_stack([nodes[same], nodes[same + 1]])
    graph = coo_array((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(count, count)).tocsr()
    parts, part = connected_components(graph, directed=False)
    odd = np.zeros(count, bool)
    first = np.full(parts, count)
    np.minimum.at(first, part, np.arange(count))
    for start in first.tolist():
        order, before = breadth_first_order(graph, start, directed=False)
        odd[order] = _steps(order, before) % 2 == 1
    singular = network.node_kinds == SINGULAR
    balance = np.bincount(part[singular], np.where(odd[singular], 1, -1), parts)
    corners = odd == (balance > 0)[part]
    return EverySecond(corners, edges[corners[edges[:, 0]] == corners[edges[:, 1]]])


def _steps(order: Integers, before: Integers) -> Integers:
    """Steps from the first of nodes in breadth-first order, whose predecessors are known, (k,)."""
    place = np.zeros(len(before), np.int64)
    place[order] = np.arange(len(order))
    parent = np.r_[0, place[before[order[1:]]]]
    steps, ancestor = (np.arange(len(order)) > 0).astype(np.int64), parent
    # ancestors twice as far in each round
    while ancestor.any():
        steps = steps + steps[ancestor]
        ancestor = ancestor[ancestor]
    return steps
