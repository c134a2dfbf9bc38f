"""Lamellas as chains through small flat triangles: which crosses which, before anything is placed exactly.

Every element is cut into small triangles on which chi is taken as linear. A level line then enters and leaves each of
them once, and a whole number of chi inside lies on one line of either family: the net's combinatorics follow without
tolerances. Exact places come afterwards, from Newton's method.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components, depth_first_order

from lamella.base.arrays import Booleans, Complexes, Floats, Integers
from lamella.base.errors import InputError
from lamella.network.elements.integer_grid_map import CellMap
from lamella.network.isothermic.isothermic import sectors
from lamella.network.network import A, B
from lamella.surface.element.connectivity import connect
from lamella.surface.element.lagrange import local_faces

# small triangles reach over at most this many cells; parts of an element's edge at least and at most
REACH, FEWEST, MOST = 0.4, 3, 24
# cells; values as near as this to a whole number are moved off it
NUDGE = 1e-9
# lines of a family go on where the shift is as near as this to a whole number of cells
WHOLE = 1e-6
# how a chain ends
CLOSED, RIM, SINGULAR_END, SEAM_END = range(4)


@dataclass(frozen=True)
class SmallTriangles:
    """Elements cut into small triangles.

    Attributes
    ----------
    element : (t,) int
    corners : (t, 3) int
        Grid points, the same across edges that are not cut.
    local : (f, 3, 2)
        Local coordinates of the corners, the same in every element: its f small triangles follow each other.
    chi : (g,) complex
        At the grid points.
    singular : (g, 2) bool
        Grid points that are umbilics with a whole real part, and imaginary part, of chi: lamellas of B, and of A, end
        there.
    """

    element: Integers
    corners: Integers
    local: Floats
    chi: Complexes
    singular: Booleans
    cut_left: Integers
    cut_right: Integers
    cut_piece: Integers


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


def small_triangles(cells: CellMap, cut: Booleans, umbilics: Integers) -> SmallTriangles:
    """Cut the elements of a cell map.

    Parameters
    ----------
    cells : CellMap
    cut : (m, 3) bool
        Edges that are cut.
    umbilics : (z,) int
        Vertices that may be singular nodes.
    """
    connectivity = cells.mesh.connectivity
    corner = cells.value[:, :3]
    span = np.abs(corner - np.roll(corner, 1, 1)).max()
    parts = int(np.clip(np.ceil(span / REACH), FEWEST, MOST))
    grid = connect(connectivity.faces, int(connectivity.faces.max()) + 1, parts)
    local = grid.basis.nodes
    point = sectors(grid, cut)
    values = cells.value @ connectivity.basis.basis(local).T
    for vertex in umbilics.tolist():
        _straighten(values, cells, local, vertex)
    chi = np.zeros(int(point.max()) + 1, complex)
    chi[point] = values
    # umbilics on the lattice have whole values; no other grid point may
    singular = np.zeros((len(chi), 2), bool)
    pair = np.stack([chi.real, chi.imag], 1)
    for vertex in umbilics.tolist():
        element, which = np.nonzero(connectivity.faces == vertex)
        at = np.unique(point[element, which])
        settled = (np.abs(pair[at] - np.round(pair[at])) < WHOLE).all(0)
        singular[at] = settled
        pair[at] = np.where(settled, np.round(pair[at]), pair[at])
    near = (np.abs(pair - np.round(pair)) < NUDGE) & ~singular
    pair += np.where(near, 3 * NUDGE, 0)
    chi = pair[:, 0] + 1j * pair[:, 1]
    # both sides of a cut alike to the last digit, where the net goes on across it
    element, edge = np.nonzero(cells.across > 0)
    piece = cells.across[element, edge] - 1
    neighbour, other = connectivity.neighbours[element, edge], connectivity.neighbour_edges[element, edge]
    left = point[element[:, None], grid.basis.edge_nodes[edge]]
    right = point[neighbour[:, None], grid.basis.edge_nodes[other][:, ::-1]]
    pair = np.stack([chi.real, chi.imag], 1)
    for family, whole in enumerate((whole_shifts(cells, A), whole_shifts(cells, B))):
        column = 1 - family
        for number in np.flatnonzero(~np.isnan(whole)):
            mine = piece == number
            target = right[mine].ravel()
            wanted = cells.signs[number] * pair[left[mine].ravel(), column] + whole[number]
            free = ~singular[target].any(1)
            pair[target[free], column] = wanted[free]
    chi = pair[:, 0] + 1j * pair[:, 1]
    faces = local_faces(parts)
    m = len(connectivity.elements)
    return SmallTriangles(
        np.repeat(np.arange(m), len(faces)),
        point[:, faces].reshape(-1, 3),
        local[faces],
        chi,
        singular,
        np.stack([left[:, :-1].ravel(), left[:, 1:].ravel()], 1),
        np.stack([right[:, :-1].ravel(), right[:, 1:].ravel()], 1),
        np.repeat(piece, parts),
    )


def _straighten(values: Complexes, cells: CellMap, local: Floats, vertex: int) -> None:
    """Make chi at local coordinates (k, 2) linear along each ray from an umbilic within the elements around it.

    It goes like a power of the distance there that polynomials only follow up to their order, to an error that near the
    umbilic is more than its value. Which lines pass through a homogeneous function's zero is decided at its rim.
    """
    basis = cells.mesh.connectivity.basis
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    far = 1 - np.column_stack([1 - local.sum(1), local])
    for element, which in np.argwhere(cells.mesh.connectivity.faces == vertex).tolist():
        share = far[:, which]
        beyond = corners[which] + (local - corners[which]) / np.where(share > 0, share, 1)[:, None]
        zero = cells.value[element, which]
        rise = np.where(share > 0, cells.value[element] @ basis.basis(beyond).T - zero, 0)
        # other lines pass these elements where they reach over a cell: their places count
        if max(np.abs(rise.real).max(), np.abs(rise.imag).max()) < 1:
            values[element] = zero + share * rise


def whole_shifts(cells: CellMap, family: int) -> Floats:
    """By how many lines of a family the transitions shift them, nan where these do not go on, (t,)."""
    shifts = cells.shifts.imag if family == A else cells.shifts.real
    near = np.round(shifts)
    return np.where(np.abs(shifts - near) < WHOLE, near, np.nan)


def level_chains(small: SmallTriangles, cells: CellMap, family: int) -> Chains:
    """All level lines of a family: of A Im chi is whole, of B Re chi."""
    value, other = (small.chi.imag, small.chi.real) if family == A else (small.chi.real, small.chi.imag)
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
    at_corner = level == middle[own]
    below = level < middle[own]
    triangle = triangle[own]
    # ends of each link: the long edge, and the short one on the level's side, as their corners (2, l)
    mine = by_value.take(own, 1)
    at_long, at_short = mine[::2], np.where(below, mine[:2], mine[1:])
    long_edge, short_edge = (grid_points.take(at) for at in (at_long, at_short))
    points = len(small.chi)
    base = int(level.min(initial=0)) - 1
    width = int(level.max(initial=0)) - base + 2
    _refuse_unnameable(points, width, len(level))
    # a crossing's name: its edge, and which whole number
    crossing = np.concatenate([_edge_keys(long_edge, points), _edge_keys(short_edge, points)]) * width
    crossing += np.tile(level - base, 2)
    # a link that ends in a singular corner has an end of its own there, named beyond all edges
    ended = np.flatnonzero(at_corner)
    beyond = points**2 * width
    crossing[len(level) + ended] = beyond + ended
    # asked for the first of each as well, it sorts by runs, of which there are long ones: twice as fast
    names, _, crossing = np.unique(crossing, return_index=True, return_inverse=True)
    one, two = crossing[: len(level)], crossing[len(level) :]
    jump_left, jump_right = _jumps(small, cells, family, names, width, base)
    total = len(names)
    links = len(one)
    tail, head = np.concatenate([one, jump_left]), np.concatenate([two, jump_right])
    degree = np.bincount(np.concatenate([tail, head]), minlength=total)
    graph = coo_matrix((np.ones(len(tail)), (tail, head)), (total, total))
    chains, group = connected_components(graph, directed=False)
    # each chain begins at a loose end; a closed one anywhere, with one link taken out
    begin = np.full(chains, -1)
    loose = np.flatnonzero(degree == 1)
    # a singular end goes first
    is_singular = names >= beyond
    for some in (loose[::-1], loose[is_singular[loose]][::-1]):
        begin[group[some]] = some
    closed = begin < 0
    opened = np.zeros(len(tail), bool)
    for chain in np.flatnonzero(closed):
        link = int(np.flatnonzero(group[tail] == chain)[0])
        opened[link], begin[chain] = True, head[link]
    kept = np.flatnonzero(~opened)
    source = np.full(chains, total)
    graph = coo_matrix(
        (np.ones(len(kept) + chains), (np.r_[tail[kept], source], np.r_[head[kept], begin])), (total + 1, total + 1)
    ).tocsr()
    walk, _ = depth_first_order(graph + graph.T, total, directed=False)
    walk = walk[1:]
    position = np.empty(total, np.int64)
    position[walk] = np.arange(total)
    real = np.arange(len(tail)) < links
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
    owner = new_number[group[tail[use]]]
    offsets = np.searchsorted(owner, np.arange(chains + 1))
    way = forward[use]
    triangle, level = triangle[use], level[use]
    corners = small.local.reshape(-1, 2)
    ends = []
    # a line into a singular corner, the middle one, has it as the short edge's first end
    for at, edge in ((at_long, long_edge), (at_short, short_edge)):
        first, second = value.take(edge.take(use, 1))
        share = (level - first) / (second - first)
        first, second = other.take(edge.take(use, 1))
        t = first + share * (second - first)
        first, second = corners.take(at.take(use, 1) % len(corners), 0)
        ends.append((t, first + share[:, None] * (second - first)))
    (t_long, p_long), (t_short, p_short) = ends
    start, end = np.where(way, t_long, t_short), np.where(way, t_short, t_long)
    local_start = np.where(way[:, None], p_long, p_short)
    local_end = np.where(way[:, None], p_short, p_long)
    kinds = np.full((chains, 2), CLOSED)
    tips = np.full((chains, 2), -1)
    tips[:, 0] = begin
    far = loose[begin[group[loose]] != loose]
    tips[group[far], 1] = far
    cut = _edge_keys(np.concatenate([small.cut_left, small.cut_right]).T, points)
    for side in range(2):
        at = tips[:, side]
        there = (at >= 0) & ~closed
        name = names[at[there]]
        kind = np.where(np.isin(name // width, cut), SEAM_END, RIM)
        kinds[there, side] = np.where(name >= beyond, SINGULAR_END, kind)
    return Chains(offsets, triangle, level, start, end, local_start, local_end, kinds[chain_rank])


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


def _jumps(
    small: SmallTriangles,
    cells: CellMap,
    family: int,
    names: Integers,
    width: int,
    base: int,
) -> tuple[Integers, Integers]:
    """Pairs of crossings that are the same point on both sides of a cut."""
    whole = whole_shifts(cells, family)
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
        name = _edge_keys(pair.T, len(small.chi)) * width + at - base
        index = np.minimum(np.searchsorted(names, name), len(names) - 1)
        return index, (at - base >= 0) & (at - base < width) & (names[index] == name)

    one, has_one = crossing(left[edge], level)
    two, has_two = crossing(right[edge], there)
    both = has_one & has_two
    return one[both], two[both]
