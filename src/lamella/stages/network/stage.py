"""The stage "network": the net of lamellas, or of principal lines, on the surface."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

from lamella import __version__
from lamella.base.drawing_origin import drawing_origin
from lamella.base.message import Message
from lamella.base.progress import Progress, Report, silent
from lamella.network.lattice.density import Density, choose_density
from lamella.network.lattice.trace import trace_closed_form
from lamella.network.streamlines.applicability import check_traced, is_traced
from lamella.project.tables import Project
from lamella.stages.drawn import in_drawing
from lamella.stages.figure import require_declared
from lamella.stages.keys import keys, with_keys
from lamella.stages.network.adjusting import refuse_adjusting
from lamella.stages.network.figures import FIGURES, REPORT
from lamella.stages.network.other_cells import OtherCells
from lamella.stages.network.output import NetworkOutput
from lamella.stages.network.warnings import network_warnings
from lamella.stages.pattern_of_table import pattern_of, refuse_lines
from lamella.stages.stage import Estimate, File, Stage, Upstream
from lamella.stages.unit_first import unit_first
from lamella.surface.closed_forms.closed_form import ClosedForm
from lamella.surface.surface import Surface
from lamella.surface.umbilic import umbilic_reason

if TYPE_CHECKING:
    from lamella.network.elements.element_network import ElementNetwork, NetPlan
    from lamella.network.elements.net_coordinates import NetCoordinates
    from lamella.network.streamlines.streamline_network import TracedNetwork
    from lamella.view.scene.scene import Shown


class NetworkStage(Stage[NetworkOutput]):
    """See `lamella.stages.stage.Stage`."""

    name = "network"
    quantities = ("twist", "geodesic")
    needs = ("surface",)
    writes = (
        ("network.json", "nodes, lamellas and faces, for programs"),
        ("network.obj", "the same as a mesh and polylines"),
        ("nodes.csv", "a line a node"),
        ("model.3dm", "surface, centre lines and nodes for Rhino; strips when the stage lamellas has run"),
    )
    figures = FIGURES
    report = ("Network", REPORT)

    def reads(self, project: Project, wanted: tuple[str, ...]) -> tuple[str, ...]:
        return ("network",)

    def warned_by(self, project: Project) -> tuple[str, ...]:
        return ("lamella.height",)

    def ends(self, up: Upstream) -> Message | None:
        if _density(up.project, up.surface):
            return None
        reason = umbilic_reason(up.surface.check_points())
        if not reason:
            return None
        text = f"the run ends with the surface: it is {reason}, and has no net of lamellas"
        return Message("ends_with_surface", text)

    def check(self, project: Project, surface: Surface[Any] | None) -> None:
        if surface is None:
            refuse_lines(project)
            refuse_adjusting(project)
        else:
            _density(project, surface)

    def estimate(self, up: Upstream, progress: Progress) -> Estimate:
        density = _density(up.project, up.surface)
        if density:
            return Estimate({"cells": density.cells, "nodes": density.estimated_nodes})
        if umbilic_reason(up.surface.check_points()):
            return Estimate({})
        # heavy, and closed forms do without
        from lamella.stages.network.net_of_table import streamline_plan

        progress(Report.step("laying the net"))
        with unit_first(up.surface):
            if is_traced(up.surface, pattern_of(up.project.network)):
                lines = streamline_plan(up.surface, up.project)
                return Estimate({"cells": lines.cells, "nodes": lines.estimated_nodes})
            lattice = _plan(up, None, progress).lattice
        return Estimate({"cells": lattice.cells, "nodes": lattice.estimated_nodes})

    def heading(self, up: Upstream) -> str:
        density = _density(up.project, up.surface)
        if density:
            return f"{density.requested}, about {density.estimated_nodes:,} nodes"
        traced = is_traced(up.surface, pattern_of(up.project.network))
        return "lines from even seeds" if traced else "umbilics, isothermic coordinates, lamellas"

    def run(self, up: Upstream, progress: Progress) -> NetworkOutput:
        out = _made(up, progress)
        require_declared(FIGURES, out.described)
        return out

    def result(self, figures: Mapping[str, Any], out: NetworkOutput) -> str:
        return (
            f"{out.network.cells} cells: {figures['lamellas']} lamellas, {figures['nodes']:,} nodes, cell edge "
            f"{figures['cell_edge_min']:.3g} to {figures['cell_edge_max']:.3g} m (median "
            f"{figures['cell_edge_median']:.3g} m)"
        )

    def warnings(self, out: NetworkOutput, up: Upstream, progress: Progress) -> Iterator[Message]:
        own = out.made.warnings(up.finer) if out.made else ()
        yield from (with_keys(warning, "surface.tolerance") for warning in own)
        table = up.project.network
        yield from network_warnings(
            out.network,
            up.project.lamella.height,
            "open" if out.made else table.closing,
            traced=is_traced(up.surface, pattern_of(table)),
            without=other_cells(out, up).without,
        )

    def files(self, out: NetworkOutput, up: Upstream) -> Iterator[File]:
        from lamella.files.write.meshes import write_network_obj
        from lamella.files.write.network_json import write_network
        from lamella.files.write.nodes_csv import write_nodes_csv

        network = in_drawing(out.network, drawing_origin(up.surface))
        signed: Any = {"name": up.project.name, "version": __version__}
        yield File("network.json", lambda path: write_network(path, network, **signed))
        yield File("network.obj", lambda path: write_network_obj(path, network, **signed))
        yield File("nodes.csv", lambda path: write_nodes_csv(path, network, **signed))

    def scene(self, out: NetworkOutput, up: Upstream) -> Iterator[Shown]:
        from lamella.stages.network.marks import network_marks
        from lamella.stages.network.scene import network_scene

        yield from network_scene(out.network)
        yield from network_marks(out.network, up.project.lamella.height)


@keys("network", surface="surface")
def _density(project: Project, surface: Surface[Any]) -> Density | None:
    """The density of a net on the lattice of a closed form, where that is arithmetic.

    Raises
    ------
    InputError
        No such density; a net of lines from seeds that cannot be as the project wants it.
    """
    table = project.network
    if is_traced(surface, pattern_of(table)):
        check_traced(surface, pattern_of(table), table.closing)
        return None
    if not isinstance(surface, ClosedForm):
        return None
    return choose_density(surface, cells=table.cells, spacing=table.spacing, pattern=pattern_of(table))


def _made(up: Upstream, progress: Progress) -> NetworkOutput:
    """The net by the algorithm that its surface and pattern ask for."""
    project, surface = up.project, up.surface
    density = _density(project, surface)
    if density:
        assert isinstance(surface, ClosedForm)
        with keys("network", surface="surface"):
            network = trace_closed_form(surface, density, minimum_length=project.network.minimum_length)
        return NetworkOutput(replace(network, surface=surface), density.requested, None, {})
    # heavy, and closed forms do without
    from lamella.stages.network.net_of_table import net_of_plan, streamline_net

    adjusted = up.outputs["surface"].adjusted
    made: ElementNetwork | TracedNetwork
    with unit_first(surface):
        if is_traced(surface, pattern_of(project.network)):
            made = streamline_net(surface, project, progress)
        else:
            made = net_of_plan(_plan(up, adjusted.step if adjusted else None, progress), project)
        network = replace(made.network, surface=surface, figures=made.describe())
    return NetworkOutput(network, made.requested, made, adjusted.figures if adjusted else {})


def _plan(up: Upstream, step: float | None, progress: Progress) -> NetPlan:
    """The lattice on a surface of elements; isothermic coordinates are kept, for they are those of all densities."""
    from lamella.stages.network.net_of_table import net_plan

    return net_plan(up.surface, up.project, step, progress, _coordinates(up, progress))


def _coordinates(up: Upstream, progress: Progress) -> NetCoordinates:
    """Isothermic coordinates of a surface of elements."""
    from lamella.network.elements.kept_coordinates import FollowedCoordinates
    from lamella.network.elements.net_coordinates import net_coordinates
    from lamella.surface.element.surface import ElementSurface

    surface, seams = up.surface, up.project.network.closing == "open"
    assert isinstance(surface, ElementSurface)

    def make() -> NetCoordinates:
        if up.memory.follow and surface.has_boundary_curves:
            of = partial(FollowedCoordinates.of, surface, seams)
            followed: FollowedCoordinates = up.memory.followed("coordinates", of)
            return followed.coordinates
        return net_coordinates(surface, seams=seams, progress=progress)

    with keys("network", surface="surface"):
        return up.remembered("isothermic coordinates", (up.outputs["surface"].key, seams), make)


def other_cells(out: NetworkOutput, up: Upstream) -> OtherCells:
    """Nets of other numbers of cells on the same surface, kept for the stages that ask for them."""
    key = up.keys["network"]

    def make() -> OtherCells:
        warned = len(list(out.made.warnings(up.finer))) if out.made else 0
        on_lattice = out.made is not None and not is_traced(up.surface, pattern_of(up.project.network))
        known = _coordinates(up, silent) if on_lattice else None
        return OtherCells(up.project, up.surface, out.network, warned, known)

    return up.remembered("nets of other cells", (key, up.finer), make)
