"""Foot points on curves, in bulk."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from scipy.spatial import cKDTree

from lamella.projection.unknowns import Floats

# samples along a curve among which the search starts; Newton's steps
SAMPLES, MOST_STEPS = 2000, 20


class FootCurve(Protocol):
    """A curve that finds the foot points of points nearby."""

    def foot(self, points: Floats) -> tuple[Floats, Floats]:
        """Foot points of (n, 3) and unit tangents there."""


class ArcLengthCurve(Protocol):
    """A closed curve by arc length, such as `lamella.surface.boundary.curve.Loop`."""

    @property
    def length(self) -> float:
        """m."""

    def at(self, t: Floats) -> Floats:
        """Points (n, 3) at arc lengths; the curve is closed."""

    def tangent(self, t: Floats) -> Floats:
        """Unit tangents."""

    def curvature(self, t: Floats) -> Floats:
        """Curvature vectors, 1/m."""


class LoopFeet:
    """Foot points on a closed curve by Newton's method in arc length."""

    def __init__(self, curve: ArcLengthCurve) -> None:
        self._curve = curve
        self._t = np.arange(SAMPLES) * (curve.length / SAMPLES)
        self._tree = cKDTree(curve.at(self._t))

    def foot(self, points: Floats) -> tuple[Floats, Floats]:
        t = self._t[self._tree.query(points)[1]]
        for _ in range(MOST_STEPS):
            off, tangent = points - self._curve.at(t), self._curve.tangent(t)
            slope = np.maximum(1 - (off * self._curve.curvature(t)).sum(1), 0.2)
            step = (off * tangent).sum(1) / slope
            t = (t + np.clip(step, -0.01 * self._curve.length, 0.01 * self._curve.length)) % self._curve.length
            if np.abs(step).max(initial=0) < 1e-14 * self._curve.length:
                break
        return self._curve.at(t), self._curve.tangent(t)


class LineFeet:
    """Foot points on a straight line."""

    def __init__(self, point: Floats, direction: Floats) -> None:
        self._point = np.asarray(point, np.float64)
        self._direction = np.asarray(direction, np.float64) / np.linalg.norm(direction)

    def foot(self, points: Floats) -> tuple[Floats, Floats]:
        along = (points - self._point) @ self._direction
        return self._point + along[:, None] * self._direction, np.broadcast_to(self._direction, points.shape)
