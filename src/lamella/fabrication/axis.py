"""The developed centre line of a flat strip: a straight line, an arc, or arcs that follow each other smoothly.

A point of the strip is given by its station s along the centre line and its height z towards +n (m). In the drawing the
origin is the centre line's point midway between its ends, x points along the strip there (where the curvature varies:
along its mean direction) and y towards +n.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lamella.base.arrays import Complexes, Floats, Integers

# bulge of a quarter of a circle
QUARTER = np.tan(np.pi / 8)
# Newton's steps for the station of a point of an edge
STATION_STEPS = 4
# 1/m: an arc that is a straight line
STRAIGHT_CURVATURE = 1e-12
# rad: how far before an arc's beginning points still count as before it, and not as beyond its end
BEFORE = 0.2
# of the distance from an arc against that beyond its ends, when a point's arc is chosen
NEARER = 1e-3
# index of a single arc
ONLY_ARC = np.array(0)


@dataclass(frozen=True)
class Axis:
    """A developed centre line.

    Attributes
    ----------
    knots : (n + 1,)
        Stations of its ends and, in between, of where one arc goes over into the next one, m.
    curvatures : (n,)
        Of the arcs, 1/m, > 0 where they bend towards +n.
    places : (n,) complex
        x + i y of each arc's point of reference in the drawing, m.
    headings : (n,)
        Direction there, rad.
    references : (n,)
        Stations of the points of reference, m.
    """

    knots: Floats
    curvatures: Floats
    places: Complexes
    headings: Floats
    references: Floats

    @classmethod
    def arc(cls, start: float, end: float, curvature: float) -> Axis:
        """A straight line or one arc between two stations."""
        zero = np.zeros(1)
        middle = np.array([0.5 * (start + end)])
        return cls(np.array([start, end]), np.array([float(curvature)]), zero.astype(complex), zero, middle)

    @classmethod
    def of(cls, knots: Floats, curvatures: Floats) -> Axis:
        """Arcs between stations."""
        if len(curvatures) == 1:
            return cls.arc(float(knots[0]), float(knots[1]), float(curvatures[0]))
        steps = np.diff(knots)
        turns = curvatures * steps
        headings = np.cumsum(turns) - turns
        headings -= np.sum((headings + 0.5 * turns) * steps) / np.sum(steps)
        chords = steps * np.sinc(0.5 * turns / np.pi) * np.exp(1j * (headings + 0.5 * turns))
        axis = cls(knots, curvatures, np.cumsum(chords) - chords, headings, knots[:-1])
        middle = axis._points(np.array([0.5 * (knots[0] + knots[-1])]), np.zeros(1))
        return cls(knots, curvatures, axis.places - middle, headings, knots[:-1])

    @property
    def is_arc(self) -> bool:
        """Whether it is a single straight line or arc."""
        return len(self.curvatures) == 1

    def piece(self, stations: Floats) -> Integers:
        """The arc that stations lie on; beyond the ends the first or the last one. Of a single arc one 0 for all."""
        if self.is_arc:
            return ONLY_ARC
        return np.asarray(np.searchsorted(self.knots[1:-1], stations, side="right"))

    def develop(self, stations: ArrayLike, heights: ArrayLike) -> Floats:
        """Points of the flat strip in the drawing, (..., 2), m, of stations and heights that broadcast together.

        On one arc ((1/k - z) sin k(s - o), 1/k - (1/k - z) cos k(s - o)), o its middle, written so that it neither
        divides by nor cancels against a small curvature.
        """
        points = self._points(np.asarray(stations, float), np.asarray(heights, float))
        return np.stack((points.real, points.imag), axis=-1)

    def heading(self, stations: Floats, piece: Integers | None = None) -> Floats:
        """Direction of the centre line at stations, rad; `piece` where it is known."""
        piece = self.piece(stations) if piece is None else piece
        return np.asarray(self.headings[piece] + self.curvatures[piece] * (stations - self.references[piece]))

    def _points(self, stations: Floats, heights: Floats | float, piece: Integers | None = None) -> Complexes:
        piece = self.piece(stations) if piece is None else piece
        ahead, begin = stations - self.references[piece], self.headings[piece]
        half = 0.5 * self.curvatures[piece] * ahead
        chord = ahead * np.sinc(half / np.pi)
        turned = begin + 2 * half
        x = chord * np.cos(begin + half) - heights * np.sin(turned)
        y = chord * np.sin(begin + half) + heights * np.cos(turned)
        return np.asarray(self.places[piece] + (x + 1j * y))

    def stations(self, points: Floats) -> Floats:
        """Stations of the feet of points (m, 2) on the centre line, m."""
        away = points[:, None, 0] + 1j * points[:, None, 1] - self.places
        away = away * np.exp(-1j * self.headings)
        k, ahead = self.curvatures, self.knots[:-1] - self.references
        flat = np.abs(k) < STRAIGHT_CURVATURE
        bend = np.where(flat, 1.0, k)
        angle = np.sign(bend) * np.arctan2(bend * away.real, 1 - bend * away.imag)
        # from a little before the arc on all the way around
        begin = np.abs(bend) * ahead - BEFORE
        angle = np.mod(angle - begin, 2 * np.pi) + begin
        local = np.where(flat, away.real, angle / np.abs(bend))
        off = np.where(flat, np.abs(away.imag), np.abs(np.abs(away - 1j / bend) - 1 / np.abs(bend)))
        beyond = np.maximum(np.maximum(ahead - local, local - ahead - np.diff(self.knots)), 0)
        piece = np.argmin(beyond + off * NEARER, axis=1)
        return np.asarray((self.references + local)[np.arange(len(points)), piece])

    def least_scale(self, height: float) -> float:
        """Least length at a height for each length along the centre line, at most 1."""
        return float(np.minimum(1.0, 1.0 - self.curvatures * height).min())

    def edge_stations(self, stations: Floats, height: float, across: float) -> Floats:
        """Stations of the points at `height` that are `across` ahead of the perpendiculars at stations (k,), m."""
        piece = self.piece(stations)
        foot, heading = self._points(stations, 0.0, piece), self.heading(stations, piece)
        ahead = stations + across / (1 - self.curvatures[piece] * height)
        for _ in range(STATION_STEPS):
            piece = self.piece(ahead)
            off = (self._points(ahead, height, piece) - foot) * np.exp(-1j * heading)
            turn = np.cos(self.heading(ahead, piece) - heading)
            scale = 1 - self.curvatures[piece] * height
            ahead = ahead - (off.real - across) / (scale * turn)
        return ahead


def outline(
    axis: Axis,
    height: float,
    slots: Floats,
    slot_width: float,
    from_above: bool,
    *,
    slot_play: float = 0.0,
    foot_radius: float = 0.0,
    ends: Floats | None = None,
) -> Floats:
    """Closed counter-clockwise outline of a strip, its slots as notches.

    A slot's sides are parallel to its axis, which is perpendicular to the centre line; its foot lies `slot_play` beyond
    the centre line, with corners rounded by `foot_radius`. The first vertex is the start's corner on the -n side, the
    last one that on the +n side.

    Parameters
    ----------
    axis : Axis
    height : float
        Of the strip, m.
    slots : (k,)
        Ascending stations of the slots' axes, m.
    slot_width : float
        m.
    from_above : bool
        Whether slots begin at the +n edge.
    slot_play, foot_radius : float
        m.
    ends : (2, 2), optional
        Of the start and of the end the stations of the corners at the -n and at the +n edge, m; perpendicular to the
        centre line where it is not given.

    Returns
    -------
    (v, 3) array
        x, y in m and the bulge (tangent of a quarter of the arc's angle) of the segment to the next vertex.
    """
    side = 0.5 * height if from_above else -0.5 * height
    corners = axis.knots[[[0, 0], [-1, -1]]] if ends is None else ends
    lower, upper = corners[:, 0], corners[:, 1]
    plain = _chain(axis, -side, lower if from_above else upper, slots[:0], slot_width)
    notched = _chain(axis, side, upper if from_above else lower, slots, slot_width, slot_play, foot_radius)
    below, above = (plain, notched) if from_above else (notched, plain)
    back = above[::-1].copy()
    back[:-1, 2], back[-1, 2] = -above[-2::-1, 2], 0.0
    return np.concatenate((below, back))


def _chain(
    axis: Axis, z: float, ends: Floats, slots: Floats, width: float, play: float = 0.0, radius: float = 0.0
) -> Floats:
    """One edge from start to end with its notches, (v, 3) as in `outline`."""
    p = 0.5 * width
    begin, end = axis.edge_stations(slots, z, -p), axis.edge_stations(slots, z, p)
    inner = axis.knots[1:-1]
    inner = inner[(inner > ends[0]) & (inner < ends[1])]
    # arcs go over into each other inside of a notch too, where there is no edge
    notch = np.searchsorted(begin, inner, side="right") - 1
    if len(slots):
        inner = inner[(notch < 0) | (inner >= end[notch])]
    edge = np.sort(np.concatenate((ends[:1], inner, begin, end, ends[1:])))
    points = axis.develop(edge, z)
    inwards = -np.sign(z)
    feet = axis.develop(slots, inwards * play)
    heading = axis.heading(slots)
    ahead = np.stack((np.cos(heading), np.sin(heading)), axis=-1)
    along, up = p * ahead, inwards * np.stack((-ahead[:, 1], ahead[:, 0]), axis=-1)
    # where notches begin among the edge's points
    at = np.searchsorted(edge, begin)
    bulges = np.zeros(len(edge))
    middles = 0.5 * (edge[1:] + edge[:-1])
    bulges[:-1] = np.tan(0.25 * axis.curvatures[axis.piece(middles)] * np.diff(edge))
    bulges[at] = 0.0
    result = np.column_stack((points, bulges))
    corners, bends = [feet - along, feet + along], [0.0, 0.0]
    if radius > 0:
        # each corner is a quarter of a circle
        before, after = corners
        inset = radius * ahead
        corners = [before - radius * up, before + inset, after - inset, after - radius * up]
        bends = [-inwards * QUARTER, 0.0, -inwards * QUARTER, 0.0]
    corner = np.stack(corners, axis=1)
    bulge = np.broadcast_to(np.array(bends)[:, None], (*corner.shape[:2], 1))
    notches = np.concatenate((corner, bulge), axis=2).reshape(-1, 3)
    return np.insert(result, np.repeat(at + 1, len(corners)), notches, axis=0)
