"""Conjugate gradients with the matrix's diagonal, for well conditioned problems that need no factorisation."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from lamella.surface.points import Floats


def conjugate_gradients(
    image_of: Callable[[Floats], Floats],
    right: Floats,
    diagonal: Floats,
    start: Floats,
    tolerance: float,
    most_steps: int = 500,
) -> Floats:
    """Solution (n, c) of a symmetric positive definite problem with c right sides (n, c).

    Parameters
    ----------
    image_of : callable
        The matrix times a table (n, c).
    right : (n, c)
    diagonal : (n,)
        Of the matrix.
    start : (n, c)
    tolerance : float
        Of the residual over the right side, both in the norm of the inverse diagonal.
    most_steps : int
    """
    solution, inverse_diagonal = start.copy(), 1 / diagonal[:, None]
    residual = right - image_of(solution)
    conditioned = inverse_diagonal * residual
    direction = conditioned.copy()
    product = _dots(residual, conditioned)
    goal = tolerance**2 * _dots(right, right * inverse_diagonal)
    for _ in range(most_steps):
        if (product <= goal).all():
            break
        image = image_of(direction)
        step = product / np.maximum(_dots(direction, image), 1e-300)
        solution += step * direction
        residual -= step * image
        np.multiply(residual, inverse_diagonal, out=conditioned)
        product, before = _dots(residual, conditioned), product
        direction *= product / np.maximum(before, 1e-300)
        direction += conditioned
    return np.asarray(solution)


def _dots(one: Floats, other: Floats) -> Floats:
    """Products of the columns of two tables (n, c), (c,)."""
    return np.asarray(np.einsum("nc,nc->c", one, other))
