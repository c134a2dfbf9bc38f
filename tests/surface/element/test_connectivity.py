"""Shared nodes and neighbours, on an irregular mesh of an annulus: seen from both sides of each edge."""

from __future__ import annotations

import numpy as np
import pytest

from lamella.surface.element.connectivity import connect
from lamella.surface.element.lagrange import EDGES


def annulus(around: int = 9, across: int = 4) -> tuple[np.ndarray, np.ndarray]:
    """Points (n, 2) and faces of an annulus; vertex numbers and first corners are shuffled."""
    rng = np.random.default_rng(3)
    i, j = (x.ravel() for x in np.meshgrid(np.arange(around), np.arange(across), indexing="ij"))
    z = (1 + j / (across - 1)) * np.exp(2j * np.pi * (i + 0.3 * j) / around)
    points = np.column_stack([z.real, z.imag])
    i, j = (x.ravel() for x in np.meshgrid(np.arange(around), np.arange(across - 1), indexing="ij"))
    a, b, c, d = i * across + j, i * across + j + 1, (i + 1) % around * across + j + 1, (i + 1) % around * across + j
    faces = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    new = rng.permutation(len(points))
    faces = new[faces]
    shuffled = np.empty_like(points)
    shuffled[new] = points
    turn = rng.integers(0, 3, len(faces))
    return shuffled, np.stack([faces[np.arange(len(faces)), (turn + k) % 3] for k in range(3)], 1)


@pytest.mark.parametrize("order", [1, 2, 3, 4, 6])
class TestConnect:
    def test_every_element_puts_a_shared_node_at_the_same_place(self, order) -> None:
        points, faces = annulus()
        mesh = connect(faces, len(points), order)
        barycentric = np.column_stack([1 - mesh.basis.nodes.sum(1), mesh.basis.nodes])
        places = barycentric @ points[faces]
        nodes = np.full((mesh.node_count, 2), np.nan)
        nodes[mesh.elements] = places
        assert not np.isnan(nodes).any(), "a node belongs to no element"
        assert nodes[mesh.elements] == pytest.approx(places, abs=1e-14)
        # and no place has two nodes
        gaps = np.linalg.norm(nodes[:, None] - nodes, axis=2) + np.eye(len(nodes))
        assert gaps.min() > 1e-3
        assert np.array_equal(mesh.elements[:, :3], faces)

    def test_count_of_nodes(self, order) -> None:
        """v vertices, p - 1 nodes on each edge, (p - 1)(p - 2) / 2 in each triangle; the annulus has v - e + m = 0."""
        points, faces = annulus()
        edges = len(points) + len(faces)
        mesh = connect(faces, len(points), order)
        assert mesh.node_count == len(points) + edges * (order - 1) + len(faces) * (order - 1) * (order - 2) // 2

    def test_neighbours_know_each_other(self, order) -> None:
        points, faces = annulus()
        mesh = connect(faces, len(points), order)
        for element in range(len(faces)):
            for edge, (a, b) in enumerate(EDGES):
                across, other = mesh.neighbours[element, edge], mesh.neighbour_edges[element, edge]
                if across < 0:
                    continue
                assert mesh.neighbours[across, other] == element
                assert mesh.neighbour_edges[across, other] == edge
                assert list(faces[element, [a, b]]) == list(faces[across, list(EDGES[other])][::-1])
                mine = mesh.elements[element, mesh.basis.edge_nodes[edge]]
                assert np.array_equal(mine, mesh.elements[across, mesh.basis.edge_nodes[other]][::-1])

    def test_rim_runs_with_the_surface_to_its_left(self, order) -> None:
        points, faces = annulus()
        mesh = connect(faces, len(points), order)
        assert len(mesh.rim_elements) == 18
        assert (mesh.neighbours[mesh.rim_elements, mesh.rim_edges] == -1).all()
        assert (mesh.neighbours < 0).sum() == 18
        start, end = points[mesh.rim_nodes[:, 0]], points[mesh.rim_nodes[:, -1]]
        turns = start[:, 0] * end[:, 1] - start[:, 1] * end[:, 0]
        outer = np.linalg.norm(start, axis=1) > 1.5
        assert outer.sum() == 9
        assert (turns[outer] > 0).all()
        assert (turns[~outer] < 0).all()
        # one edge after the other
        assert sorted(mesh.rim_nodes[:, 0]) == sorted(mesh.rim_nodes[:, -1])
