"""Products of rows of vectors in space: numpy's own take several times as long where a row has three numbers.

Symmetric matrices are rows of six entries: xx, xy, xz, yy, yz, zz.
"""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats


def dots(one: Floats, other: Floats) -> Floats:
    """Products of the rows of (..., 3), (...)."""
    product = one[..., 0] * other[..., 0]
    product += one[..., 1] * other[..., 1]
    product += one[..., 2] * other[..., 2]
    return np.asarray(product)


def lengths(vectors: Floats) -> Floats:
    """Lengths of the rows of (..., 3), (...)."""
    return np.asarray(np.sqrt(dots(vectors, vectors)))


def diagonal(points: Floats) -> float:
    """Length of the diagonal of the box around points (n, 3)."""
    return float(np.linalg.norm(np.ptp(np.ascontiguousarray(points.T), axis=1)))


def crosses(one: Floats, other: Floats) -> Floats:
    """Vector products of the rows of (..., 3)."""
    result = np.empty(np.broadcast_shapes(one.shape, other.shape))
    for c in range(3):
        a, b = (c + 1) % 3, (c + 2) % 3
        np.multiply(one[..., a], other[..., b], out=result[..., c])
        result[..., c] -= one[..., b] * other[..., a]
    return result


def images(entries: Floats, vectors: Floats) -> Floats:
    """Products of symmetric matrices (..., 6) with rows (..., 3)."""
    result = np.empty((*np.broadcast_shapes(entries.shape[:-1], vectors.shape[:-1]), 3))
    for c, (a, b, d) in enumerate(((0, 1, 2), (1, 3, 4), (2, 4, 5))):
        np.multiply(entries[..., a], vectors[..., 0], out=result[..., c])
        result[..., c] += entries[..., b] * vectors[..., 1]
        result[..., c] += entries[..., d] * vectors[..., 2]
    return result


def symmetric(one: Floats, other: Floats, both_one: Floats, mixed: Floats, both_other: Floats) -> Floats:
    """Symmetric matrices (n, 6) from their entries (n,) in frames of two unit vectors (n, 3)."""
    u, v = one.T, other.T
    left, right = both_one * u + mixed * v, mixed * u + both_other * v
    return np.stack([left[i] * u[j] + right[i] * v[j] for i in range(3) for j in range(i, 3)], 1)
