"""Normals at vertices, as a start for stars."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.errors import InputError
from lamella.projection.quad_mesh import QuadMesh


def smoothed_normals(mesh: QuadMesh, rounds: int = 1) -> Floats:
    """Unit normals of all vertices, (n, 3), on the side from which faces are counter-clockwise.

    Normals of faces averaged over vertices and neighbours.

    Parameters
    ----------
    mesh : QuadMesh
    rounds : int
        How often neighbours are averaged.

    Raises
    ------
    InputError
        A vertex without a face, or faces that cancel out.
    """
    v = mesh.vertices[mesh.faces]
    across = np.cross(v[:, 2] - v[:, 0], v[:, 3] - v[:, 1])
    normals = _sum(mesh.faces.ravel(), np.repeat(across, 4, axis=0), len(mesh.vertices))
    a, b = mesh.edges.T
    for _ in range(rounds):
        normals = _unit(normals)
        normals = (
            (mesh.valence / 2)[:, None] * normals
            + _sum(a, normals[b], len(normals))
            + _sum(b, normals[a], len(normals))
        )
    return _unit(normals)


def _sum(index: Integers, vectors: Floats, count: int) -> Floats:
    return np.stack([np.bincount(index, vectors[:, c], count) for c in range(3)], 1)


def _unit(vectors: Floats) -> Floats:
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    none = np.flatnonzero(~(length[:, 0] > 0))
    if len(none):
        raise InputError(
            f"vertex {none[0]} has no normal: it is in no face, or its faces fold onto one another",
            "remove loose vertices and flattened faces",
        )
    return np.asarray(vectors / length)
