"""The stage "erection": the flat state of a net, and its way to the designed shape."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from lamella import __version__
from lamella.base.drawing_origin import drawing_origin
from lamella.base.message import Message
from lamella.base.progress import Progress
from lamella.project.tables import Project
from lamella.stages.erection.figures import FIGURES, REPORT
from lamella.stages.fabrication.defaults import cable_rules
from lamella.stages.keys import keys
from lamella.stages.stage import File, Missing, Stage, Upstream

if TYPE_CHECKING:
    from lamella.erection.erection import Erection


class ErectionStage(Stage["Erection"]):
    """See `lamella.stages.stage.Stage`."""

    name = "erection"
    needs = ("surface", "network", "lamellas")
    writes = (
        ("erection/states.json", "nodes, lamellas, joint angles, energy and driver of every state"),
        ("erection/path.csv", "places of all nodes in every state"),
        ("erection/flat.dxf", "assembly drawing of the flat state"),
    )
    figures = FIGURES
    report = ("Erection", REPORT)

    def reads(self, project: Project, wanted: tuple[str, ...]) -> tuple[str, ...]:
        return ("erection", "joint", "cables", "edge_beam", "materials", "surface")

    def warned_by(self, project: Project) -> tuple[str, ...]:
        return ("fabrication", "joint")

    def missing(self, project: Project) -> Missing | None:
        if project.erection is not None:
            return None
        reason = "the project has none"
        return Missing("a table [erection]", reason, "add a line [erection] to it", "erection", unasked=True)

    def heading(self, up: Upstream) -> str:
        return "laid flat, and driven to the designed shape"

    def run(self, up: Upstream, progress: Progress) -> Erection:
        from lamella.erection.braced import spring_backs
        from lamella.erection.erect import erect
        from lamella.stages.fabrication.making import edge_beams_of

        table = up.project.erection
        assert table is not None
        lamellas = up.outputs["lamellas"].lamellas
        with keys("erection", lamellas="lamella"):
            made = erect(lamellas, states=table.states, elements=table.elements, progress=progress)
        with keys("erection", prestress="cables.prestress"):
            braced = spring_backs(
                lamellas,
                elements=table.elements,
                cables=cable_rules(up.project),
                edge_beams=edge_beams_of(up, lamellas),
                materials=up.project.known_materials(),
                progress=progress,
            )
        return replace(made, braced=braced)

    def result(self, figures: Mapping[str, Any], out: Erection) -> str:
        length, width = figures["flat"]["size"]
        return f"flat on {length:.3g} x {width:.3g} m, springs back by {figures['spring_back']:.3g} m"

    def warnings(self, out: Erection, up: Upstream, progress: Progress) -> Iterator[Message]:
        from lamella.erection.warnings import slot_warning, spring_back_warning

        yield from out.warnings
        yield from spring_back_warning(out)
        project = up.project
        given = project.fabrication.slot_width or (project.joint.slot_width if project.joint else None)
        yield from slot_warning(out, given or 2 * project.lamella.thickness)

    def files(self, out: Erection, up: Upstream) -> Iterator[File]:
        from lamella.erection.flat_drawing import write_flat
        from lamella.erection.path_csv import write_path
        from lamella.erection.states_json import write_states

        signed: Any = {"name": up.project.name, "version": __version__}
        origin = np.array(drawing_origin(up.surface), float)
        yield File("erection/states.json", lambda path: write_states(path, out, origin, **signed))
        yield File("erection/path.csv", lambda path: write_path(path, out, origin, **signed))
        yield File("erection/flat.dxf", lambda path: write_flat(path, out, **signed))
