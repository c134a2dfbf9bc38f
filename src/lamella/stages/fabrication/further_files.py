"""Files of what is built that not every run has: the model for viewers, drawings for people."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

from lamella import __version__
from lamella.base.drawing_origin import drawing_origin
from lamella.fabrication.contours import CutOptions
from lamella.files.whole import write_whole
from lamella.files.write.drawn_layer import DrawnLayer
from lamella.project.drawings_table import DrawingsTable
from lamella.project.tables import Project
from lamella.stages.fabrication.output import FabricationOutput
from lamella.stages.stage import File, Upstream


def draws_sheets(project: Project) -> bool:
    """Whether drawings.pdf is written."""
    asked = project.joint is not None or project.drawings is not None
    return asked and (project.drawings or DrawingsTable()).pdf


def further_files(out: FabricationOutput, up: Upstream, scene: Callable[[], Iterable[DrawnLayer]]) -> Iterator[File]:
    """model.glb, drawings.pdf, drawings as SVG, where the project asks for them or has joints.

    Parameters
    ----------
    out : FabricationOutput
    up : Upstream
    scene : callable
        Makes the layers of the model.
    """
    project = up.project
    signed: Any = {"name": project.name, "version": __version__}
    if project.joint is not None or project.files.solids:
        from lamella.files.write.gltf import glb_bytes

        origin = drawing_origin(up.surface)
        yield File("model.glb", lambda path: write_whole(path, glb_bytes(scene(), origin=origin, **signed)))
    if project.files.ifc:
        from lamella.files.write.ifc import ifc_bytes

        corner = drawing_origin(up.surface)
        yield File("model.ifc", lambda path: write_whole(path, ifc_bytes(scene(), origin=corner, **signed)))
    if project.joint is None and project.drawings is None:
        return
    from lamella.files.write.svg import write_svg
    from lamella.hardware.plate_sheets_drawing import drawn_plate_sheets
    from lamella.hardware.plates_drawing import drawn_plates
    from lamella.stages.fabrication.defaults import cut_options

    options = cut_options(project)
    cut: Any = signed | {"further": tuple(options.layers)}
    drawings = project.drawings or DrawingsTable()
    if draws_sheets(project):
        yield File("fabrication/drawings.pdf", lambda path: write_whole(path, _pdf(out, up, drawings)))
    if drawings.svg:
        yield File(
            "fabrication/A.svg",
            lambda path: _svg(path.parent, out, options, **cut),
            also=("fabrication/B.svg", "fabrication/sheets.svg"),
        )
        if out.hardware.items:
            yield File(
                "fabrication/plates.svg", lambda path: write_svg(path, drawn_plates(out.hardware, "", options), **cut)
            )
        if out.plates:
            yield File(
                "fabrication/plate_sheets.svg",
                lambda path: write_svg(path, drawn_plate_sheets(out.plates, "", options), **cut),
            )


def _svg(folder: Path, out: FabricationOutput, options: CutOptions, **signed: Any) -> None:
    """The cutting drawings."""
    from lamella.fabrication.drawing import drawn_sheets
    from lamella.files.write.svg import write_svg

    for name, placed in drawn_sheets(out.parts, out.nesting, "", options).items():
        write_svg(folder / f"{name}.svg", placed, **signed)


def _pdf(out: FabricationOutput, up: Upstream, drawings: DrawingsTable) -> bytes:
    from lamella.drawings.built import Built
    from lamella.drawings.drawing_set import drawings_pdf

    project = up.project
    built = Built(
        up.outputs["network"].network,
        up.outputs["lamellas"].lamellas,
        out.parts,
        out.hardware,
        project.name,
        __version__,
        project.lamella.material,
        project.joint.kind if project.joint is not None else "interlocked",
        out.segments if out.segments.segments else None,
    )
    return drawings_pdf(built, paper=drawings.paper, language=drawings.language)
