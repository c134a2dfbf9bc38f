"""The questions every surface answers, closed form, found or imported: what later stages know of it.

What a surface can do is asked with these. `ClosedForm` and `ElementSurface`, its classes, say how its places are
stored: code that needs one of the two asks with `isinstance`. `kind` is a name in files and decides nothing.
"""

from __future__ import annotations

from typing import Any, Protocol, TypeVar

from lamella.base.arrays import Floats
from lamella.base.message import Message
from lamella.surface.mesh import SurfaceMesh
from lamella.surface.points import SurfacePoints

Where = TypeVar("Where")
"""Places on a surface in bulk; only the surface that gave them knows what is inside."""


class Surface(Protocol[Where]):
    """A surface of constant mean curvature. Signs and names are those of `lamella`'s package docstring.

    `Where` is how the surface names n places at once: complex parameters (n,) on a closed form, elements with local
    coordinates on a surface that was found.
    """

    @property
    def kind(self) -> str:
        """Name in a project file."""

    @property
    def mean_curvature(self) -> float:
        """H, 1/m, for the surface's own normal."""

    def has_lattice(self, normal_curvature: float | None = None) -> bool:
        """Whether curves of a normal curvature (1/m; None: lamellas of kn = H, or principal lines) follow a lattice.

        Then they are level curves of isothermic, or of like, coordinates; elsewhere they are traced one by one.
        """

    def at(self, where: Where) -> SurfacePoints:
        """Everything about n places, in one evaluation."""

    def mesh(self, tolerance: float = 1e-3) -> SurfaceMesh:
        """The surface sampled for files and pictures.

        Parameters
        ----------
        tolerance : float
            Largest distance of the faces from the surface over the diagonal of the bounding box.
        """

    def area(self) -> float:
        """m^2."""

    def check_places(self) -> Where:
        """Places spread over the whole surface, at which a run measures it."""

    def check_points(self) -> SurfacePoints:
        """Everything about these places."""

    def measured_mean_curvature(self, where: Where) -> Floats:
        """H at n places from positions alone, 1/m, (n,): not from the equation that made the surface."""

    def singular_orders(self) -> tuple[int, ...]:
        """Orders m >= 1 of the umbilics, as far as they are known before the network is; each has 2 (m + 2) rays."""

    def describe(self) -> dict[str, Any]:
        """Further figures for the summary; "stability" is one where it is asked ("stable", "unstable", "fold")."""

    def warnings(self) -> tuple[Message, ...]:
        """What a user should know about this surface before building it."""


__all__ = ["Surface", "Where"]
