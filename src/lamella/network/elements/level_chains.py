"""Level lines through small flat triangles, as chains of links: one across each triangle they pass."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components, depth_first_order

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.errors import InputError
from lamella.network.elements.integer_grid_map import IntegerGridMap
from lamella.network.elements.small_triangles import SmallTriangles, integer_transitions
from lamella.network.network import A

# how a chain ends
CLOSED, RIM, SINGULAR_END, SEAM_END = range(4)


@dataclass(frozen=True)
class Chains:
    """The level lines of one family, link by link.

    Attributes
    ----------
    offsets : (c + 1,) int
        Where each chain's links begin.
    triangle : (l,) int
        Small triangle of each link.
    level : (l,) int
        The line's whole number on that triangle's sheet.
    start, end : (l,)
        The other coordinate where the link begins and ends, on that sheet.
    local_start, local_end : (l, 2)
        Local coordinates there.
    ends : (c, 2) int
        How each chain begins and ends: `CLOSED`, `RIM`, `SINGULAR_END`, `SEAM_END`.
    """

    offsets: Integers
    triangle: Integers
    level: Integers
    start: Floats
    end: Floats
    local_start: Floats
    local_end: Floats
    ends: Integers

    @property
    def owner(self) -> Integers:
        """Chain of each link, (l,)."""
        return np.repeat(np.arange(len(self.offsets) - 1), np.diff(self.offsets))


@dataclass(frozen=True)
class _Links:
    """Pieces of level lines across small triangles, from a triangle's long edge to a short one.

    Attributes
    ----------
    triangle, level : (l,) int
    at_long, at_short : (2, l) int
        Ends of the edges, as numbers of all triangles' corners one after the other. Where a line runs into the middle
        corner, that is the first end of the short one.
    names : (p,) int
        Of the points where lines cross edges, ascending.
    one, two : (l,) int
        The points of each link on the long and on the short edge, as rows of the names.
    width, base : int
        A name is the edge's key times the width, plus the level above the base.
    beyond : int
        Names from here on are those of ends in singular corners.
    """

    triangle: Integers
    level: Integers
    at_long: Integers
    at_short: Integers
    names: Integers
    one: Integers
    two: Integers
    width: int
    base: int
    beyond: int


@dataclass(frozen=True)
class _Walk:
    """Links in order along the chains.

    Attributes
    ----------
    use : (l,) int
        The links, chain after chain.
    offsets : (c + 1,) int
        Where each chain's links begin.
    forward : (l,) bool
        Whether each of them runs from its point `one` to `two`.
    tips : (c, 2) int
        The points where each chain begins and ends, -1 where it is closed.
    """

    use: Integers
    offsets: Integers
    forward: Booleans
    tips: Integers


def level_chains(small: SmallTriangles, cells: IntegerGridMap, family: int) -> Chains:
    """All level lines of a family: of A Im chi is whole, of B Re chi."""
    value, other = (small.chi.imag, small.chi.real) if family == A else (small.chi.real, small.chi.imag)
    links = _links(small, value)
    walk = _walk(links, _jumps(small, cells, family, links))
    use, forward = walk.use, walk.forward
    (t_long, p_long), (t_short, p_short) = (
        _on_edge(small, value, other, at.take(use, 1), links.level[use]) for at in (links.at_long, links.at_short)
    )
    return Chains(
        walk.offsets,
        links.triangle[use],
        links.level[use],
        np.where(forward, t_long, t_short),
        np.where(forward, t_short, t_long),
        np.where(forward[:, None], p_long, p_short),
        np.where(forward[:, None], p_short, p_long),
        _end_kinds(small, links, walk.tips),
    )


def _links(small: SmallTriangles, value: Floats) -> _Links:
    """Where the values at the grid points are whole, triangle by triangle."""
    at_corners = np.ascontiguousarray(value.take(small.corners).T)
    a, b, c = at_corners
    passed = np.ceil(np.minimum(np.minimum(a, b), c)) <= np.floor(np.maximum(np.maximum(a, b), c))
    triangle = np.flatnonzero(passed)
    # corners by value, as numbers of all triangles' corners one after the other
    by_value = 3 * triangle + _ranks(at_corners.take(triangle, 1))
    grid_points = small.corners.ravel()
    low, middle, high = value.take(grid_points.take(by_value))
    first, last = np.ceil(low).astype(np.int64), np.floor(high).astype(np.int64)
    count = last - first + 1
    own = np.repeat(np.arange(len(count)), count)
    level = first[own] + np.arange(len(own)) - np.repeat(np.cumsum(count) - count, count)
    # a line that only touches a singular corner is not there
    keep = (level != low[own]) & (level != high[own])
    own, level = own[keep], level[keep]
    # ends of each link: the long edge, and the short one on the level's side, as their corners (2, l)
    mine = by_value.take(own, 1)
    at_long, at_short = mine[::2], np.where(level < middle[own], mine[:2], mine[1:])
    points = len(small.chi)
    base = int(level.min(initial=0)) - 1
    width = int(level.max(initial=0)) - base + 2
    _refuse_unnameable(points, width, len(level))
    # a crossing's name: its edge, and which whole number
    crossing = np.concatenate([_edge_keys(grid_points.take(at), points) for at in (at_long, at_short)]) * width
    crossing += np.tile(level - base, 2)
    # a link that ends in a singular corner has an end of its own there, named beyond all edges
    ended = np.flatnonzero(level == middle[own])
    beyond = points**2 * width
    crossing[len(level) + ended] = beyond + ended
    # with the first of each as well it sorts by runs, of which there are long ones: twice as fast
    names, _, crossing = np.unique(crossing, return_index=True, return_inverse=True)
    one, two = crossing[: len(level)], crossing[len(level) :]
    return _Links(triangle[own], level, at_long, at_short, names, one, two, width, base, beyond)


def _walk(links: _Links, jumps: tuple[Integers, Integers]) -> _Walk:
    """Links one after the other, over the pairs of points that are one across a cut."""
    total = len(links.names)
    tail, head = np.concatenate([links.one, jumps[0]]), np.concatenate([links.two, jumps[1]])
    degree = np.bincount(np.concatenate([tail, head]), minlength=total)
    graph = coo_matrix((np.ones(len(tail)), (tail, head)), (total, total))
    chains, group = connected_components(graph, directed=False)
    # each chain begins at a loose end; a closed one anywhere, with one link taken out
    begin = np.full(chains, -1)
    loose = np.flatnonzero(degree == 1)
    # a singular end goes first
    is_singular = links.names >= links.beyond
    for some in (loose[::-1], loose[is_singular[loose]][::-1]):
        begin[group[some]] = some
    closed = begin < 0
    opened = np.zeros(len(tail), bool)
    for chain in np.flatnonzero(closed):
        link = int(np.flatnonzero(group[tail] == chain)[0])
        opened[link], begin[chain] = True, head[link]
    position = _depth_first(tail[~opened], head[~opened], begin, total)
    real = np.arange(len(tail)) < len(links.one)
    # a link's place in its chain: that of its earlier end, a closed chain's opened link last
    early = np.minimum(position[tail], position[head])
    early[opened] = np.maximum(position[tail], position[head])[opened]
    forward = (position[tail] < position[head]) ^ opened
    # no two links have the same place, and the walk takes one chain after the other
    at_place = np.full(total, -1)
    at_place[early[real]] = np.flatnonzero(real)
    use = at_place[at_place >= 0]
    chain_rank = np.argsort(position[begin], kind="stable")
    new_number = np.empty(chains, np.int64)
    new_number[chain_rank] = np.arange(chains)
    offsets = np.searchsorted(new_number[group[tail[use]]], np.arange(chains + 1))
    tips = np.stack([np.where(closed, -1, begin), np.full(chains, -1)], 1)
    far = loose[begin[group[loose]] != loose]
    tips[group[far], 1] = far
    return _Walk(use, offsets, forward[use], tips[chain_rank])


def _depth_first(tail: Integers, head: Integers, begin: Integers, total: int) -> Integers:
    """Places (p,) of points on a walk over all chains, from where each of them begins."""
    source = np.full(len(begin), total)
    graph = coo_matrix(
        (np.ones(len(tail) + len(begin)), (np.r_[tail, source], np.r_[head, begin])), (total + 1, total + 1)
    ).tocsr()
    walk, _ = depth_first_order(graph + graph.T, total, directed=False)
    position = np.empty(total, np.int64)
    position[walk[1:]] = np.arange(total)
    return position


def _on_edge(
    small: SmallTriangles, value: Floats, other: Floats, at: Integers, level: Integers
) -> tuple[Floats, Floats]:
    """The other coordinate (l,) and the local coordinates (l, 2) where edges (2, l) have their levels."""
    corners = small.local.reshape(-1, 2)
    edge = small.corners.ravel().take(at)
    first, second = value.take(edge)
    share = (level - first) / (second - first)
    first, second = other.take(edge)
    t = first + share * (second - first)
    first, second = corners.take(at % len(corners), 0)
    return t, first + share[:, None] * (second - first)


def _end_kinds(small: SmallTriangles, links: _Links, tips: Integers) -> Integers:
    """How each chain begins and ends, (c, 2), by its tips (c, 2)."""
    kinds = np.full(tips.shape, CLOSED)
    cut = _edge_keys(np.concatenate([small.cut_left, small.cut_right]).T, len(small.chi))
    name = links.names[tips[tips >= 0]]
    kind = np.where(np.isin(name // links.width, cut), SEAM_END, RIM)
    kinds[tips >= 0] = np.where(name >= links.beyond, SINGULAR_END, kind)
    return kinds


def _refuse_unnameable(points: int, width: int, links: int) -> None:
    """Crossings are named by whole numbers, which end at 2^63."""
    names = points**2 * width + links
    if names > np.iinfo(np.int64).max:
        raise InputError(
            f"a net {width:,} cells wide on elements cut at {points:,} places has {float(names):.2g} names for the "
            f"crossings of its lamellas (limit {float(np.iinfo(np.int64).max):.2g})",
            "choose fewer cells (or a larger spacing), or a larger tolerance of the surface",
            "cells",
        )


def _edge_keys(ends: Integers, points: int) -> Integers:
    """A whole number below points^2 for each edge between two of so many points, columns of (2, n)."""
    one, other = ends
    return np.asarray(np.minimum(one, other) * points + np.maximum(one, other))


def _ranks(values: Floats) -> Integers:
    """Rows of three values a column in ascending order, (3, n)."""
    a, b, c = values
    # how many of the others go before each: equal ones in the order of the rows
    place_a = (b < a).astype(np.int64) + (c < a)
    place_b = (a <= b).astype(np.int64) + (c < b)
    result = np.empty(values.shape, np.int64)
    columns = np.arange(len(a))
    result[place_a, columns], result[place_b, columns], result[3 - place_a - place_b, columns] = 0, 1, 2
    return result


def _jumps(small: SmallTriangles, cells: IntegerGridMap, family: int, links: _Links) -> tuple[Integers, Integers]:
    """Pairs of crossings that are the same point on both sides of a cut."""
    whole = integer_transitions(cells, family)
    goes_on = ~np.isnan(whole[small.cut_piece]) if len(whole) else np.zeros(0, bool)
    left, right, piece = small.cut_left[goes_on], small.cut_right[goes_on], small.cut_piece[goes_on]
    if not len(left):
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    value = small.chi.imag if family == A else small.chi.real
    low, high = value[left].min(1), value[left].max(1)
    first, last = np.ceil(low).astype(np.int64), np.floor(high).astype(np.int64)
    count = np.maximum(last - first + 1, 0)
    edge = np.repeat(np.arange(len(count)), count)
    level = first[edge] + np.arange(len(edge)) - np.repeat(np.cumsum(count) - count, count)
    there = cells.signs[piece[edge]] * level + whole[piece[edge]].astype(np.int64)

    def crossing(pair: Integers, at: Integers) -> tuple[Integers, Booleans]:
        name = _edge_keys(pair.T, len(small.chi)) * links.width + at - links.base
        index = np.minimum(np.searchsorted(links.names, name), len(links.names) - 1)
        return index, (at - links.base >= 0) & (at - links.base < links.width) & (links.names[index] == name)

    one, has_one = crossing(left[edge], level)
    two, has_two = crossing(right[edge], there)
    both = has_one & has_two
    return one[both], two[both]
