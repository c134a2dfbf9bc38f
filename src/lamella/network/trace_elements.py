"""From level lines to the network of a surface of elements."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lamella.errors import InputError
from lamella.network.arcs import ArcLengths
from lamella.network.cell_map import CellMap
from lamella.network.faces import trace_faces
from lamella.network.lattice import ragged_ranges
from lamella.network.level_lines import (
    CLOSED,
    SEAM_END,
    SINGULAR_END,
    Chains,
    SmallTriangles,
    level_chains,
    small_triangles,
)
from lamella.network.net_mesh import COLUMNS, ROWS
from lamella.network.network import BOUNDARY, REGULAR, SEAM, SINGULAR, Network, Period
from lamella.network.trace import COARSE, FINE, FINE_LIMIT
from lamella.surface.darboux import Darboux
from lamella.surface.element.places import Places
from lamella.surface.element.rim import element_rims
from lamella.surface.points import Floats

Integers = NDArray[np.int64]

A, B = 0, 1
# of a ray's first cell: a place taken for the singular node's own direction
BESIDE = 1e-3
# of a ray's first cell: nearer to the node it is led out from it to points at these multiples
OUT, LEADING = 0.2, np.array([1.0, 1.5, 2.0, 2.5])
# samples to either side over which a lamella turns by its geodesic curvature: the kinks at elements average out
WIDE = 3
# the speed along a lamella has a kink at every element's edge: so many points of a segment's series do, and at most
ROUGH, SETTLE = 1e-6, 48


@dataclass(frozen=True)
class _Tracks:
    """Chains of both families with a running coordinate tau in cells, A before B."""

    family: Integers  # of each chain
    ends: Integers  # (c, 2)
    owner: Integers  # chain of each link
    triangle: Integers
    level: Integers
    start: Floats
    way: Floats  # +-1: how the other coordinate runs along the chain
    tau: Floats  # at the link's start, counted from the chain's
    span: Floats
    local_start: Floats
    local_end: Floats
    element: Integers

    @property
    def first(self) -> Integers:
        """First link of each chain."""
        return np.searchsorted(self.owner, np.arange(len(self.family)))

    @property
    def last(self) -> Integers:
        """Last link of each chain."""
        return np.searchsorted(self.owner, np.arange(len(self.family)), side="right") - 1


def _tracks(small: SmallTriangles, chains: tuple[Chains, Chains]) -> _Tracks:
    counts = [len(c.offsets) - 1 for c in chains]
    owner = np.concatenate([chains[A].owner, chains[B].owner + counts[0]])

    def both(name: str) -> NDArray[np.generic]:
        return np.concatenate([getattr(c, name) for c in chains])

    start, end = both("start").astype(float), both("end").astype(float)
    span = np.abs(end - start)
    running = np.cumsum(span) - span
    first = np.searchsorted(owner, np.arange(sum(counts)))
    triangle = both("triangle").astype(np.int64)
    return _Tracks(
        np.repeat([A, B], counts),
        both("ends").astype(np.int64),
        owner,
        triangle,
        both("level").astype(np.int64),
        start,
        np.where(end >= start, 1.0, -1.0),
        running - running[first][owner],
        span,
        both("local_start").astype(float),
        both("local_end").astype(float),
        small.element[triangle],
    )


class _Segments:
    """Pieces of lamella between neighbouring stops."""

    def __init__(
        self, cells: CellMap, tracks: _Tracks, chain: Integers, tau: Floats, reach: Floats, power: Floats
    ) -> None:
        self._cells, self._tracks = cells, tracks
        self.owner, self._chain, self._tau, self._reach, self._power = chain, chain, tau, reach, power
        self._stride = float(tracks.tau.max() + tracks.span.max() + 2)
        self._keys = tracks.owner * self._stride + tracks.tau

    @property
    def singular(self) -> NDArray[np.bool_]:
        """Which segments begin at a singular node."""
        return np.asarray(self._power != 1)

    def tau(self, segment: Integers, sigma: Floats) -> Floats:
        """Running coordinate of the chain."""
        return np.asarray(self._tau[segment] + sigma ** self._power[segment] * self._reach[segment])

    def _find(self, segment: Integers, sigma: Floats) -> tuple[Places, Floats]:
        """Places of parameters (k,) of segments (k,), and which way the chain's coordinate runs on their sheets."""
        t = self._tracks
        tau, chain = self.tau(segment, sigma), self._chain[segment]
        link = np.searchsorted(self._keys, chain * self._stride + np.clip(tau, 0, self._stride - 1), side="right") - 1
        link = np.clip(link, t.first[chain], t.last[chain])
        ahead = tau - t.tau[link]
        share = np.clip(ahead / np.maximum(t.span[link], 1e-300), 0, 1)
        local = t.local_start[link] + share[:, None] * (t.local_end[link] - t.local_start[link])
        other = t.start[link] + ahead * t.way[link]
        target = np.where(t.family[chain] == A, other + 1j * t.level[link], t.level[link] + 1j * other)
        places, turn, _ = self._cells.invert(Places(t.element[link], local), target)
        return places, turn * t.way[link]

    def velocity(self, segment: Integers, sigma: Floats) -> tuple[Places, Floats, Floats]:
        """Places, positions (k, 3) and their derivatives by sigma (k, 3), m."""
        # at a singular node chi has no slope: the way out is that of a place just beside it
        beside = np.where((self._power[segment] != 1) & (sigma < BESIDE), BESIDE, sigma)
        places, way = self._find(segment, beside)
        position, first, second = self._cells.tangents(places)
        chi_x, chi_y = self._cells.slopes(places)
        determinant = chi_x.real * chi_y.imag - chi_x.imag * chi_y.real
        is_a = self._tracks.family[self._chain[segment]] == A
        step = np.where(
            is_a[:, None],
            np.stack([chi_y.imag, -chi_x.imag], 1),
            np.stack([-chi_y.real, chi_x.real], 1),
        )
        power = self._power[segment]
        rate = way * power * beside ** (power - 1) * self._reach[segment] / determinant
        velocity = (step[:, :1] * first + step[:, 1:] * second) * rate[:, None]
        moved = beside != sigma
        if moved.any():
            places = Places(places.element.copy(), places.local.copy())
            exact, _ = self._find(segment[moved], sigma[moved])
            places.element[moved], places.local[moved] = exact.element, exact.local
            position[moved] = self._cells.tangents(exact)[0]
        return places, position, velocity

    def speed(self, segment: Integers, sigma: Floats) -> Floats:
        """Arc length per sigma, m, at parameters (p,) of segments (s,), shape (s, p)."""
        _, _, velocity = self.velocity(np.repeat(segment, len(sigma)), np.tile(sigma, len(segment)))
        return np.asarray(np.linalg.norm(velocity, axis=1)).reshape(len(segment), len(sigma))


@dataclass(frozen=True)
class _Stops:
    """Stops in order along the chains."""

    chain: Integers
    tau: Floats
    node: Integers
    kinds: Integers  # of the nodes


def _crossings(tracks: _Tracks, alive: NDArray[np.bool_]) -> tuple[Integers, Floats, Integers]:
    """Chain, tau and name of every whole number passed by a living chain whose partner lives as well."""
    end = tracks.start + tracks.way * tracks.span
    low, high = np.minimum(tracks.start, end), np.maximum(tracks.start, end)
    first, last = np.floor(low).astype(np.int64) + 1, np.ceil(high).astype(np.int64) - 1
    count = np.where(alive[tracks.owner], np.maximum(last - first + 1, 0), 0)
    link = np.repeat(np.arange(len(count)), count)
    whole = first[link] + ragged_ranges(count)
    is_a = tracks.family[tracks.owner[link]] == A
    name = np.stack(
        [
            tracks.triangle[link],
            np.where(is_a, whole, tracks.level[link]),
            np.where(is_a, tracks.level[link], whole),
        ],
        1,
    )
    _, number = np.unique(name, axis=0, return_inverse=True)
    number = number.ravel()
    both = (np.bincount(number[is_a], minlength=number.max(initial=-1) + 1) == 1) & (
        np.bincount(number[~is_a], minlength=number.max(initial=-1) + 1) == 1
    )
    kept = both[number]
    tau = tracks.tau[link] + np.abs(whole - tracks.start[link])
    return tracks.owner[link][kept], tau[kept], number[kept]


def _stops(tracks: _Tracks, alive: NDArray[np.bool_], singular: Integers, tips: Floats) -> _Stops:
    """All stops of living chains; `singular` (c, 2) is the umbilic at each end, `tips` (c, 2) the exact tau there."""
    chain, tau, name = _crossings(tracks, alive)
    closed = tracks.ends[:, 0] == CLOSED
    nodes = int(name.max(initial=-1)) + 1
    parts = [(chain, tau, name, np.full(len(chain), REGULAR))]
    umbilics = int(singular.max(initial=-1)) + 1
    for side in range(2):
        mine = np.flatnonzero(alive & ~closed)
        kind = tracks.ends[mine, side]
        own = nodes + umbilics + np.arange(len(mine)) + side * len(tracks.family)
        node = np.where(kind == SINGULAR_END, nodes + singular[mine, side], own)
        told = np.where(kind == SINGULAR_END, SINGULAR, np.where(kind == SEAM_END, SEAM, BOUNDARY))
        parts.append((mine, tips[mine, side], node, told))
    chain, tau, node, kind = (np.concatenate(column) for column in zip(*parts, strict=True))
    order = np.lexsort((tau, chain))
    chain, tau, node, kind = chain[order], tau[order], node[order], kind[order]
    # a closed lamella begins at its first node and comes back to it
    looped = [k for k in np.flatnonzero(alive & closed).tolist() if (chain == k).any()]
    for k in looped:
        at = np.flatnonzero(chain == k)
        whole = tracks.tau[tracks.last[k]] + tracks.span[tracks.last[k]]
        place = at[-1] + 1
        chain, tau = np.insert(chain, place, k), np.insert(tau, place, tau[at[0]] + whole)
        node, kind = np.insert(node, place, node[at[0]]), np.insert(kind, place, kind[at[0]])
    used, first, number = np.unique(node, return_index=True, return_inverse=True)
    rank = np.empty(len(used), np.int64)
    rank[np.argsort(first, kind="stable")] = np.arange(len(used))
    number = rank[number.ravel()]
    kinds = np.zeros(len(used), np.int64)
    kinds[number] = kind
    return _Stops(chain, tau, number, kinds)


def trace_elements(
    cells: CellMap,
    cut: NDArray[np.bool_],
    umbilics: Integers,
    orders: Integers,
    *,
    mean_curvature: float,
    rim_loop: Integers,
    count: int,
    periods: tuple[Period, ...],
    minimum_length: float = 0.5,
) -> Network:
    """The network of a surface of elements.

    Parameters
    ----------
    cells : CellMap
    cut : (m, 3) bool
        Edges that are cut, see `Isothermic.cut`.
    umbilics, orders : (z,) int
        Vertices that are umbilics, and their orders.
    mean_curvature : float
        H, 1/m.
    rim_loop : (b,) int
        Boundary loop of each boundary edge of the net mesh.
    count : int
        Cells around the first hole, or along the longest principal line.
    periods : tuple of Period
    minimum_length : float
        Lamellas shorter than this many median cell edges are left out.

    Raises
    ------
    InputError
        No two lamellas cross, or the net is too coarse.
    """
    small = small_triangles(cells, cut, umbilics)
    tracks = _tracks(small, (level_chains(small, cells, A), level_chains(small, cells, B)))
    chains = len(tracks.family)
    singular, power_of = _singular_ends(cells, small, tracks, umbilics, orders)
    tips = _tips(cells, tracks)
    rough = np.linalg.norm(
        cells.tangents(Places(tracks.element, tracks.local_end))[0]
        - cells.tangents(Places(tracks.element, tracks.local_start))[0],
        axis=1,
    )
    length = np.bincount(tracks.owner, rough, chains)
    alive = np.ones(chains, bool)
    median = np.median(np.repeat(rough / np.maximum(tracks.span, 1e-12), 1)) if len(rough) else 0.0
    alive &= length >= minimum_length * median
    stops = _stops(tracks, alive, singular, tips)
    if not (stops.kinds == REGULAR).any():
        raise InputError(
            f"no two lamellas cross: with {count} cells the longest one runs over "
            f"{np.bincount(tracks.owner, tracks.span, chains).max(initial=0.0):.2g} cells",
            "raise network.cells, or lower network.spacing",
            "network.cells",
        )
    pair = np.flatnonzero(stops.chain[1:] == stops.chain[:-1])
    chain, reach = stops.chain[pair], stops.tau[pair + 1] - stops.tau[pair]
    begins = np.r_[True, stops.chain[1:] != stops.chain[:-1]][pair]
    power = np.where(begins, power_of[chain], 1.0)
    segments = _Segments(cells, tracks, chain, stops.tau[pair], reach, power)
    arcs = ArcLengths(segments, ROUGH, SETTLE)

    per_cell = FINE if len(stops.kinds) <= FINE_LIMIT else COARSE
    whole = np.minimum(np.bincount(chain, reach, chains), 1.0)[chain]
    number = np.maximum(np.ceil(reach / whole * per_cell - 1e-6), 1).astype(np.int64)
    last = np.r_[chain[1:] != chain[:-1], True]
    given = number + last
    segment = np.repeat(np.arange(len(number)), given)
    fraction = ragged_ranges(given) / number[segment]
    parameter = arcs.parameter(segment, fraction)
    places, points, velocity = segments.velocity(segment, parameter)
    tangents = velocity / np.linalg.norm(velocity, axis=1)[:, None]
    _lead_out(segments, segment, parameter, points, tangents)
    normals = _normals(cells, places)
    tangents -= (tangents * normals).sum(1)[:, None] * normals
    tangents /= np.linalg.norm(tangents, axis=1)[:, None]

    used = np.flatnonzero(np.bincount(chain, minlength=chains) > 0)
    lamella_of = np.full(chains, -1)
    lamella_of[used] = np.arange(len(used))
    owner = lamella_of[chain]
    offsets = np.r_[0, np.cumsum(np.bincount(owner, given, minlength=len(used)).astype(np.int64))]
    before = np.cumsum(arcs.length) - arcs.length
    before -= before[np.searchsorted(owner, owner)]
    arclengths = before[segment] + fraction * arcs.length[segment]
    kept = lamella_of[stops.chain] >= 0
    stop_chain, stop_node = lamella_of[stops.chain[kept]], stops.node[kept]
    segment_start = np.cumsum(given) - given
    first_stop = (np.cumsum(kept) - 1)[pair]
    stop_sample = np.empty(len(stop_node), np.int64)
    stop_sample[first_stop] = segment_start
    stop_sample[first_stop[last] + 1] = (segment_start + number)[last]
    family = tracks.family[used]
    darboux = _darboux(cells, places, tangents, normals, points, arclengths, offsets)

    nodes, at = np.unique(stop_node, return_inverse=True)
    at = at.ravel()
    node_sample = np.empty(len(nodes), np.int64)
    node_sample[at[::-1]] = stop_sample[::-1]
    kinds = stops.kinds[nodes]
    loops, rim_directions = _rims(cells, rim_loop, places, node_sample, kinds)
    starts, ends = stop_sample[first_stop], stop_sample[first_stop + 1]
    tails, heads = at[first_stop], at[first_stop + 1]
    face_offsets, face_nodes = trace_faces(
        normals[node_sample],
        np.r_[tails, heads],
        np.r_[heads, tails],
        np.vstack([tangents[starts], -tangents[ends]]),
        loops,
        rim_directions,
        seam=kinds == SEAM,
    )
    rank = np.where(family == A, np.cumsum(family == A), np.cumsum(family != A))
    ids = tuple(f"{'AB'[f]}{r}" for f, r in zip(family.tolist(), rank.tolist(), strict=True))
    return Network(
        mean_curvature=mean_curvature,
        step=cells.step,
        cells=count,
        periods=periods,
        left_out=int(chains - len(used)),
        node_points=points[node_sample],
        node_normals=normals[node_sample],
        node_kinds=kinds,
        ids=ids,
        families=np.where(family == A, "A", "B"),
        closed=tracks.ends[used, 0] == CLOSED,
        sample_offsets=offsets,
        sample_points=points,
        sample_normals=normals,
        sample_tangents=tangents,
        sample_darboux=darboux,
        sample_where=np.column_stack([places.element, places.local]),
        sample_arclengths=arclengths,
        stop_offsets=np.r_[0, np.cumsum(np.bincount(stop_chain, minlength=len(used)))],
        stop_nodes=at,
        stop_samples=stop_sample - offsets[stop_chain],
        stop_arclengths=arclengths[stop_sample],
        face_offsets=face_offsets,
        face_nodes=face_nodes,
    )


def _lead_out(segments: _Segments, segment: Integers, sigma: Floats, points: Floats, tangents: Floats) -> None:
    """Points and directions next to singular nodes, from the node and points a little further out.

    chi has next to no slope there, and a zero of higher order is not quite one in numbers: a lamella would pass the
    node by. As a function of sigma a ray is analytic.
    """
    near = np.flatnonzero(segments.singular[segment] & (sigma < OUT))
    if not len(near):
        return
    own, row = np.unique(segment[near], return_inverse=True)
    at = np.r_[0.0, OUT * LEADING]
    where = segments.velocity(np.repeat(own, len(at)), np.tile(at, len(own)))[1].reshape(len(own), len(at), 3)
    series = np.matmul(np.linalg.inv(np.vander(at, increasing=True)), where)[row.ravel()]
    power = np.arange(len(at))
    points[near] = np.einsum("np,npc->nc", sigma[near, None] ** power, series)
    slope = power[1:] * sigma[near, None] ** power[:-1]
    there = np.einsum("np,npc->nc", slope, series[:, 1:])
    tangents[near] = there / np.linalg.norm(there, axis=1)[:, None]


def _singular_ends(
    cells: CellMap, small: SmallTriangles, tracks: _Tracks, umbilics: Integers, orders: Integers
) -> tuple[Integers, Floats]:
    """Umbilic at each end of the chains, (c, 2), -1 where there is none; and the power of sigma at the start."""
    result = np.full(tracks.ends.shape, -1)
    power = np.ones(len(result))
    if not len(umbilics):
        return result, power
    zeros = cells.mesh.nodes[umbilics]
    for side, (link, local) in enumerate(((tracks.first, tracks.local_start), (tracks.last, tracks.local_end))):
        mine = np.flatnonzero(tracks.ends[:, side] == SINGULAR_END)
        if not len(mine):
            continue
        at = cells.tangents(Places(tracks.element[link[mine]], local[link[mine]]))[0]
        result[mine, side] = np.linalg.norm(at[:, None] - zeros, axis=2).argmin(1)
        if side == 0:
            power[mine] = 1 + orders[result[mine, 0]] / 2
    return result, power


def _tips(cells: CellMap, tracks: _Tracks) -> Floats:
    """Exact tau of the chains' ends on the rim, (c, 2): where the boundary edge has the chain's level."""
    last = tracks.last
    tips = np.stack([np.zeros(len(last)), tracks.tau[last] + tracks.span[last]], 1)
    basis = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    for side, (link, local) in enumerate(((tracks.first, tracks.local_start), (last, tracks.local_end))):
        mine = np.flatnonzero((tracks.ends[:, side] != SINGULAR_END) & (tracks.ends[:, side] != CLOSED))
        index = link[mine]
        at = local[index]
        barycentric = np.column_stack([1 - at.sum(1), at])
        edge = (barycentric.argmin(1) + 1) % 3
        begin, along = basis[edge], basis[(edge + 1) % 3] - basis[edge]
        share = ((at - begin) * along).sum(1) / (along**2).sum(1)
        is_a = tracks.family[mine] == A
        for _ in range(8):
            place = Places(tracks.element[index], begin + share[:, None] * along)
            chi = cells.at(place)
            slopes = cells.slopes(place)
            slope = slopes[0] * along[:, 0] + slopes[1] * along[:, 1]
            miss = np.where(is_a, chi.imag, chi.real) - tracks.level[index]
            share = np.clip(share - miss / np.where(is_a, slope.imag, slope.real), 0, 1)
        chi = cells.at(Places(tracks.element[index], begin + share[:, None] * along))
        other = np.where(is_a, chi.real, chi.imag)
        tips[mine, side] = tracks.tau[index] + (other - tracks.start[index]) * tracks.way[index]
    return tips


def _normals(cells: CellMap, places: Places) -> Floats:
    connectivity = cells.mesh.connectivity
    nodal = cells.mesh.normals[connectivity.elements[places.element]]
    normal = np.einsum("nk,nkc->nc", connectivity.basis.basis(places.local), nodal)
    return np.asarray(normal / np.linalg.norm(normal, axis=1)[:, None])


def _darboux(
    cells: CellMap,
    places: Places,
    tangents: Floats,
    normals: Floats,
    points: Floats,
    arclengths: Floats,
    offsets: Integers,
) -> Darboux:
    """kn and tg from the surface's shape operator along the curve; kg from the curve's own turning."""
    connectivity = cells.mesh.connectivity
    shape = np.einsum(
        "nk,nkc->nc", connectivity.basis.basis(places.local), cells.mesh.shape[connectivity.elements[places.element]]
    )
    sideways = np.cross(normals, tangents)

    def form(s: Floats, t: Floats) -> Floats:
        both = s[:, ROWS] * t[:, COLUMNS] + s[:, COLUMNS] * t[:, ROWS]
        return np.asarray((shape * both * np.where(ROWS == COLUMNS, 0.5, 1.0)).sum(1))

    index = np.arange(len(points))
    owner = np.searchsorted(offsets, index, side="right") - 1
    before = np.maximum(index - WIDE, offsets[owner])
    after = np.minimum(index + WIDE, offsets[owner + 1] - 1)
    turning = (tangents[after] - tangents[before]) / (arclengths[after] - arclengths[before])[:, None]
    return Darboux(form(tangents, tangents), (turning * sideways).sum(1), form(tangents, sideways))


def _rims(
    cells: CellMap, rim_loop: Integers, places: Places, node_sample: Integers, kinds: Integers
) -> tuple[list[Integers], Floats]:
    """Boundary nodes of each loop in order, and the rim's direction at all nodes."""
    mesh = cells.mesh
    rims = element_rims(mesh.connectivity, mesh.nodes, rim_loop)
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    boundary = np.flatnonzero(kinds == BOUNDARY)
    at = Places(places.element[node_sample[boundary]], places.local[node_sample[boundary]])
    barycentric = np.column_stack([1 - at.local.sum(1), at.local])
    barycentric[mesh.connectivity.neighbours[at.element[:, None], (np.arange(3) + 1) % 3] >= 0] = np.inf
    edge = (barycentric.argmin(1) + 1) % 3
    along = corners[(edge + 1) % 3] - corners[edge]
    share = ((at.local - corners[edge]) * along).sum(1) / (along**2).sum(1)
    _, first, second = cells.tangents(at)
    directions = np.zeros((len(kinds), 3))
    directions[boundary] = along[:, :1] * first + along[:, 1:] * second
    directions[boundary] /= np.linalg.norm(directions[boundary], axis=1)[:, None]
    vertex = mesh.connectivity.faces[at.element, edge]
    loops = []
    for rim in rims:
        order = np.full(len(mesh.loop), -1)
        order[rim.vertices] = np.arange(len(rim.vertices))
        mine = np.flatnonzero(order[vertex] >= 0)
        loops.append(boundary[mine[np.lexsort((share[mine], order[vertex[mine]]))]])
    return loops, directions
