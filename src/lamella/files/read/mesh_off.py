"""Object File Format .off, as text (Geomview, CGAL, libigl)."""

from __future__ import annotations

import re

import numpy as np

from lamella.base.arrays import Integers
from lamella.files.read.file_mesh import Polygons, mesh_error

AGAIN = "is the file cut off or damaged? Export it again"


def read_off(data: bytes) -> Polygons:
    """Read vertices and faces; normals, texture coordinates and colours are passed over.

    The first word is OFF, with letters before it for what vertices have besides coordinates (ST, C, N); it may be
    missing. Then come the numbers of vertices, faces and edges, the vertices one a line, and the faces, each with its
    number of corners first.
    """
    lines = [line.partition(b"#")[0].split() for line in data.splitlines()]
    lines = [words for words in lines if words]
    word = lines[0][0] if lines else b""
    if re.fullmatch(rb"(ST)?C?N?(4?)(n?)OFF", word):
        if b"4" in word or b"n" in word:
            raise mesh_error(
                f"the .off holds points of another dimension than three ({word.decode()})", "export x, y, z"
            )
        if lines[0][1:2] == [b"BINARY"]:
            raise mesh_error("the .off is binary", "export it as text")
        lines[0] = lines[0][1:]
        lines = lines if lines[0] else lines[1:]
    elif not word.isdigit():
        raise mesh_error("the file does not begin like an .off: its first word is OFF", AGAIN)
    try:
        vertices, faces = (int(number) for number in lines[0][:2])
    except (IndexError, ValueError):
        raise mesh_error("the .off does not say how many vertices and faces it has", AGAIN) from None
    if not (0 <= vertices < len(lines) and 0 <= faces < len(lines) and 1 + vertices + faces <= len(lines)):
        raise mesh_error(
            f"the .off announces {vertices} vertices and {faces} faces, and has {len(lines) - 1} lines of them", AGAIN
        )
    try:
        points = np.array([words[:3] for words in lines[1 : 1 + vertices]], dtype=np.float64).reshape(vertices, 3)
        rows = [
            [int(word) for word in words[: 1 + max(int(words[0]), 0)]]
            for words in lines[1 + vertices : 1 + vertices + faces]
        ]
    except (ValueError, OverflowError):
        raise mesh_error("a line of the .off is not the numbers it should be", AGAIN) from None
    short = [number for number, row in enumerate(rows, 1) if row[0] < 3 or len(row) != 1 + row[0]]
    if short:
        raise mesh_error(f"face {short[0]} of the .off has fewer corners than it says, or fewer than 3", AGAIN)
    sizes: Integers = np.array([row[0] for row in rows], dtype=np.int64)
    try:
        corners = np.array([corner for row in rows for corner in row[1:]], dtype=np.int64)
    except OverflowError:
        raise mesh_error("a face of the .off names a vertex that is not there", AGAIN) from None
    return Polygons(points, sizes, corners)
