"""Foot points on curves, in bulk."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from scipy.spatial import cKDTree

from lamella.projection.unknowns import Floats, dot
from lamella.surface.boundary.curve import Loop

# samples along a curve among which the search starts; Newton's steps, the longest and the last, in loops
SAMPLES, MOST_STEPS, MOST, FINE = 2000, 30, 0.01, 1e-14
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
        self._t = np.arange(SAMPLES) / SAMPLES
        self._tree = cKDTree(loop.at(self._t))

    def foot(self, points: Floats) -> tuple[Floats, Floats]:
        t = self._t[self._tree.query(points)[1]]
        for _ in range(MOST_STEPS):
            off, tangent = points - self._loop.at(t), self._loop.tangent(t)
            bend = (self._loop.tangent(t + TURN) - self._loop.tangent(t - TURN)) / (2 * TURN * self._loop.length)
            step = dot(off, tangent)[:, 0] / np.maximum(1 - dot(off, bend)[:, 0], 0.2) / self._loop.length
            t = t + np.clip(step, -MOST, MOST)
            if np.abs(step).max(initial=0.0) < FINE:
                break
        return self._loop.at(t), self._loop.tangent(t)


class LineFeet:
    """Foot points on a straight line."""

    def __init__(self, point: Floats, direction: Floats) -> None:
        self._point = np.asarray(point, np.float64)
        self._direction = np.asarray(direction, np.float64) / np.linalg.norm(direction)

    def foot(self, points: Floats) -> tuple[Floats, Floats]:
        along = (points - self._point) @ self._direction
        return self._point + along[:, None] * self._direction, np.broadcast_to(self._direction, points.shape)
