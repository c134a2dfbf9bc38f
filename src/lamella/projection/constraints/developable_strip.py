"""Strips with one tangent plane along each ruling."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.projection.constraint import Constraint
from lamella.projection.unknowns import Slot


@dataclass(frozen=True, kw_only=True)
class DevelopableStrip(Constraint):
    r"""The tangents of both borders and the ruling between them lie in one plane. With `UnitLength`.

    .. math::

        n_k \cdot (b_k - a_k) / e = 0, \quad
        n_k \cdot (a_{k+1} - a_{k-1}) / (2 e) = 0, \quad n_k \cdot (b_{k+1} - b_{k-1}) / (2 e) = 0

    A ruled surface is developable exactly when its tangent plane is the same along each ruling (Tang et al. 2016).
    The borders' tangents are central differences, so the error is of second order in the spacing of rulings; quads of
    `PlanarFace` between neighbouring rulings are a developable surface of their own at any spacing.

    ============== ============= ============
    variable       symbol        count
    ============== ============= ============
    borders        a_k, b_k      3 each
    ruling normals n_k           3 a ruling
    equations                    3 a ruling
    ============== ============= ============

    Attributes
    ----------
    lower, upper : (r, 3) int
        Vertices k - 1, k, k + 1 of each border at ruling k; normal k belongs to ruling k.
    edge : float
        e, m, spacing of the rulings.
    vertices, normals : str
        Names of the blocks.
    """

    lower: Integers
    upper: Integers
    edge: float
    vertices: str = "vertices"
    normals: str = "ruling normals"

    def slots(self) -> tuple[Slot, ...]:
        borders = [*self.lower.T, *self.upper.T]
        return (Slot(self.normals, np.arange(len(self.lower))), *(Slot(self.vertices, v) for v in borders))

    def residual(self, *arguments: Floats) -> Floats:
        n, a0, a1, a2, b0, b1, b2 = arguments
        lines = np.stack([b1 - a1, (a2 - a0) / 2, (b2 - b0) / 2], 1)
        return np.asarray(np.einsum("mpc,mc->mp", lines, n)) / self.edge

    def jacobian(self, *arguments: Floats) -> tuple[Floats, ...]:
        n, a0, a1, a2, b0, b1, b2 = arguments
        lines = np.stack([b1 - a1, (a2 - a0) / 2, (b2 - b0) / 2], 1)
        share = {"a0": (0, -0.5, 0), "a1": (-1, 0, 0), "a2": (0, 0.5, 0), "b0": (0, 0, -0.5), "b1": (1, 0, 0)}
        share["b2"] = (0, 0, 0.5)
        by_border = (np.array(s)[None, :, None] * n[:, None] / self.edge for s in share.values())
        return (lines / self.edge, *by_border)
