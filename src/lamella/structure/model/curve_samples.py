"""Where a lamella, or one of its layers, runs: points and frames at any arc length of its centre line, in bulk.

Between a network's samples by Hermite's cubics of point, tangent and normal, whose derivatives are known there: errors
are of the fourth order in the samples' distance.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from lamella.base.arrays import Floats, Integers
from lamella.network.network import Network
from lamella.strip.lamellas import Lamellas


@dataclass(frozen=True)
class CurveSamples:
    """Curves at the samples of a network, and their derivatives by the arc length of the centre lines.

    Attributes
    ----------
    network : Network
    points, along, bending : (k, 3)
        x, x' and x''.
    normals, turning : (k, 3)
        Surface normal n and n'.
    """

    network: Network
    points: Floats
    along: Floats
    bending: Floats
    normals: Floats
    turning: Floats

    @classmethod
    def of_centre_lines(cls, network: Network) -> CurveSamples:
        """The centre lines: t' = kg u + kn n, n' = -kn t - tg u."""
        t, n = network.sample_tangents, network.sample_normals
        u = np.cross(n, t)
        kn, kg, tg = (values[:, None] for values in network.sample_darboux)
        return cls(network, network.sample_points, t, kg * u + kn * n, n, -kn * t - tg * u)

    @classmethod
    def of_layer(cls, lamellas: Lamellas, row: int) -> CurveSamples:
        """A layer, from the right one (0) on: splines through its points."""
        network, layers = lamellas.network, lamellas.layers
        points, normals = layers.points[row], layers.normals[row]
        along, bending, turning = np.empty((3, *points.shape))
        for first, last in zip(network.sample_offsets[:-1].tolist(), network.sample_offsets[1:].tolist(), strict=True):
            span = slice(first, last)
            place = network.sample_arclengths[span]
            curve, normal = CubicSpline(place, points[span]), CubicSpline(place, normals[span])
            along[span], bending[span], turning[span] = curve(place, 1), curve(place, 2), normal(place, 1)
        return cls(network, points, along, bending, normals, turning)

    def at(self, lamella: Integers, arclength: Floats) -> tuple[Floats, Floats]:
        """Points (..., 3) and frames t, u, n in columns (..., 3, 3) of lamellas (...,) at arc lengths, m."""
        shape = lamella.shape
        before, after, share, step = self._between(lamella.ravel(), arclength.ravel())
        point = _hermite(self.points, self.along, before, after, share, step)
        t = _hermite(self.along, self.bending, before, after, share, step)
        n = _hermite(self.normals, self.turning, before, after, share, step)
        t /= np.linalg.norm(t, axis=1)[:, None]
        n -= (n * t).sum(1)[:, None] * t
        n /= np.linalg.norm(n, axis=1)[:, None]
        frames = np.stack((t, np.cross(n, t), n), 2)
        return point.reshape(*shape, 3), frames.reshape(*shape, 3, 3)

    def speed(self, lamella: Integers, arclength: Floats) -> Floats:
        """Length of x' of lamellas (...,) at arc lengths, (...,)."""
        before, after, share, step = self._between(lamella.ravel(), arclength.ravel())
        along = _hermite(self.along, self.bending, before, after, share, step)
        return np.asarray(np.linalg.norm(along, axis=1).reshape(lamella.shape))

    def integrated(self, lamella: Integers, arclength: Floats, values: Floats) -> Floats:
        """Linear interpolation of values (k,) of the samples, (...,)."""
        before, after, share, _ = self._between(lamella.ravel(), arclength.ravel())
        found = (1 - share) * values[before] + share * values[after]
        return np.asarray(found.reshape(lamella.shape))

    def _between(self, lamella: Integers, arclength: Floats) -> tuple[Integers, Integers, Floats, Floats]:
        """Samples before and after, where in between (0 to 1), and their distance, m."""
        network = self.network
        first, last = network.sample_offsets[lamella], network.sample_offsets[lamella + 1] - 1
        # lamellas one after the other on one line
        stride = 2 * float(network.sample_arclengths.max()) + 1
        owner = np.repeat(np.arange(len(network.ids)), np.diff(network.sample_offsets))
        places = owner * stride + network.sample_arclengths
        after = np.clip(np.searchsorted(places, lamella * stride + arclength), first + 1, last)
        before = after - 1
        start = network.sample_arclengths[before]
        step = network.sample_arclengths[after] - start
        return before, after, (arclength - start) / step, step


def _hermite(values: Floats, slopes: Floats, before: Integers, after: Integers, share: Floats, step: Floats) -> Floats:
    s, h = share[:, None], step[:, None]
    rise = values[after] - values[before]
    low, high = h * slopes[before], h * slopes[after]
    return np.asarray(values[before] + s * (low + s * (3 * rise - 2 * low - high + s * (low + high - 2 * rise))))
