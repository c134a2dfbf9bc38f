"""The stage "panels": plates on the diagonals of the net, their list and drawing."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from lamella import __version__
from lamella.base.drawing_origin import drawing_origin
from lamella.base.message import Message
from lamella.base.progress import Progress
from lamella.base.wording import counted
from lamella.files.write.drawn_layer import DrawnLayer
from lamella.project.tables import Project
from lamella.stages.keys import keys, with_keys
from lamella.stages.panels.figures import FIGURES, REPORT
from lamella.stages.stage import File, Missing, Stage, Upstream

if TYPE_CHECKING:
    from lamella.panels.panels import Panels
    from lamella.panels.rules import PanelRules
    from lamella.view.scene.scene import Shown

MM = 1000.0


class PanelsStage(Stage["Panels"]):
    """See `lamella.stages.stage.Stage`."""

    name = "panels"
    quantities = ("out_of_plane", "kink", "plate_area")
    needs = ("surface", "network")
    writes = (
        ("panels/panels.dxf", "where `[panels]` is given: the flat outline of each kind of plate"),
        ("panels.csv", "with it: a row for each plate"),
    )
    figures = FIGURES
    report = ("Panels", REPORT)

    def reads(self, project: Project, wanted: tuple[str, ...]) -> tuple[str, ...]:
        return ("panels", "lamella.height")

    def missing(self, project: Project) -> Missing | None:
        if project.panels is not None:
            return None
        reason = "the project has none"
        return Missing("a table [panels]", reason, "add a line [panels] to it", "panels", unasked=True)

    def heading(self, up: Upstream) -> str:
        return "plates, their kinds and outlines"

    def run(self, up: Upstream, progress: Progress) -> Panels:
        from lamella.panels.make_panels import make_panels

        with keys("panels", network="network", limit="panels.limit_mm"):
            return make_panels(up.outputs["network"].network, rules_of(up.project))

    def result(self, figures: Mapping[str, Any], out: Panels) -> str:
        return (
            f"{counted(figures['count'], 'plate')} of {counted(figures['different'], 'kind')}, "
            f"{figures['area']:.4g} m2, {figures['out_of_plane_max_mm']:.3g} mm out of plane at most"
        )

    def warnings(self, out: Panels, up: Upstream, progress: Progress) -> Iterator[Message]:
        yield from (with_keys(warning, "panels.gap") for warning in out.notes)

    def files(self, out: Panels, up: Upstream) -> Iterator[File]:
        from lamella.panels.drawing import write_panel_drawing
        from lamella.panels.lists import write_panels

        signed: Any = {"name": up.project.name, "version": __version__}
        origin = drawing_origin(up.surface)
        yield File("panels/panels.dxf", lambda path: write_panel_drawing(path, out, **signed))
        yield File("panels.csv", lambda path: write_panels(path, out, **signed, origin=origin))

    def model(self, out: Panels, up: Upstream) -> Iterator[DrawnLayer]:
        from lamella.panels.bodies import panel_layers

        yield from panel_layers(out)

    def scene(self, out: Panels, up: Upstream) -> Iterator[Shown]:
        from lamella.stages.panels.scene import panels_scene

        yield from panels_scene(out)


def rules_of(project: Project) -> PanelRules:
    """What the table [panels] asks for."""
    from lamella.panels.rules import PanelRules

    assert project.panels is not None
    table = project.panels.filled(project.lamella.height)
    assert table.offset is not None
    assert table.above_limit is not None
    return PanelRules(
        kind=table.kind,
        on=table.on,
        along=table.along,
        offset=table.offset,
        gap=table.gap,
        limit=table.limit_mm / MM,
        above_limit=table.above_limit,
    )
