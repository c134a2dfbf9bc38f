"""From level lines to the network of a surface of elements."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.blocks import blocks
from lamella.base.errors import InputError
from lamella.base.sparse import counted
from lamella.base.vectors import crosses, dots, images, lengths
from lamella.network.assemble import Curves, CurveSamples, RimNodes, SampledCurves, assemble
from lamella.network.elements.arc_lengths import ElementArcs
from lamella.network.elements.crossings import Crossings, find_crossings
from lamella.network.elements.integer_grid_map import IntegerGridMap
from lamella.network.elements.level_chains import CLOSED, RIM, SEAM_END, SINGULAR_END, level_chains
from lamella.network.elements.level_curves import LevelCurves, make_level_curves, rim_tips, singular_ends
from lamella.network.elements.numbering import numbered, rim_places
from lamella.network.elements.rim_ends import Ends, along_rim, settled_ends, within_tips
from lamella.network.elements.segments import ElementSegments
from lamella.network.elements.small_triangles import small_triangles
from lamella.network.network import BOUNDARY, REGULAR, SEAM, SINGULAR, A, B, Network, Period
from lamella.network.sampling import Division, divide, parts_of
from lamella.network.turning import sideways_slopes, turning
from lamella.surface.darboux import Darboux
from lamella.surface.element.places import Places
from lamella.surface.element.polynomials import Polynomials
from lamella.surface.element.rim import ElementRim, element_rims

Onto = Callable[[Integers, Floats], Floats]


@dataclass(frozen=True)
class _Stops:
    """Stops in order along the chains."""

    chain: Integers
    tau: Floats
    node: Integers
    kinds: Integers  # of the nodes


def _stops(level_curves: LevelCurves, crossings: Crossings, singular: Integers, ends: Ends) -> _Stops:
    """All stops of the chains; `singular` (c, 2) is the umbilic at each end."""
    nodes, chains = len(ends.boundary), len(level_curves.family)
    closed = level_curves.ends[:, 0] == CLOSED
    kind_there = np.where(ends.boundary, BOUNDARY, REGULAR)
    parts = [(crossings.chain.ravel(), crossings.tau.ravel(), np.tile(np.arange(nodes), 2), np.tile(kind_there, 2))]
    shared = nodes + ends.shared
    own = shared + int(singular.max(initial=-1)) + 1
    for side in range(2):
        # where a crossing is the end it is a stop already
        mine = np.flatnonzero(~closed & ((ends.node[:, side] < 0) | (ends.node[:, side] >= nodes)))
        kind, name = level_curves.ends[mine, side], ends.node[mine, side]
        name = np.where(name >= 0, name, own + mine + side * chains)
        name = np.where(kind == SINGULAR_END, shared + singular[mine, side], name)
        reported = np.where(kind == SINGULAR_END, SINGULAR, np.where(kind == SEAM_END, SEAM, BOUNDARY))
        parts.append((mine, ends.tips[mine, side], name, reported))
    chain, tau, node, kind = (np.concatenate(column) for column in zip(*parts, strict=True))
    order = np.lexsort((tau, chain))
    chain, tau, node, kind = chain[order], tau[order], node[order], kind[order]
    # a closed lamella begins at its first node and comes back to it
    looped = [k for k in np.flatnonzero(closed).tolist() if (chain == k).any()]
    for k in looped:
        at = np.flatnonzero(chain == k)
        whole = level_curves.tau[level_curves.last[k]] + level_curves.span[level_curves.last[k]]
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
    cells: IntegerGridMap,
    cut: Booleans,
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
    cells : IntegerGridMap
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
    found = make_level_curves(small, (level_chains(small, cells, A), level_chains(small, cells, B)))
    rims = element_rims(cells.mesh.connectivity, cells.mesh.nodes, rim_loop)
    length, median = _lengths(cells, found)
    short = length < minimum_length * median
    level_curves, on_rim = _kept(cells, rims, found, ~short)
    short &= ~on_rim
    singular = singular_ends(cells, level_curves)
    crossings, rim_ends = _settled(cells, level_curves)
    stops = _stops(level_curves, crossings, singular, rim_ends)
    if not (stops.kinds == REGULAR).any():
        raise _none_cross(found, count, length / median, short, minimum_length, median)
    curves, nodes, used = _curves(level_curves, stops)
    segments = _segments(cells, level_curves, stops, singular, orders)
    sampled, samples = _sampled(segments, curves, onto, mean_curvature)
    loops, directions = _rims(cells, rims, level_curves, stops, rim_ends, nodes)
    return assemble(
        sampled,
        samples,
        RimNodes(loops, directions, curves.kinds == SEAM),
        pattern=cells.pattern,
        mean_curvature=mean_curvature,
        step=cells.step,
        cells=count,
        periods=periods,
        left_out=int(short.sum()) + len(level_curves.family) - len(used),
    )


def _none_cross(
    found: LevelCurves, count: int, edges: Floats, short: Booleans, minimum_length: float, median: float
) -> InputError:
    """Why no two of the chains cross that are `edges` median cell edges (c,) long, and with what they do."""
    if short.any():
        return InputError(
            f"no two lamellas cross: {short.sum()} of {len(short)} are shorter than minimum_length = "
            f"{minimum_length:g} median cell edges of {median:.3g} m, the longest has {edges.max():.2g}",
            "write minimum_length = 0, with which none is left out, or raise cells",
            "minimum_length",
        )
    longest = float(np.bincount(found.owner, found.span, len(short)).max(initial=0.0))
    return InputError(
        f"no two lamellas cross: with {count} cells the longest one runs over {longest:.2g} cells",
        f"raise cells to about {np.ceil(2 * count / max(longest, 1e-3)):.0f}, or lower spacing",
        "cells",
    )


def _curves(level_curves: LevelCurves, stops: _Stops) -> tuple[Curves, Integers, Integers]:
    """The chains that have two stops, as curves of the net; the nodes (of the stops) and the chains that they keep."""
    chains = len(level_curves.family)
    used = np.unique(stops.chain[1:][stops.chain[1:] == stops.chain[:-1]])
    curve_of = np.full(chains, -1)
    curve_of[used] = np.arange(len(used))
    kept = curve_of[stops.chain] >= 0
    nodes, number = np.unique(stops.node[kept], return_inverse=True)
    closed = level_curves.ends[used, 0] == CLOSED
    curves = Curves(level_curves.family[used], closed, curve_of[stops.chain[kept]], number.ravel(), stops.kinds[nodes])
    return curves, nodes, used


def _segments(
    cells: IntegerGridMap, level_curves: LevelCurves, stops: _Stops, singular: Integers, orders: Integers
) -> ElementSegments:
    """The pieces of the chains between neighbouring stops."""
    pair = np.flatnonzero(stops.chain[1:] == stops.chain[:-1])
    chain, reach = stops.chain[pair], stops.tau[pair + 1] - stops.tau[pair]
    begins = np.r_[True, stops.chain[1:] != stops.chain[:-1]][pair]
    ends = np.r_[stops.chain[1:] != stops.chain[:-1], True][pair + 1]
    zeros = np.where(np.stack([begins, ends], 1), singular[chain], -1)
    return ElementSegments(cells, level_curves, chain, stops.tau[pair], reach, zeros, orders)


class _Spots(NamedTuple):
    """Places in order along the curves, with unit tangents, and the elements near which they were looked for."""

    near: Integers
    places: Places
    points: Floats
    tangents: Floats


class _Sampler:
    """Samples of segments; those of pieces that are divided as before are taken over."""

    def __init__(self, segments: ElementSegments, arcs: ElementArcs) -> None:
        self._segments, self._arcs = segments, arcs
        self._before: tuple[Division, _Spots] | None = None

    def __call__(self, division: Division) -> _Spots:
        """Places that divide the segments evenly."""
        if self._before is None:
            made = self._made(division.piece, division.fraction)
        else:
            before, known = self._before
            anew = (division.counts != before.counts)[division.piece]
            kept = (division.counts == before.counts)[before.piece]
            fresh = self._made(division.piece[anew], division.fraction[anew])

            def merged(old: NDArray[Any], new: NDArray[Any]) -> NDArray[Any]:
                whole = np.empty((len(anew), *old.shape[1:]), old.dtype)
                whole[anew], whole[~anew] = new, old[kept]
                return whole

            made = _Spots(
                merged(known.near, fresh.near),
                Places(
                    merged(known.places.element, fresh.places.element), merged(known.places.local, fresh.places.local)
                ),
                merged(known.points, fresh.points),
                merged(known.tangents, fresh.tangents),
            )
        self._before = division, made
        return made

    def _made(self, piece: Integers, fraction: Floats) -> _Spots:
        parameter, near = self._arcs.parameter(piece, fraction)
        # element by element
        order = _by_element(near.element, len(self._segments.cells.value))
        back = _inverse(order)
        spots = self._segments.spots(piece, parameter)[order]
        places, points, velocity = self._segments.velocity(spots, near[order])
        directions = velocity / lengths(velocity)[:, None]
        return _Spots(near.element, places[back], points.take(back, 0), directions.take(back, 0))


def _by_element(element: Integers, count: int) -> Integers:
    """Order of places by their elements (n,) of so many; -1: unknown, first."""
    return counted(element + 1, count + 1).astype(np.int64)


def _sampled(
    segments: ElementSegments, curves: Curves, onto: Onto, mean_curvature: float
) -> tuple[SampledCurves, CurveSamples]:
    """Samples along the segments, exactly on the surface, and the curvatures of the lamellas there."""
    arcs = ElementArcs(segments)
    owner = segments.owner
    # a lamella shorter than a cell is sampled as finely as a whole cell
    whole = np.minimum(np.bincount(owner, segments.reach), 1.0)[owner]
    parts = parts_of(segments.reach / whole, len(curves.kinds))
    division, spots = divide(parts, arcs.length, owner, _Sampler(segments, arcs))
    sampled = SampledCurves(curves, division)
    places, points = spots.places, onto(spots.places.element, spots.points)
    order = _by_element(spots.near, len(segments.cells.value))
    back = _inverse(order)
    normals, tangents, bend, twist = _frames(segments.cells, places[order], spots.tangents.take(order, 0))
    bend, twist, normals, tangents = bend[back], twist[back], normals.take(back, 0), tangents.take(back, 0)
    begun = np.cumsum(arcs.length) - arcs.length
    begun -= begun[np.searchsorted(owner, owner)]
    arclengths = begun[division.piece] + division.fraction * arcs.length[division.piece]
    offsets, closed = sampled.offsets, curves.closed
    darboux = Darboux(bend, turning(tangents, crosses(normals, tangents), arclengths, offsets, closed), twist)
    # kn is H on a lamella but for errors; along principal lines tg is 0 but for them
    slopes = sideways_slopes(darboux, mean_curvature, arclengths, offsets, closed)
    where = np.column_stack([places.element, places.local])
    mean = np.full(len(bend), mean_curvature)
    return sampled, CurveSamples(points, normals, tangents, darboux, mean, slopes, where, arclengths)


def _inverse(order: Integers) -> Integers:
    inverse = np.empty(len(order), np.int64)
    inverse[order] = np.arange(len(order))
    return inverse


def _frames(cells: IntegerGridMap, places: Places, directions: Floats) -> tuple[Floats, Floats, Floats, Floats]:
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
    cells: IntegerGridMap,
    rims: tuple[ElementRim, ...],
    level_curves: LevelCurves,
    stops: _Stops,
    ends: Ends,
    nodes: Integers,
) -> tuple[list[Integers], Floats]:
    """Boundary nodes of each loop in order, and the rim's direction at all nodes: from where lamellas meet it."""
    chain, side = np.nonzero(level_curves.ends == RIM)
    first = np.searchsorted(stops.chain, np.arange(len(level_curves.family)))
    last = np.searchsorted(stops.chain, np.arange(len(level_curves.family)), side="right") - 1
    node = stops.node[np.where(side == 0, first[chain], last[chain])]
    # each node once, where it is one of the net
    there = np.isin(node, nodes)
    node, at = np.unique(node[there], return_index=True)
    loop, place, direction = rim_places(cells, rims, ends.places[(2 * chain + side)[there][at]])
    number = np.searchsorted(nodes, node)
    directions = np.zeros((len(nodes), 3))
    directions[number] = direction
    order = np.lexsort((place, loop))
    return [number[order[loop[order] == k]] for k in range(len(rims))], directions


def _lengths(cells: IntegerGridMap, level_curves: LevelCurves) -> tuple[Floats, float]:
    """Rough lengths of the chains, m, (c,), and the median length of a cell, alike on fine and coarse elements."""
    begin = cells.positions(Places(level_curves.element, level_curves.local_start))
    # every link ends where the next one begins, but for the last ones
    end = np.roll(begin, -1, 0)
    end[level_curves.last] = cells.positions(
        Places(level_curves.element[level_curves.last], level_curves.local_end[level_curves.last])
    )
    rough = lengths(end - begin)
    if not len(rough):
        return np.zeros(0), 0.0
    edge = rough / np.maximum(level_curves.span, 1e-12)
    order = np.argsort(edge)
    share = np.cumsum(level_curves.span[order])
    median = float(edge[order[np.searchsorted(share, share[-1] / 2)]])
    return np.asarray(np.bincount(level_curves.owner, rough, len(level_curves.family)), np.float64), median


def _kept(
    cells: IntegerGridMap, rims: tuple[ElementRim, ...], level_curves: LevelCurves, long: Booleans
) -> tuple[LevelCurves, Booleans]:
    """The chains that are lamellas, in order; and which of all are the rim, (c,)."""
    crossings = find_crossings(level_curves)
    crossings = crossings.of(long)
    tips, _ = rim_tips(cells, level_curves)
    beam = along_rim(cells, rims, level_curves, tips, crossings.take(within_tips(level_curves, tips, crossings)))
    kept = long & ~beam
    crossings = crossings.of(kept)
    return numbered(cells, rims, level_curves, crossings, np.flatnonzero(kept)), beam


def _settled(cells: IntegerGridMap, level_curves: LevelCurves) -> tuple[Crossings, Ends]:
    """Crossings, and how the chains end on the rim."""
    tips, places = rim_tips(cells, level_curves)
    crossings = find_crossings(level_curves)
    crossings = crossings.take(within_tips(level_curves, tips, crossings))
    return crossings, settled_ends(cells, level_curves, tips, places, crossings)
