"""The stage "fabrication": flat parts with slots, sheets, drawings and the part list."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from lamella import __version__
from lamella.base.drawing_origin import drawing_origin
from lamella.base.message import Message
from lamella.base.progress import Progress
from lamella.files.write.drawn_layer import DrawnLayer
from lamella.project.tables import Project
from lamella.stages.drawn import in_drawing
from lamella.stages.fabrication.defaults import (
    check_drawings,
    check_fabrication,
    check_joint,
    cut_options,
    filled_measures,
    slots_by_erection,
    usual_slot_width,
)
from lamella.stages.fabrication.figures import FIGURES, REPORT
from lamella.stages.fabrication.further_files import draws_sheets
from lamella.stages.fabrication.output import FabricationOutput
from lamella.stages.keys import with_keys
from lamella.stages.stage import File, Stage, Upstream
from lamella.surface.surface import Surface

if TYPE_CHECKING:
    from lamella.view.scene.scene import Shown


class FabricationStage(Stage[FabricationOutput]):
    """See `lamella.stages.stage.Stage`."""

    name = "fabrication"
    needs = ("surface", "network", "lamellas")
    writes = (
        ("fabrication/A.dxf, fabrication/B.dxf", "the parts of either family"),
        ("fabrication/sheets.dxf", "all pieces on their sheets"),
        ("fabrication/schedule.csv", "the part list"),
        (
            "fabrication/parts.xlsx",
            "strips, hardware, cables, plates, edge beams, cut plan, stock, segments and totals as a workbook",
        ),
        (
            "fabrication/hardware.csv, fabrication/places.csv, fabrication/plates.dxf",
            "where `[joint]` is given: the hardware, the place of every piece, and what of it is cut from plates",
        ),
        (
            "fabrication/drawings.pdf",
            "where `[joint]` or `[drawings]` is given: sheets with views, details, dimensions, assembly, parts list",
        ),
        (
            "fabrication/A.svg, fabrication/B.svg, fabrication/sheets.svg, fabrication/plates.svg, "
            "fabrication/plate_sheets.svg",
            "with it: the cutting drawings as SVG, as in the DXF files of these names",
        ),
        ("model.ifc", "where `files.ifc` is true: the same as IFC 4 members, plates and fasteners"),
        ("model.glb", "where `[joint]` is given or `files.solids` is true: the same for viewers and renderers"),
        ("fabrication/plate_sheets.dxf", "where `[[stock]]` is given too: all these plates on their sheets"),
        (
            "fabrication/segments.csv, fabrication/segment_joints.csv, fabrication/segment_parts.csv",
            "where `[segments]` is given: the segments, the joints between them, and the parts of each",
        ),
    )
    figures = FIGURES
    report = ("Fabrication", REPORT)

    def warned_by(self, project: Project) -> tuple[str, ...]:
        return ("files", "drawings")

    def reads(self, project: Project, wanted: tuple[str, ...]) -> tuple[str, ...]:
        # the way of the joints hangs on the table [erection] alone
        way = ("erection",) if slots_by_erection(project) else ()
        return ("fabrication", "joint", "cables", "edge_beam", "stock", "segments", *way)

    def check(self, project: Project, surface: Surface[Any] | None) -> None:
        check_joint(project)
        check_drawings(project)
        if surface is not None:
            check_fabrication(project, surface)

    def heading(self, up: Upstream) -> str:
        return "parts and sheets"

    def run(self, up: Upstream, progress: Progress) -> FabricationOutput:
        from lamella.stages.fabrication.making import made

        if not slots_by_erection(up.project):
            return replace(made(up), slot_width=usual_slot_width(up.project))
        # the beam model, which slots of a given width do without
        from lamella.stages.fabrication.slot_widths import with_slots

        return with_slots(up, made, progress)

    def filled(self, up: Upstream, out: FabricationOutput) -> Project:
        return filled_measures(up.project, up.surface, out.slot_width)

    def result(self, figures: Mapping[str, Any], out: FabricationOutput) -> str:
        return f"{figures['parts']:,} parts, {figures['mass']:.4g} kg, {figures['sheets']} sheets"

    def warnings(self, out: FabricationOutput, up: Upstream, progress: Progress) -> Iterator[Message]:
        named = ("fabrication.end_distance", "fabrication.hub_radius")
        yield from (with_keys(warning, *named) for warning in out.parts.warnings)
        for warning in out.hardware.warnings:
            by = "short lamellas out by a larger network.minimum_length"
            yield Message(warning.key, warning.replace("short lamellas out", by))
        yield from out.notes
        yield from out.segments.warnings
        if up.project.joint is not None:
            from lamella.stages.fabrication.scene import solids_left_out

            yield from solids_left_out(up.project, out, up.outputs["lamellas"].lamellas)
        if draws_sheets(up.project):
            from lamella.drawings.strip_sheets import strips_not_drawn

            yield from strips_not_drawn(out.parts)

    def files(self, out: FabricationOutput, up: Upstream) -> Iterator[File]:
        from lamella.fabrication.drawing import write_drawings
        from lamella.fabrication.schedule import write_schedule
        from lamella.hardware.lists import write_hardware, write_places
        from lamella.hardware.plates_drawing import write_plates
        from lamella.hardware.workbook import write_workbook
        from lamella.stages.fabrication.further_files import further_files
        from lamella.stages.fabrication.pages import pages
        from lamella.stages.figure import evaluate

        signed: Any = {"name": up.project.name, "version": __version__}
        options = cut_options(up.project)
        network = in_drawing(up.outputs["network"].network, drawing_origin(up.surface))
        lamellas = up.outputs["lamellas"].lamellas
        yield File(
            "fabrication/A.dxf",
            lambda path: write_drawings(path.parent, out.parts, out.nesting, options, **signed),
            also=("fabrication/B.dxf", "fabrication/sheets.dxf"),
        )
        yield File(
            "fabrication/schedule.csv",
            lambda path: write_schedule(path, out.parts, out.nesting, network, lamellas, **signed),
        )
        yield File(
            "fabrication/parts.xlsx",
            lambda path: write_workbook(
                path,
                out.parts,
                out.nesting,
                network,
                lamellas,
                out.hardware,
                pages(out, evaluate(FIGURES, out), network, drawing_origin(up.surface)),
                **signed,
            ),
        )
        if out.hardware.items:
            drawn: Any = signed | {"origin": drawing_origin(up.surface)}
            yield File("fabrication/hardware.csv", lambda path: write_hardware(path, out.hardware, **signed))
            yield File("fabrication/places.csv", lambda path: write_places(path, out.hardware, **drawn))
            yield File("fabrication/plates.dxf", lambda path: write_plates(path, out.hardware, options, **signed))
        if out.segments.segments:
            from lamella.segments.lists import write_segments

            yield File(
                "fabrication/segments.csv",
                lambda path: write_segments(
                    path.parent,
                    out.segments,
                    out.parts,
                    out.hardware,
                    network,
                    **signed,
                    origin=drawing_origin(up.surface),
                ),
                also=("fabrication/segment_joints.csv", "fabrication/segment_parts.csv"),
            )
        if out.plates:
            from lamella.hardware.plate_sheets_drawing import write_plate_sheets

            yield File(
                "fabrication/plate_sheets.dxf", lambda path: write_plate_sheets(path, out.plates, options, **signed)
            )
        yield from further_files(out, up, lambda: self.model(out, up))

    def model(self, out: FabricationOutput, up: Upstream) -> Iterator[DrawnLayer]:
        from lamella.stages.fabrication.scene import hardware_layers, shows_solids, strip_layers

        lamellas = up.outputs["lamellas"].lamellas
        if shows_solids(up.project, out, lamellas):
            yield from strip_layers(out, lamellas, up.project.lamella.material)
        yield from hardware_layers(out.hardware.items)

    def scene(self, out: FabricationOutput, up: Upstream) -> Iterator[Shown]:
        from lamella.stages.fabrication.view_layers import fabrication_scene

        yield from fabrication_scene(up.project, out, up.outputs["lamellas"].lamellas)

    def still(self, out: FabricationOutput, up: Upstream) -> Iterator[Shown]:
        from lamella.stages.fabrication.view_layers import fabrication_scene

        yield from fabrication_scene(up.project, out, up.outputs["lamellas"].lamellas, still=True)
