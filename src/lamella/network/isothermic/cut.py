"""The cut: edges along which a surface is opened until isothermic coordinates have one value everywhere.

Every hole and every umbilic of odd order hangs on the outer rim by the cut, by the shortest ways that keep clear of the
umbilics; what is left is a disc without any of them.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from lamella.base.arrays import Booleans, Integers
from lamella.base.ties import shortened
from lamella.network.isothermic.integration_mesh import IntegrationMesh

# how much longer an edge counts than it is, times the rosette's radius over its distance to the nearest umbilic
CUT_CLEARANCE = 3.0


def cut_edges(mesh: IntegrationMesh, odd: Integers) -> Booleans:
    """Local edges (m, 3) to cut along, alike from both sides.

    Parameters
    ----------
    mesh : IntegrationMesh
    odd : (z,) int
        Vertices that are umbilics of odd order.
    """
    connectivity = mesh.connectivity
    vertices = int(connectivity.faces.max()) + 1
    element, edge = np.nonzero(connectivity.neighbours >= 0)
    ends = connectivity.faces[element[:, None], (edge[:, None] + [0, 1]) % 3]
    cost = np.linalg.norm(mesh.nodes[ends[:, 1]] - mesh.nodes[ends[:, 0]], axis=1)
    inside = np.flatnonzero(mesh.umbilics >= 0)
    if len(inside):
        near, which = cKDTree(mesh.nodes[mesh.umbilics[inside]]).query(mesh.nodes[ends].mean(1))
        cost = cost * (1 + CUT_CLEARANCE * mesh.radii[inside][which] / np.maximum(near, 1e-300))
    # an edge from rim to rim would cut off what hangs on one edge; so would the rim itself
    on_rim = mesh.loop >= 0
    free = ~on_rim[ends].all(1) | (mesh.loop[ends[:, 0]] != mesh.loop[ends[:, 1]])
    # ways that cost the same do so on every machine
    graph = coo_matrix((shortened(cost[free]), tuple(ends[free].T)), (vertices, vertices)).tocsr()
    reached = mesh.loop == 0
    holes = [np.flatnonzero(mesh.loop == hole) for hole in range(1, int(mesh.loop.max()) + 1)]
    zeros = [odd[number : number + 1] for number in range(len(odd))]
    pairs: list[tuple[int, int]] = []
    # holes first: what they hang on is what zeros may hang on
    for goals in (holes, zeros):
        left = list(goals)
        while left:
            distance, before, _ = dijkstra(
                graph, directed=False, indices=np.flatnonzero(reached), min_only=True, return_predecessors=True
            )
            nearest = min(range(len(left)), key=lambda number: float(distance[left[number]].min()))
            goal = left.pop(nearest)
            vertex = int(goal[distance[goal].argmin()])
            reached[goal] = True
            while before[vertex] >= 0:
                pairs.append((vertex, int(before[vertex])))
                reached[vertex] = True
                vertex = int(before[vertex])
    cut = np.zeros((len(connectivity.faces), 3), bool)
    if pairs:
        low, high = np.sort(np.array(pairs), 1).T
        cut[element, edge] = np.isin(ends.min(1) * vertices + ends.max(1), low * vertices + high)
    return cut
