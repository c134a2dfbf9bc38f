"""The net a project asks for, on a surface of elements or of lines from seeds."""

from __future__ import annotations

from typing import Any

from lamella.base.progress import Progress
from lamella.network.charts.charts_of import charts_of
from lamella.network.elements.element_network import Closing, ElementNetwork, NetPlan, plan_net
from lamella.network.elements.net_coordinates import NetCoordinates
from lamella.network.streamlines.applicability import reported_mean_curvature
from lamella.network.streamlines.streamline_network import TracedNetwork, traced_network
from lamella.network.streamlines.streamline_plan import StreamlinePlan, plan_streamlines
from lamella.project.tables import Project
from lamella.stages.keys import keys
from lamella.stages.pattern_of_table import pattern_of
from lamella.surface.element.surface import ElementSurface
from lamella.surface.surface import Surface
from lamella.surface.umbilic import refuse_umbilic


@keys("network", surface="surface")
def net_plan(
    surface: Surface[Any],
    project: Project,
    step: float | None,
    progress: Progress,
    coordinates: NetCoordinates | None = None,
) -> NetPlan:
    """The lattice of a surface of elements; of a given spacing l0 (sqrt(m)) where it was adjusted."""
    assert isinstance(surface, ElementSurface)
    table = project.network
    return plan_net(
        surface,
        coordinates=coordinates,
        cells=table.cells,
        spacing=table.spacing,
        step=step,
        pattern=pattern_of(table),
        loop_names=tuple(loop.name for loop in getattr(project.surface, "boundary", ())),
        seams=table.closing == "open",
        minimum_length=table.minimum_length,
        progress=progress,
    )


@keys("network", surface="surface")
def net_of_plan(laid: NetPlan, project: Project) -> ElementNetwork:
    """The network of that lattice."""
    table = project.network
    # what is left of an adjusted net's misses is below what counts as closed
    closing: Closing = "round" if table.closing == "round" else "open"
    return laid.traced(closing=closing, minimum_length=table.minimum_length)


@keys("network", surface="surface")
def streamline_plan(surface: Surface[Any], project: Project) -> StreamlinePlan:
    """How lines that follow from no lattice are laid."""
    refuse_umbilic(surface)
    table = project.network
    return plan_streamlines(charts_of(surface), pattern_of(table), cells=table.cells, spacing=table.spacing)


@keys("network", surface="surface")
def streamline_net(surface: Surface[Any], project: Project, progress: Progress) -> TracedNetwork:
    """The network of such lines."""
    refuse_umbilic(surface)
    table = project.network
    return traced_network(
        charts_of(surface),
        pattern_of(table),
        mean_curvature=reported_mean_curvature(surface, pattern_of(table)),
        cells=table.cells,
        spacing=table.spacing,
        minimum_length=table.minimum_length,
        progress=progress,
    )
