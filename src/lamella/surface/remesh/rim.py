"""Boundary loops of a mesh that is being remeshed: how many edges each piece gets, and how to come there."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Protocol

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.ties import MARGIN, grid_of, nearest_whole, rounded
from lamella.surface.remesh.collapse import apart, link_condition, star_after
from lamella.surface.remesh.draft import Draft
from lamella.surface.remesh.smooth import guarded
from lamella.surface.remesh.split import apply_splits
from lamella.surface.remesh.topology import Topology, disjoint

CORNER_PARAMETER = 1e-9  # difference of boundary parameters below which a vertex sits in a corner
LOOP_EDGES_MIN = 3  # edges of a loop
SPREAD_SHAPE = 0.1  # shape above which a careful move of a boundary vertex may make a triangle worse
STATIONS = grid_of(1.0)  # to which stations are rounded, in edges


class Rim(Protocol):
    """The exact curve of a boundary loop.

    Attributes
    ----------
    length : float
        Length of the loop (m).
    corners : sequence of float
        Ascending parameters in [0, 1) that have to be vertices.
    """

    @property
    def length(self) -> float: ...

    @property
    def corners(self) -> Sequence[float] | Floats: ...

    def at(self, t: Floats, /) -> Floats:
        """Points (k, 3) (m) at parameters (k,): fractions of the arc length, periodic with 1."""
        ...


@dataclass(frozen=True)
class Plan:
    """Where the vertices of a loop go.

    The station of a point is the number of final edges between it and the first knot; the final vertices are those
    with whole stations.

    Attributes
    ----------
    rim : Rim
        The curve.
    knots : (k,)
        Parameters that stay vertices: the corners, or any one vertex of a loop that has none.
    counts : (k,) int
        Final edges between a knot and the next.
    fine, stations : (f,)
        Table of parameters, from the first knot once around, and their stations.
    """

    rim: Rim
    knots: Floats
    counts: Integers
    fine: Floats
    stations: Floats

    @property
    def total(self) -> int:
        return int(self.counts.sum())

    def station(self, parameter: Floats) -> Floats:
        """Stations in [0, total) of parameters; knots get their whole number exactly."""
        turned = self.knots[0] + np.mod(parameter - self.knots[0], 1.0)
        station = np.interp(turned, self.fine, self.stations)
        whole = np.concatenate([[0], np.cumsum(self.counts)])
        gap = np.abs(np.mod(parameter[:, None] - self.knots + 0.5, 1.0) - 0.5)
        near = gap.argmin(axis=1)
        # a vertex half-way between two stations goes to the same one on every machine
        station = rounded(station, STATIONS)
        exact: Floats = np.mod(np.where(gap.min(axis=1) < CORNER_PARAMETER, whole[near], station), self.total)
        return exact

    def parameter(self, station: Floats) -> Floats:
        """Parameters in [0, 1) of stations, exactly the knots at their whole numbers."""
        # The table holds the knots, and an interpolation at an entry of its table returns that entry.
        parameter = np.mod(np.interp(np.mod(station, self.total), self.stations, self.fine), 1.0)
        parameter[parameter >= 1.0] = 0.0
        return parameter


def plan(rim: Rim, start: float, size: Callable[[Floats], Floats]) -> Plan:
    """Share out the vertices of a loop: between knots each edge spans the same integral of ds/size.

    Parameters
    ----------
    rim : Rim
        The curve.
    start : float
        Parameter of the vertex that stays if the loop has no corners.
    size : callable
        Wanted edge length (m) at points (k, 3).
    """
    corners = np.asarray(rim.corners, dtype=np.float64)
    knots = corners if corners.size else np.array([start])
    stops = np.append(knots, knots[0] + 1.0)
    pieces: list[Floats] = []
    spans: list[Floats] = []
    for low, high in pairwise(stops):
        samples = 65
        while True:
            t = np.linspace(low, high, samples)
            density = rim.length / size(rim.at(np.mod(t, 1.0)))
            steps = 0.5 * (density[1:] + density[:-1]) * np.diff(t)
            # Several samples to an edge, or a small size between two samples is missed. Even steps along a whole number
            # of edges are never near the limit.
            if steps.max() < 0.13 or samples > 100_000:
                break
            samples = 2 * samples - 1
        pieces.append(t)
        spans.append(np.concatenate([[0.0], np.cumsum(steps)]))
    ideal = np.array([span[-1] for span in spans])
    counts = np.maximum(nearest_whole(ideal), 1).astype(np.int64)
    while counts.sum() < LOOP_EDGES_MIN:
        counts[np.argmax(nearest_whole(ideal / counts / MARGIN))] += 1
    first = np.cumsum(counts) - counts
    fine = np.concatenate([t[:-1] for t in pieces] + [stops[-1:]])
    scaled = [f + s[:-1] * (c / s[-1]) for f, s, c in zip(first, spans, counts, strict=True)]
    return Plan(rim, knots, counts, fine, np.concatenate([*scaled, [float(counts.sum())]]))


@dataclass(frozen=True)
class _Row:
    """Boundary vertices of one loop in order.

    A vertex belongs to the whole station nearest to it, so that none has to slide by more than half an edge. `span` is
    the number of whole stations from that of a vertex to that of the following one.
    """

    vertices: Integers
    stations: Floats
    following: Integers
    whole: Integers
    span: Integers


def _row(draft: Draft, which: int, plan: Plan) -> _Row:
    vertices = np.flatnonzero(draft.loop == which)
    vertices = vertices[np.argsort(draft.station[vertices], kind="stable")]
    stations = draft.station[vertices]
    whole = np.floor(stations + 0.5).astype(np.int64)
    span = np.diff(whole, append=whole[0] + plan.total)
    return _Row(vertices, stations, np.roll(vertices, -1), whole, span)


def done(draft: Draft, plans: Sequence[Plan]) -> bool:
    """Whether every loop has its final vertices."""
    for which, one in enumerate(plans):
        station = np.sort(draft.station[draft.loop == which])
        if station.size != one.total or np.any(station != np.arange(one.total)):
            return False
    return True


def insert_knots(draft: Draft, plans: Sequence[Plan]) -> None:
    """Split the boundary edges in which a knot lies that is not a vertex yet."""
    while True:
        topology = draft.topology()
        edges: list[Integers] = []
        stations: list[Floats] = []
        for which, one in enumerate(plans):
            row = _row(draft, which, one)
            whole = (np.cumsum(one.counts) - one.counts).astype(np.float64)
            draft.fixed[row.vertices] = np.isin(row.stations, whole)
            missing = whole[~np.isin(whole, row.stations)]
            at = np.searchsorted(row.stations, missing, side="right") - 1
            at, keep = np.unique(at, return_index=True)
            edges.append(topology.find(row.vertices[at], row.following[at]))
            stations.append(missing[keep])
        if not sum(e.size for e in edges):
            return
        _split(draft, plans, topology, edges, stations)


def split(draft: Draft, plans: Sequence[Plan]) -> int:
    """Split boundary edges that pass over whole stations; returns how many."""
    topology = draft.topology()
    edges: list[Integers] = []
    stations: list[Floats] = []
    for which, one in enumerate(plans):
        row = _row(draft, which, one)
        at = np.flatnonzero(row.span > 1)
        edges.append(topology.find(row.vertices[at], row.following[at]))
        stations.append(np.mod(row.whole[at] + row.span[at] // 2, one.total).astype(np.float64))
    return _split(draft, plans, topology, edges, stations)


def _split(
    draft: Draft, plans: Sequence[Plan], topology: Topology, edges: list[Integers], stations: list[Floats]
) -> int:
    loop = np.repeat(np.arange(len(plans)), [e.size for e in edges])
    if loop.size == 0:
        return 0
    edge, station = np.concatenate(edges), np.concatenate(stations)
    one_each = disjoint(topology.sides[edge, :1], np.zeros(edge.size), len(draft.faces), passes=1)
    loop, edge, station = loop[one_each], edge[one_each], station[one_each]
    if edge.size:
        first = len(draft.points)
        draft.append(curve_points(draft, plans, loop, station), loop, station)
        apply_splits(draft, topology, edge, first)
    return int(edge.size)


def curve_points(draft: Draft, plans: Sequence[Plan], loop: Integers, station: Floats) -> Floats:
    """Points of the curves at stations, (k, 3), on the draft's grid."""
    points = np.empty((loop.size, 3))
    for which, one in enumerate(plans):
        mine = loop == which
        if mine.any():
            points[mine] = one.rim.at(one.parameter(station[mine]))
    return rounded(points, draft.grid)


def collapse(draft: Draft, plans: Sequence[Plan], careful: bool) -> int:
    """Merge neighbours on a boundary that belong to the same whole station; returns how many.

    Parameters
    ----------
    draft, plans
        The mesh, changed in place, and the plans of its loops.
    careful : bool
        Leave vertices in whose removal would turn a triangle over.
    """
    pairs: list[Integers] = []
    for which, one in enumerate(plans):
        row = _row(draft, which, one)
        pair = np.column_stack([row.vertices, row.following])[row.span == 0]
        pairs += [pair, pair[:, ::-1]]
    removed, kept = np.concatenate([*pairs, np.zeros((0, 2), dtype=np.int64)]).T
    loose = ~draft.fixed[removed]
    removed, kept = removed[loose], kept[loose]
    if removed.size == 0:
        return 0
    topology = draft.topology()
    allowed = link_condition(draft, topology, topology.find(removed, kept), removed, kept)
    removed, kept = removed[allowed], kept[allowed]
    new, old, _ = star_after(draft, topology, removed, kept, draft.points[kept])
    rank: Floats = -nearest_whole(10.0 * np.clip(new, -1.0, 0.5))
    if careful:
        allowed = new >= np.minimum(0.1, old) - MARGIN
        removed, kept, rank = removed[allowed], kept[allowed], rank[allowed]
    chosen = apart(draft, topology, removed, kept, rank)
    draft.merge(removed[chosen], kept[chosen])
    return int(chosen.sum())


def spread(draft: Draft, plans: Sequence[Plan], careful: bool, step: float = 0.6) -> None:
    """Slide boundary vertices along their curves to their whole stations.

    Parameters
    ----------
    draft, plans
        The mesh, changed in place, and the plans of its loops.
    careful : bool
        Leave vertices where they are whose move would turn a triangle over.
    step : float
        Fraction of the way to go; the last bit of the way is gone at once.
    """
    station, goal = draft.station.copy(), draft.points.copy()
    for which, one in enumerate(plans):
        row = _row(draft, which, one)
        # Of several vertices that belong to one station none can go there yet.
        alone = (row.span > 0) & (np.roll(row.span, 1) > 0)
        way = row.whole - row.stations
        near = np.abs(way) < 0.1
        there = np.where(near, np.mod(row.whole, one.total), row.stations + step * way)
        station[row.vertices[alone]] = there[alone]
    rim = np.flatnonzero(draft.boundary & (station != draft.station))
    if rim.size == 0:
        return
    goal[rim] = curve_points(draft, plans, draft.loop[rim], station[rim])
    if careful:
        moves = station != draft.station
        goal, away = guarded(draft, goal, draft.face_shapes(), SPREAD_SHAPE, moves)
        station = np.where(moves & ~away, draft.station, station)
    draft.points, draft.station = goal, station
    draft.size[rim] = draft.size_at(goal[rim])
