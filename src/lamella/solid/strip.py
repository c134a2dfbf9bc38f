"""Solids of bent and twisted strips, from the outlines they are cut by.

A point of the flat strip at the station s and the height z is the point c(s) + z n(s) of the built one, c its layer's
curve and n the surface normal along it; half the thickness is put on either side.
"""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats
from lamella.fabrication.flat import outline_points
from lamella.fabrication.part import Part
from lamella.solid.extrusion import between
from lamella.solid.solid import Solid
from lamella.strip.lamellas import Lamellas
from lamella.strip.layer_map import LayerMap

AT_EDGE = 1e-6
"""Share of the height within which a point lies on the strip's edge."""


def strip_solid(part: Part, lamellas: Lamellas, row: int, *, step: float = 0.01) -> Solid:
    """One piece as it is built.

    Parameters
    ----------
    part : Part
    lamellas : Lamellas
        That it was made from.
    row : int
        Which layer it is, from the right one (0) on.
    step : float
        Longest piece of its edges, m.
    """
    rings = [_fine(_flat(part, part.outline), step)]
    rings += [_flat(part, hole)[::-1] for hole in part.hole_outlines()]
    flat = np.concatenate(rings)
    right, left = LayerMap.of(lamellas, part.lamella, row).surfaces(flat[:, 0], flat[:, 1], part.thickness)
    # x along the strip and y up: seen from the right the drawing is not mirrored
    # across the strip the built face is straight: flattened, the triangles reach across it and not far along it
    flattened = np.array([1.0, step / part.height])
    return between([ring * flattened for ring in rings], left, right)


def layer_rows(part: Part, lamellas: Lamellas) -> range:
    """The layers that a part is, from the right one (0) on."""
    return range(part.layer - 1, part.layer) if part.layer else range(lamellas.section.layers)


def _flat(part: Part, outline: Floats) -> Floats:
    """Stations and heights of an outline's points, (n, 2), m."""
    at_edge = np.abs(np.abs(_unrolled(part, outline[:, :2])[:, 1]) - part.height / 2) < AT_EDGE * part.height
    # along the strip's edges the height does not change: arcs are straight lines of stations
    straight = np.where(at_edge & np.roll(at_edge, -1), 0.0, outline[:, 2])
    return _unrolled(part, outline_points(np.column_stack([outline[:, :2], straight]))[:-1])


def _unrolled(part: Part, points: Floats) -> Floats:
    """Stations and heights of points of the drawing, (n, 2), m."""
    stations = part.axis.stations(points)
    foot = part.place(stations, 0.0)
    heading = part.axis.heading(stations)
    away = points - foot
    return np.column_stack([stations, away[:, 1] * np.cos(heading) - away[:, 0] * np.sin(heading)])


def _fine(ring: Floats, step: float) -> Floats:
    """A ring with points at most `step` apart."""
    ahead = np.roll(ring, -1, axis=0) - ring
    pieces = np.maximum(np.ceil(np.linalg.norm(ahead, axis=1) / step), 1).astype(np.int64)
    owner = np.repeat(np.arange(len(ring)), pieces)
    share = (np.arange(len(owner)) - np.repeat(np.cumsum(pieces) - pieces, pieces)) / pieces[owner]
    return np.asarray(ring[owner] + share[:, None] * ahead[owner])
