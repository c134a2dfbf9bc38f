"""What a picture needs of a run."""

from __future__ import annotations

from typing import Any, Protocol

from lamella.network.network import Network
from lamella.strip.lamellas import Lamellas
from lamella.surface.mesh import SurfaceMesh
from lamella.surface.surface import Surface


class ShownRun(Protocol):
    """A run, as `lamella.Results` is one."""

    @property
    def project(self) -> Any:
        """The project: `lamella.height` of it is the height of the strips."""

    @property
    def surface(self) -> Surface[Any]:
        """The surface."""

    @property
    def mesh(self) -> SurfaceMesh:
        """The surface sampled."""

    @property
    def network(self) -> Network | None:
        """The net, where there is one."""

    @property
    def lamellas(self) -> Lamellas | None:
        """The strips, where there are."""
