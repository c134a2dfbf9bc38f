"""A mesh as it is given: points and triangles, nothing mended yet."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lamella.base.arrays import Floats, Integers
from lamella.base.drawing_origin import NOWHERE, Origin, coordinates
from lamella.base.errors import InputError
from lamella.base.limits import MOST_COORDINATE, MOST_LENGTH
from lamella.base.message import Message
from lamella.base.wording import counted
from lamella.surface.from_mesh.split_polygons import split_faces


@dataclass(frozen=True)
class RawMesh:
    """Triangles, nothing mended yet.

    Attributes
    ----------
    points : (n, 3)
        m, measured from `origin`.
    faces : (m, 3) int
        Vertex indices, in the orientation they were given with.
    source : str
        Where it is from, with numbers of vertices and faces, unit: for the summary.
    notes : tuple of Message
        What was left out or decided.
    origin : tuple of float
        Point of the drawing, m.
    """

    points: Floats
    faces: Integers
    source: str = "mesh"
    notes: tuple[Message, ...] = ()
    origin: Origin = NOWHERE


def mesh_of_arrays(points: ArrayLike, faces: ArrayLike) -> RawMesh:
    """The triangles of a mesh of triangles or of quads.

    Parameters
    ----------
    points : (n, 3)
        m.
    faces : (m, 3) or (m, 4) int
        Vertex indices from 0.

    Raises
    ------
    InputError
        No such arrays, points that are not finite or out of range, or faces of vertices that are not there.
    """
    at, given = np.asarray(points, float), np.asarray(faces)
    if at.ndim != 2 or at.shape[1] != 3:
        raise InputError(f"points are an array {at.shape}, not (n, 3)", "give x, y, z of each vertex", "points")
    if not np.isfinite(at).all():
        first = int(np.flatnonzero(~np.isfinite(at).all(axis=1))[0])
        raise InputError(f"points[{first}] is not finite: {at[first]}", "give finite numbers in m", "points")
    if np.abs(at).max(initial=0.0) > MOST_COORDINATE:
        first = int(np.flatnonzero((np.abs(at) > MOST_COORDINATE).any(axis=1))[0])
        raise InputError(
            f"points[{first}] is out of range: a coordinate is {np.abs(at[first]).max():.3g} m (limit "
            f"{MOST_COORDINATE:g})",
            "give lengths in m",
            "points",
        )
    if given.ndim != 2 or given.shape[1] not in (3, 4) or not len(given) or given.dtype.kind not in "iu":
        raise InputError(
            f"faces are an array {given.shape} of {given.dtype}, not of whole numbers (m, 3) or (m, 4)",
            "give the vertex indices of triangles or quads",
            "faces",
        )
    if given.min() < 0 or given.max() >= len(at):
        raise InputError(
            f"faces name vertices from {given.min()} to {given.max()}; there are {len(at):,}, from 0",
            "count vertices from 0",
            "faces",
        )
    size = float(np.ptp(at[given.ravel()], axis=0).max())
    if not size > 0:
        raise InputError("the mesh has no size: all its vertices are at one place", "give lengths in m", "points")
    if size > MOST_LENGTH:
        raise InputError(f"the mesh is {size:.3g} m large (limit {MOST_LENGTH:g})", "give lengths in m", "points")
    corners = given.astype(np.int64)
    triangles, left_out = split_faces(at, np.full(len(given), given.shape[1]), corners.ravel())
    notes = (Message("faces_covered", f"{counted(left_out, 'face')} that lie on others left out"),) if left_out else ()
    return RawMesh(at, triangles, f"mesh: {len(at)} vertices, {len(given)} faces", notes)


def mesh_error(message: str, remedy: str = "") -> InputError:
    """The error about the faces of a mesh, to be raised."""
    return InputError(message, remedy, "faces")


def place(point: Floats) -> str:
    """A point (3,) in m, for messages."""
    return f"({coordinates(np.round(point, 4) + 0.0, 6)})"
