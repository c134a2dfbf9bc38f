"""Edges of a net along its boundary, from its faces."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from lamella.base.arrays import Integers
from lamella.network.network import BOUNDARY, Network


def rim_edges(network: Network) -> Integers:
    """Pairs of neighbouring boundary nodes, (e, 2): sides of one face only, the surface to the left."""
    tails, heads = face_sides(network)
    count = len(network.node_points)
    forward, back = tails * count + heads, heads * count + tails
    rim = (network.node_kinds[tails] == BOUNDARY) & (network.node_kinds[heads] == BOUNDARY) & ~np.isin(forward, back)
    return np.column_stack([tails[rim], heads[rim]])


def face_sides(network: Network) -> tuple[Integers, Integers]:
    """First and last node of every side of every face, in the order of `Network.face_nodes`."""
    nodes, offsets = network.face_nodes, network.face_offsets
    following = np.arange(1, len(nodes) + 1)
    following[offsets[1:] - 1] = offsets[:-1]
    return nodes, nodes[following]


def rim_loops(network: Network, edges: Integers) -> Integers:
    """Number of the loop each boundary node is on, (n,), -1 elsewhere; loops in the order of their first nodes."""
    count = len(network.node_points)
    graph = coo_array((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(count, count))
    _, part = connected_components(graph, directed=False)
    loops = np.full(count, -1)
    on_rim = np.zeros(count, bool)
    on_rim[edges] = True
    _, loops[on_rim] = np.unique(part[on_rim], return_inverse=True)
    return loops
