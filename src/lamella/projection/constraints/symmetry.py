"""Pairs of vertices that are images of one another: mirrored, or turned about an axis."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.projection.constraint import Constraint
from lamella.projection.unknowns import Slot


@dataclass(frozen=True, kw_only=True)
class Symmetry(Constraint):
    r"""A vertex is the image of another under a fixed motion or reflection.

    .. math:: (v_j - A v_i - b) / e = 0

    ========== ========= ===========
    variable   symbol    count
    ========== ========= ===========
    vertices   v_i, v_j  3 each
    equations            3 a pair
    ========== ========= ===========

    Attributes
    ----------
    pairs : (m, 2) int
        i and j. Around an axis, pairs (k, k + 1) of the first and each next sector are enough.
    matrix : (3, 3)
        A, orthogonal.
    shift : (3,)
        b, m.
    edge : float
        e, m.
    block : str
        Of the vertices.
    """

    linear: ClassVar[bool] = True

    pairs: Integers
    matrix: Floats
    shift: Floats
    edge: float
    block: str = "vertices"

    def slots(self) -> tuple[Slot, ...]:
        return Slot(self.block, self.pairs[:, 0]), Slot(self.block, self.pairs[:, 1])

    def residual(self, *arguments: Floats) -> Floats:
        original, image = arguments
        return (image - original @ self.matrix.T - self.shift) / self.edge

    def jacobian(self, *arguments: Floats) -> tuple[Floats, ...]:
        shape = (len(self.pairs), 3, 3)
        return np.broadcast_to(-self.matrix / self.edge, shape), np.broadcast_to(np.eye(3) / self.edge, shape)


def mirrored(name: str, pairs: Integers, normal: Floats, distance: float, edge: float) -> Symmetry:
    """Pairs mirrored in the plane m . x = d, m a unit vector."""
    return Symmetry(
        name=name,
        pairs=pairs,
        matrix=np.eye(3) - 2 * np.outer(normal, normal),
        shift=2 * distance * np.asarray(normal, np.float64),
        edge=edge,
    )


def turned(name: str, pairs: Integers, point: Floats, axis: Floats, parts: int, edge: float) -> Symmetry:
    """Pairs turned by a full turn over `parts` about the axis through a point, right-handed."""
    a = np.asarray(axis, np.float64)
    a = a / np.linalg.norm(a)
    angle = 2 * np.pi / parts
    cross = np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])
    matrix = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return Symmetry(name=name, pairs=pairs, matrix=matrix, shift=point - matrix @ point, edge=edge)
