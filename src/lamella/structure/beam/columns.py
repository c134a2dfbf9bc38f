"""Vectors (3, m) and matrices (3, 3, m) of m elements, the element last.

So a sum of products is a sum of long rows, whatever small the matrices are; with the element first numpy takes several
times as long.
"""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats


def dot(one: Floats, other: Floats) -> Floats:
    """Products of vectors (3, m), (m,)."""
    return np.asarray(one[0] * other[0] + one[1] * other[1] + one[2] * other[2])


def cross(one: Floats, other: Floats) -> Floats:
    """Vector products of (3, m)."""
    result = np.empty_like(one)
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        np.multiply(one[j], other[k], out=result[i])
        result[i] -= one[k] * other[j]
    return result


def outer(one: Floats, other: Floats) -> Floats:
    """Matrices (3, 3, m) of vectors (3, m)."""
    return np.asarray(one[:, None] * other[None])


def product(one: Floats, other: Floats) -> Floats:
    """Products of matrices (i, j, m) and (j, k, m), or of matrices and vectors (j, m)."""
    return np.asarray(np.einsum("ijm,j...m->i...m", one, other))


def turned_product(one: Floats, other: Floats) -> Floats:
    """Products of transposed matrices (j, i, m) with matrices (j, k, m) or vectors (j, m)."""
    return np.asarray(np.einsum("jim,j...m->i...m", one, other))


def transposed(matrices: Floats) -> Floats:
    """Of (i, j, m)."""
    return np.swapaxes(matrices, 0, 1)


def symmetric(matrices: Floats) -> Floats:
    """Symmetric part of (i, i, m)."""
    return np.asarray(0.5 * (matrices + transposed(matrices)))


def crossing(vectors: Floats) -> Floats:
    """Matrices (3, 3, m) whose products with w are the vector products of (3, m) with w."""
    result = np.zeros((3, *vectors.shape))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        result[j, i] = vectors[k]
        np.negative(vectors[k], out=result[i, j])
    return result


def add_unit(matrices: Floats, factor: Floats) -> None:
    """Add a multiple (m,) of the unit matrix to (3, 3, m)."""
    for i in range(3):
        matrices[i, i] += factor


def element_last(rows: Floats) -> Floats:
    """Of an array with the element first, contiguous."""
    return np.ascontiguousarray(np.moveaxis(rows, 0, -1))
