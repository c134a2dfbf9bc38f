"""What a computation has made."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lamella.base.drawing_origin import Origin, drawing_origin
from lamella.base.result import Result, Shown
from lamella.base.wording import counted
from lamella.project.tables import Project
from lamella.stages.stage import Upstream

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from lamella.fabrication.part import Parts
    from lamella.fabrication.sheet import Nesting
    from lamella.network.network import Network
    from lamella.stages.surface.adjusted_table import AdjustedTable
    from lamella.strip.lamellas import Lamellas
    from lamella.surface.mesh import SurfaceMesh
    from lamella.surface.surface import Surface


@dataclass(frozen=True, eq=False, repr=False)
class Results(Result):
    """Everything a run has computed; what was not computed is None.

    Points are measured from `origin`, those of files and of the summary from the drawing's own.

    Attributes
    ----------
    project : Project
        With all defaults filled in.
    outputs : mapping
        What each stage has computed, by its name.
    summary : dict
        The content of summary.json, without the time spent on files.
    upstream : Upstream
        What a stage after the last one would be given.

    Examples
    --------
    >>> import lamella
    >>> project = lamella.parse_project(
    ...     {"surface": {"kind": "catenoid", "neck_radius": 2.5, "height": [-2.0, 3.0]}, "network": {"cells": 12}}
    ... )
    >>> results = lamella.compute(project)
    >>> results.network, results.parts
    (Network(12 cells: 24 lamellas, 144 nodes, 120 faces), Parts(24 parts, 48 pieces, 481.9 kg))
    """

    project: Project
    outputs: Mapping[str, Any]
    summary: dict[str, Any] = field(compare=False)
    upstream: Upstream = field(compare=False)

    @property
    def folder(self) -> Path:
        """Where the files the project names were looked for."""
        return self.upstream.folder

    @property
    def surface(self) -> Surface[Any]:
        """The surface."""
        return self.upstream.surface

    @property
    def mesh(self) -> SurfaceMesh:
        """The surface sampled for files and pictures."""
        mesh: SurfaceMesh = self.outputs["surface"].mesh
        return mesh

    @property
    def adjusted(self) -> AdjustedTable | None:
        """The boundary as it was changed for a net that closes."""
        adjusted: AdjustedTable | None = self.outputs["surface"].adjusted
        return adjusted

    @property
    def network(self) -> Network | None:
        """The net."""
        network: Network | None = self._of("network", "network")
        return network

    @property
    def lamellas(self) -> Lamellas | None:
        """The strips."""
        lamellas: Lamellas | None = self._of("lamellas", "lamellas")
        return lamellas

    @property
    def parts(self) -> Parts | None:
        """The parts."""
        parts: Parts | None = self._of("fabrication", "parts")
        return parts

    @property
    def nesting(self) -> Nesting | None:
        """Where the parts lie on sheets."""
        nesting: Nesting | None = self._of("fabrication", "nesting")
        return nesting

    def _line(self) -> str:
        warnings = counted(len(self.summary["warnings"]), "warning")
        return f"{self.surface.kind}, up to {list(self.outputs)[-1]}: {warnings}"

    @property
    def _last(self) -> Shown:
        """What is shown of a run."""
        return self.lamellas or self.network or self.mesh

    def _repr_html_(self) -> str:
        return f"<div>{self._last._repr_html_()}<div><code>{escape(repr(self))}</code></div></div>"

    def plot(self, ax: Axes | None = None, **options: Any) -> Axes:
        """The strips, the net or the surface, whichever the run came to, see `lamella.Shown.plot`."""
        return self._last.plot(ax, **options)

    @property
    def origin(self) -> Origin:
        """Point of the drawing that points are measured from, m; not 0 where it is in survey coordinates."""
        return drawing_origin(self.surface)

    def _of(self, stage: str, name: str) -> Any:
        return getattr(self.outputs[stage], name) if stage in self.outputs else None
