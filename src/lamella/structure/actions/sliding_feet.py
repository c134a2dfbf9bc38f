"""Supports that carry upwards alone: feet that slide."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats
from lamella.structure.actions.node_supports import NodeSupports

UP = 2


def sliding_feet(supports: NodeSupports, points: Floats) -> NodeSupports:
    """The same nodes held upwards alone, with what keeps the whole from drifting and no more.

    Rotations that are held stay held. The first node is held in plan as well, and of the node farthest from it in plan
    the shift across the line between both: under vertical loads nothing of it has a force.

    Parameters
    ----------
    supports : NodeSupports
    points : (n, 3)
        m.
    """
    nodes = np.flatnonzero(supports.supported)
    fixed, springs = supports.fixed.copy(), supports.springs.copy()
    fixed[:, :UP], springs[:, :UP] = False, 0.0
    fixed[nodes, UP] |= springs[nodes, UP] == 0
    if len(nodes) > 1:
        by = points[nodes, :UP] - points[nodes[0], :UP]
        size = np.linalg.norm(by, axis=1)
        # of nodes alike the first, whatever the last bits
        far = int(np.round(size / max(float(size.max()), np.finfo(float).tiny), 9).argmax())
        along_x, along_y = np.abs(by[far])
        fixed[nodes[0], :UP] = True
        fixed[nodes[far], int(along_x > along_y * (1 + 1e-9))] = True
    return NodeSupports(fixed, springs)
