"""A surface of curved elements on which lamellas of one normal curvature cross at one angle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from lamella.surface.element.varying import VaryingSurface


@dataclass(frozen=True, eq=False, repr=False)
class AngleSurface(VaryingSurface):
    """See `VaryingSurface`: its mean curvature varies, `mean_curvature` is its mean over the area, 1/m.

    Attributes
    ----------
    angle : float
        Between the lamellas, bisected by the first principal direction, degrees.
    normal_curvature : float
        c of the lamellas, 1/m.
    """

    angle: float = 90.0
    normal_curvature: float = 0.0

    def describe(self) -> dict[str, Any]:
        """Further figures for the summary."""
        return super().describe() | {"node_angle": self.angle, "normal_curvature": self.normal_curvature}
