"""Parts of a structure that can move as rigid bodies: told from the supports alone.

The stiffness of a structure that is not in equilibrium yet resists a rotation of the whole, since first-order
rotations stretch it; and of one that is, rounding may. What supports hold of the six motions of a rigid body is a
matter of rank, whatever the stiffness.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.structure.beam.poses import NODE_UNKNOWNS
from lamella.structure.mechanism import MechanismError
from lamella.structure.structure import Structure

# of the supports' squared resistance to a motion over that to the one they resist best, shifts and arcs alike
LEAST_HELD = 1e-12
_WAYS = ("moves along x", "moves along y", "moves along z", "turns about x", "turns about y", "turns about z")


def refuse_loose_parts(structure: Structure) -> None:
    """Refuse a structure of which a connected part can move as a whole.

    Raises
    ------
    MechanismError
        Names a node of the part, and how it moves.
    """
    points = structure.poses.points
    part = _parts(structure)
    carried = structure.held | (_springs(structure) > 0)
    used = np.zeros(len(points), bool)
    used[structure.beams.attachment.nodes] = True
    for k in np.unique(part[used]).tolist():
        nodes = np.flatnonzero((part == k) & used)
        motion = _loose_motion(points[nodes], carried[nodes], structure.size)
        if motion is not None:
            way = int(np.abs(motion).argmax())
            raise MechanismError(
                f"node {nodes[0]} {_WAYS[way]} with all that is connected, and nothing resists",
                "support it, or connect it to what is supported",
                "structure",
                _farthest(points[nodes], nodes, motion, structure.size),
                f"{_WAYS[way]} with all that is connected",
            )


def _parts(structure: Structure) -> Integers:
    """Number of the connected part of each node, (n,)."""
    count = len(structure.poses.points)
    one, other = structure.beams.attachment.nodes.T
    graph = sp.coo_matrix((np.ones(len(one)), (one, other)), (count, count))
    return np.asarray(connected_components(graph, directed=False)[1])


def _springs(structure: Structure) -> Floats:
    springs = np.zeros((len(structure.poses.points), NODE_UNKNOWNS))
    springs[structure.node_springs.nodes] = structure.node_springs.stiffness
    return springs


def _loose_motion(points: Floats, carried: Booleans, size: float) -> Floats | None:
    """A shift and a rotation times the size about the middle of points (n, 3) that nothing carries, (6,); None: none.

    Parameters
    ----------
    points : (n, 3)
    carried : (n, 6) bool
        Shifts and rotations that are held or on springs.
    size : float
        m.
    """
    arms = (points - points.mean(0)) / size
    # of a unit rotation w the shift is w x arm
    shift = np.concatenate((np.tile(np.eye(3), (len(points), 1, 1)), -_cross(arms)), 2)
    turn = np.concatenate((np.zeros((3, 3)), np.eye(3)), 1)
    rows = np.concatenate((shift[carried[:, :3]], np.tile(turn, (len(points), 1, 1))[carried[:, 3:]]))
    values, vectors = np.linalg.eigh(rows.T @ rows)
    if values[0] > LEAST_HELD * max(values[-1], 1.0):
        return None
    return np.asarray(vectors[:, 0])


def _cross(arms: Floats) -> Floats:
    """Matrices whose products with w are arm x w, (n, 3, 3)."""
    result = np.zeros((*arms.shape, 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        result[:, j, i], result[:, i, j] = arms[:, k], -arms[:, k]
    return result


def _farthest(points: Floats, nodes: Integers, motion: Floats, size: float) -> int:
    """The node that such a motion moves most; of nodes alike the first, whatever the last bits."""
    moved = np.linalg.norm(motion[:3] + np.cross(motion[3:], (points - points.mean(0)) / size), axis=1)
    return int(nodes[np.round(moved, 9).argmax()])
