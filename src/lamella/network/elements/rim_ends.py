"""What happens where lamellas, or their crossings, lie on the rim but for the surface's own error.

A straight beam is an asymptotic line: a line of the lattice along it is the beam and no lamella. A crossing on the rim
is one boundary node, at which both lamellas end, whether the error of the surface puts it inside or beyond. Both are
decided with margins in cells that are the same for all surfaces, far above the error of any.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.vectors import crosses, dots, lengths
from lamella.network.elements.crossings import Crossings
from lamella.network.elements.integer_grid_map import IntegerGridMap
from lamella.network.elements.level_chains import RIM, SINGULAR_END
from lamella.network.elements.level_curves import LevelCurves
from lamella.network.network import A, B
from lamella.surface.element.places import Places
from lamella.surface.element.rim import ElementRim

# cells: a line that keeps as near to the rim all along is the rim, and what is left of a line behind a boundary node
ALONG = 0.05
# cells: a crossing as near to the end of one of its lines is a boundary node
AT_END = 5e-3
# places along each loop between which the rim counts as straight
RIM_SAMPLES = 4000


class Ends(NamedTuple):
    """Ends of chains on the rim.

    Attributes
    ----------
    tips : (c, 2)
        tau where each chain begins and ends.
    node : (c, 2) int
        The crossing that is the node there; beyond the crossings a number that two chains may share; -1: an own one.
    shared : int
        How many such numbers there are.
    boundary : (n,) bool
        Crossings that are boundary nodes.
    places : Places
        Where the chains meet the rim, (2 c).
    """

    tips: Floats
    node: Integers
    shared: int
    boundary: Booleans
    places: Places


def _to_ends(level_curves: LevelCurves, tips: Floats, crossings: Crossings) -> Floats:
    """How far the crossings are from both ends of their chains on the rim, cells, (2, n, 2); inf: no such end."""
    away = np.abs(crossings.tau[:, :, None] - tips[crossings.chain])
    return np.where(level_curves.ends[crossings.chain] == RIM, away, np.inf)


def along_rim(
    cells: IntegerGridMap, rims: tuple[ElementRim, ...], level_curves: LevelCurves, tips: Floats, crossings: Crossings
) -> Booleans:
    """Chains (c,) that are the rim: all that crosses them ends within `ALONG` from there, or they lie as near to it.

    Rays of a singular node are none: the node lies inside, however near to the rim, and cells next to it are large.
    """
    chains = len(level_curves.family)
    ray = (level_curves.ends == SINGULAR_END).any(1)
    near = _to_ends(level_curves, tips, crossings).min(2) < ALONG
    inside, beside = np.zeros(chains), np.zeros(chains)
    for family in (A, B):
        mine, other = crossings.chain[family], near[1 - family]
        inside += np.bincount(mine, ~other, chains)
        # a crossing in a corner is near to the ends of both
        beside += np.bincount(mine, other & ~near[family], chains)
    result = ~ray & (inside == 0) & (beside > 0)
    for chain in np.flatnonzero(~ray & (inside == 0) & (beside == 0)).tolist():
        links = slice(int(level_curves.first[chain]), int(level_curves.last[chain]) + 1)
        points = cells.positions(Places(level_curves.element[links], level_curves.local_end[links]))
        points = np.vstack(
            [cells.positions(Places(level_curves.element[links], level_curves.local_start[links]))[:1], points]
        )
        edge = lengths(np.diff(points, axis=0)).sum() / max(float(level_curves.span[links].sum()), 1e-12)
        result[chain] = _from_rims(rims, points).max() < ALONG * edge
    return np.asarray(result, bool)


def _from_rims(rims: tuple[ElementRim, ...], points: Floats) -> Floats:
    """Distance of points (n, 3) from the rim, m."""
    share = np.arange(RIM_SAMPLES) / RIM_SAMPLES
    apart = np.full(len(points), np.inf)
    for rim in rims:
        along = rim.at(share)
        _, nearest = cKDTree(along).query(points)
        for begin, end in ((nearest - 1, nearest), (nearest, (nearest + 1) % RIM_SAMPLES)):
            step, off = along[end] - along[begin], points - along[begin]
            part = np.clip(dots(off, step) / np.maximum(dots(step, step), 1e-300), 0, 1)
            apart = np.minimum(apart, lengths(off - part[:, None] * step))
    return apart


def within_tips(level_curves: LevelCurves, tips: Floats, crossings: Crossings) -> Booleans:
    """Crossings (n,) between the exact ends of their chains: others are there on flat triangles alone."""
    low, high = tips[crossings.chain].transpose(2, 0, 1)
    open_ = level_curves.ends[crossings.chain] == RIM
    before = open_[..., 0] & (crossings.tau < low - AT_END)
    behind = open_[..., 1] & (crossings.tau > high + AT_END)
    return np.asarray(~(before | behind).any(0), bool)


def settled_ends(
    cells: IntegerGridMap, level_curves: LevelCurves, tips: Floats, places: Places, crossings: Crossings
) -> Ends:
    """Which crossings are boundary nodes, and where chains end.

    Parameters
    ----------
    cells : IntegerGridMap
    level_curves : LevelCurves
    tips : (c, 2)
        Exact tau of the ends on the rim.
    places : Places
        Of these, (2 c).
    crossings : Crossings
    """
    tips = tips.copy()
    node = np.full(tips.shape, -1)
    away = _to_ends(level_curves, tips, crossings)
    boundary = np.asarray((away < AT_END).any((0, 2)), bool)
    for family in (A, B):
        # what is left of a line behind a boundary node is no piece of its own
        at, side = np.nonzero(boundary[:, None] & (away[family] < ALONG))
        chain = crossings.chain[family, at]
        node[chain, side], tips[chain, side] = at, crossings.tau[family, at]
    count = len(boundary)
    chain, side, tau, position, edge = _whole_tips(cells, level_curves, tips, places, node)
    is_a = level_curves.family[chain] == A
    one, other = np.flatnonzero(is_a), np.flatnonzero(~is_a)
    shared = 0
    if len(one) and len(other):
        apart, nearest = cKDTree(position[other]).query(position[one])
        met = np.flatnonzero(apart < 3 * AT_END * edge[one])
        # each end of a B chain once, with the nearest A chain
        met = met[np.argsort(apart[met], kind="stable")]
        _, first = np.unique(nearest[met], return_index=True)
        met = met[np.sort(first)]
        shared = len(met)
        for rows in (one[met], other[nearest[met]]):
            node[chain[rows], side[rows]], tips[chain[rows], side[rows]] = count + np.arange(shared), tau[rows]
    return Ends(tips, node, shared, boundary, places)


def _whole_tips(
    cells: IntegerGridMap, level_curves: LevelCurves, tips: Floats, places: Places, node: Integers
) -> tuple[Integers, Integers, Floats, Floats, Floats]:
    """Ends on the rim that have no crossing but a whole number nearby: chain, side, its tau, position, cell edge, m."""
    chain, side = np.nonzero((level_curves.ends == RIM) & (node < 0))
    link = np.where(side == 0, level_curves.first[chain], level_curves.last[chain])
    other = level_curves.start[link] + (tips[chain, side] - level_curves.tau[link]) * level_curves.direction[link]
    beyond = (np.round(other) - other) * level_curves.direction[link]
    near = np.abs(beyond) < AT_END
    chain, side, beyond = chain[near], side[near], beyond[near]
    chi, (position, first, second) = cells.jet_and_tangents(places[2 * chain + side])
    turned = np.abs(chi[1].real * chi[2].imag - chi[1].imag * chi[2].real)
    edge = np.sqrt(lengths(crosses(first, second)) / np.maximum(turned, 1e-300))
    return chain, side, tips[chain, side] + beyond, position, edge
