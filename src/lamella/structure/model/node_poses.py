"""Frames of a network's nodes as nodes of a structure, and which of them have a joint."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.network.network import Network
from lamella.strip.lamellas import crossings


def node_frames(network: Network) -> Floats:
    """t, u, n in columns, (n, 3, 3): of the A lamella through each node, of a B lamella where there is none.

    The first stop in the network's order counts. Nodes without a lamella have any frame about their normal.
    """
    sample = network.sample_offsets[network.stop_owner] + network.stop_samples
    chosen = np.full(len(network.node_points), -1)
    is_a = network.families[network.stop_owner] == "A"
    for stops in (np.flatnonzero(~is_a)[::-1], np.flatnonzero(is_a)[::-1]):
        chosen[network.stop_nodes[stops]] = sample[stops]
    normal = network.node_normals / np.linalg.norm(network.node_normals, axis=1)[:, None]
    least = np.eye(3)[np.abs(normal).argmin(1)]
    tangent = np.where((chosen >= 0)[:, None], network.sample_tangents[chosen], least)
    tangent = tangent - (tangent * normal).sum(1)[:, None] * normal
    tangent /= np.linalg.norm(tangent, axis=1)[:, None]
    return np.stack((tangent, np.cross(normal, tangent), normal), 2)


def joint_numbers(network: Network) -> Integers:
    """Number of the joint at each node, (n,); -1 where no A lamella crosses a B lamella."""
    crossed = crossings(network)
    return np.where(crossed, np.cumsum(crossed) - 1, -1)


def bare_nodes(network: Network) -> Integers:
    """Nodes that no lamella reaches."""
    return np.setdiff1d(np.arange(len(network.node_points)), network.stop_nodes)
