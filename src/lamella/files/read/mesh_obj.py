"""Wavefront .obj."""

from __future__ import annotations

from collections import Counter
from itertools import chain

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.files.read.file_mesh import MAXIMUM_FACES, Polygons, blocks, mesh_error

FREE_FORM = (b"curv", b"surf", b"curv2", b"bzp", b"bsp", b"cstype")


def read_obj(data: bytes) -> Polygons:
    """Read vertices and faces; normals, texture coordinates, groups, materials, colours and weights are passed over.

    Faces may be given as ``v``, ``v/vt``, ``v//vn`` or ``v/vt/vn``, with negative numbers counting back from the
    last vertex, and go on in the next line after a backslash. All groups and objects together are one mesh.
    """
    text = data.removeprefix(b"\xef\xbb\xbf").replace(b"\r\n", b"\n").replace(b"\r", b"\n").replace(b"\\\n", b" ")
    counts: Counter[bytes] = Counter()
    points: list[Floats] = []
    faces: list[tuple[Integers, Integers]] = []
    for block in blocks(text, b"\n"):
        _read_block(block, counts, points, faces)
    if not faces:
        raise mesh_error(*_no_faces(counts))
    sizes, corners = (np.concatenate(parts) for parts in zip(*faces, strict=True))
    return Polygons(np.concatenate([np.zeros((0, 3)), *points]), sizes, corners)


def _read_block(
    block: bytes, counts: Counter[bytes], points: list[Floats], faces: list[tuple[Integers, Integers]]
) -> None:
    """Add the vertices of some lines, and sizes and corners of their faces, to those of the lines before."""
    if b"#" in block:
        block = b"\n".join(line.partition(b"#")[0] for line in block.split(b"\n"))
    lines = [words for line in block.split(b"\n") if (words := line.split())]
    keywords = [words[0] for words in lines]
    vertices = [words for words in lines if words[0] == b"v"]
    named = [words for words in lines if words[0] == b"f"]
    first = counts[b"v"]
    counts.update(keywords)
    if counts[b"f"] > MAXIMUM_FACES:
        raise mesh_error(
            f"the .obj has more than {MAXIMUM_FACES} faces; at most {MAXIMUM_FACES} are read",
            "reduce it: curvature needs a few thousand",
        )
    if vertices:
        points.append(_points(vertices, first))
    if not named:
        return
    before = first + np.cumsum([word == b"v" for word in keywords])[[word == b"f" for word in keywords]]
    sizes = np.array([len(words) - 1 for words in named], dtype=np.int64)
    if sizes.min() < 3:
        short = b" ".join(named[int(sizes.argmin())]).decode("latin-1")[:60]
        raise mesh_error(f"a face has fewer than 3 corners: {short!r}", "is the file cut off? Export it again")
    faces.append((sizes, _corners(named, sizes, before)))


def _no_faces(counts: Counter[bytes]) -> tuple[str, str]:
    if any(counts[word] for word in FREE_FORM):
        return "the .obj holds free-form curves or surfaces, no mesh", "export it as polygons (in Rhino: Mesh first)"
    if counts[b"l"] or counts[b"p"]:
        return (
            f"the .obj holds only lines and points ({counts[b'l']} l, {counts[b'p']} p, {counts[b'v']} v), no faces",
            "export a mesh; boundary curves belong in a project of kind 'form-found'",
        )
    return f"the .obj has no faces ({counts[b'v']} vertices)", "export a mesh with faces"


def _points(vertices: list[list[bytes]], first: int) -> Floats:
    """Coordinates (n, 3) of vertices from number `first` on; a weight or colours behind them are not read."""
    try:
        flat = list(map(float, chain.from_iterable([words[1:4] for words in vertices])))
    except ValueError:
        raise mesh_error(_bad_vertex(vertices, first), "is the file damaged? Export it again") from None
    if len(flat) != 3 * len(vertices):
        raise mesh_error(_bad_vertex(vertices, first), "is the file cut off? Export it again")
    return np.array(flat, dtype=np.float64).reshape(-1, 3)


def _bad_vertex(vertices: list[list[bytes]], first: int) -> str:
    for number, words in enumerate(vertices, first + 1):
        try:
            good = len(list(map(float, words[1:4]))) == 3
        except ValueError:
            good = False
        if not good:
            return f"vertex {number} is not three numbers: {b' '.join(words).decode('latin-1')[:60]!r}"
    return "a vertex is not three numbers"


def _corners(faces: list[list[bytes]], sizes: Integers, before: Integers) -> Integers:
    """Vertex indices from 0; `before` is the number of vertices above each face, from which negative ones count."""
    words = list(chain.from_iterable([words[1:] for words in faces]))
    try:
        flat = np.array([int(word.partition(b"/")[0]) for word in words], dtype=np.int64)
    except (ValueError, OverflowError):
        bad = next(word for word in words if not _is_index(word.partition(b"/")[0]))
        raise mesh_error(
            f"a face has the corner {bad.decode('latin-1')[:40]!r}, which is no vertex number",
            "is the file damaged? Export it again",
        ) from None
    if not flat.all():
        raise mesh_error("a face has vertex number 0; vertices of an .obj count from 1", "export the file again")
    return np.where(flat > 0, flat - 1, flat + np.repeat(before, sizes))


def _is_index(word: bytes) -> bool:
    try:
        return abs(int(word)) < 2**62
    except ValueError:
        return False
