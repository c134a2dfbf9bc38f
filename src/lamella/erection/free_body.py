"""A net that nothing holds but one node in its middle, against moving away."""

from __future__ import annotations

import numpy as np

from lamella.base.ties import grid_of, rounded
from lamella.network.network import Network
from lamella.structure.actions.node_supports import NodeSupports
from lamella.structure.beam.poses import NODE_UNKNOWNS


def free_body(network: Network) -> NodeSupports:
    """All six freedoms of the node nearest to the nodes' centre are held; it takes no force where nothing acts."""
    points = network.node_points
    reached = np.unique(network.stop_nodes)
    away = np.linalg.norm(points[reached] - points[reached].mean(0), axis=1)
    # of several as near the first one
    middle = reached[rounded(away, grid_of(float(away.max(initial=1.0)))).argmin()]
    fixed = np.zeros((len(points), NODE_UNKNOWNS), bool)
    fixed[middle] = True
    return NodeSupports(fixed, np.zeros((len(points), NODE_UNKNOWNS)))
