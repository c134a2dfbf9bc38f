"""Strip ends that run into each other beyond the rim, where no slot is cut."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.ragged import ragged_ranges
from lamella.network.network import BOUNDARY, Network


def end_collisions(network: Network, before: Floats, after: Floats, spread: float) -> tuple[list[str], float]:
    """Pairs of an A and a B strip that meet beyond the rim nodes where they end, and by how much ends are too long.

    Parameters
    ----------
    network : Network
    before, after : (m,)
        How far each lamella's strip reaches beyond its first and its last node, m (negative: it stops short).
    spread : float
        From a lamella's centre line to the middle of its outermost layer, m.

    Returns
    -------
    pairs : list of str
        "A1 and B2", by their ids.
    excess : float
        How much shorter all ends have to be for one of each pair to end before the other, m; infinite where no length
        does, since the strips' own width meets.
    """
    first, last = network.sample_offsets[:-1], network.sample_offsets[1:] - 1
    node = np.r_[network.stop_nodes[network.stop_offsets[:-1]], network.stop_nodes[network.stop_offsets[1:] - 1]]
    sample = np.r_[first, last]
    outwards = np.repeat([-1.0, 1.0], len(first))[:, None] * network.sample_tangents[sample]
    reach = np.r_[before, after] + spread
    is_a = np.tile(network.families == "A", 2)
    free = (network.node_kinds[node] == BOUNDARY) & (reach > 0)
    a, b = np.flatnonzero(free & is_a), np.flatnonzero(free & ~is_a)
    if not len(a) or not len(b):
        return [], 0.0
    points = network.sample_points[sample]
    near = _near(points[a], points[b], 2 * float(reach[free].max()))
    a, b = a[near[0]], b[near[1]]
    # where the two straight ends p + x t come closest: they are nearly at right angles
    gap = points[b] - points[a]
    cosine = np.einsum("ij,ij->i", outwards[a], outwards[b])
    along_a, along_b = (np.einsum("ij,ij->i", gap, outwards[end]) for end in (a, b))
    square = 1 - np.minimum(cosine**2, 0.99)
    x_a, x_b = (along_a - cosine * along_b) / square, (cosine * along_a - along_b) / square
    # a node that both share has its slot
    meet = (node[a] != node[b]) & (x_a > 0) & (x_b > 0) & (x_a < reach[a]) & (x_b < reach[b])
    excess = np.minimum(*(np.where(x >= spread, reach[end] - x, np.inf)[meet] for end, x in ((a, x_a), (b, x_b))))
    lamella = np.tile(np.arange(len(first)), 2)
    pairs = np.unique(np.column_stack([lamella[a[meet]], lamella[b[meet]]]), axis=0)
    names = [f"{network.ids[one]} and {network.ids[other]}" for one, other in pairs.tolist()]
    return names, float(excess.max(initial=0.0))


def _near(one: Floats, other: Floats, distance: float) -> tuple[Integers, Integers]:
    """Indices of all pairs of points (n, 3), (m, 3) at most that far apart.

    Ends are few: they are sorted along the axis in which they spread most. (A k-d tree is faster for many, but scipy's
    takes longer to import than a check of a closed form has.)
    """
    axis = int(np.ptp(np.concatenate([one, other]), axis=0).argmax())
    order = np.argsort(other[:, axis], kind="stable")
    along = other[order, axis]
    begin = np.searchsorted(along, one[:, axis] - distance, side="left")
    counts = np.searchsorted(along, one[:, axis] + distance, side="right") - begin
    first = np.repeat(np.arange(len(one)), counts)
    second = order[np.repeat(begin, counts) + ragged_ranges(counts)]
    close = ((one[first] - other[second]) ** 2).sum(1) <= distance**2
    return first[close], second[close]
