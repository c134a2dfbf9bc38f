"""Bounds that every surface of constant mean curvature in given loops has to keep."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.optimize import minimize_scalar

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.ties import least_axis
from lamella.base.vectors import diagonal
from lamella.surface.form_finding.chart import Curve, samples_of, vector_area
from lamella.surface.form_finding.film import Loop

# two equal coaxial rings: largest distance over their radius, the maximum of 2 acosh(x) / x
RING_DISTANCE = 1.3254868387
# half opening of the double cone no connected minimal surface leaves through both of: sinh of coth(x) = x
CONE = 1.5088795615
CONDITION_SAMPLES = 2000
# height of a flat loop over its length
FLAT_HEIGHT = 1e-6
# turn (rad) the wrong way that is rounding
STRAIGHT_LOOP = 1e-7


class ImpossibleError(InputError):
    """A bound says that there is no such film.

    Attributes
    ----------
    limit : float or None
        The bound: of |H|, 1/m, or of the distance of two coaxial rings, m.
    """

    def __init__(self, message: str, where: str, limit: float | None = None) -> None:
        super().__init__(message, "", where)
        self.limit = limit


def refuse_impossible(loops: Sequence[Curve], mean_curvature: float) -> None:
    """Raise an `ImpossibleError` where a bound says that no surface exists.

    Parameters
    ----------
    loops : sequence of Curve
        All held.
    mean_curvature : float
        1/m.
    """
    refuse_flux(loops, mean_curvature)
    if mean_curvature == 0 and len(loops) == 2:
        refuse_apart(loops)


def refuse_afloat(loops: Sequence[Loop]) -> None:
    """Loops all of which slide, all of them: nothing holds the film, which can move away and shrink."""
    if all(any(slide.end - slide.start >= 1 for slide in loop.slides) for loop in loops):
        names = " and ".join(f"{loop.name!r}" for loop in loops)
        raise InputError(
            f"nothing holds the surface: {names} {'slides' if len(loops) == 1 else 'slide'} as a whole",
            "hold one loop, or a part of one",
            "loops",
        )


def refuse_single(loops: Sequence[Curve], mean_curvature: float) -> None:
    """Raise an `ImpossibleError` where an unstable film without pressure is wanted in a loop that has the stable one.

    A flat loop's only film is its plane: no film leaves the convex hull of its loop. A loop that is a convex curve seen
    along some direction has one film, a graph over that curve's inside (Rado, Acta Litt. Sci. Szeged 6 (1932), 1-20),
    and graphs are stable. As directions the vector area and the principal axes are tried.
    """
    if len(loops) > 1 or mean_curvature:
        return
    points = loops[0].at(samples_of(loops[0], CONDITION_SAMPLES))
    _, length, axes = np.linalg.svd(points - points.mean(0), full_matrices=False)
    if length[2] <= FLAT_HEIGHT * length[0]:
        raise ImpossibleError(
            "there is no unstable surface: the boundary is flat, and without pressure its only surface is the plane",
            "branch",
        )
    for axis in (vector_area(points), *axes):
        if is_convex_along(points, axis):
            x, y, z = np.round(axis / np.linalg.norm(axis), 3) + 0.0
            raise ImpossibleError(
                f"there is no unstable surface: seen along ({x:g}, {y:g}, {z:g}) the boundary is a convex curve, and "
                "without pressure the only surface in such a boundary is the stable one (Rado 1932)",
                "branch",
            )


def is_convex_along(points: Floats, axis: Floats) -> bool:
    """Whether a closed polygon (n, 3), seen along a direction, is a convex curve that runs around once."""
    length = float(np.linalg.norm(axis))
    step = np.roll(points, -1, 0) - points
    if length <= 1e-9 * float((step**2).sum()):
        return False
    axis = axis / length
    across = np.cross(axis, np.eye(3)[least_axis(axis)])
    across /= np.linalg.norm(across)
    seen = step @ across + 1j * (step @ np.cross(axis, across))
    # seen end on, a part of the curve would be one point
    if (np.abs(seen) < 1e-3 * np.linalg.norm(step, axis=1)).any():
        return False
    turns = np.angle(np.roll(seen, -1) / seen)
    turns = turns if turns.sum() > 0 else -turns
    return bool(turns.min() > -STRAIGHT_LOOP and abs(turns.sum() - 2 * np.pi) < 1e-6)


def refuse_flux(loops: Sequence[Curve], mean_curvature: float) -> None:
    """The bound |H| <= L / (2 |a|) of one loop of length L and vector area a.

    The tension along the rim carries the pressure: the integral of the conormal is 2 H a.
    """
    if len(loops) > 1 or not mean_curvature:
        return
    points = loops[0].at(np.arange(CONDITION_SAMPLES) / CONDITION_SAMPLES)
    enclosed = float(np.linalg.norm(vector_area(points)))
    length = loops[0].length
    limit = length / (2 * max(enclosed, 1e-300))
    if abs(mean_curvature) > limit * (1 + 1e-9):
        raise ImpossibleError(
            f"mean_curvature = {mean_curvature:.6g} 1/m: no surface in this boundary bends that much. Its length is "
            f"{length:.5g} m and its vector area {enclosed:.5g} m2, so that |H| <= length / (2 area) = {limit:.6g} 1/m",
            "mean_curvature",
            limit,
        )


def refuse_apart(loops: Sequence[Curve]) -> None:
    """Two loops too far apart for one film: coaxial circles exactly, others by the cone of Hildebrandt.

    Loops in the two nappes of a cone of half opening arctan 1.5089 bound no connected minimal surface: docs/theory.md
    has the proof.
    """
    first, second = (loop.at(np.arange(CONDITION_SAMPLES) / CONDITION_SAMPLES) for loop in loops)
    middles = [points.mean(0) for points in (first, second)]
    apart = middles[1] - middles[0]
    distance = float(np.linalg.norm(apart))
    size = max(diagonal(points) for points in (first, second))
    if distance < 0.05 * size:
        return
    axis = apart / distance
    reach = [_reach(points, middles[0], axis) for points in (first, second)]
    (low0, high0, least0, most0), (low1, high1, least1, most1) = reach
    flat = max(high0 - low0, high1 - low1) < 1e-6 * size
    if flat and most0 - least0 < 1e-6 * size and most1 - least1 < 1e-6 * size:
        limit = _catenary_limit(most0, most1)
        if distance > limit:
            same = abs(most0 - most1) < 1e-6 * size
            reported = (
                f"{distance / most0:.6g} radii; a film between two equal rings exists up to a distance of "
                f"{RING_DISTANCE:.7f} radii ({limit:.6g} m)"
                if same
                else f"a film between rings of radius {most0:.5g} and {most1:.5g} m exists up to {limit:.6g} m"
            )
            raise ImpossibleError(
                f"the two rings are {distance:.6g} m apart, which is {reported}"
                if same
                else f"the two rings are {distance:.6g} m apart; {reported}",
                "loops",
                limit,
            )
        return
    # apex between the loops, on the line through their middles
    share = np.linspace(0, 1, 201)[1:-1] * distance
    for apex in share:
        ratios = []
        for points in (first, second):
            off = points - middles[0] - apex * axis
            height = off @ axis
            across = np.linalg.norm(off - height[:, None] * axis, axis=1)
            sign = -1 if points is first else 1
            ratios.append((across / np.maximum(sign * height, 1e-12)).max())
        if max(ratios) < CONE:
            raise ImpossibleError(
                f"the two loops are too far apart ({distance:.5g} m between their middles) for one film: seen from a "
                f"point between them both lie in a double cone of half opening "
                f"{np.degrees(np.arctan(max(ratios))):.3g} deg (limit {np.degrees(np.arctan(CONE)):.4g} deg)",
                "loops",
            )


def _reach(points: np.ndarray, origin: np.ndarray, axis: np.ndarray) -> tuple[float, float, float, float]:
    """Least and most height along an axis and distance from it."""
    off = points - origin
    height = off @ axis
    across = np.linalg.norm(off - height[:, None] * axis, axis=1)
    return float(height.min()), float(height.max()), float(across.min()), float(across.max())


def _catenary_limit(first: float, second: float) -> float:
    """Largest distance of coaxial rings between which a catenoid spans, m."""
    small, large = sorted((first, second))

    def shorter(neck: float) -> float:
        return float(-neck * (np.arccosh(large / neck) + np.arccosh(max(small / neck, 1.0))))

    return -float(
        minimize_scalar(shorter, bounds=(1e-9 * small, small), method="bounded", options={"xatol": 1e-13 * small}).fun
    )
