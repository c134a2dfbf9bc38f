r"""Springs between nodes and the ground: along the global axes, and about them.

A spring may be a floor along z: it resists where its node is below the place of rest, and is off where it is above.

Of the shift v from where the node was at rest and the rotation vector :math:`\theta = \log(R R_0^T)` the energy is half
the sum of stiffness times square. A rotation follows the exact relative motion of
`lamella.structure.beam.relative_motion`, so that forces have an energy whatever the size of the rotation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.errors import InputError
from lamella.base.result import Lean
from lamella.structure.beam.poses import NODE_UNKNOWNS, Poses
from lamella.structure.beam.relative_motion import RelativeMotion


@dataclass(frozen=True)
class NodeSprings(Lean):
    """s nodes on springs.

    Attributes
    ----------
    nodes : (s,) int
    stiffness : (s, 6)
        Along x, y, z (N/m) and about them (N m/rad).
    points, frames : (s, 3), (s, 3, 3)
        Poses in which they are at rest.
    one_way : (s,) bool
        Springs along z that push upwards and do not pull.
    """

    nodes: Integers
    stiffness: Floats
    points: Floats
    frames: Floats
    one_way: Booleans

    def __len__(self) -> int:
        return len(self.nodes)

    def unknowns(self) -> Integers:
        """(6, s)."""
        return np.ascontiguousarray((NODE_UNKNOWNS * self.nodes[:, None] + np.arange(NODE_UNKNOWNS)).T)

    def at(self, poses: Poses) -> NodeSpringState:
        """In a pose."""
        frames = np.stack((self.frames, poses.frames[self.nodes]), 1)
        turn = RelativeMotion.between(np.zeros((len(self), 2, 3)), frames)
        shift = (poses.points[self.nodes] - self.points).T
        lifted = self.one_way & (shift[2] > 0)
        return NodeSpringState(self, shift, turn, lifted)


@dataclass(frozen=True)
class NodeSpringState(Lean):
    """Nodes on springs in a pose.

    Attributes
    ----------
    springs : NodeSprings
    shift : (3, s)
        m.
    turn : RelativeMotion
        From the frame at rest to that of the pose.
    lifted : (s,) bool
        Above what pushes one way only.
    """

    springs: NodeSprings
    shift: Floats
    turn: RelativeMotion
    lifted: Booleans

    @property
    def _along(self) -> Floats:
        """Stiffness along x, y and z in this pose, N/m, (3, s)."""
        stiffness = self.springs.stiffness.T[:3].copy()
        stiffness[2, self.lifted] = 0.0
        return stiffness

    @property
    def energy(self) -> Floats:
        """J, (s,)."""
        motion = np.concatenate((self.shift, self.turn.theta))
        stiffness = np.concatenate((self._along, self.springs.stiffness.T[3:]))
        return np.asarray(0.5 * (stiffness * motion**2).sum(0))

    def forces(self) -> Floats:
        """Derivative of the energy: forces (N) and moments (N m) on the springs, global, (6, s)."""
        force = self._along * self.shift
        return np.concatenate((force, self.turn.on_ends(np.zeros_like(force), self._moment())[9:]))

    def stiffness(self) -> Floats:
        """Tangent stiffness, symmetric, (6, 6, s)."""
        result, inner = np.zeros((2, 6, 6, len(self.springs)))
        along = self._along
        for axis in range(3):
            result[axis, axis] = along[axis]
            inner[axis + 3, axis + 3] = self.springs.stiffness[:, axis + 3]
        moment = self._moment()
        result[3:, 3:] = self.turn.stiffness(inner, np.zeros_like(moment), moment)[9:, 9:]
        return result

    def _moment(self) -> Floats:
        return np.asarray(self.springs.stiffness.T[3:] * self.turn.theta)


def make_node_springs(poses: Poses, stiffness: ArrayLike) -> NodeSprings:
    """Springs that are at rest in a pose.

    Parameters
    ----------
    poses : Poses
    stiffness : (n, 6)
        Of every node along x, y, z (N/m) and about them (N m/rad); 0: none.

    Raises
    ------
    InputError
        A stiffness below 0 or not finite; not a row a node.
    """
    rows = np.asarray(stiffness, float)
    if rows.shape != (len(poses.points), NODE_UNKNOWNS):
        shape = (len(poses.points), NODE_UNKNOWNS)
        raise InputError(f"springs have the shape {rows.shape}", f"it has to be {shape}: a row a node", "stiffness")
    bad = np.flatnonzero(~(np.isfinite(rows) & (rows >= 0)).all(1))
    if len(bad):
        raise InputError(
            f"springs at node {bad[0]} are {rows[bad[0]].tolist()}", "they have to be finite and 0 or more", "stiffness"
        )
    nodes = np.flatnonzero(rows.any(1))
    return NodeSprings(nodes, rows[nodes], poses.points[nodes], poses.frames[nodes], np.zeros(len(nodes), bool))


def floor_springs(nodes: Integers, height: float, stiffness: float, points: Floats, frames: Floats) -> NodeSprings:
    """A floor without friction under nodes, which pushes and does not pull.

    Parameters
    ----------
    nodes : (s,) int
    height : float
        z of the floor, m.
    stiffness : float
        Of each spring, N/m.
    points, frames : (s, 3), (s, 3, 3)
        Poses of these nodes.
    """
    at = points.copy()
    at[:, 2] = height
    rows = np.zeros((len(nodes), NODE_UNKNOWNS))
    rows[:, 2] = stiffness
    return NodeSprings(nodes, rows, at, frames, np.ones(len(nodes), bool))


def no_node_springs() -> NodeSprings:
    """None at all."""
    return NodeSprings(
        np.zeros(0, np.int64), np.zeros((0, 6)), np.zeros((0, 3)), np.zeros((0, 3, 3)), np.zeros(0, bool)
    )
