"""What holds a body in space without holding its shape."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.ties import grid_of, rounded

# of a row of the rigid motions that are left, by its length: less is none
NO_HOLD = 1e-6
# how little resistance of a moved node is still taken before that of any other
OTHERWISE = 1e-3


def rigid_holds(points: Floats, held: Booleans, able: Booleans, moved: Integers) -> Booleans:
    """Single shifts of nodes to be held, so that nothing moves as a rigid body: no more than that takes.

    They carry nothing where what acts is in balance.

    Parameters
    ----------
    points : (n, 3)
        m.
    held : (n, 3) bool
        Shifts that are held already.
    able : (n,) bool
        Nodes that may be held.
    moved : (p,) int
        Nodes that are held and moved: where they can, further shifts of theirs are held. A ring that is held in its
        plane is free to tilt to first order only, and elsewhere a hold would tilt it.

    Returns
    -------
    (n, 3) bool
        Further ones: of those that resist the motions that are left, the one that resists most each time, and the
        first of several alike.
    """
    at = points - points[able].mean(0)
    at = at / np.linalg.norm(at[able], axis=1).max()
    # shifts and rotations of all nodes, (n, 3, 6)
    turns = np.stack([np.cross(np.broadcast_to(axis, at.shape), at) for axis in np.eye(3)], 2)
    motions = np.concatenate((np.broadcast_to(np.eye(3), (len(at), 3, 3)), turns), 2)
    left = _null_space(motions[held])
    weight = np.where(able, OTHERWISE, 0.0)
    weight[moved] = 1.0
    more = np.zeros_like(held)
    while left.shape[1]:
        resists = np.linalg.norm(motions @ left, axis=2)
        resists *= weight[:, None]
        node, way = divmod(int(rounded(resists.ravel(), grid_of(OTHERWISE)).argmax()), 3)
        more[node, way] = True
        left = left @ _null_space(motions[node, way][None] @ left)
    return more


def _null_space(rows: Floats) -> Floats:
    """Orthonormal columns that all rows (r, c) are orthogonal to, (c, c - rank)."""
    if not len(rows):
        return np.eye(rows.shape[1])
    _, sizes, axes = np.linalg.svd(rows)
    rank = int((sizes > NO_HOLD * max(1.0, float(sizes[0]))).sum())
    return np.asarray(axes[rank:].T)
