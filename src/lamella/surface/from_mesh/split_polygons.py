"""Quads and polygons split into triangles."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.errors import InputError
from lamella.base.ties import MARGIN
from lamella.surface.from_mesh.covering import covered_faces, second_diagonals

MAXIMUM_CORNERS = 256
"""A face with more corners says nothing about the surface inside it."""

EQUALLY_FLAT = np.radians(1.0)
"""Two diagonals that fold a quad alike to this are told apart by their lengths."""


def split_faces(points: Floats, sizes: Integers, corners: Integers) -> tuple[Integers, int]:
    """Triangles of faces that cover a surface once, and the number of those left out because they lie on others.

    Parameters
    ----------
    points, sizes, corners
        See `split_polygons`.
    """
    covered = covered_faces(points, sizes, corners)
    faces = split_polygons(points, sizes[~covered], corners[np.repeat(~covered, sizes)])
    twice = second_diagonals(np.unique(points, axis=0, return_inverse=True)[1].reshape(-1)[faces])
    return faces[~twice], int(covered.sum() + twice.sum())


def split_polygons(points: Floats, sizes: Integers, corners: Integers) -> Integers:
    """Split faces into triangles that keep their orientation.

    A quad is split along the diagonal that folds it less; along the shorter one when both fold it alike, and through
    its first corner when they are as long as each other. The flatter one is also the one inside, should the quad have a
    notch. Larger faces lose their best ear one after the other: the ear with the shortest cut among those that hold no
    other corner.

    Parameters
    ----------
    points : (n, 3)
        m.
    sizes : (f,) int
        Corners of each face, at least 3.
    corners : (sum of sizes,) int
        Vertex indices, face after face.

    Returns
    -------
    (m, 3) int
        Triangles, in the order of the faces.
    """
    largest = int(sizes.max(initial=3))
    if largest > MAXIMUM_CORNERS:
        raise InputError(
            f"a face has {largest} corners (at most {MAXIMUM_CORNERS} are read): a mesh says nothing of the surface "
            "inside such a face",
            "mesh the surface with triangles or quads of about one size",
            "faces",
        )
    first_corner = np.concatenate(([0], np.cumsum(sizes)))[:-1]
    first_triangle = np.concatenate(([0], np.cumsum(sizes - 2)))
    triangles = np.empty((int(first_triangle[-1]), 3), dtype=np.int64)
    for size in np.unique(sizes).tolist():
        members = np.flatnonzero(sizes == size)
        loops = corners[first_corner[members, None] + np.arange(size)]
        split = _split_quads if size == 4 else _cut_ears
        rows = first_triangle[members, None] + np.arange(size - 2)
        triangles[rows.ravel()] = split(points, loops).reshape(-1, 3)
    return triangles


def _split_quads(points: Floats, quads: Integers) -> Integers:
    """Two triangles of each quad, (q, 2, 3)."""
    a, b, c, d = (points[quads[:, k]] for k in range(4))
    fold_ac, fold_bd = _fold(a, b, c, d), _fold(b, c, d, a)
    shorter_bd = np.linalg.norm(d - b, axis=1) < (1 - MARGIN) * np.linalg.norm(c - a, axis=1)
    along_bd = np.where(np.abs(fold_ac - fold_bd) <= EQUALLY_FLAT, shorter_bd, fold_bd < fold_ac)
    return np.where(along_bd[:, None, None], quads[:, [[1, 2, 3], [1, 3, 0]]], quads[:, [[0, 1, 2], [0, 2, 3]]])


def _fold(a: Floats, b: Floats, c: Floats, d: Floats) -> Floats:
    """Angle between the triangles abc and acd, (q,); pi if one of them has no area."""
    one, two = np.cross(b - a, c - a), np.cross(c - a, d - a)
    sizes = np.linalg.norm(one, axis=1), np.linalg.norm(two, axis=1)
    sine = np.linalg.norm(np.cross(one, two), axis=1)
    # Collinear corners: the other diagonal gives two triangles with an area.
    no_area = np.minimum(*sizes) <= 1e-12 * np.maximum(*sizes)
    return np.where(no_area, np.pi, np.arctan2(sine, np.einsum("ij,ij->i", one, two)))


def _cut_ears(points: Floats, loops: Integers) -> Integers:
    """Triangles of polygons of one size, (p, size - 2, 3): all of them lose one ear at a time."""
    triangles = np.empty((len(loops), loops.shape[1] - 2, 3), dtype=np.int64)
    # Memory: each step compares every corner with every ear.
    block = max(1, 2_000_000 // loops.shape[1] ** 2)
    for begin in range(0, len(loops), block):
        part = slice(begin, begin + block)
        triangles[part] = _cut_ears_of(points, loops[part])
    return triangles


def _cut_ears_of(points: Floats, loops: Integers) -> Integers:
    found = []
    at = points[loops]
    normal = np.cross(at, np.roll(at, -1, axis=1)).sum(axis=1)
    while loops.shape[1] > 3:
        size = loops.shape[1]
        at = points[loops]
        before, after = np.roll(at, 1, axis=1), np.roll(at, -1, axis=1)
        area = np.einsum("pij,pj->pi", np.cross(at - before, after - at), normal)
        cut = np.linalg.norm(after - before, axis=2)
        blocked = _holds_another(at, before, after, normal)
        worst = cut.max(axis=1, keepdims=True) + 1
        # Convex empty ears first, then convex ones (crossing outlines), then any, so that every polygon is used up.
        rank = cut + worst * (2 * (area <= 0) + blocked)
        # the first of cuts as short as each other
        ear = np.rint(rank / (MARGIN * worst)).argmin(axis=1)
        rows = np.arange(len(loops))
        found.append(np.stack((loops[rows, ear - 1], loops[rows, ear], loops[rows, (ear + 1) % size]), axis=1))
        keep = np.arange(size)[None, :] != ear[:, None]
        loops = loops[keep].reshape(len(loops), size - 1)
    found.append(loops)
    return np.stack(found, axis=1)


def _holds_another(
    at: Floats, before: Floats, after: Floats, normal: Floats
) -> np.ndarray[tuple[int, int], np.dtype[np.bool_]]:
    """Whether the ear at each corner holds another corner of its polygon, (p, size)."""
    size = at.shape[1]
    inside = np.ones((len(at), size, size), dtype=bool)
    for start, end in ((before, at), (at, after), (after, before)):
        offset = at[:, None, :, :] - start[:, :, None, :]
        side = np.einsum("pijk,pk->pij", np.cross((end - start)[:, :, None, :], offset), normal)
        inside &= side >= 0
    own = np.arange(size)
    for shift in (-1, 0, 1):
        inside[:, own, (own + shift) % size] = False
    return np.asarray(inside.any(axis=2))
