"""Strips with their thickness as triangles, as `view/assets/strips.js` makes them in the browser."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.view.scene.layer import StripsLayer

CORNERS = np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])
"""Of a strip's section: shares of the thickness to the side, of the height upwards."""


def swept(layer: StripsLayer, kept: Integers) -> tuple[Floats, Integers, Integers]:
    """Vertices (v, 3), outward triangles (f, 3), and the sample of each vertex.

    Parameters
    ----------
    layer : StripsLayer
    kept : (k,) int
        Samples that are used, in order; the ends of every curve are among them.
    """
    points, normals = layer.positions, layer.normals
    sides = sideways(points, normals, layer.offsets)
    offsets = np.searchsorted(kept, layer.offsets)
    distances = np.broadcast_to(
        np.asarray(layer.sides, float).reshape(len(layer.sides), -1), (len(layer.sides), len(points))
    )
    beside = distances[:, kept, None] + CORNERS[:, 0] * layer.thickness
    up = layer.level + CORNERS[:, 1] * layer.height
    vertices = (
        points[kept][None, :, None]
        + beside[..., None] * sides[kept][None, :, None]
        + up[:, None] * normals[kept][None, :, None]
    )
    starts = np.setdiff1d(np.arange(len(kept)), offsets[1:] - 1)
    one = np.concatenate([_walls(starts), _ends(offsets)])
    step = 4 * len(kept)
    faces = (one[None] + step * np.arange(len(layer.sides))[:, None, None]).reshape(-1, 3)
    return vertices.reshape(-1, 3), faces, np.tile(np.repeat(kept, 4), len(layer.sides))


def sideways(points: Floats, normals: Floats, offsets: Integers) -> Floats:
    """Unit vectors normal x tangent at the samples of curves."""
    first = np.repeat(offsets[:-1], np.diff(offsets))
    last = np.repeat(offsets[1:] - 1, np.diff(offsets))
    here = np.arange(len(points))
    along = points[np.minimum(here + 1, last)] - points[np.maximum(here - 1, first)]
    across = np.cross(normals, along)
    length = np.linalg.norm(across, axis=1)
    return np.asarray(across / np.where(length > 0, length, 1.0)[:, None])


def _walls(starts: Integers) -> Integers:
    """Triangles between the sections at samples and at the next ones."""
    k = np.arange(4)
    a, n = 4 * starts[:, None] + k, 4 * starts[:, None] + (k + 1) % 4
    return np.concatenate([np.stack([a, n, a + 4], -1), np.stack([n, n + 4, a + 4], -1)]).reshape(-1, 3)


def _ends(offsets: Integers) -> Integers:
    long = np.diff(offsets) > 1
    a, b = 4 * offsets[:-1][long], 4 * (offsets[1:][long] - 1)
    return np.concatenate(
        [
            np.stack([a, a + 2, a + 1], 1),
            np.stack([a, a + 3, a + 2], 1),
            np.stack([b, b + 1, b + 2], 1),
            np.stack([b, b + 2, b + 3], 1),
        ]
    )
