"""A film and how it was found."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from lamella.base.message import Message
from lamella.surface.element.surface import ElementSurface
from lamella.surface.form_finding.enclosed_volume import enclosed_volume
from lamella.surface.form_finding.newton import Equilibrium
from lamella.surface.form_finding.stability import Stability


@dataclass(frozen=True)
class Found:
    """A film and how it was found.

    Attributes
    ----------
    equilibrium : Equilibrium
        On the final elements.
    stability : Stability
    deviation : float
        Largest |H - H0| at the check points, over the curvature scale.
    scale : float
        Curvature scale, 1/m.
    start_steps : int
        Newton steps from the harmonic start, or on the whole path where one was followed.
    followed : bool
        Whether a path was followed.
    """

    equilibrium: Equilibrium
    stability: Stability
    deviation: float
    scale: float
    start_steps: int
    followed: bool

    def surface(self, kind: str, notes: tuple[Message, ...] = (), **figures: Any) -> ElementSurface:
        """The surface as later stages see it, with further figures for the summary."""
        film = self.equilibrium.film
        known = {
            "stability": self.stability.verdict,
            "jacobi_eigenvalue": self.stability.lowest,
            "negative_eigenvalues": self.stability.negative,
            "order": film.connectivity.basis.order,
            "surface_nodes": film.connectivity.node_count,
            "elements": len(film.connectivity.elements),
            "newton_steps": self.start_steps,
            "continuation": self.followed,
            "curvature_scale": self.scale,
            "mean_curvature_deviation": self.deviation,
            "mean_curvature_deviation_max": self.deviation * self.scale,
            "volume": enclosed_volume(film),
        }
        return surface_of(self.equilibrium, kind, known | figures, notes)


def surface_of(
    equilibrium: Equilibrium, kind: str, figures: dict[str, Any], notes: tuple[Message, ...] = ()
) -> ElementSurface:
    """A film as later stages see it, with figures for the summary and what a user should know."""
    film = equilibrium.film
    rim_loop = film.mesh.loop[film.connectivity.rim_nodes[:, 0]]
    return ElementSurface(
        kind,
        equilibrium.mean_curvature,
        film.connectivity,
        film.nodes,
        rim_loop,
        figures,
        notes,
        film.loop_starts(),
        film.slide_ends(),
    )
