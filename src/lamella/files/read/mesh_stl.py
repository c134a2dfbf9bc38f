"""Stereolithography .stl, text and binary."""

from __future__ import annotations

import re

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.files.read.file_mesh import MAXIMUM_FACES, Polygons, blocks, mesh_error

HEADER = 84
"""Bytes before the first facet of a binary file: 80 of comment, 4 of count."""

FACET = np.dtype([("normal", "<f4", (3,)), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
VERTEX = re.compile(rb"^[ \t]*vertex[ \t]+(\S+)[ \t]+(\S+)[ \t]+(\S+)[ \t]*$", re.MULTILINE | re.IGNORECASE)
BEGIN = re.compile(rb"^[ \t]*facet\b", re.MULTILINE | re.IGNORECASE)
END = re.compile(rb"^[ \t]*endfacet\b", re.MULTILINE | re.IGNORECASE)


def read_stl(data: bytes) -> Polygons:
    """Read facets; every one has three vertices of its own, and the normals written beside them are passed over.

    The word "solid" in front does not tell text from binary, because many binary files begin with it: the length does.
    """
    binary = len(data) >= HEADER and len(data) == HEADER + FACET.itemsize * int.from_bytes(data[80:84], "little")
    text = data.lstrip()[:5].lower() == b"solid" and (b"facet" in data[:4096].lower() or b"endsolid" in data.lower())
    corners = _binary_corners(data) if binary or not text else _text_corners(data)
    count = len(corners) // 3
    return Polygons(corners, np.full(count, 3, dtype=np.int64), np.arange(3 * count, dtype=np.int64))


def _binary_corners(data: bytes) -> Floats:
    again = "is the file cut off, or not an .stl? Export it again"
    if len(data) < HEADER:
        raise mesh_error(f"the .stl has {len(data)} bytes; the header alone has {HEADER}", again)
    count = int.from_bytes(data[80:84], "little")
    expected = HEADER + FACET.itemsize * count
    if len(data) != expected:
        raise mesh_error(f"the .stl says {count} facets, which take {expected} bytes, but has {len(data)} bytes", again)
    if count > MAXIMUM_FACES:
        raise mesh_error(f"the .stl has {count} facets; at most {MAXIMUM_FACES} are read", "reduce the mesh")
    # bytes that are no numbers are found out later, with the place
    with np.errstate(invalid="ignore"):
        return np.frombuffer(data, FACET, count, HEADER)["corners"].reshape(-1, 3).astype(np.float64)


def _text_corners(data: bytes) -> Floats:
    text = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    begun, ended = len(BEGIN.findall(text)), len(END.findall(text))
    last = re.match(rb"endsolid\b", text.rstrip().rpartition(b"\n")[2].lstrip(), re.IGNORECASE)
    if not last or begun != ended:
        raise mesh_error(
            f"the .stl breaks off: {begun} facets begun, {ended} ended, {'an' if last else 'no'} endsolid at the end",
            "export the file again",
        )
    if ended > MAXIMUM_FACES:
        raise mesh_error(f"the .stl has {ended} facets; at most {MAXIMUM_FACES} are read", "reduce the mesh")
    try:
        parts = [_vertices(block) for block in blocks(text, b"\n")]
    except ValueError as bad:
        if isinstance(bad, InputError):
            raise
        raise mesh_error(f"the .stl has a vertex that is not three numbers ({bad})", "export the file again") from None
    corners = np.concatenate([np.zeros((0, 3)), *parts])
    if len(corners) != 3 * ended:
        raise mesh_error(f"the .stl has {ended} facets but {len(corners)} vertices, not three each", "export it again")
    return corners


def _vertices(block: bytes) -> Floats:
    flat = [float(word) for vertex in VERTEX.findall(block) for word in vertex]
    return np.array(flat, dtype=np.float64).reshape(-1, 3)
