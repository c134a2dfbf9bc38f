"""In which order the lamellas of a net are numbered, and which way they run.

From the rim alone, so that a net is numbered alike on whatever elements, turned, mirrored or scaled: each family in the
order in which its ends are met along the outer loop, from the first lamella on whose two ends follow each other there;
then along the holes. What has no end on a rim follows in the order in which it crosses those that have one.
"""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.triangle import CORNERS
from lamella.network.elements.crossings import Crossings
from lamella.network.elements.integer_grid_map import IntegerGridMap
from lamella.network.elements.level_chains import CLOSED, RIM, SINGULAR_END
from lamella.network.elements.level_curves import LevelCurves, rim_tips
from lamella.network.network import A, B
from lamella.surface.element.places import Places
from lamella.surface.element.rim import ElementRim

# of a loop: an end this near before its start is met last of all, or first: first
AT_START = 1e-3


def rim_places(cells: IntegerGridMap, rims: tuple[ElementRim, ...], places: Places) -> tuple[Integers, Floats, Floats]:
    """Loop (n,), share of its length from its start on (n,), and direction (n, 3) of places on edges of the rim."""
    mesh = cells.mesh
    connectivity = mesh.connectivity
    loop, start, span = np.full(len(mesh.loop), -1), np.zeros(len(mesh.loop)), np.zeros(len(mesh.loop))
    for number, rim in enumerate(rims):
        loop[rim.vertices] = number
        start[rim.vertices] = rim.starts - rim.place_of(mesh.rim_starts[number])
        span[rim.vertices] = np.diff(np.append(rim.starts, 1.0))
    barycentric = np.column_stack([1 - places.local.sum(1), places.local])
    barycentric[connectivity.neighbours[places.element[:, None], (np.arange(3) + 1) % 3] >= 0] = np.inf
    edge = (barycentric.argmin(1) + 1) % 3
    along = CORNERS[(edge + 1) % 3] - CORNERS[edge]
    share = ((places.local - CORNERS[edge]) * along).sum(1) / (along**2).sum(1)
    vertex = connectivity.faces[places.element, edge]
    _, first, second = cells.tangents(places)
    direction = along[:, :1] * first + along[:, 1:] * second
    direction /= np.linalg.norm(direction, axis=1)[:, None]
    return loop[vertex], (start[vertex] + share * span[vertex]) % 1, direction


def numbered(
    cells: IntegerGridMap, rims: tuple[ElementRim, ...], level_curves: LevelCurves, crossings: Crossings, kept: Integers
) -> LevelCurves:
    """Chains in the order of their numbers, A before B, each from its beginning on.

    Parameters
    ----------
    cells : IntegerGridMap
    rims : tuple of ElementRim
        Of the cell map's mesh.
    level_curves : LevelCurves
    crossings : Crossings
        Of those that are kept.
    kept : (k,) int
        The chains to keep.
    """
    chains = len(level_curves.family)
    rank, backward = np.full(chains, np.inf), np.zeros(chains, bool)
    at_rim = level_curves.ends == RIM
    left_out = np.ones(chains, bool)
    left_out[kept] = False
    at_rim[left_out] = False
    chain, side = np.nonzero(at_rim)
    loop, place, _ = rim_places(cells, rims, rim_tips(cells, level_curves)[1][2 * chain + side])
    place = (place + AT_START) % 1
    for family in (A, B):
        mine = np.flatnonzero(level_curves.family[chain] == family)
        met = mine[np.lexsort((place[mine], loop[mine]))]
        met = np.concatenate([_from_a_turn(chain, met[loop[met] == 0]), met[loop[met] > 0]])
        found, first = np.unique(chain[met], return_index=True)
        rank[found] = first
        backward[found] = side[met[first]] == 1
    # a ray runs out of its singular node
    backward = np.where(level_curves.ends[:, 0] == SINGULAR_END, False, backward)
    backward = np.where(
        (level_curves.ends[:, 1] == SINGULAR_END) & (level_curves.ends[:, 0] != SINGULAR_END), True, backward
    )
    rolled = np.where(backward, level_curves.links - 1, 0)
    inner = ~at_rim.any(1) & ~left_out
    if inner.any():
        _rank_inner(level_curves, crossings, rank, backward, rolled, inner)
    order = kept[np.lexsort((kept, rank[kept], level_curves.family[kept]))]
    return level_curves.arranged(order, backward[order], rolled[order])


def _from_a_turn(chain: Integers, met: Integers) -> Integers:
    """Ends met along a closed loop from between two of one chain on, where there are such: the first from the start."""
    own = chain[met]
    turns = np.flatnonzero(own == np.roll(own, 1))
    return np.roll(met, -int(turns[0])) if len(turns) else met


def _rank_inner(
    level_curves: LevelCurves,
    crossings: Crossings,
    rank: Floats,
    backward: Booleans,
    rolled: Integers,
    inner: Booleans,
) -> None:
    """Rank chains without an end on a rim by the first ranked chain that they cross, and then by where along it."""
    whole = np.bincount(level_curves.owner, level_curves.span, len(rank))
    outer = np.where(np.isinf(rank), np.inf, rank)
    keys = np.full((len(rank), 2), np.inf)
    for family in (A, B):
        one, other = crossings.chain[[family, 1 - family]]
        here, there = crossings.tau[[family, 1 - family]]
        there = np.where(backward[other], whole[other] - there, there)
        mine = np.flatnonzero(inner[one] & ~np.isinf(outer[other]))
        for k in np.unique(one[mine]).tolist():
            at = mine[one[mine] == k]
            at = at[np.lexsort((there[at], outer[other[at]]))]
            keys[k] = outer[other[at[0]]], there[at[0]]
            along = at[np.argsort(here[at])]
            met = outer[other[along]]
            if level_curves.ends[k, 0] == CLOSED:
                begin = int(np.flatnonzero(along == at[0])[0])
                backward[k] = met[(begin - 1) % len(met)] < met[(begin + 1) % len(met)]
                links = level_curves.tau[level_curves.first[k] : level_curves.last[k] + 1]
                rolled[k] = int(np.searchsorted(links, here[at[0]], side="right")) - 1
            elif (level_curves.ends[k, 0] == SINGULAR_END) == (level_curves.ends[k, 1] == SINGULAR_END):
                backward[k] = met[-1] < met[0]
                rolled[k] = level_curves.links[k] - 1 if backward[k] else 0
    order = np.lexsort((keys[:, 1], keys[:, 0]))
    later = order[inner[order]]
    rank[later] = len(crossings.chain[0]) + len(rank) * 2 + np.arange(len(later))
