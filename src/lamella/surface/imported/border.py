"""Border loops of a mesh as points of smooth curves with corners."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lamella.surface.imported.clean import CleanMesh
from lamella.surface.imported.edges import vertex_normals
from lamella.surface.imported.noise import smooth_scatter
from lamella.surface.imported.raw_mesh import Floats
from lamella.surface.imported.zigzag import is_zigzag, smooth_zigzag
from lamella.wording import loop_names

CORNER_ANGLE = 40.0
"""Degrees."""

ALWAYS_CORNER = 59.0
"""Degrees; a smooth loop with such turns would have six vertices or fewer, too few to be meant as a smooth one."""

SHARPER = 2.0
"""A corner turns more than this times what the curvature beside it suggests."""

TOO_CLOSE = 0.2
"""Border vertices nearer than this part of the median border edge say more about the mesher than about the curve."""


@dataclass(frozen=True)
class BorderCurve:
    """Points of one closed border; a smooth curve is meant between corners, through the points.

    Attributes
    ----------
    points : (k, 3)
        m, not repeated at the end, surface to the left.
    corner : (k,) bool
        Where the curve has a corner.
    notes : tuple of str
        What was thinned or smoothed.
    """

    points: Floats
    corner: NDArray[np.bool_]
    notes: tuple[str, ...] = ()


def border_curves(
    mesh: CleanMesh, corner_angle: float = CORNER_ANGLE, most: int | None = None
) -> tuple[BorderCurve, ...]:
    """Curves of all border loops of a mesh, in their order.

    Parameters
    ----------
    mesh : CleanMesh
    corner_angle : float
        Degrees; see `border_curve`.
    most : int, optional
        Loops of more vertices are thinned to about as many.
    """
    normals = vertex_normals(mesh.points, mesh.faces)
    curves = []
    for name, loop in zip(loop_names(len(mesh.borders)), mesh.borders, strict=True):
        points = mesh.points[loop]
        spacing = float(_steps(points).sum()) / most if most and len(loop) > most else None
        curve = border_curve(points, normals[loop], corner_angle, spacing)
        curves.append(BorderCurve(curve.points, curve.corner, tuple(f"the {name}: {note}" for note in curve.notes)))
    return tuple(curves)


def border_curve(
    points: Floats, normals: Floats, corner_angle: float = CORNER_ANGLE, spacing: float | None = None
) -> BorderCurve:
    """Points and corners of the curve a closed polyline means.

    Parameters
    ----------
    points : (k, 3)
        Vertices of the loop, m.
    normals : (k, 3)
        Unit surface normals at them; they tell left turns from right ones.
    corner_angle : float
        Degrees. A corner turns by more than this and by more than twice what the curvature on both sides of it
        suggests, so that a coarse circle has none; turns of 60 degrees and more are corners if `corner_angle` allows.
    spacing : float, optional
        m. Vertices are thinned until neighbours are at least this far apart; by default only those nearer than 0.2
        median edges go. Corners stay.
    """
    notes = []
    if is_zigzag(points, normals):
        points, move = smooth_zigzag(points)
        notes.append(
            f"its edges turn to and fro; a smooth curve was laid through them, which moves vertices by up to "
            f"{1000 * move:.3g} mm"
        )
    before = len(points)
    limit = TOO_CLOSE * float(np.median(_steps(points)))
    short = _steps(points) < limit
    # Angles at very short edges mean nothing: there the vertex that bends the curve more stays, corner or not.
    clear = ~(short | np.roll(short, 1))
    points = _thinned(points, find_corners(points, corner_angle) & clear, limit)
    corner = find_corners(points, corner_angle)
    if spacing is not None and spacing > limit:
        limit = spacing
        kept = _thinned(np.column_stack((points, corner)), corner, limit)
        points, corner = kept[:, :3], kept[:, 3] > 0
    if len(points) < before:
        notes.append(f"{before - len(points)} of {before} vertices left out, closer than {1000 * limit:.3g} mm")
    points, scatter, move = smooth_scatter(points, corner)
    if scatter:
        notes.append(
            f"its vertices scatter by {1000 * scatter:.2g} mm about a smooth curve; that was taken, which moves "
            f"vertices by up to {1000 * move:.2g} mm"
        )
    return BorderCurve(points, corner, tuple(notes))


def _steps(points: Floats) -> Floats:
    """Length of the edge after each point of a closed polyline, m."""
    return np.asarray(np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1))


def turning_angles(points: Floats) -> Floats:
    """Angle between the edges before and after each point of a closed polyline, radians, 0 to pi, (k,)."""
    after = np.roll(points, -1, axis=0) - points
    before = np.roll(after, 1, axis=0)
    sine = np.linalg.norm(np.cross(before, after), axis=1)
    return np.asarray(np.arctan2(sine, np.einsum("ij,ij->i", before, after)))


def find_corners(points: Floats, corner_angle: float = CORNER_ANGLE) -> NDArray[np.bool_]:
    """Corners of a closed polyline (k, 3): see `border_curve`; bool (k,)."""
    angle = turning_angles(points)
    step = _steps(points)
    reach = (step + np.roll(step, 1)) / 2
    curvature = angle / reach
    limit = np.radians(corner_angle)
    corner = angle > max(limit, np.radians(ALWAYS_CORNER))
    # A corner says nothing about the curvature beside it: its neighbours are judged by their other sides.
    for _ in range(len(points)):
        sides = [np.roll(curvature, shift) for shift in (1, -1)]
        unknown = [np.roll(corner, shift) for shift in (1, -1)]
        known = np.sum(~np.array(unknown), axis=0)
        suggested = np.sum(np.where(unknown, 0.0, sides), axis=0) / np.maximum(known, 1) * reach
        found = corner | ((angle > limit) & (angle > SHARPER * suggested))
        if (found == corner).all():
            break
        corner = found
    return np.asarray(corner)


def _thinned(rows: Floats, fixed: NDArray[np.bool_], limit: float) -> Floats:
    """Drop vertices until none is nearer than `limit` to the next: of two, the one that bends the curve less.

    Parameters
    ----------
    rows : (k, 3 or more)
        Points, and what goes with them.
    fixed : (k,) bool
        Vertices that stay.
    limit : float
        m.
    """
    while len(rows) > 4:
        points = rows[:, :3]
        step = _steps(points)
        nearest = np.minimum(step, np.roll(step, 1))
        chord = np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0)
        length = np.maximum(np.linalg.norm(chord, axis=1), np.finfo(float).tiny)
        offset = np.linalg.norm(np.cross(points - np.roll(points, 1, axis=0), chord), axis=1) / length
        # Shortest edge first; the offset decides between its two ends.
        rank = np.where((nearest < limit) & ~fixed, nearest + 1e-3 * np.minimum(offset, limit), np.inf)
        # One of each neighbourhood at a time, so that no stretch vanishes whole.
        lowest = np.minimum(np.roll(rank, 1), np.roll(rank, -1))
        goes = np.isfinite(rank) & ((rank < lowest) | ((rank == lowest) & _first_of_ties(rank)))
        if not goes.any() or len(rows) - np.count_nonzero(goes) < 4:
            break
        rows, fixed = rows[~goes], fixed[~goes]
    return rows


def _first_of_ties(rank: Floats) -> NDArray[np.bool_]:
    """Every other one of a run of equal ranks, so that neighbours do not wait for one another."""
    same = rank == np.roll(rank, 1)
    same[0] = False
    begin = np.flatnonzero(~same)
    position = np.arange(len(rank)) - np.repeat(begin, np.diff(begin, append=len(rank)))
    even = position % 2 == 0
    # Around the end of the loop the first one wins.
    even[-1] &= rank[-1] != rank[0]
    return np.asarray(even)
