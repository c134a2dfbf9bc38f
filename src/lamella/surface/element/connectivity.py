"""Which nodes, edges and neighbours the elements of a triangle mesh have."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lamella.base.arrays import Integers
from lamella.base.result import Lean
from lamella.base.sparse import SymmetricPattern
from lamella.surface.element.lagrange import EDGES, Lagrange, lagrange


@dataclass(frozen=True)
class Connectivity(Lean):
    """Nodes of Lagrange triangles on a mesh of m triangles with v vertices; the first v nodes are the vertices.

    Attributes
    ----------
    basis : Lagrange
    faces : (m, 3) int
    elements : (m, k) int
        Nodes of each element in the numbering of `lamella.surface.element.lagrange`.
    neighbours : (m, 3) int
        Element across each local edge; -1: none.
    neighbour_edges : (m, 3) int
        Which local edge of that element it is; edges of two elements run in opposite directions.
    rim_elements, rim_edges : (b,) int
        Element and local edge of each boundary edge.
    node_count : int
    """

    basis: Lagrange
    faces: Integers
    elements: Integers
    neighbours: Integers
    neighbour_edges: Integers
    rim_elements: Integers
    rim_edges: Integers
    node_count: int

    @property
    def rim_nodes(self) -> Integers:
        """Nodes along each boundary edge, corners included, (b, order + 1); the surface lies to the left."""
        return np.asarray(self.elements[self.rim_elements[:, None], self.basis.edge_nodes[self.rim_edges]])

    @cached_property
    def inner_unknowns(self) -> Integers:
        """Number of each node's unknown where the whole boundary is held, (n,); -1: on the boundary."""
        inside = np.ones(self.node_count, bool)
        inside[self.rim_nodes] = False
        return np.where(inside, np.cumsum(inside) - 1, -1)

    @cached_property
    def inner_pattern(self) -> SymmetricPattern:
        """Pattern of problems with the whole boundary held: its analysis serves them all."""
        unknowns = self.inner_unknowns
        return SymmetricPattern.from_elements(unknowns[self.elements], int(unknowns.max()) + 1)


def connect(faces: Integers, vertex_count: int, order: int) -> Connectivity:
    """Number the nodes of Lagrange triangles of an order on a manifold, consistently oriented mesh."""
    basis = lagrange(order)
    m, inner = len(faces), order - 1
    ends = np.stack([faces[:, edge] for edge in EDGES], 1)  # (m, 3, 2)
    low, high = ends.min(2), ends.max(2)
    keys, edge_of = np.unique((low * vertex_count + high).ravel(), return_inverse=True)
    edge_of = edge_of.reshape(m, 3)
    elements = np.empty((m, len(basis.nodes)), np.int64)
    elements[:, :3] = faces
    step = np.arange(inner)
    for local in range(3):
        forward = ends[:, local, 0] < ends[:, local, 1]
        along = np.where(forward[:, None], step, inner - 1 - step)
        elements[:, basis.edge_nodes[local, 1:-1]] = vertex_count + edge_of[:, local, None] * inner + along
    inside = np.arange(3 + 3 * inner, len(basis.nodes))
    first_inside = vertex_count + len(keys) * inner
    elements[:, inside] = first_inside + np.arange(m * len(inside)).reshape(m, -1)
    by_edge = np.argsort(edge_of.ravel(), kind="stable")
    sorted_edges = edge_of.ravel()[by_edge]
    pair = np.flatnonzero(sorted_edges[1:] == sorted_edges[:-1])
    neighbours = np.full(3 * m, -1)
    neighbours[by_edge[pair]], neighbours[by_edge[pair + 1]] = by_edge[pair + 1], by_edge[pair]
    rim = np.flatnonzero(neighbours < 0)
    across = np.where(neighbours < 0, -1, neighbours // 3).reshape(m, 3)
    return Connectivity(
        basis,
        faces,
        elements,
        across,
        (neighbours % 3).reshape(m, 3),
        rim // 3,
        rim % 3,
        first_inside + m * len(inside),
    )
