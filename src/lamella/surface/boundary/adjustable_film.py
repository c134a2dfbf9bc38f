"""A film whose boundary and mean curvature may change: what it is found from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from lamella.base.drawing_origin import NOWHERE, Origin
from lamella.surface.boundary.boundary_curve import BoundaryCurve
from lamella.surface.boundary.checks import check_corner_count, check_loops
from lamella.surface.boundary.curve import Loop


@dataclass(frozen=True)
class AdjustableFilm:
    """What a film is found from, with how far it may be changed.

    Attributes
    ----------
    curves : tuple of BoundaryCurve
        The outer one first, each with its `adjust`.
    mean_curvature : float or None
        H, 1/m; None with a volume.
    adjust_mean_curvature : float
        How far H may be changed, 1/m.
    volume, order, tolerance, branch, most_nodes
        See `lamella.surface.form_finding.find.find_film`.
    """

    curves: tuple[BoundaryCurve, ...]
    mean_curvature: float | None = 0.0
    adjust_mean_curvature: float = 0.0
    volume: float | None = None
    order: int = 4
    tolerance: float = 2e-3
    branch: Literal["stable", "unstable"] = "stable"
    most_nodes: int = 100_000

    @property
    def origin(self) -> Origin:
        """Point of the drawing that loops are measured from, m."""
        return self.curves[0].origin if self.curves else NOWHERE

    def loops(self) -> tuple[Loop, ...]:
        """The boundary, built and checked.

        Raises
        ------
        InputError
            Whatever is wrong with it, by the number of the curve: "curves[1]", or "loops[1]" once it is built.
        """
        loops = tuple(curve.loop(f"curves[{k}]") for k, curve in enumerate(self.curves))
        check_loops(loops)
        check_corner_count(loops, self.most_nodes, self.tolerance)
        return loops
