"""Where a structure is: points and frames of its nodes, and the angles of its joints."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.structure.beam.rotations import exponential, orthonormal

NODE_UNKNOWNS = 6
"""Of a node: a shift and a rotation in global axes. Those of joints' angles come after all nodes'."""


@dataclass(frozen=True)
class Poses:
    """Poses of n nodes and angles of k joints.

    Attributes
    ----------
    points : (n, 3)
        m.
    frames : (n, 3, 3)
        Rotations; columns are the node's axes. For a lamella's node: t, u, n.
    angles : (k,)
        By which a joint is turned about the third axis of its node, from the frame's own sideways position, rad.
    """

    points: Floats
    frames: Floats
    angles: Floats

    @property
    def unknowns(self) -> int:
        """6 n + k."""
        return NODE_UNKNOWNS * len(self.points) + len(self.angles)

    def moved(self, motion: Floats) -> Poses:
        """After a motion (6 n + k,): shifts (m) and rotation vectors (rad) of the nodes, angles of the joints."""
        nodes = motion[: NODE_UNKNOWNS * len(self.points)].reshape(-1, NODE_UNKNOWNS)
        return Poses(
            self.points + nodes[:, :3],
            orthonormal(exponential(nodes[:, 3:]) @ self.frames),
            self.angles + motion[NODE_UNKNOWNS * len(self.points) :],
        )


def straight_poses(length: float, elements: int) -> Poses:
    """Nodes of a straight strip along x, in elements of equal length, upright along z: frames are the axes."""
    points = np.zeros((elements + 1, 3))
    points[:, 0] = np.linspace(0, length, elements + 1)
    return Poses(points, np.tile(np.eye(3), (elements + 1, 1, 1)), np.zeros(0))
