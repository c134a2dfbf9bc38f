"""Panels that are congruent within a tenth of a millimetre are cut alike.

Sides and diagonals are put into classes of lengths that differ by no more than that, and panels of equal sequences of
classes around are one kind, from whatever corner they are read. Lengths are rounded to a micrometre before: rounding
errors, which make copies differ on a symmetric net, decide nothing. Mirror images are two kinds, for a panel has a face
and a back.
"""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.hardware.classes import classes
from lamella.panels.polygons import Polygons

SAME_LENGTH = 1e-4
"""m; lengths of panels of one kind differ by no more."""


def kinds_of(points: Floats, polygons: Polygons, heights: Floats, made: Integers) -> Integers:
    """The kind of each polygon, numbered in the order of their first ones, (p,).

    Parameters
    ----------
    points : (e, 2)
        Corners of the flat outlines, m.
    polygons : Polygons
    heights : (e,)
        Of the corners over the plane, m: 0 where it is cut flat.
    made : (p,) int
        How each is made; panels made differently are of different kinds.
    """
    following = polygons.following()
    sides = np.linalg.norm(points[following] - points, axis=1)
    diagonals = np.linalg.norm(points[following[following]] - points, axis=1)
    row = np.column_stack([_classes(sides), _classes(diagonals), _classes(heights), made[polygons.owner]])
    kind, found = np.zeros(len(polygons), np.int64), 0
    for some, at in polygons.by_size():
        n = at.shape[1]
        turns = np.stack([row[np.roll(at, -k, axis=1)].reshape(len(some), -1) for k in range(n)])
        ranks = np.unique(turns.reshape(n * len(some), -1), axis=0, return_inverse=True)[1]
        least = ranks.reshape(n, len(some)).min(axis=0)
        kind[some] = found + np.unique(least, return_inverse=True)[1]
        found = int(kind[some].max()) + 1
    first = np.unique(kind, return_index=True)[1]
    number = np.empty(len(first), np.int64)
    number[np.argsort(first, kind="stable")] = np.arange(len(first))
    return number[kind]


def _classes(values: Floats) -> Integers:
    return classes(values, SAME_LENGTH)[0] if len(values) else np.zeros(0, np.int64)
