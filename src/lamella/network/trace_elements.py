"""From level lines to the network of a surface of elements."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lamella.blocks import blocks
from lamella.errors import InputError
from lamella.network.cell_map import CellMap
from lamella.network.element_arcs import ElementArcs
from lamella.network.element_segments import ElementSegments
from lamella.network.faces import trace_faces
from lamella.network.lattice import ragged_ranges
from lamella.network.level_lines import (
    CLOSED,
    SEAM_END,
    SINGULAR_END,
    level_chains,
    small_triangles,
)
from lamella.network.network import BOUNDARY, REGULAR, SEAM, SINGULAR, Network, Period
from lamella.network.trace import COARSE, FINE, FINE_LIMIT
from lamella.network.tracks import A, B, Tracks, make_tracks, rim_tips, singular_ends
from lamella.network.turning import turning
from lamella.sparse import counted
from lamella.surface.darboux import Darboux
from lamella.surface.element.places import Places
from lamella.surface.element.polynomials import Polynomials
from lamella.surface.element.rim import element_rims
from lamella.surface.points import Floats
from lamella.surface.vectors import crosses, dots, images, lengths

Integers = NDArray[np.int64]
Onto = Callable[[Integers, Floats], Floats]

# samples a segment, however short: next to the rim curvatures are read from the last of them
FEWEST = 3


@dataclass(frozen=True)
class _Stops:
    """Stops in order along the chains."""

    chain: Integers
    tau: Floats
    node: Integers
    kinds: Integers  # of the nodes


def _crossings(tracks: Tracks, alive: NDArray[np.bool_]) -> tuple[Integers, Floats, Integers]:
    """Chain, tau and name of every whole number passed by a living chain whose partner lives as well."""
    end = tracks.start + tracks.way * tracks.span
    low, high = np.minimum(tracks.start, end), np.maximum(tracks.start, end)
    first, last = np.floor(low).astype(np.int64) + 1, np.ceil(high).astype(np.int64) - 1
    count = np.where(alive[tracks.owner], np.maximum(last - first + 1, 0), 0)
    link = np.repeat(np.arange(len(count)), count)
    whole = first[link] + ragged_ranges(count)
    is_a = tracks.family[tracks.owner[link]] == A
    levels = [np.where(is_a, tracks.level[link], whole), np.where(is_a, whole, tracks.level[link])]
    parts = [tracks.triangle[link], *(level - level.min(initial=0) for level in levels)]
    name = np.ravel_multi_index(parts, [int(part.max(initial=0)) + 1 for part in parts])
    _, number = np.unique(name, return_inverse=True)
    both = (np.bincount(number[is_a], minlength=number.max(initial=-1) + 1) == 1) & (
        np.bincount(number[~is_a], minlength=number.max(initial=-1) + 1) == 1
    )
    kept = both[number]
    tau = tracks.tau[link] + np.abs(whole - tracks.start[link])
    return tracks.owner[link][kept], tau[kept], number[kept]


def _stops(tracks: Tracks, alive: NDArray[np.bool_], singular: Integers, tips: Floats) -> _Stops:
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
    orders: Integers,
    *,
    onto: Onto,
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
    orders : (z,) int
        Of the umbilics.
    onto : callable
        Points (n, 3) of elements (n,) exactly on the surface.
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
    small = small_triangles(cells, cut, cells.mesh.umbilics[cells.mesh.umbilics >= 0])
    tracks = make_tracks(small, (level_chains(small, cells, A), level_chains(small, cells, B)))
    chains = len(tracks.family)
    singular = singular_ends(cells, tracks)
    tips = rim_tips(cells, tracks)
    begin = cells.positions(Places(tracks.element, tracks.local_start))
    # every link ends where the next one begins, but for the last ones
    end = np.roll(begin, -1, 0)
    end[tracks.last] = cells.positions(Places(tracks.element[tracks.last], tracks.local_end[tracks.last]))
    rough = lengths(end - begin)
    length = np.bincount(tracks.owner, rough, chains)
    alive = np.ones(chains, bool)
    median = np.median(rough / np.maximum(tracks.span, 1e-12)) if len(rough) else 0.0
    alive &= length >= minimum_length * median
    stops = _stops(tracks, alive, singular, tips)
    if not (stops.kinds == REGULAR).any():
        short = int((~alive).sum())
        if short:
            raise InputError(
                f"no two lamellas cross: {short} of {chains} are shorter than minimum_length = {minimum_length:g} "
                f"median cell edges of {median:.3g} m, the longest one has {length.max() / median:.2g}",
                "lower network.minimum_length, or raise network.cells",
                "network.minimum_length",
            )
        raise InputError(
            f"no two lamellas cross: with {count} cells the longest one runs over "
            f"{np.bincount(tracks.owner, tracks.span, chains).max(initial=0.0):.2g} cells",
            "raise network.cells, or lower network.spacing",
            "network.cells",
        )
    pair = np.flatnonzero(stops.chain[1:] == stops.chain[:-1])
    chain, reach = stops.chain[pair], stops.tau[pair + 1] - stops.tau[pair]
    begins = np.r_[True, stops.chain[1:] != stops.chain[:-1]][pair]
    ends = np.r_[stops.chain[1:] != stops.chain[:-1], True][pair + 1]
    zeros = np.where(np.stack([begins, ends], 1), singular[chain], -1)
    segments = ElementSegments(cells, tracks, chain, stops.tau[pair], reach, zeros, orders)
    arcs = ElementArcs(segments)

    per_cell = FINE if len(stops.kinds) <= FINE_LIMIT else COARSE
    whole = np.minimum(np.bincount(chain, reach, chains), 1.0)[chain]
    number = np.maximum(np.ceil(reach / whole * per_cell - 1e-6), FEWEST).astype(np.int64)
    last = np.r_[chain[1:] != chain[:-1], True]
    given = number + last
    segment = np.repeat(np.arange(len(number)), given)
    fraction = ragged_ranges(given) / number[segment]
    parameter, near = arcs.parameter(segment, fraction)
    # element by element
    order = counted(near.element + 1, len(cells.value) + 1).astype(np.int64)
    spots = segments.spots(segment, parameter)[order]
    places, points, velocity = segments.velocity(spots, near[order])
    tangents = velocity / lengths(velocity)[:, None]
    points, tangents = segments.lead_out(spots, points, tangents)
    points = onto(places.element, points)
    normals, tangents, bend, twist = _frames(cells, places, tangents)
    back = np.empty(len(order), np.int64)
    back[order] = np.arange(len(order))
    places, bend, twist = places[back], bend[back], twist[back]
    points, normals, tangents = (t.take(back, 0) for t in (points, normals, tangents))

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
    closed = tracks.ends[used, 0] == CLOSED
    darboux = Darboux(bend, turning(tangents, crosses(normals, tangents), arclengths, offsets, closed), twist)

    nodes, at = np.unique(stop_node, return_inverse=True)
    at = at.ravel()
    node_sample = np.empty(len(nodes), np.int64)
    node_sample[at[::-1]] = stop_sample[::-1]
    kinds = stops.kinds[nodes]
    loops, rim_directions = _rims(cells, rim_loop, places, node_sample, kinds)
    starts, ends = stop_sample[first_stop], stop_sample[first_stop + 1]
    tails, heads = at[first_stop], at[first_stop + 1]
    faces = trace_faces(
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
        closed=closed,
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
        face_offsets=faces.offsets,
        face_nodes=faces.nodes,
        faces_left_out=faces.large,
        pattern=cells.pattern,
    )


def _frames(cells: CellMap, places: Places, directions: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Unit normals (n, 3), tangents nearest to directions (n, 3), and kn and tg from the surface's shape operator."""
    mesh = cells.mesh
    nodal = np.column_stack([mesh.normals, mesh.shape])[mesh.connectivity.elements]
    fields = Polynomials.through(mesh.connectivity.basis, nodal)
    normals, tangents = np.empty((2, len(places), 3))
    bend, twist = np.empty((2, len(places)))
    for block in blocks(len(places)):
        both = fields.values(places[block]).T
        normal, entries = both[:, :3], both[:, 3:]
        normal /= lengths(normal)[:, None]
        # components follow each other, as in the fields
        tangent = np.array(directions[block], order="F")
        tangent -= dots(tangent, normal)[:, None] * normal
        tangent /= lengths(tangent)[:, None]
        image = images(entries, tangent)
        bend[block], twist[block] = dots(image, tangent), dots(image, crosses(normal, tangent))
        normals[block], tangents[block] = normal, tangent
    return normals, tangents, bend, twist


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
    directions[boundary] /= lengths(directions[boundary])[:, None]
    vertex = mesh.connectivity.faces[at.element, edge]
    loops = []
    for rim in rims:
        order = np.full(len(mesh.loop), -1)
        order[rim.vertices] = np.arange(len(rim.vertices))
        mine = np.flatnonzero(order[vertex] >= 0)
        loops.append(boundary[mine[np.lexsort((share[mine], order[vertex[mine]]))]])
    return loops, directions
