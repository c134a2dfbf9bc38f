"""Splines: interpolation through points, and any B-spline as Bezier pieces."""

from __future__ import annotations

import warnings

import numpy as np
from scipy.interpolate import make_interp_spline
from scipy.linalg import LinAlgError, LinAlgWarning

from lamella.base.arrays import Floats
from lamella.base.drawing_origin import origin_of
from lamella.base.errors import InputError
from lamella.surface.boundary.pieces import Pieces, lines

QUINTIC_FROM = 7
"""Points. From here on splines are quintic, below they are cubic.

Surface elements are of order up to 4, so their boundary should be smooth to the fourth derivative; a cubic spline
jumps in its third, and the surface's convergence stops at what the jumps allow. Quintics need six conditions; with so
few points they overshoot more than cubics do.
"""

_LONGEST_SWING = 3.0
"""Length of a spline between two points over their distance: half a circle has 1.57, and no drawn curve means more."""

_LARGEST_MISS = 1e-11
"""Of the length: a spline that misses its own points by more has lost its digits in the solution of its equations."""


def closed_spline(points: Floats, *, where: str = "") -> Pieces:
    """Periodic spline through points (n, 3), n >= 3: quintic from `QUINTIC_FROM` points on, else cubic.

    The parameter is the length of the chords, so unevenly spaced points do not make loops.

    Raises
    ------
    InputError
        Points spaced so unevenly that the spline swings far out, or has no digits left; `where` is the key to name.
    """
    ring = np.vstack([points, points[:1]])
    degree = 5 if len(points) >= QUINTIC_FROM else 3
    return _interpolate(ring, degree, where, closed=True)


def open_spline(points: Floats, *, where: str = "") -> Pieces:
    """Not-a-knot spline through points (n, 3): quintic or cubic as closed ones, a parabola through three, a line."""
    if len(points) == 2:
        return lines(points, closed=False)
    degree = 5 if len(points) >= QUINTIC_FROM else min(3, len(points) - 1)
    return _interpolate(points, degree, where, closed=False)


def follow_weights(points: Floats, t: Floats, *, straight: bool = False) -> Floats:
    """How places of a closed curve through points (n, 3) move with these, its parameter held, (k, n).

    Parameters
    ----------
    points : (n, 3)
    t : (k,)
        Of the places, shares of the length of all chords.
    straight : bool
        Between the points are lines.
    """
    chords = np.append(0.0, np.cumsum(np.linalg.norm(np.roll(points, -1, 0) - points, axis=1)))
    each = np.eye(len(points))[np.append(np.arange(len(points)), 0)]
    degree = 1 if straight else 5 if len(points) >= QUINTIC_FROM else 3
    spline = make_interp_spline(chords, each, k=degree, bc_type="periodic" if degree > 1 else None)
    return np.asarray(spline(t * chords[-1]))


def _interpolate(points: Floats, degree: int, where: str, *, closed: bool) -> Pieces:
    # a drawing far from its origin has no digits left in products
    origin = np.array(origin_of(points))
    points = points - origin
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    chords = np.concatenate([[0.0], np.cumsum(steps)])
    residual = np.inf
    with warnings.catch_warnings():
        warnings.simplefilter("error", LinAlgWarning)
        try:
            spline = make_interp_spline(chords, points, k=degree, bc_type="periodic" if closed else None)
            residual = float(np.abs(spline(chords) - points).max())
        except (LinAlgError, LinAlgWarning, ValueError):
            pass
    remedy = 'space the points more evenly, add points, or write interpolation = "polyline"'
    if not residual <= _LARGEST_MISS * chords[-1]:
        raise InputError(
            f"the points are spaced too unevenly for a spline: {steps.min():.4g} m after point {np.argmin(steps)} "
            f"(counted from 0), {steps.max():.4g} m after point {np.argmax(steps)}",
            remedy,
            where,
        )
    samples = spline(chords[:-1, None] + steps[:, None] * np.linspace(0, 1, 17))
    lengths = np.linalg.norm(np.diff(samples, axis=1), axis=2).sum(axis=1)
    k = int(np.argmax(lengths / steps))
    if lengths[k] > _LONGEST_SWING * steps[k]:
        raise InputError(
            f"the spline swings far out between points {k} and {(k + 1) % (len(points) - closed)} (counted from 0): it "
            f"is {lengths[k]:.4g} m long there, its ends are {steps[k]:.4g} m apart",
            remedy,
            where,
        )
    pieces = bezier(spline.t, degree, spline.c)
    return pieces.transformed(1.0, origin) if origin.any() else pieces


def bezier(knots: Floats, degree: int, controls: Floats) -> Pieces:
    """The pieces of a B-spline, exactly: their control points are values of its polar form.

    Parameters
    ----------
    knots : (n + degree + 1,)
        Not decreasing; clamped, periodic or any other.
    degree : int
    controls : (n, 3) or (n, 4)
        Control points, m, or homogeneous ones (w x, w y, w z, w).
    """
    k, n = degree, len(controls)
    if controls.shape[1] == 3:
        controls = np.hstack([controls, np.ones((n, 1))])
    j = k + np.flatnonzero(np.diff(knots[k : n + 1]) > 0)
    t = knots[j[:, None] + np.arange(1 - k, k + 1)]  # t[:, i] is knot j + 1 - k + i
    a, b = knots[j], knots[j + 1]
    result = np.empty((len(j), k + 1, 4))
    for r in range(k + 1):
        d = controls[j[:, None] + np.arange(-k, 1)]
        for level in range(1, k + 1):
            u = b if level <= r else a
            low, high = t[:, level - 1 : k], t[:, k : 2 * k + 1 - level]
            share = ((u[:, None] - low) / (high - low))[..., None]
            d = (1 - share) * d[:, :-1] + share * d[:, 1:]
        result[:, r] = d[:, 0]
    return Pieces(result)
