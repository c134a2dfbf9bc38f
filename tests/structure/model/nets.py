"""Nets to make structures of."""

from dataclasses import replace

import numpy as np

import lamella
from lamella.network.network import BOUNDARY, Network
from lamella.structure.actions.load_case import LoadCase, no_load
from lamella.structure.actions.node_supports import NodeSupports

PATCH = lamella.net(lamella.Enneper(2, 0.6, 3.0), spacing=0.45)
"""Enneper's surface, 89 nodes."""


def held_at(network: Network, nodes, ways="all") -> NodeSupports:
    """Some nodes held: "all" or a slice of the six ways."""
    fixed = np.zeros((len(network.node_points), 6), bool)
    fixed[nodes, slice(None) if ways == "all" else ways] = True
    return NodeSupports(fixed, np.zeros(fixed.shape))


def pinned_rim(network: Network) -> NodeSupports:
    return held_at(network, network.node_kinds == BOUNDARY, slice(0, 3))


def central_node(network: Network) -> int:
    points = network.node_points
    return int(np.linalg.norm(points - points.mean(0), axis=1).argmin())


def pushed(network: Network, force, weight=0.0, nodes=None) -> LoadCase:
    """The same force at all nodes, or some, and the weight."""
    case = no_load("pushed", len(network.node_points))
    forces = np.zeros_like(case.node_forces)
    forces[slice(None) if nodes is None else nodes] = force
    return replace(case, node_forces=forces, self_weight=np.array([0, 0, -weight]))
