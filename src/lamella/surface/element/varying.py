"""A surface of curved elements whose mean curvature varies: a mesh's own surface, kept as it is.

Its Gauss map is not harmonic, so that its normals are the elements' own, by L2 projection onto continuous polynomials;
the shape operator is -dn of these, with its own mean curvature.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from lamella.surface.element.connectivity import Connectivity
from lamella.surface.element.geometry import smooth_normals
from lamella.surface.element.surface import ElementSurface
from lamella.surface.points import Floats


class VaryingSurface(ElementSurface):
    """See `ElementSurface`; `mean_curvature` is the mean of H over the area, 1/m."""

    constant: ClassVar[bool] = False

    @cached_property
    def _gauss(self) -> Floats:
        return smooth_normals(self.connectivity, self.nodes)

    @property
    def _shape_space(self) -> Connectivity:
        # its normals are no better than the elements' own
        return self._smooth_space

    def _mean(self, uu: Floats, vv: Floats) -> Floats:
        return np.asarray((uu + vv) / 2)

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
