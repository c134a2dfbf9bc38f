"""What the stage "surface" computes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from lamella.project.tables import Project
from lamella.surface.mesh import SurfaceMesh
from lamella.surface.surface import Surface

if TYPE_CHECKING:
    from lamella.stages.surface.adjusted_table import AdjustedTable


@dataclass(frozen=True)
class SurfaceOutput:
    """A surface, and a mesh of it for files and pictures.

    Attributes
    ----------
    project : Project
        Whose surface it is.
    surface : Surface
    mesh : SurfaceMesh
    adjusted : AdjustedTable or None
        The boundary as it was changed for a net that closes.
    key : str
        What decides the surface, without its mesh.
    """

    project: Project
    surface: Surface[Any]
    mesh: SurfaceMesh
    adjusted: AdjustedTable | None
    key: str

    @cached_property
    def described(self) -> dict[str, Any]:
        """What the surface knows of itself, by key of the summary."""
        return self.surface.describe()
