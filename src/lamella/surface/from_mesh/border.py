"""Border loops of a mesh as points of smooth curves with corners."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Booleans, Floats
from lamella.base.message import Message
from lamella.base.wording import loop_names
from lamella.surface.boundary.corners import CORNER_TURN, edge_lengths, find_corners, thinned
from lamella.surface.boundary.scatter import smooth_scatter
from lamella.surface.from_mesh.border_zigzag import is_zigzag, smooth_zigzag
from lamella.surface.from_mesh.clean import CleanMesh
from lamella.surface.from_mesh.edges import vertex_normals

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
    notes : tuple of Message
        What was thinned or smoothed.
    """

    points: Floats
    corner: Booleans
    notes: tuple[Message, ...] = ()


def border_curves(
    mesh: CleanMesh, corner_angle: float = CORNER_TURN, most: int | None = None
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
        spacing = float(edge_lengths(points).sum()) / most if most and len(loop) > most else None
        curve = border_curve(points, normals[loop], corner_angle, spacing)
        curves.append(BorderCurve(curve.points, curve.corner, tuple(note.of(f"the {name}") for note in curve.notes)))
    return tuple(curves)


def border_curve(
    points: Floats, normals: Floats, corner_angle: float = CORNER_TURN, spacing: float | None = None
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
            Message(
                "border_zigzag",
                f"its edges turn to and fro; a smooth curve was laid through them, which moves vertices by up to "
                f"{1000 * move:.3g} mm",
            )
        )
    before = len(points)
    limit = TOO_CLOSE * float(np.median(edge_lengths(points)))
    short = edge_lengths(points) < limit
    # Angles at very short edges mean nothing: there the vertex that bends the curve more stays, corner or not.
    clear = ~(short | np.roll(short, 1))
    points = thinned(points, find_corners(points, corner_angle) & clear, limit)
    corner = find_corners(points, corner_angle)
    if spacing is not None and spacing > limit:
        limit = spacing
        kept = thinned(np.column_stack((points, corner)), corner, limit)
        points, corner = kept[:, :3], kept[:, 3] > 0
    if len(points) < before:
        notes.append(
            Message(
                "border_thinned",
                f"{before - len(points)} of {before} vertices left out, closer than {1000 * limit:.3g} mm",
            )
        )
    points, scatter, move = smooth_scatter(points, corner)
    if scatter:
        notes.append(
            Message(
                "border_scatter",
                f"its vertices scatter by {1000 * scatter:.2g} mm about a smooth curve; that was taken, which moves "
                f"vertices by up to {1000 * move:.2g} mm",
            )
        )
    return BorderCurve(points, corner, tuple(notes))
