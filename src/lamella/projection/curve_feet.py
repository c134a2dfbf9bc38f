"""Foot points on curves, in bulk."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.spatial import cKDTree

from lamella.base.arrays import Floats
from lamella.projection.unknowns import dot
from lamella.surface.boundary.curve import Loop

# samples along a curve among which the search starts; Newton's steps, the longest and the last, in loops
CURVE_SAMPLES, CURVE_FOOT_STEPS_MAX, CURVE_STEP_MAX, CURVE_FOOT_TOLERANCE = 2000, 30, 0.01, 1e-14
# half the difference by which the tangent's turning is measured, in loops
TURN = 1e-5


class FootCurve(Protocol):
    """A curve that finds the foot points of points nearby."""

    def foot(self, points: Floats) -> tuple[Floats, Floats]:
        """Foot points of (n, 3) and unit tangents there."""


class LoopFeet:
    """Foot points on a closed boundary curve, by Newton's method in its arc length."""

    def __init__(self, loop: Loop) -> None:
        self._loop = loop
        self._t = np.arange(CURVE_SAMPLES) / CURVE_SAMPLES
        self._tree = cKDTree(loop.at(self._t))

    def foot(self, points: Floats) -> tuple[Floats, Floats]:
        t = self._t[self._tree.query(points)[1]]
        for _ in range(CURVE_FOOT_STEPS_MAX):
            off, tangent = points - self._loop.at(t), self._loop.tangent(t)
            bend = (self._loop.tangent(t + TURN) - self._loop.tangent(t - TURN)) / (2 * TURN * self._loop.length)
            step = dot(off, tangent)[:, 0] / np.maximum(1 - dot(off, bend)[:, 0], 0.2) / self._loop.length
            t = t + np.clip(step, -CURVE_STEP_MAX, CURVE_STEP_MAX)
            if np.abs(step).max(initial=0.0) < CURVE_FOOT_TOLERANCE:
                break
        return self._loop.at(t), self._loop.tangent(t)


class SplineFeet:
    """Foot points on open curves through points in order, each point asked for on a curve of its own.

    Parameters
    ----------
    curves : sequence of (k, 3)
        Points of cubic splines, m, k >= 4.
    counts : sequence of int
        How many of the points asked for belong to each curve, curve after curve.
    """

    def __init__(self, curves: Sequence[Floats], counts: Sequence[int]) -> None:
        self._splines = []
        for points in curves:
            s = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
            self._splines.append(CubicSpline(s, points))
        self._ends = np.cumsum(counts)

    def foot(self, points: Floats) -> tuple[Floats, Floats]:
        parts = np.split(points, self._ends[:-1])
        both = [self._on(spline, part) for spline, part in zip(self._splines, parts, strict=True)]
        return np.concatenate([b[0] for b in both]), np.concatenate([b[1] for b in both])

    @staticmethod
    def _on(spline: CubicSpline, points: Floats) -> tuple[Floats, Floats]:
        length = spline.x[-1]
        sampled = np.linspace(0, length, 4 * len(spline.x))
        t = sampled[cKDTree(spline(sampled)).query(points)[1]]
        for _ in range(CURVE_FOOT_STEPS_MAX):
            off, first, second = points - spline(t), spline(t, 1), spline(t, 2)
            speed = dot(first, first)[:, 0]
            step = dot(off, first)[:, 0] / np.maximum(speed - dot(off, second)[:, 0], 0.2 * speed)
            t = t + np.clip(step, -CURVE_STEP_MAX * length, CURVE_STEP_MAX * length)
            if np.abs(step).max(initial=0.0) < CURVE_FOOT_TOLERANCE * length:
                break
        tangent = spline(t, 1)
        return spline(t), tangent / np.linalg.norm(tangent, axis=1)[:, None]


class LineFeet:
    """Foot points on a straight line."""

    def __init__(self, point: Floats, direction: Floats) -> None:
        self._point = np.asarray(point, np.float64)
        self._direction = np.asarray(direction, np.float64) / np.linalg.norm(direction)

    def foot(self, points: Floats) -> tuple[Floats, Floats]:
        along = (points - self._point) @ self._direction
        return self._point + along[:, None] * self._direction, np.broadcast_to(self._direction, points.shape)
