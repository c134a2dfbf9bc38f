"""Lists of points as people write them, checked before a curve is laid through them."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.vectors import diagonal
from lamella.base.wording import shown
from lamella.surface.boundary.curve import place

_SAME = 1e-6
"""Of the size of the list: points nearer than this are one, as two curves that near would touch."""


def clean_points(points: ArrayLike, *, closed: bool, where: str = "") -> Floats:
    """Points to lay a curve through.

    Parameters
    ----------
    points : (n, 3)
        m; of a closed curve the last one may repeat the first.
    closed : bool
    where : str, optional
        Key for messages.

    Returns
    -------
    (n, 3)
        Without that repetition.

    Raises
    ------
    InputError
        Not finite, too few, or the same point twice in a row.
    """
    given = np.asarray(points, float)
    if given.ndim != 2 or given.shape[1] != 3:
        raise InputError(f"the points are an array {given.shape}, not (n, 3)", "give x, y, z of each point", where)
    bad = np.flatnonzero(~np.isfinite(given).all(axis=1))
    if len(bad):
        raise InputError(
            f"point {bad[0]} is not finite: {shown(given[bad[0]].tolist())}", "give finite numbers in m", where
        )
    size = diagonal(given) if len(given) else 0.0
    if closed and len(given) > 1 and np.linalg.norm(given[-1] - given[0]) <= _SAME * size:
        given = given[:-1]
    following = np.roll(given, -1, axis=0) if closed else given[1:]
    steps = np.linalg.norm(following - given[: len(following)], axis=1)
    least = 3 if closed else 2
    if len(given) < least or len(np.unique(given, axis=0)) < least:
        count = len(np.unique(given, axis=0))
        kind = "a closed curve" if closed else "a part"
        raise InputError(
            f"{count} different {'point' if count == 1 else 'points'} (limit {least} for {kind})",
            "add points along the curve",
            where,
        )
    if steps.min() <= _SAME * size:
        k = int(np.argmax(steps <= _SAME * size))
        after = (k + 1) % len(given)
        raise InputError(
            f"points {k} and {after} (counted from 0) are the same point, {place(given[k])}",
            f"take out point {max(k, after)}",
            where,
        )
    return given
