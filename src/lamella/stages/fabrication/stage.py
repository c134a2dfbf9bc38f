"""The stage "fabrication": flat parts with slots, sheets, drawings and the part list."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from lamella import __version__
from lamella.base.drawing_origin import drawing_origin
from lamella.base.message import Message
from lamella.base.progress import Progress
from lamella.fabrication.parts import make_parts
from lamella.fabrication.sheet import nest
from lamella.project.tables import Project
from lamella.stages.drawn import in_drawing
from lamella.stages.fabrication.defaults import check_fabrication
from lamella.stages.fabrication.figures import FIGURES, REPORT
from lamella.stages.fabrication.output import FabricationOutput
from lamella.stages.keys import keys, with_keys
from lamella.stages.lamellas.stage import strips_of
from lamella.stages.network.stage import other_cells
from lamella.stages.stage import File, Stage, Upstream
from lamella.surface.surface import Surface


class FabricationStage(Stage[FabricationOutput]):
    """See `lamella.stages.stage.Stage`."""

    name = "fabrication"
    needs = ("surface", "network", "lamellas")
    writes = (
        ("fabrication/A.dxf, fabrication/B.dxf", "the parts of either family"),
        ("fabrication/sheets.dxf", "all pieces on their sheets"),
        ("fabrication/schedule.csv", "the part list"),
    )
    figures = FIGURES
    report = ("Fabrication", REPORT)

    def reads(self, project: Project, wanted: tuple[str, ...]) -> tuple[str, ...]:
        return ("fabrication",)

    def check(self, project: Project, surface: Surface[Any] | None) -> None:
        if surface is not None:
            check_fabrication(project, surface)

    def heading(self, up: Upstream) -> str:
        return "parts and sheets"

    def run(self, up: Upstream, progress: Progress) -> FabricationOutput:
        project, cut = up.project, up.project.fabrication
        net, strips = up.outputs["network"], strips_of(up.project, up.surface)
        others = other_cells(net, up)
        with keys("fabrication", height="lamella.height"):
            parts = make_parts(
                net.network,
                up.outputs["lamellas"].lamellas,
                density=project.material().density,
                others=lambda fault: others.without(lambda net: fault(net, strips(net))),
                **cut.model_dump(),
            )
        return FabricationOutput(parts, nest(parts, sheet=cut.sheet, gap=cut.gap), up.figures["surface"]["area"])

    def result(self, figures: Mapping[str, Any], out: FabricationOutput) -> str:
        return f"{figures['parts']:,} parts, {figures['mass']:.4g} kg, {figures['sheets']} sheets"

    def warnings(self, out: FabricationOutput, up: Upstream, progress: Progress) -> Iterator[Message]:
        named = ("fabrication.end_distance", "fabrication.hub_radius")
        return (with_keys(warning, *named) for warning in out.parts.warnings)

    def files(self, out: FabricationOutput, up: Upstream) -> Iterator[File]:
        from lamella.fabrication.drawing import write_drawings
        from lamella.fabrication.schedule import write_schedule

        signed: Any = {"name": up.project.name, "version": __version__}
        network = in_drawing(up.outputs["network"].network, drawing_origin(up.surface))
        lamellas = up.outputs["lamellas"].lamellas
        yield File(
            "fabrication/A.dxf",
            lambda path: write_drawings(path.parent, out.parts, out.nesting, **signed),
            also=("fabrication/B.dxf", "fabrication/sheets.dxf"),
        )
        yield File(
            "fabrication/schedule.csv",
            lambda path: write_schedule(path, out.parts, out.nesting, network, lamellas, **signed),
        )
