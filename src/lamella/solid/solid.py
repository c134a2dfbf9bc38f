"""A closed triangle mesh."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers


@dataclass(frozen=True, eq=False)
class Solid:
    """Closed triangle mesh, its triangles counter-clockwise seen from outside.

    Attributes
    ----------
    vertices : (v, 3)
        m.
    triangles : (f, 3) int
    """

    vertices: Floats
    triangles: Integers

    @property
    def volume(self) -> float:
        """m3, by the divergence theorem; coordinates are taken from the first vertex, so that far ones lose nothing."""
        a, b, c = np.moveaxis((self.vertices - self.vertices[:1])[self.triangles], 1, 0)
        return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)

    @classmethod
    def of(cls, solids: list[Solid]) -> Solid:
        """Several solids as one mesh."""
        starts = np.cumsum([0, *(len(solid.vertices) for solid in solids)])
        return cls(
            np.concatenate([np.empty((0, 3)), *(solid.vertices for solid in solids)]),
            np.concatenate(
                [np.empty((0, 3), np.int64), *(s.triangles + k for s, k in zip(solids, starts[:-1], strict=True))]
            ),
        )
