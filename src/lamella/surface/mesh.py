"""A surface sampled as a mesh, for pictures and for programs that read meshes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.result import Shown
from lamella.base.wording import counted


@dataclass(frozen=True, eq=False, repr=False)
class SurfaceMesh(Shown):
    """Vertices on the surface with their curvatures, and faces.

    Attributes
    ----------
    points, normals : (n, 3)
        Vertices (m) and unit surface normals.
    faces : (f, 4) int
        Vertex indices, counter-clockwise about the normal; a triangle repeats its last index.
    mean_curvature, gaussian_curvature, k1, k2 : (n,)
        H, K and the principal curvatures k1 >= k2 at the vertices, 1/m (K in 1/m^2).

    Examples
    --------
    >>> import lamella
    >>> lamella.Catenoid(2.5, (-2.0, 3.0)).mesh(0.02)
    SurfaceMesh(576 points, 552 faces)
    """

    points: Floats
    normals: Floats
    faces: Integers
    mean_curvature: Floats
    gaussian_curvature: Floats
    k1: Floats
    k2: Floats

    def _line(self) -> str:
        return f"{counted(len(self.points), 'point')}, {counted(len(self.faces), 'face')}"

    def sag(self) -> float:
        """Largest distance of the faces from the surface, estimated from the vertices' normals, m.

        The chord e between two vertices misses the surface by |e . dn| / 8, dn being the difference of their normals;
        inside of an equilateral triangle on a sphere it is 4 / 3 of that. Edges and diagonals are looked at.
        """
        most = 0.0
        for i, j in ((0, 1), (1, 2), (2, 3), (3, 0), (0, 2), (1, 3)):
            one, other = self.faces[:, i], self.faces[:, j]
            chord, turn = self.points[other] - self.points[one], self.normals[other] - self.normals[one]
            most = max(most, float(np.abs((chord * turn).sum(1)).max(initial=0.0)))
        return most / 6
