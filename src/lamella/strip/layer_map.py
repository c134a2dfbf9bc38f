"""The curve of a layer beside its lamella's centre line, between the samples and a little beyond its ends.

A point of the flat strip at the station s and the height z is the point c(s) + z n(s) of the built one, c the layer's
curve and n the surface normal along it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from lamella.base.arrays import Floats
from lamella.strip.lamellas import Lamellas

LEAST_SAMPLE_STEP = 1e-9
"""m; samples of a layer nearer to each other count once."""


@dataclass(frozen=True)
class LayerMap:
    """Where a layer runs.

    Attributes
    ----------
    curve, normal : CubicSpline
        By the station on the flat strip, or by the arc length of the lamella's centre line, m.
    first, last : float
        Between which the layer's curve is known, m; beyond it goes on straight.
    whole : (2,)
        Whether the curve is known up to the lamella's start, and to its end: what lies beyond is cut to its own length.
    """

    curve: CubicSpline
    normal: CubicSpline
    first: float
    last: float
    whole: tuple[bool, bool]

    @classmethod
    def of(cls, lamellas: Lamellas, lamella: int, row: int, *, by_arclength: bool = False) -> LayerMap:
        """The map of a layer, from the right one (0) on, of one lamella."""
        network, layers = lamellas.network, lamellas.layers
        span = slice(int(network.sample_offsets[lamella]), int(network.sample_offsets[lamella + 1]))
        known = np.flatnonzero(layers.followed[span]) + span.start
        place = network.sample_arclengths if by_arclength else layers.stations[row]
        known = known[np.append(True, np.diff(place[known]) > LEAST_SAMPLE_STEP)]
        stations = place[known]
        return cls(
            CubicSpline(stations, layers.points[row, known]),
            CubicSpline(stations, layers.normals[row, known]),
            float(stations[0]),
            float(stations[-1]),
            (bool(layers.followed[span.start]), bool(layers.followed[span.stop - 1])),
        )

    def frames(self, stations: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """Curve, its derivative by the station, unit normal and its derivative, (n, 3) each."""
        at = np.clip(stations, self.first, self.last)
        beyond = (stations - at)[:, None]
        point, along = self.curve(at), self.curve(at, 1)
        normal, turning = self.normal(at), self.normal(at, 1)
        own = ((beyond < 0) & self.whole[0]) | ((beyond > 0) & self.whole[1])
        speed = np.where(own, np.linalg.norm(along, axis=1)[:, None], 1.0)
        along, turning = along / speed, turning / speed
        raised = normal + beyond * turning
        length = np.linalg.norm(raised, axis=1)[:, None]
        return point + beyond * along, along, raised / length, turning / length

    def surfaces(self, stations: Floats, heights: Floats, thickness: float) -> tuple[Floats, Floats]:
        """Points of the built strip's right and left face, half a thickness beside its middle, (n, 3) each, m."""
        return self.beside(stations, heights, -thickness / 2), self.beside(stations, heights, thickness / 2)

    def beside(self, stations: Floats, heights: Floats, offset: float) -> Floats:
        """Points at a distance to the left of the strip's middle, perpendicular to it, (n, 3), m."""
        point, along, normal, turning = self.frames(stations)
        z = heights[:, None]
        left = np.cross(normal, along + z * turning)
        return np.asarray(point + z * normal + offset / np.linalg.norm(left, axis=1)[:, None] * left)
