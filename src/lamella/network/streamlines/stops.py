"""Stops of traced lines: where they cross and where they end, and the nodes and faces these make."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.network.assemble import RimNodes
from lamella.network.charts.charts import Charts
from lamella.network.network import BOUNDARY, REGULAR
from lamella.network.streamlines.intersections import Crossings
from lamella.network.streamlines.streamlines import RIM, Streamlines
from lamella.surface.element.places import Places

# of the edge of whole cells: ends and crossings this near to each other are one node (docs/files.md)
SAME_NODE = 1e-6


class Stops(NamedTuple):
    """Stops in order along the lines."""

    line: Integers
    s: Floats
    crossing: Integers  # -1: an end
    is_end: Booleans


def line_stops(streamlines: Streamlines, crossings: Crossings) -> Stops:
    lines, count = np.arange(streamlines.count), len(crossings.a)
    line = np.r_[crossings.a, crossings.b, lines, lines]
    s = np.r_[crossings.s_a, crossings.s_b, np.zeros(streamlines.count), streamlines.lengths]
    crossing = np.r_[np.arange(count), np.arange(count), np.full(2 * streamlines.count, -1)]
    order = np.lexsort((s, line))
    return Stops(line[order], s[order], crossing[order], crossing[order] < 0)


def whole_edge(streamlines: Streamlines, crossings: Crossings) -> float:
    """Median distance of neighbouring crossings, m: of whole cells, without pieces at the rim; nan without any."""
    stops = line_stops(streamlines, crossings)
    inner = ~stops.is_end[1:] & ~stops.is_end[:-1] & (stops.line[1:] == stops.line[:-1])
    return float(np.median(np.diff(stops.s)[inner])) if inner.any() else np.nan


def median_edge(streamlines: Streamlines, crossings: Crossings) -> float:
    """Median cell edge of the net of these lines, m: `Network.cell_edges`, pieces at the rim included."""
    whole = whole_edge(streamlines, crossings)
    stops = merged_stops(
        streamlines, line_stops(streamlines, crossings), SAME_NODE * whole if np.isfinite(whole) else 0.0
    )
    edges = np.diff(stops.s)[stops.line[1:] == stops.line[:-1]]
    return float(np.median(edges)) if len(edges) else np.nan


def without_short(
    streamlines: Streamlines, crossings: Crossings, minimum_length: float
) -> tuple[Streamlines, Crossings]:
    """The lines that are not shorter than so many edges of whole cells, and their crossings."""
    least = minimum_length * whole_edge(streamlines, crossings)
    kept = np.flatnonzero(streamlines.lengths >= (least if np.isfinite(least) else 0.0))
    number = np.full(streamlines.count, -1)
    number[kept] = np.arange(len(kept))
    a, b = number[crossings.a], number[crossings.b]
    both = (a >= 0) & (b >= 0)
    return streamlines.take(kept), Crossings(a[both], b[both], crossings.s_a[both], crossings.s_b[both])


def merged_stops(streamlines: Streamlines, stops: Stops, same: float) -> Stops:
    """Stops without those crossings that are an end of their line: the end stays and is the crossing."""
    crossing = stops.crossing.copy()
    gone = np.zeros(len(stops.line), bool)
    close = (np.diff(stops.s) <= same) & (stops.line[1:] == stops.line[:-1])
    start = np.flatnonzero(close & stops.is_end[:-1] & ~stops.is_end[1:])
    crossing[start], gone[start + 1] = crossing[start + 1], True
    end = np.flatnonzero(close & ~stops.is_end[:-1] & stops.is_end[1:])
    crossing[end + 1], gone[end] = crossing[end], True
    return Stops(stops.line[~gone], stops.s[~gone], crossing[~gone], stops.is_end[~gone])


def stop_nodes(
    charts: Charts, streamlines: Streamlines, stops: Stops, same: float
) -> tuple[Integers, Integers, Booleans]:
    """Node of each stop; kind of each node; whether it is an end inside the surface."""
    count = len(stops.line)
    ends = np.flatnonzero(stops.is_end)
    _, sample, _ = streamlines.at(stops.line[ends], stops.s[ends])
    pairs = cKDTree(sample.position).query_pairs(same, output_type="ndarray")
    # stops of one crossing, and ends in one place
    order = np.argsort(stops.crossing, kind="stable")
    order = order[stops.crossing[order] >= 0]
    pair = np.flatnonzero(stops.crossing[order][1:] == stops.crossing[order][:-1])
    i, j = np.r_[ends[pairs[:, 0]], order[pair]], np.r_[ends[pairs[:, 1]], order[pair + 1]]
    _, group = connected_components(coo_array((np.ones(len(i)), (i, j)), (count, count)), directed=False)
    # numbered in the order in which the lamellas meet them
    used, first, node = np.unique(group, return_index=True, return_inverse=True)
    rank = np.empty(len(used), np.int64)
    rank[np.argsort(first, kind="stable")] = np.arange(len(used))
    node = rank[node.ravel()]
    kinds = np.full(len(used), REGULAR)
    kinds[node[ends]] = BOUNDARY
    halves = 2 * stops.line[ends] + (stops.s[ends] > 0)
    inner = np.zeros(len(used), bool)
    inner[node[ends]] = streamlines.ends[halves] != RIM
    return node, kinds, inner


def rim_nodes(charts: Charts, where: Places, kinds: Integers, inner: Booleans) -> RimNodes:
    """How the boundary runs through nodes at places (n,); no face across the ends inside the surface."""
    rim = np.flatnonzero((kinds == BOUNDARY) & ~inner)
    places = charts.rim_places(where[rim])
    order = np.lexsort((places.along, places.loop))
    loops = np.split(rim[order], np.flatnonzero(np.diff(places.loop[order])) + 1)
    directions = np.zeros((len(kinds), 3))
    directions[rim] = places.tangent
    return RimNodes(loops, directions, inner)
