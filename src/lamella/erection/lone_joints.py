"""Joints that nothing but their own friction keeps from turning."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Booleans, Integers
from lamella.network.network import SINGULAR, Network


def lone_joints(network: Network, joint_nodes: Integers) -> Booleans:
    """Joints (k,) of lamellas that are held at one node only, and would spin about it.

    Short lamellas in a net's corners cross one other. They are left locked: they go along with that one.
    """
    at_node = np.zeros(len(network.node_points), bool)
    at_node[joint_nodes] = True
    # the rays of a singular node are held on a hub
    at_node |= network.node_kinds == SINGULAR
    held = np.bincount(network.stop_owner, at_node[network.stop_nodes], len(network.ids))
    lone = np.zeros(len(network.node_points), bool)
    lone[network.stop_nodes[held[network.stop_owner] < 2]] = True
    return np.asarray(lone[joint_nodes])
