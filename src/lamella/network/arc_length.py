"""Arc lengths along lamellas, to rounding, and the points that divide them evenly."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.errors import InputError

# Gauss-Legendre points a cell to begin with, and at most
SERIES_POINTS, SERIES_POINTS_MAX = 12, 768
# share of the speed's series that its last two terms may have
SPEED_TAIL = 1e-12
# of the parameter, when points are divided evenly
ARC_LAST_STEP = 1e-6


class Pieces(Protocol):
    """Pieces of lamella, each with a parameter 0 <= sigma <= 1."""

    owner: Integers

    def speed(self, segment: Integers, sigma: Floats) -> Floats:
        """Arc length per sigma, m, at parameters (p,) of segments (s,), shape (s, p)."""


class Stretched(InputError):
    """Cells stretch so much that no series reaches full accuracy."""


class ArcLengths:
    """Arc length along every segment as a Legendre series in 2 sigma - 1.

    The speed is analytic beyond a cell, so that a dozen terms leave rounding only; segments on which they do not
    (close to where a surface runs to infinity) get more, until they do.

    Parameters
    ----------
    segments : Pieces
    tail : float
        Share of the speed's series that its last two terms may have.
    settle : int
        Points a segment at which any series is taken: where the speed is not smooth enough for more to tell more.
    points : int
        Points a segment to begin with.

    Attributes
    ----------
    length : (s,)
        m.

    Raises
    ------
    Stretched
    """

    def __init__(
        self, segments: Pieces, tail: float = SPEED_TAIL, settle: int = 10**9, points: int = SERIES_POINTS
    ) -> None:
        count = len(segments.owner)
        self.length = np.empty(count)
        self._series: list[tuple[Floats, Floats]] = []
        self._group, self._member = np.zeros(count, np.int64), np.zeros(count, np.int64)
        left = np.arange(count)
        reached = 0.0
        while len(left):
            if points > SERIES_POINTS_MAX:
                raise Stretched(
                    f"{len(left)} pieces of lamella stretch too much for their length to be measured: to "
                    f"{reached:.2g} of the mean speed along them (limit {tail:g})",
                    where="cells",
                )
            speed, length = _speed_series(segments, left, points)
            end = np.abs(speed[-2:]).max(0) / speed[0]
            reached = float(end.max())
            done = (end <= tail) | (points >= settle)
            self._group[left[done]] = len(self._series)
            self._member[left[done]] = np.arange(done.sum())
            self.length[left[done]] = length[done]
            integral = np.polynomial.legendre.legint(speed[:, done], lbnd=-1, axis=0) / 2
            # rows in one piece: numpy's take copies any other row as a whole, however few of its members are taken
            self._series.append((np.ascontiguousarray(integral), np.ascontiguousarray(speed[:, done] / 2)))
            left, points = left[~done], 4 * points

    def parameter(self, segment: Integers, fraction: Floats) -> Floats:
        """sigma where the given fractions of the segments' arc lengths are reached, (k,)."""
        sigma = np.empty(len(segment))
        group = self._group[segment]
        for number, (integral, speed) in enumerate(self._series):
            own = np.flatnonzero(group == number)
            if len(own):
                member = self._member[segment[own]]
                sigma[own] = _reach(integral, speed, member, fraction[own], self.length[segment[own]])
        return np.where(fraction == 1, 1.0, np.where(fraction == 0, 0.0, sigma))


def _speed_series(segments: Pieces, segment: Integers, points: int) -> tuple[Floats, Floats]:
    """Legendre coefficients of the speed, (points, s), and the lengths, (s,)."""
    x, weight = np.polynomial.legendre.leggauss(points)
    speed = segments.speed(segment, (x + 1) / 2)
    basis = np.polynomial.legendre.legvander(x, points - 1)
    transform: Floats = (basis * weight[:, None]) * (np.arange(points) + 0.5)
    # einsum, not BLAS: starting its threads takes longer than this product
    coefficients: Floats = np.einsum("pd,sp->ds", transform, speed)
    return coefficients, np.einsum("sp,p->s", speed, weight) / 2


def _reach(integral: Floats, speed: Floats, member: Integers, fraction: Floats, length: Floats) -> Floats:
    """sigma where a fraction of the length is reached: Newton's method kept inside a shrinking bracket."""
    low, high = np.full(len(member), -1.0), np.full(len(member), 1.0)
    x: Floats = 2 * fraction - 1
    # to begin with, as if the speed were the first two terms of its series
    bend = speed[1].take(member) / (2 * speed[0].take(member))
    x = np.clip(x + bend * (1 - x * x), -1, 1)
    for _ in range(60):
        residual = _clenshaw(integral, member, x) - fraction * length
        low, high = np.where(residual < 0, x, low), np.where(residual > 0, x, high)
        goal = x - residual / _clenshaw(speed, member, x)
        before, x = x, np.where((goal >= low) & (goal <= high), goal, (low + high) / 2)
        # the next step would be its square
        if np.abs(x - before).max() <= ARC_LAST_STEP:
            break
    return np.asarray((x + 1) / 2)


def _clenshaw(coefficients: Floats, member: Integers, x: Floats) -> Floats:
    """Legendre series, one a member, each at its own arguments."""
    after, now = np.zeros_like(x), np.zeros_like(x)
    for n in range(len(coefficients) - 1, -1, -1):
        term: Floats = (2 * n + 1) / (n + 1) * x * now - (n + 1) / (n + 2) * after
        after, now = now, coefficients[n].take(member) + term
    return now
