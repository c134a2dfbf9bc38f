"""What a mesh file holds, before and after its faces are split into triangles."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.drawing_origin import NOWHERE, Origin, coordinates
from lamella.base.errors import InputError
from lamella.base.message import Message

FILE_KEY = "surface.file"
"""Key of the project file that errors about a mesh are about."""

MAXIMUM_FACES = 2_000_000
"""Curvature needs a few thousand faces; beyond this reading takes minutes and gigabytes."""


BLOCK = 1_000_000
"""Bytes of a text that are taken apart at a time."""


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
    notes : tuple of Message
        What the reader of the file left out or decided.
    metres_per_unit : float or None
        From the file's header; None if the format has no units.
    """

    points: Floats
    sizes: Integers
    corners: Integers
    notes: tuple[Message, ...] = ()
    metres_per_unit: float | None = None


@dataclass(frozen=True)
class RawMesh:
    """Triangles read from a file, nothing mended yet.

    Attributes
    ----------
    points : (n, 3)
        m, measured from `origin`.
    faces : (m, 3) int
        Vertex indices, in the file's own orientation.
    source : str
        File name, format, numbers of vertices and faces, unit: for the summary.
    notes : tuple of Message
        What the reader left out or decided.
    origin : tuple of float
        Point of the drawing, m.
    """

    points: Floats
    faces: Integers
    source: str = ""
    notes: tuple[Message, ...] = ()
    origin: Origin = NOWHERE


def mesh_error(message: str, remedy: str = "") -> InputError:
    """Return the error about the project's mesh file, to be raised."""
    return InputError(message, remedy, where=FILE_KEY)


def blocks(text: bytes, ends: bytes) -> Iterator[bytes]:
    """Pieces of a text of some `BLOCK` bytes, cut behind one of the bytes `ends`.

    Words of a text as objects take ten to fifty times its memory: a block of them at a time does not matter.

    Raises
    ------
    InputError
        No such byte within `BLOCK` bytes: it is no text of numbers.
    """
    start = 0
    while start < len(text):
        end = start + BLOCK
        if end < len(text):
            end = max(text.rfind(bytes([one]), start, end) for one in ends) + 1
            if end <= start:
                raise mesh_error(
                    f"the file has a line of more than {BLOCK / 1e6:g} million characters", "export the mesh again"
                )
        yield text[start:end]
        start = end


def place(point: Floats) -> str:
    """A point (3,) in m, for messages."""
    return f"({coordinates(np.round(point, 4) + 0.0, 6)})"
