"""Conjugate gradients, for well conditioned problems that need no factorisation."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from lamella.base.arrays import Floats


def conjugate_gradients(
    image_of: Callable[[Floats], Floats],
    conditioned: Callable[[Floats], Floats],
    right: Floats,
    start: Floats,
    goal: Floats,
    most_steps: int = 500,
) -> Floats:
    """Solution (n, c) of a symmetric positive definite problem with c right sides (n, c).

    Parameters
    ----------
    image_of, conditioned : callable
        The matrix, and what is next to its inverse, times a table (n, c).
    right, start : (n, c)
    goal : (c,)
        Of the residual times the conditioned residual.
    most_steps : int
    """
    solution = start.copy()
    residual = right - image_of(solution)
    direction = conditioned(residual)
    product = _dots(residual, direction)
    for _ in range(most_steps):
        if (product <= goal).all():
            break
        image = image_of(direction)
        step = product / np.maximum(_dots(direction, image), 1e-300)
        solution += step * direction
        residual -= step * image
        near = conditioned(residual)
        product, before = _dots(residual, near), product
        direction *= product / np.maximum(before, 1e-300)
        direction += near
    return np.asarray(solution)


def _dots(one: Floats, other: Floats) -> Floats:
    """Products of the columns of two tables (n, c), (c,)."""
    return np.asarray(np.einsum("nc,nc->c", one, other))
