"""What a mesh file holds, before its faces are split into triangles."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from lamella.base.arrays import Floats, Integers
from lamella.base.errors import InputError
from lamella.base.message import Message

FILE = "path"
"""Parameter that errors about a mesh file are about."""

MAXIMUM_FACES = 2_000_000
"""Curvature needs a few thousand faces; beyond this reading takes minutes and gigabytes."""


TEXT_BLOCK = 1_000_000
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


def mesh_error(message: str, remedy: str = "") -> InputError:
    """The error about a mesh file, to be raised."""
    return InputError(message, remedy, FILE)


def blocks(text: bytes, ends: bytes) -> Iterator[bytes]:
    """Pieces of a text of some `TEXT_BLOCK` bytes, cut behind one of the bytes `ends`.

    Words of a text as objects take ten to fifty times its memory: a block of them at a time does not matter.

    Raises
    ------
    InputError
        No such byte within `TEXT_BLOCK` bytes: it is no text of numbers.
    """
    start = 0
    while start < len(text):
        end = start + TEXT_BLOCK
        if end < len(text):
            end = max(text.rfind(bytes([one]), start, end) for one in ends) + 1
            if end <= start:
                raise mesh_error(
                    f"the file has a line of more than {TEXT_BLOCK / 1e6:g} million characters", "export the mesh again"
                )
        yield text[start:end]
        start = end
