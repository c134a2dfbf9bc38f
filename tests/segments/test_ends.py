"""Ends of lamellas at the rim go with the last crossing before them."""

from __future__ import annotations

import numpy as np
import pytest

import lamella
from lamella.segments.partition import Graph, Limits, partition


@pytest.mark.parametrize("size", [1.6, 2.2, 3.0, 3.4])
def test_no_segment_is_an_end_alone(size: float) -> None:
    """Rim cells of every length: each patch is connected, small enough, and more than the end of a lamella."""
    net = lamella.net(lamella.Enneper(2, 0.6, 3.0), spacing=0.45)
    graph = Graph.of(net, np.ones(len(net.node_points)), 0.1)
    of_node = partition(graph, Limits(size=size))
    assert set(of_node.tolist()) == set(range(of_node.max() + 1))
    one, other = graph.ends.T
    degree = np.bincount(graph.ends.ravel())
    for end in np.flatnonzero(degree == 1).tolist():
        (edge,) = np.flatnonzero((graph.ends == end).any(1)).tolist()
        assert of_node[one[edge]] == of_node[other[edge]]
    for patch in range(of_node.max() + 1):
        nodes = np.flatnonzero(of_node == patch)
        points = net.node_points[nodes]
        assert np.linalg.norm(points[:, None] - points[None], axis=2).max() <= size + 1e-9
        # spreading along its edges from its first node reaches all of it
        reached = {int(nodes[0])}
        inside = graph.ends[(of_node[graph.ends] == patch).all(1)].tolist()
        for _ in range(len(nodes)):
            reached |= {b for a, b in inside if a in reached} | {a for a, b in inside if b in reached}
        assert reached == set(nodes.tolist())


def test_two_ends_that_hang_on_each_other() -> None:
    """A lamella that crosses no other one is a patch of its own."""
    net = lamella.net(lamella.Enneper(2, 0.6, 3.0), spacing=0.45)
    graph = Graph.of(net, np.ones(len(net.node_points)))
    alone = type(graph)(
        np.array([[0, 1]]),
        np.zeros(1, int),
        np.zeros(1, int),
        np.ones(2),
        np.array([[0.0, 0, 0], [1, 0, 0]]),
        np.array([[0.5, 0, 0]]),
        np.zeros(1, bool),
    )
    assert partition(alone, Limits(size=2.0)).tolist() == [0, 0]
