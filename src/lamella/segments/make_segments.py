"""Segments of a structure: the net divided, parts cut at the borders, and what each weighs as it is built."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.errors import InputError
from lamella.fabrication.part import Parts
from lamella.hardware.item import Hardware
from lamella.network.network import Network
from lamella.segments.lifting import lifting_nodes
from lamella.segments.partition import Graph, Limits, extent, partition
from lamella.segments.segments import Segment, SegmentJoint, Segments
from lamella.segments.weights import Weights, part_stops
from lamella.strip.lamellas import Lamellas, crossings

# splices and cut ends change what segments weigh: how often the net is divided anew for less
DIVIDED_ANEW = 8
# of what a segment has to lose, that it is divided for
MASS_MARGIN = 0.005

Make = Callable[[Sequence[Integers] | None], tuple[Parts, Hardware]]
"""Parts and hardware with lamellas cut in some cells."""


@dataclass(frozen=True, eq=False)
class Divided:
    """Segments, and the parts and hardware they are made of."""

    parts: Parts
    hardware: Hardware
    segments: Segments


def make_segments(lamellas: Lamellas, limits: Limits, make: Make, splice_room: float = 0.0) -> Divided:
    """Divide a structure into segments that keep within limits as they are built.

    The net is divided by what goes with each node; then parts and hardware are made anew, cut and spliced at the
    borders, and weighed. Where a segment is too heavy then, the net is divided for less.

    Parameters
    ----------
    lamellas : Lamellas
    limits : Limits
    make : callable
    splice_room : float
        From a cut to the next slot, m: cells too short for it are cut where nothing else can be.

    Raises
    ------
    InputError
        What goes with a single node is beyond a limit, or the hardware at the borders is too heavy.
    """
    network = lamellas.network
    weights = Weights.of(*make(None), lamellas)
    wanted, section = limits, lamellas.section
    least_cell = 2 * splice_room + (section.layers - 1) * section.offset if splice_room else 0.0
    for _ in range(DIVIDED_ANEW):
        graph = Graph.of(network, weights.nodes, least_cell)
        of_node = partition(graph, wanted)
        borders = _borders(graph, of_node, len(network.ids))
        parts, hardware = make(borders)
        weights = Weights.of(parts, hardware, lamellas)
        segments = _segments(parts, weights, graph, of_node, borders, lamellas)
        heaviest = max(segments.segments, key=lambda one: one.mass)
        if heaviest.mass <= limits.mass * (1 + 1e-9):
            return Divided(parts, hardware, segments)
        share = limits.mass / heaviest.mass
        wanted = replace(wanted, mass=wanted.mass * (share - MASS_MARGIN))
    raise InputError(
        f"segments cannot be made as light as mass = {limits.mass:g} kg: {heaviest.id} of {len(segments.segments)} "
        f"weighs {heaviest.mass:.4g} kg, of which its splices are a large part",
        f"write mass = {1.1 * heaviest.mass:.3g} or more",
        "mass",
    )


def _borders(graph: Graph, of_node: Integers, lamellas: int) -> tuple[Integers, ...]:
    """Cells whose ends lie in two segments, of each lamella."""
    cut = of_node[graph.ends[:, 0]] != of_node[graph.ends[:, 1]]
    return tuple(graph.cells[cut & (graph.lamellas == k)] for k in range(lamellas))


def _segments(
    parts: Parts,
    weights: Weights,
    graph: Graph,
    of_node: Integers,
    borders: tuple[Integers, ...],
    lamellas: Lamellas,
) -> Segments:
    network = lamellas.network
    of_part = of_node[weights.part_nodes]
    of_place = tuple(of_node[nodes] for nodes in weights.place_nodes)
    liftable = crossings(network)
    owners = np.array([part.lamella for part in parts.parts])
    found = []
    for k in range(int(of_node.max()) + 1):
        own = np.flatnonzero(of_part == k)
        mass, centre = _weighed(weights, of_part == k, [places == k for places in of_place])
        inside = of_node == k
        nodes = np.flatnonzero(inside)
        able = nodes[liftable[nodes]]
        lifting, shares = lifting_nodes(able, network.node_points[able], centre)
        if not len(lifting):
            # small ones at the rim may be surrounded by its nodes alone
            lifting, shares = lifting_nodes(nodes, network.node_points[nodes], centre)
        size = extent(graph, inside)
        found.append(Segment(f"S{k + 1}", nodes, np.unique(owners[own]), own, mass, centre, size, lifting, shares))
    return Segments(tuple(found), _joints(parts, of_part, lamellas), of_node, of_part, of_place, borders)


def _weighed(weights: Weights, parts: Booleans, places: Sequence[Booleans]) -> tuple[float, Floats]:
    """Mass and centre of gravity of some parts and pieces."""
    mass = float(weights.parts[parts].sum())
    moment = weights.parts[parts] @ weights.part_centres[parts]
    for one, points, own in zip(weights.items, weights.places, places, strict=True):
        mass += one * float(own.sum())
        moment = moment + one * points[own].sum(axis=0)
    return mass, np.asarray(moment / mass)


def _joints(parts: Parts, of_part: Integers, lamellas: Lamellas) -> tuple[SegmentJoint, ...]:
    """Neighbouring pieces of a strip that lie in two segments."""
    network = lamellas.network
    strips: dict[tuple[int, int], list[int]] = {}
    for k, part in enumerate(parts.parts):
        strips.setdefault((part.lamella, part.layer), []).append(k)
    found = []
    for (lamella, _), pieces in strips.items():
        pairs = list(pairwise(pieces)) + ([(pieces[-1], pieces[0])] if network.closed[lamella] else [])
        for one, other in pairs:
            if of_part[one] != of_part[other]:
                stop = int(part_stops(parts.parts[one], network)[-1])
                segments = int(of_part[one]), int(of_part[other])
                found.append(SegmentJoint(segments, (one, other), lamella, _middle(network, lamella, stop)))
    return tuple(found)


def _middle(network: Network, lamella: int, stop: int) -> Floats:
    """The centre line midway between a stop and the next one, m."""
    span = slice(int(network.sample_offsets[lamella]), int(network.sample_offsets[lamella + 1]))
    at = 0.5 * float(network.stop_arclengths[stop] + network.stop_arclengths[stop + 1])
    arc, points = network.sample_arclengths[span], network.sample_points[span]
    return np.array([float(np.interp(at, arc, points[:, k])) for k in range(3)])
