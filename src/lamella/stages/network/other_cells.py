"""With how many cells, near the present number, a net is without a fault: where curves end decides, so it is tried."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from lamella.base.errors import InputError
from lamella.base.limits import CELLS_MIN
from lamella.base.progress import silent
from lamella.network.lattice.density import choose_density
from lamella.network.lattice.trace import trace_closed_form
from lamella.network.network import Network
from lamella.network.streamlines.applicability import is_traced
from lamella.project.tables import Project
from lamella.stages.pattern_of_table import pattern_of
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.surface import Surface

if TYPE_CHECKING:
    from lamella.network.elements.net_coordinates import NetCoordinates

# cells more or fewer that are tried
FARTHEST = 4
# larger nets, and surfaces of more nodes, are not made anew: all trials take as long as a few seconds' run
MOST_NODES, MOST_ELEMENT_NODES = 3_000, 15_000


@dataclass(frozen=True)
class OtherCells:
    """The nets of nearly as many cells on the surface of a project.

    Attributes
    ----------
    project : Project
    surface : Surface
    network : Network
        The present net.
    warned : int
        Warnings of the present net itself: one of other cells with more of them is no remedy.
    coordinates : NetCoordinates or None
        Isothermic coordinates of a surface of elements, where they are known.
    """

    project: Project
    surface: Surface[Any]
    network: Network
    warned: int = 0
    coordinates: NetCoordinates | None = None
    _made: dict[int, Network | None] = field(default_factory=dict)

    def without(self, fault: Callable[[Network], bool]) -> str:
        """In words, with how many cells there is no such fault; empty where none are tried.

        Parameters
        ----------
        fault : callable
            Whether a net has it; may raise an `InputError` where a run would.
        """
        if not self._cheap():
            return ""
        present = self.network.cells
        near = [present + sign * k for k in range(1, FARTHEST + 1) for sign in (1, -1)]
        for cells in near:
            network = self._net(cells)
            try:
                if network and not fault(network):
                    return f"with {cells} cells there are none"
            except InputError:
                continue
        return f"with {max(present - FARTHEST, CELLS_MIN)} to {present + FARTHEST} cells there are such too"

    def _cheap(self) -> bool:
        """Whether a few more nets can be made at once; nets that change their boundary, or are traced, cannot."""
        table, surface = self.project.network, self.surface
        if len(self.network.node_points) > MOST_NODES or is_traced(surface, pattern_of(table)):
            return False
        if isinstance(surface, ClosedForm):
            return True
        # heavy, and closed forms do without
        from lamella.surface.element.surface import ElementSurface

        few = isinstance(surface, ElementSurface) and len(surface.nodes) <= MOST_ELEMENT_NODES
        return few and table.closing != "adjust"

    def _net(self, cells: int) -> Network | None:
        """The net of a number of cells, None where a run refuses it or warns of more."""
        if cells not in self._made:
            try:
                self._made[cells] = self._make(cells) if cells >= CELLS_MIN else None
            except InputError:
                self._made[cells] = None
        return self._made[cells]

    def _make(self, cells: int) -> Network | None:
        table = self.project.network.model_copy(update={"cells": cells, "spacing": None})
        if isinstance(self.surface, ClosedForm):
            density = choose_density(self.surface, cells=cells, pattern=pattern_of(table))
            return trace_closed_form(self.surface, density, minimum_length=table.minimum_length)
        from lamella.stages.network.net_of_table import net_of_plan, net_plan

        project = self.project.model_copy(update={"network": table})
        made = net_of_plan(net_plan(self.surface, project, None, silent, self.coordinates), project)
        return made.network if len(list(made.warnings())) <= self.warned else None
