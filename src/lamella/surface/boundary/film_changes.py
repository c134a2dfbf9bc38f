"""Changes of a film's boundary and H, each as a function of the film and of a few numbers.

The parameters of `lamella.surface.boundary.freedom`, and what a study varies: shifts, sizes and tilts of loops about
their middle, waves along them, H.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from lamella.base.arrays import Floats
from lamella.base.limits import MOST_WAVES
from lamella.surface.boundary.adjustable_film import AdjustableFilm
from lamella.surface.boundary.boundary_curve import BoundaryCurve, Place, Triple

Change = Callable[[AdjustableFilm, Floats], AdjustableFilm]
"""The film with some parameters changed by values."""


def placed(index: int) -> Change:
    """Curve number `index` shifted by (2,) in plan or (3,), m."""
    return lambda film, values: _mapped(film, index, np.eye(3), 1.0, _in_space(values))


def sized(index: int) -> Change:
    """Curve number `index` larger by a share of its size, (1,)."""
    return lambda film, values: _mapped(film, index, np.eye(3), 1.0 + float(values[0]), np.zeros(3))


def tilted(index: int) -> Change:
    """Curve number `index` turned by a vector along the axis, (3,), rad."""
    return lambda film, values: _mapped(film, index, Rotation.from_rotvec(values).as_matrix(), 1.0, np.zeros(3))


def waved(index: int, waves: Floats) -> Change:
    """Points of curve number `index` shifted by rows of waves at these points, (w, n), times (w, 2 or 3), m."""

    def apply(film: AdjustableFilm, values: Floats) -> AdjustableFilm:
        curve = film.curves[index]
        points = np.array(curve.points) + waves.T @ _in_space(values.reshape(len(waves), -1))
        return _replaced(film, index, replace(curve, points=_tuples(points)))

    return apply


def curve_waved(index: int, first: int) -> Change:
    """Waves by arc length, added to those the curve is placed with; without the even one where it is moved anyway."""

    def apply(film: AdjustableFilm, values: Floats) -> AdjustableFilm:
        curve = film.curves[index]
        place = curve.place or Place()
        rows = np.zeros((2 * MOST_WAVES + 1, 3))
        rows[: len(place.waves)] = np.array(place.waves).reshape(-1, 3)
        rows[first:] += _in_space(values.reshape(len(rows) - first, -1))
        waves = _tuples(rows) if rows.any() else ()
        return _replaced(film, index, replace(curve, place=replace(place, waves=waves)))

    return apply


def with_curvature(film: AdjustableFilm, values: Floats) -> AdjustableFilm:
    """H larger by (1,), 1/m."""
    return replace(film, mean_curvature=(film.mean_curvature or 0.0) + float(values[0]))


def _replaced(film: AdjustableFilm, index: int, curve: BoundaryCurve) -> AdjustableFilm:
    curves = list(film.curves)
    curves[index] = curve
    return replace(film, curves=tuple(curves))


def _mapped(film: AdjustableFilm, index: int, turn: Floats, factor: float, shift: Floats) -> AdjustableFilm:
    """One curve turned and scaled about its middle, then shifted."""
    curve = film.curves[index]
    if curve.points is not None:
        points = np.array(curve.points)
        middle = points.mean(0)
        moved = (points - middle) @ turn.T * factor + middle + shift
        return _replaced(film, index, replace(curve, points=_tuples(moved)))
    if curve.circle is not None:
        ring = replace(
            curve.circle,
            center=_triple(np.array(curve.circle.center) + shift),
            radius=curve.circle.radius * factor,
            normal=_triple(turn @ np.array(curve.circle.normal)),
        )
        return _replaced(film, index, replace(curve, circle=ring))
    place = curve.place or Place()
    there = replace(
        place,
        shift=_triple(np.array(place.shift) + shift),
        scale=place.scale * factor,
        turn=_degrees(turn @ Rotation.from_rotvec(np.radians(place.turn)).as_matrix()),
    )
    return _replaced(film, index, replace(curve, place=there))


def _degrees(turn: Floats) -> Triple:
    """Vector along the axis of a rotation (3, 3), as long as its angle, degrees."""
    return _triple(np.degrees(Rotation.from_matrix(turn).as_rotvec()))


def _triple(vector: Floats) -> Triple:
    x, y, z = vector.tolist()
    return x, y, z


def _tuples(points: Floats) -> tuple[Triple, ...]:
    return tuple(map(_triple, points))


def _in_space(shifts: Floats) -> Floats:
    """Shifts (..., 3) of shifts in plan (..., 2), or those of three already."""
    return np.concatenate([shifts, np.zeros((*shifts.shape[:-1], 3 - shifts.shape[-1]))], axis=-1)
