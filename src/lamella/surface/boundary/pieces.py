"""Rational Bezier pieces: the one form every boundary curve is brought into.

Lines, polynomial splines, circles, ellipses and NURBS all are rational piecewise polynomials, so one vectorised
evaluation serves them exactly, and whatever works on curves (arc length, corners, crossings) is written once.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import comb

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.vectors import diagonal, lengths

_ROUNDING = 1e-9
"""Of a curve's size: ends further apart have a gap."""


PIECE_COORDINATE_MAX = 1e12
"""In the unit of a file; beyond it a model in millimetres is not even known to a tenth of one."""

LEAST_WEIGHT = 1e-9
"""Of the largest weight; CAD writes those of arcs, 0.1 to 10. Others pull the curve to a point."""


@dataclass(frozen=True, eq=False)
class Pieces:
    """Consecutive rational Bezier pieces of one degree, each with its parameter s from 0 to 1.

    Attributes
    ----------
    controls : (m, degree + 1, 4)
        Homogeneous control points (w x, w y, w z, w), m; w > 0.
    """

    controls: Floats

    @property
    def count(self) -> int:
        """Number of pieces."""
        return len(self.controls)

    @property
    def degree(self) -> int:
        """Degree of all pieces."""
        return int(self.controls.shape[1]) - 1

    @property
    def starts(self) -> Floats:
        """First point of each piece, m, (m, 3)."""
        return np.asarray(self.controls[:, 0, :3] / self.controls[:, 0, 3:])

    @property
    def ends(self) -> Floats:
        """Last point of each piece, m, (m, 3)."""
        return np.asarray(self.controls[:, -1, :3] / self.controls[:, -1, 3:])

    @property
    def hull(self) -> Floats:
        """Control points in space, m, (m (degree + 1), 3); the curve lies in their convex hull."""
        flat = self.controls.reshape(-1, 4)
        return np.asarray(flat[:, :3] / flat[:, 3:])

    @property
    def extent(self) -> float:
        """Diagonal of the control points' bounding box, m."""
        return diagonal(self.hull)

    @property
    def sound(self) -> bool:
        """Whether its numbers make a curve: pieces, points within `PIECE_COORDINATE_MAX`, weights of like size."""
        weights = self.controls[..., 3]
        if not self.count or not np.isfinite(self.controls).all():
            return False
        if not weights.min() > LEAST_WEIGHT * weights.max():
            return False
        return bool((np.abs(self.controls[..., :3]) <= PIECE_COORDINATE_MAX * self.controls[..., 3:]).all())

    def evaluate(self, piece: Integers, s: Floats) -> tuple[Floats, Floats, Floats]:
        """Position and its first two derivatives by s.

        Parameters
        ----------
        piece : (n,)
            Indices of pieces.
        s : (n,)
            Parameters in 0..1.

        Returns
        -------
        position, first, second : (n, 3)
            m.
        """
        d = max(self.degree, 2)
        controls = self.raised(d).controls
        # the last three points of de Casteljau's scheme hold value and derivatives; Bernstein's basis reaches them
        basis = _bernstein(d - 2, s)
        b0, b1, b2 = (np.einsum("ni,nij->nj", basis, controls[piece, r : d - 1 + r]) for r in range(3))
        rest, s = (1 - s)[:, None], s[:, None]
        low, high = rest * b0 + s * b1, rest * b1 + s * b2
        x = rest * low + s * high
        dx, ddx = d * (high - low), d * (d - 1) * ((b2 - b1) - (b1 - b0))
        w, dw, ddw = x[:, 3:], dx[:, 3:], ddx[:, 3:]
        position = x[:, :3] / w
        first = (dx[:, :3] - position * dw) / w
        second = (ddx[:, :3] - 2 * first * dw - position * ddw) / w
        return position, first, second

    def speed(self, piece: Integers, s: Floats) -> Floats:
        """Length of the first derivative at several parameters of each piece.

        Parameters
        ----------
        piece : (n,)
        s : (n, q)

        Returns
        -------
        (n, q)
            m.
        """
        d = self.degree
        basis = _bernstein(d - 1, s)
        if not self._rational:
            return lengths(basis @ self._slopes[piece])
        controls = self.controls[piece]
        low, high = basis @ controls[:, :-1], basis @ controls[:, 1:]
        dx = d * (high - low)
        s = s[..., None]
        x = (1 - s) * low + s * high
        first = (dx[..., :3] - x[..., :3] * (dx[..., 3:] / x[..., 3:])) / x[..., 3:]
        return np.asarray(np.sqrt(np.einsum("...i,...i", first, first)))

    @cached_property
    def _slopes(self) -> Floats:
        """Bezier points of the first derivative where all weights are 1, (m, degree, 3), m."""
        return np.asarray(self.degree * np.diff(self.controls[..., :3], axis=1))

    @cached_property
    def _rational(self) -> bool:
        return bool((self.controls[..., 3] != 1).any())

    def raised(self, degree: int) -> Pieces:
        """The same curve with control points of a higher degree."""
        controls = self.controls
        while (d := controls.shape[1] - 1) < degree:
            share = (np.arange(1, d + 1) / (d + 1))[None, :, None]
            inner = share * controls[:, :-1] + (1 - share) * controls[:, 1:]
            controls = np.concatenate([controls[:, :1], inner, controls[:, -1:]], axis=1)
        return Pieces(controls)

    def reversed(self) -> Pieces:
        """The same curve run through backwards."""
        return Pieces(np.ascontiguousarray(self.controls[::-1, ::-1]))

    def transformed(self, factor: float, shift: Floats, turn: Floats | None = None) -> Pieces:
        """The curve factor x + shift, turned first by a rotation (3, 3)."""
        w, x = self.controls[..., 3:], self.controls[..., :3]
        turned = x if turn is None else x @ turn.T
        return Pieces(np.concatenate([factor * turned + w * shift, w], axis=-1))

    def mapped(self, matrix: Floats) -> Pieces:
        """The image of the curve under an affine map (4, 4) of columns (x, y, z, 1): exact, whatever it shears."""
        w, x = self.controls[..., 3:], self.controls[..., :3]
        return Pieces(np.concatenate([x @ matrix[:3, :3].T + w * matrix[:3, 3], w], axis=-1))

    def cut(self, piece: Integers, low: Floats, high: Floats) -> Pieces:
        """Parts of pieces, (n,), from one parameter to another, as pieces of their own."""
        controls = self.controls[piece]
        # de Casteljau's scheme, with each parameter in turn: blossoms of both
        for end, s in ((1, high), (0, low / np.where(high > 0, high, 1.0))):
            points, kept = controls, []
            share = s[:, None, None]
            while points.shape[1]:
                kept.append(points[:, 0] if end else points[:, -1])
                points = (1 - share) * points[:, :-1] + share * points[:, 1:]
            controls = np.stack(kept if end else kept[::-1], axis=1)
        return Pieces(controls)

    def shifted(self, shifts: Floats) -> Pieces:
        """The curve x(s) + d(s), d a polynomial on each piece with Bezier points (m, degree + 1, 3), m."""
        p, q = self.degree, shifts.shape[1] - 1
        w = self.controls[..., 3]
        more = np.zeros((self.count, p + q + 1, 3))
        # the product of two polynomials in Bernstein's form
        for i in range(p + 1):
            for j in range(q + 1):
                more[:, i + j] += comb(p, i) * comb(q, j) / comb(p + q, i + j) * w[:, i, None] * shifts[:, j]
        controls = self.raised(p + q).controls.copy()
        controls[..., :3] += more
        return Pieces(controls)

    def from_to(self, start: Floats, end: Floats) -> Pieces:
        """The curve with its very first and last point moved, to close gaps.

        Straight pieces stay straight. Where a curved piece is moved by more than rounding, it is moved with its first
        and second derivative there and stays as it is at its other end: no tangent turns and no curvature jumps for it.
        """
        moves = start - self.starts[0], end - self.ends[-1]
        if self.degree == 1 or max(np.linalg.norm(move) for move in moves) <= _ROUNDING * self.extent:
            controls = self.controls.copy()
            controls[0, 0, :3] = start * controls[0, 0, 3]
            controls[-1, -1, :3] = end * controls[-1, -1, 3]
            return Pieces(controls)
        # of degree 5 the first three control points hold position, tangent and curvature of one end
        controls = self.raised(5).controls.copy()
        controls[0, :3, :3] += controls[0, :3, 3:] * moves[0]
        controls[-1, -3:, :3] += controls[-1, -3:, 3:] * moves[1]
        return Pieces(controls)


def stack(parts: Sequence[Pieces]) -> Pieces:
    """Pieces of several curves one after the other, of the highest degree among them."""
    degree = max(part.degree for part in parts)
    return Pieces(np.concatenate([part.raised(degree).controls for part in parts]))


def lines(points: Floats, *, closed: bool) -> Pieces:
    """Straight pieces between consecutive points (n, 3), and back to the first where the curve is closed."""
    corners = np.vstack([points, points[:1]]) if closed else points
    homogeneous = np.hstack([corners, np.ones((len(corners), 1))])
    return Pieces(np.stack([homogeneous[:-1], homogeneous[1:]], axis=1))


def _bernstein(degree: int, s: Floats) -> Floats:
    """Bernstein polynomials at s (...): (..., degree + 1)."""
    basis = np.empty((*s.shape, degree + 1))
    rest, power = 1 - s, np.ones_like(s)
    for k in range(degree + 1):
        basis[..., k] = comb(degree, k) * power
        power = power * s
    power = rest
    for k in range(degree - 1, -1, -1):
        basis[..., k] *= power
        power = power * rest
    return basis
