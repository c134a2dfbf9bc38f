"""A surface of curved elements whose mean curvature varies: a mesh's own surface, kept as it is.

Its Gauss map is not harmonic, so that its normals are the elements' own, by L2 projection onto continuous polynomials;
the shape operator is -dn of these, with its own mean curvature.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from lamella.base.arrays import Floats
from lamella.surface.element.connectivity import Connectivity
from lamella.surface.element.geometry import smooth_normals
from lamella.surface.element.places import Places
from lamella.surface.element.surface import ElementSurface

# of a triangle of the mesh
CORNERS = 3


@dataclass(frozen=True, eq=False, repr=False)
class VaryingSurface(ElementSurface):
    """See `ElementSurface`; `mean_curvature` is the mean of H over the area, 1/m.

    Attributes
    ----------
    vertices : (v, 3), optional
        Of the mesh, m.
    vertex_errors : (v,), optional
        How far normal curvatures may be off those of the surface that the mesh means, 1/m.
    """

    vertices: Floats | None = None
    vertex_errors: Floats | None = None

    def has_lattice(self, normal_curvature: float | None = None) -> bool:
        """Never: isothermic coordinates are those of a constant mean curvature."""
        return False

    @cached_property
    def gauss_map(self) -> Floats:
        return smooth_normals(self.connectivity, self.nodes)

    @property
    def _shape_space(self) -> Connectivity:
        # its normals are no better than the elements' own
        return self._smooth_space

    def _mean(self, uu: Floats, vv: Floats) -> Floats:
        return np.asarray((uu + vv) / 2)

    def uncertain(self, places: Places) -> Floats:
        """The largest error at the corners around each of n places, 1/m, (n,)."""
        if self.vertices is None or self.vertex_errors is None:
            return np.zeros(len(places))
        _, near = cKDTree(self.vertices).query(self.at(places).position, k=min(CORNERS, len(self.vertices)))
        return np.asarray(self.vertex_errors[near].reshape(len(places), -1).max(axis=1))

    def singular_orders(self) -> tuple[int, ...]:
        """None: only on surfaces of constant mean curvature are umbilics nodes of a net."""
        return ()

    def describe(self) -> dict[str, Any]:
        """Further figures for the summary."""
        there = self.at(self.check_places())
        mean, half = there.mean_curvature, np.abs(there.deviator)
        return super().describe() | {
            "mean_curvature_range": [float(mean.min()), float(mean.max())],
            "normal_curvature_range": [float((mean - half).min()), float((mean + half).max())],
        }
