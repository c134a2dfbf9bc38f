"""The stage "erection": the flat state of a net, and its way to the designed shape."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from lamella import __version__
from lamella.base.drawing_origin import drawing_origin
from lamella.base.message import Message
from lamella.base.progress import Progress
from lamella.base.wording import counted
from lamella.files.whole import write_whole
from lamella.project.drawings_table import DrawingsTable
from lamella.project.tables import Project
from lamella.stages.erection.figures import FIGURES, REPORT
from lamella.stages.stage import File, Missing, Stage, Upstream

if TYPE_CHECKING:
    from lamella.erection.erection import Erection
    from lamella.stages.erection.output import ErectionOutput
    from lamella.view.scene.scene import Shown


# of states.json, for a sample or a node in a state, and from which size on it is told before
STATE_BYTES, TOLD_BYTES = 76, 100e6


class ErectionStage(Stage["ErectionOutput"]):
    """See `lamella.stages.stage.Stage`."""

    name = "erection"
    sliders = ("erection",)
    quantities = ("joint_turn",)
    needs = ("surface", "network", "lamellas", "fabrication")
    writes = (
        (
            "erection/states.json",
            "nodes, lamellas, joint angles, energy and driver of every state; where `[segments]` is given in a folder "
            "of each segment, as the next two",
        ),
        ("erection/path.csv, erection/polylines.csv", "places of all nodes in every state, and in few for FE programs"),
        ("erection/flat.dxf", "assembly drawing of the flat state"),
        ("erection/flat.pdf", "the same on paper, with the order of threading, a plan for each segment"),
        ("erection/forces.csv", "forces of a driver on site in every state, where there is one"),
        (
            "erection/lifting.csv",
            "where `erection.lifting` is given: deflections, stresses, slings in the crane",
        ),
    )
    figures = FIGURES
    report = ("Erection", REPORT)

    def reads(self, project: Project, wanted: tuple[str, ...]) -> tuple[str, ...]:
        return ("erection", "joint", "cables", "edge_beam", "materials", "segments", "surface", "drawings")

    def warned_by(self, project: Project) -> tuple[str, ...]:
        return ("fabrication", "joint")

    def missing(self, project: Project) -> Missing | None:
        if project.erection is not None:
            return None
        reason = "the project has none"
        return Missing("a table [erection]", reason, "add a line [erection] to it", "erection", unasked=True)

    def takes_long(self, up: Upstream) -> str:
        from lamella.stages.fabrication.slot_widths import MOST_CHECKED_STATES, way_takes_long

        if not way_takes_long(up):
            return ""
        return f"how the net lies flat and is erected (checked up to {MOST_CHECKED_STATES:,} elements times states)"

    def heading(self, up: Upstream) -> str:
        table = up.project.erection
        assert table is not None
        network = up.outputs["network"].network
        size = table.states * STATE_BYTES * (len(network.sample_points) + len(network.node_points))
        told = f"; states.json takes about {size / 1e6:.2g} MB" if size > TOLD_BYTES else ""
        return f"laid flat, and driven to the designed shape{told}"

    def run(self, up: Upstream, progress: Progress) -> ErectionOutput:
        from lamella.stages.erection.erecting import erected

        return erected(up, progress)

    def result(self, figures: Mapping[str, Any], out: ErectionOutput) -> str:
        length, width = figures["flat"]["size"]
        pieces = f"{counted(len(out.segments), 'segment')}, the largest " if out.divided else ""
        return f"{pieces}flat on {length:.3g} x {width:.3g} m, springs back by {figures['spring_back']:.3g} m"

    def warnings(self, out: ErectionOutput, up: Upstream, progress: Progress) -> Iterator[Message]:
        from lamella.erection.warnings import cut_warning, lifting_warnings, slot_warning, spring_back_warning

        project = up.project
        slot = project.fabrication.slot_width or (project.joint.slot_width if project.joint else None)
        # what goes back farthest stands for all
        springiest = max(out.made, key=lambda made: made.spring_back)
        for one in out.segments:
            if one.made is None:
                yield Message("segment_not_erected", f"segment {one.id}: {one.fault}")
                continue
            said = [
                *one.made.warnings,
                *cut_warning(one.cut),
                *slot_warning(one.made, slot or 2 * project.lamella.thickness),
            ]
            if one.made is springiest:
                said += spring_back_warning(one.made)
            for message in said:
                yield Message(message.key, f"segment {one.id}: {message}") if one.id else message
        yield from lifting_warnings({one.id: one.lifts for one in out.segments})

    def files(self, out: ErectionOutput, up: Upstream) -> Iterator[File]:
        from lamella.erection.flat_drawing import write_flat
        from lamella.erection.forces_csv import write_forces
        from lamella.erection.lifting_csv import write_lifting
        from lamella.erection.path_csv import write_path
        from lamella.erection.polylines_csv import write_polylines
        from lamella.erection.states_json import write_states

        signed: Any = {"name": up.project.name, "version": __version__}
        origin = np.array(drawing_origin(up.surface), float)
        if any(one.lifts for one in out.segments):
            lifts = [(one.id, one.lifts) for one in out.segments]
            yield File("erection/lifting.csv", partial(write_lifting, lifts=lifts, **signed))
        laid = [(one.id, one.made) for one in out.segments if one.made is not None and one.made.laid]
        if laid:
            yield File("erection/flat.pdf", lambda path: write_whole(path, self._pdf(laid, up, signed)))
        for one in out.segments:
            if one.made is None:
                continue
            folder = f"erection/{one.id}/" if one.id else "erection/"
            yield File(f"{folder}states.json", partial(write_states, erection=one.made, origin=origin, **signed))
            yield File(f"{folder}path.csv", partial(write_path, erection=one.made, origin=origin, **signed))
            yield File(f"{folder}polylines.csv", partial(write_polylines, erection=one.made, origin=origin, **signed))
            if one.made.laid:
                yield File(f"{folder}flat.dxf", partial(write_flat, erection=one.made, **signed))
            if one.made.way is not None and len(one.made.way.nodes):
                yield File(f"{folder}forces.csv", partial(write_forces, erection=one.made, **signed))

    def _pdf(self, laid: list[tuple[str, Erection]], up: Upstream, signed: dict[str, str]) -> bytes:
        from lamella.erection.flat_sheets import flat_pdf

        project = up.project
        drawings = project.drawings or DrawingsTable()
        return flat_pdf(
            laid, material=project.lamella.material, paper=drawings.paper, language=drawings.language, **signed
        )

    def scene(self, out: ErectionOutput, up: Upstream) -> Iterator[Shown]:
        from lamella.stages.erection.scene import erection_scene

        yield from erection_scene(out)
