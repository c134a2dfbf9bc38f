"""Angles between the lamellas of a net at its joints."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.network.network import Network


def twist_over_depth(network: Network, nodes: Integers, depth: float) -> Floats:
    """How far the angle between two crossing strips changes from the surface to a depth at most, rad, (k,).

    At height z along the normal the line of a twisted strip runs along (1 - z kn) t - z tg u: turned about n by
    atan(-z tg / (1 - z kn)), the one to one side and the other to the other.

    Parameters
    ----------
    network : Network
    nodes : (k,) int
        Where one lamella crosses the other.
    depth : float
        Of the slots, m, to either side.
    """
    sample = network.sample_offsets[network.stop_owner] + network.stop_samples
    is_a = network.families[network.stop_owner] == "A"
    turned = np.zeros((2, 2, len(network.node_points)))
    for family, stops in enumerate((np.flatnonzero(is_a)[::-1], np.flatnonzero(~is_a)[::-1])):
        torsion, normal = network.sample_darboux.tg[sample[stops]], network.sample_darboux.kn[sample[stops]]
        for side, z in enumerate((-depth, depth)):
            turned[family, side, network.stop_nodes[stops]] = np.arctan2(-z * torsion, 1 - z * normal)
    return np.asarray(np.abs(turned[1] - turned[0])[:, nodes].max(axis=0))


def designed_angles(network: Network, nodes: Integers) -> Floats:
    """From the A to the B lamella about the node's normal, rad, 0 to pi, at nodes (k,) where one crosses the other.

    Lamellas have no direction: a straight angle more is the same.
    """
    sample = network.sample_offsets[network.stop_owner] + network.stop_samples
    is_a = network.families[network.stop_owner] == "A"
    tangents = np.zeros((2, len(network.node_points), 3))
    for family, stops in enumerate((np.flatnonzero(is_a)[::-1], np.flatnonzero(~is_a)[::-1])):
        # the first stop of a family counts, as for the frames of the structural model
        tangents[family, network.stop_nodes[stops]] = network.sample_tangents[sample[stops]]
    a, b = tangents[:, nodes]
    sine = (network.node_normals[nodes] * np.cross(a, b)).sum(1)
    return np.asarray(np.arctan2(sine, (a * b).sum(1)) % np.pi)
