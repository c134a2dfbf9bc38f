"""What a mesh file holds, before and after its faces are split into triangles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lamella.errors import InputError

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

FILE_KEY = "surface.file"
"""Key of the project file that errors about a mesh are about."""

MAXIMUM_FACES = 2_000_000
"""Curvature needs a few thousand faces; beyond this reading takes minutes and gigabytes."""


@dataclass(frozen=True)
class Polygons:
    """Vertices and faces as they stand in a file.

    Attributes
    ----------
    points : (n, 3)
        In units of the file.
    sizes : (f,) int
        Corners of each face.
    corners : (sum of sizes,) int
        Vertex indices from 0, face after face.
    notes : tuple of str
        What the reader of the file left out or decided.
    metres_per_unit : float or None
        From the file's header; None if the format has no units.
    """

    points: Floats
    sizes: Integers
    corners: Integers
    notes: tuple[str, ...] = ()
    metres_per_unit: float | None = None


@dataclass(frozen=True)
class RawMesh:
    """Triangles read from a file, nothing mended yet.

    Attributes
    ----------
    points : (n, 3)
        m.
    faces : (m, 3) int
        Vertex indices, in the file's own orientation.
    source : str
        File name, format, numbers of vertices and faces, unit: for the summary.
    notes : tuple of str
        What the reader left out or decided.
    """

    points: Floats
    faces: Integers
    source: str = ""
    notes: tuple[str, ...] = ()


def mesh_error(message: str, remedy: str = "") -> InputError:
    """Return the error about the project's mesh file, to be raised."""
    return InputError(message, remedy, where=FILE_KEY)


def place(point: Floats) -> str:
    """A point (3,) in m, for messages."""
    x, y, z = (round(float(value), 4) + 0.0 for value in point)
    return f"({x:g}, {y:g}, {z:g})"
