"""Parts of a network as networks of their own."""

from __future__ import annotations

import numpy as np
import pytest

import lamella
from lamella import InputError
from lamella.network.network_part import network_part


def test_all_of_it() -> None:
    """With all nodes inside it is the whole, closed lamellas too."""
    net = lamella.net(lamella.Cylinder(2.0, (0.0, 3.0)), cells=8)
    part = network_part(net, np.ones(len(net.node_points), bool))
    assert part.network.ids == net.ids
    for name in ("node_points", "sample_points", "sample_arclengths", "stop_nodes", "stop_samples", "face_nodes"):
        np.testing.assert_array_equal(getattr(part.network, name), getattr(net, name))
    np.testing.assert_array_equal(part.network.closed, net.closed)


@pytest.mark.parametrize("cut", [0.0, 0.4])
def test_both_sides_of_a_plane(cut: float) -> None:
    """Edges of the two parts and those across the plane are all of the whole; each part's arrays fit each other."""
    net = lamella.net(lamella.Enneper(3, 0.7, 3.0), spacing=0.4)
    side = net.node_points[:, 0] > cut
    parts = [network_part(net, side), network_part(net, ~side)]
    owner = net.stop_owner
    joined = owner[1:] == owner[:-1]
    across = joined & (side[net.stop_nodes[1:]] != side[net.stop_nodes[:-1]])
    assert sum(len(part.network.cell_edges) for part in parts) + across.sum() == joined.sum()
    for part in parts:
        own = part.network
        np.testing.assert_array_equal(own.node_points, net.node_points[part.nodes])
        at = own.sample_offsets[own.stop_owner] + own.stop_samples
        np.testing.assert_allclose(own.sample_points[at], own.node_points[own.stop_nodes], atol=1e-9)
        np.testing.assert_allclose(own.sample_arclengths[at], own.stop_arclengths, atol=1e-12)
        assert (own.stop_arclengths[own.stop_offsets[:-1]] == 0).all()
        assert [name.partition(".")[0] for name in own.ids] == [net.ids[k] for k in part.lamellas]
        assert len(set(own.ids)) == len(own.ids)
        # faces of the part are faces of the whole
        whole = {tuple(sorted(face)) for face in np.split(net.face_nodes, net.face_offsets[1:-1])}
        for face in np.split(part.nodes[own.face_nodes], own.face_offsets[1:-1]):
            assert tuple(sorted(face.tolist())) in {tuple(int(i) for i in f) for f in whole}
        assert own.strips().network is own


def test_nothing_inside() -> None:
    net = lamella.net(lamella.Catenoid(2.5, (-1.0, 1.0)), cells=6)
    with pytest.raises(InputError) as caught:
        network_part(net, np.zeros(len(net.node_points), bool))
    assert caught.value.where == "inside"
