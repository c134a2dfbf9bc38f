"""Nodes of curved elements placed on flat triangles, with the boundary's nodes on the exact curve.

The shift of a boundary edge's nodes from the chord to the curve is carried into its element as the polynomial
lambda_a lambda_b q(lambda_b - lambda_a), which vanishes on the other two edges and whose derivatives are as small as
those of the curve itself: the parametrisation stays smooth enough for the full order (Lenoir, SIAM J. Numer. Anal. 23
(1986), 562-580, doi:10.1137/0723036).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Protocol

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.surface.element.connectivity import Connectivity
from lamella.surface.element.lagrange import EDGES, lagrange


class Rim(Protocol):
    """A closed boundary curve, parametrised by its arc length fraction t."""

    def at(self, t: Floats) -> Floats:
        """Points (n, 3), m."""


@lru_cache
def edge_blends(order: int) -> Floats:
    """Share of the shift of each inner node of each local edge in the shift of every node, (3, k, order - 1)."""
    basis = lagrange(order)
    barycentric = np.column_stack([1 - basis.nodes.sum(1), basis.nodes])
    result = []
    powers = np.arange(order - 1)
    for a, b in EDGES:
        la, lb = barycentric[:, a], barycentric[:, b]
        columns = (la * lb)[:, None] * (lb - la)[:, None] ** powers
        inner = basis.edge_nodes[EDGES.index((a, b)), 1:-1]
        result.append(columns @ np.linalg.inv(columns[inner]))
    return np.array(result)


def rim_parameters(connectivity: Connectivity, parameter: Floats) -> Floats:
    """Parameter t of the nodes along each boundary edge, (b, order + 1), from that of the vertices (v,)."""
    p = connectivity.basis.order
    ends = connectivity.rim_nodes[:, [0, -1]]
    start, end = parameter[ends[:, 0]], parameter[ends[:, 1]]
    # the short way around: no edge spans half a loop
    span = (end - start + 0.5) % 1 - 0.5
    return np.asarray((start[:, None] + span[:, None] * np.arange(p + 1) / p) % 1)


def place_nodes(
    connectivity: Connectivity, points: Floats, loop: Integers, parameter: Floats, rims: Sequence[Rim]
) -> Floats:
    """Nodes (n, 3) on the flat triangles of vertices (v, 3), blended towards the boundary curves.

    Parameters
    ----------
    connectivity : Connectivity
    points : (v, 3)
    loop, parameter : (v,)
        Boundary curve of each vertex (-1: inside) and its parameter there.
    rims : sequence of Rim
    """
    basis = connectivity.basis
    barycentric = np.column_stack([1 - basis.nodes.sum(1), basis.nodes])
    nodes = np.empty((connectivity.node_count, 3))
    nodes[connectivity.elements] = np.matmul(barycentric, points[connectivity.faces])
    rim_nodes, at = connectivity.rim_nodes, rim_parameters(connectivity, parameter)
    of_loop = loop[rim_nodes[:, 0]]
    exact = np.empty((*rim_nodes.shape, 3))
    for index, rim in enumerate(rims):
        mine = of_loop == index
        exact[mine] = rim.at(at[mine].ravel()).reshape(-1, rim_nodes.shape[1], 3)
    shift = exact - nodes[rim_nodes]
    blends = edge_blends(basis.order)
    for local in range(3):
        mine = connectivity.rim_edges == local
        touched = connectivity.elements[connectivity.rim_elements[mine]]
        moved = np.matmul(blends[local], shift[mine][:, 1:-1])
        # an element with two boundary edges takes both shifts; its own edges' nodes are set below
        np.add.at(nodes, touched, moved)
    nodes[rim_nodes] = exact
    return nodes
