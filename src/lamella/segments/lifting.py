"""Where a segment is lifted: at three nodes around its centre of gravity."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from lamella.base.arrays import Floats, Integers

# nodes among which three are chosen
NODES_TRIED = 36
# of the weight, that each of the three has to carry where that can be
LEAST_SHARE = 0.2


def lifting_nodes(nodes: Integers, points: Floats, centre: Floats) -> tuple[Integers, Floats]:
    """Three nodes to lift at, and the share of the weight that each carries.

    In plan the centre of gravity lies in their triangle, so that three slings carry shares that equilibrium alone
    decides: its barycentric coordinates. Of all triangles in which each node carries a fifth or more the largest is
    taken; where there is none, that in which the least share is largest. Among many nodes those are tried that lie
    farthest out in 36 directions.

    Parameters
    ----------
    nodes : (n,) int
    points : (n, 3)
        Where they are, m; z up.
    centre : (3,)
        Of gravity, m.

    Returns
    -------
    nodes, shares : (3,), (3,)
        Empty where no three nodes surround the centre.
    """
    flat = points[:, :2] - centre[:2]
    if len(nodes) > NODES_TRIED:
        angle = 2 * np.pi * np.arange(NODES_TRIED) / NODES_TRIED
        along = np.round(flat @ np.stack([np.cos(angle), np.sin(angle)]), 6)
        kept = np.unique(along.argmax(axis=0))
        nodes, flat = nodes[kept], flat[kept]
    if len(nodes) < 3:
        return nodes[:0], np.empty(0)
    triples = np.array(list(combinations(range(len(nodes)), 3)))
    a, b, c = (flat[triples[:, k]] for k in range(3))
    double = _cross(b - a, c - a)
    wide = np.abs(double) > 1e-9 * float(np.ptp(flat, axis=0).max()) ** 2
    safe = np.where(wide, double, 1.0)
    shares = np.column_stack([_cross(b, c), _cross(c, a), _cross(a, b)]) / safe[:, None]
    least = np.where(wide, np.round(shares.min(axis=1), 6), -1.0)
    if least.max() <= 0:
        return nodes[:0], np.empty(0)
    good = least >= LEAST_SHARE
    rank = np.where(good, np.round(np.abs(double), 6), -1.0) if good.any() else least
    best = int(np.argmax(rank))
    return nodes[triples[best]], shares[best]


def _cross(one: Floats, other: Floats) -> Floats:
    return np.asarray(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0])
