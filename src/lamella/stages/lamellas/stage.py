"""The stage "lamellas": strips, their stresses, and the node marks on the flat strips."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

from lamella import __version__
from lamella.base.drawing_origin import drawing_origin
from lamella.base.message import Message
from lamella.base.progress import Progress, Report
from lamella.fabrication.defaults import default_slot_width
from lamella.files.write.drawn_layer import DrawnLayer
from lamella.project.tables import Project
from lamella.stages.drawn import in_drawing
from lamella.stages.keys import keys
from lamella.stages.lamellas.developable import developable_warnings
from lamella.stages.lamellas.figures import FIGURES, REPORT
from lamella.stages.lamellas.optimising import optimised_layers, optimised_strips
from lamella.stages.lamellas.output import LamellasOutput
from lamella.stages.lamellas.warnings import lamella_warnings, layer_warnings
from lamella.stages.pattern_of_table import pattern_of
from lamella.stages.section_of_table import section_of
from lamella.stages.stage import File, Missing, Stage, Upstream
from lamella.stages.surface.surface_of_table import make_surface
from lamella.strip.developable_strips import developable_strips
from lamella.strip.lamellas import Lamellas, largest_utilisation, make_lamellas
from lamella.strip.layer_curves import check_layer_curves
from lamella.strip.sizing import largest_measures
from lamella.surface.surface import Surface

if TYPE_CHECKING:
    from lamella.view.scene.scene import Shown


class LamellasStage(Stage[LamellasOutput]):
    """See `lamella.stages.stage.Stage`."""

    name = "lamellas"
    quantities = (
        "utilisation",
        "mises",
        "layers",
        "planarity",
        "limit",
        "limit_thickness",
        "limit_height",
        "developable_stress",
    )
    needs = ("surface", "network")
    writes = (
        ("lamellas.json", "curvatures and stresses along every lamella, node marks of the flat strips"),
        ("developable.csv", 'where `lamella.strips = "developable"`: the rulings of developable strips'),
        ("sizing.csv", "where `[sizing]` is given: how thick, high and far apart the strips of each lamella may be"),
    )
    figures = FIGURES
    report = ("Lamellas", REPORT)

    def reads(self, project: Project, wanted: tuple[str, ...]) -> tuple[str, ...]:
        return ("lamella", "materials", "sizing", "joint")

    def warned_by(self, project: Project) -> tuple[str, ...]:
        return ("fabrication",)

    def missing(self, project: Project) -> Missing | None:
        reason = pattern_of(project.network).no_strips
        if not reason:
            return None
        return Missing("a net of lamellas", reason, 'write --until network, or kind = "lamellas"', "network.kind")

    def check(self, project: Project, surface: Surface[Any] | None) -> None:
        strip = project.lamella
        if surface is not None and strip.layers > 1 and strip.layer_curves == "lamella":
            with keys("lamella", section="lamella"):
                check_layer_curves(surface, pattern_of(project.network))

    def heading(self, up: Upstream) -> str:
        strip = up.project.lamella
        return f"{strip.height * 1000:g} x {strip.thickness * 1000:g} mm, {strip.material}"

    def run(self, up: Upstream, progress: Progress) -> LamellasOutput:
        net = up.outputs["network"]
        with keys("lamella", section="lamella", network="network"):
            lamellas = strips_of(up.project, up.surface)(net.network)
        developable, optimised = None, None
        if up.project.lamella.strips == "developable":
            developable = developable_strips(lamellas)
            optimised = optimised_strips(lamellas, developable, up.surface, progress)
        table, material = up.project.sizing, up.project.material()
        sizing = None
        if table is not None:
            progress(Report.step("largest measures that stay elastic"))
            sizing = largest_measures(lamellas.network, lamellas.section, material, table.safety)
        named = up.project.lamella.material, material
        return LamellasOutput(lamellas.network, lamellas, *named, net.made, developable, optimised, sizing)

    def result(self, figures: Mapping[str, Any], out: LamellasOutput) -> str:
        return f"{figures['total_length']:.4g} m of lamella, utilisation up to {figures['utilisation_max']:.2f}"

    def warnings(self, out: LamellasOutput, up: Upstream, progress: Progress) -> Iterator[Message]:
        project, network = up.project, out.network
        advice = None
        if out.made:
            from lamella.stages.lamellas.corner_search import corner_help

            make = partial(make_surface, folder=up.folder)
            advice = corner_help(out.made, out.lamellas.utilisation, project, make, progress)
        yield from lamella_warnings(
            up.outputs["surface"].mesh,
            network,
            out.lamellas,
            project.fabrication.slot_width or default_slot_width(project.lamella.thickness),
            out.material,
            project.known_materials(),
            lambda other, of: largest_utilisation(network, other, of),
            advice,
        )
        yield from layer_warnings(network, out.lamellas, out.material)
        yield from developable_warnings(out)

    def files(self, out: LamellasOutput, up: Upstream) -> Iterator[File]:
        from lamella.files.write.lamellas_json import write_lamellas

        network = in_drawing(out.network, drawing_origin(up.surface))
        signed: Any = {"name": up.project.name, "version": __version__}
        yield File("lamellas.json", lambda path: write_lamellas(path, network, out.lamellas, **signed))
        if out.developable is not None:
            from lamella.files.write.developable_csv import write_developable

            made = out.developable
            yield File("developable.csv", lambda path: write_developable(path, network, out.lamellas, made, **signed))
        if out.sizing is not None:
            from lamella.files.write.sizing_csv import write_sizing

            sizing = out.sizing
            yield File("sizing.csv", lambda path: write_sizing(path, sizing, network, out.lamellas, **signed))

    def scene(self, out: LamellasOutput, up: Upstream) -> Iterator[Shown]:
        from lamella.stages.lamellas.marks import lamella_marks
        from lamella.stages.lamellas.scene import lamellas_scene

        yield from lamellas_scene(out.lamellas, out.sizing)
        yield from lamella_marks(out.lamellas)
        if out.developable is not None:
            from lamella.stages.lamellas.developable_model import developable_scene

            yield from developable_scene(out.lamellas, out.developable)

    def model(self, out: LamellasOutput, up: Upstream) -> Iterator[DrawnLayer]:
        if out.developable is not None:
            from lamella.stages.lamellas.developable_model import developable_layers

            yield from developable_layers(out.lamellas, out.developable)
        if out.optimised is not None:
            yield from optimised_layers(out.optimised)


def strips_of(project: Project, surface: Surface[Any]) -> partial[Lamellas]:
    """How a project makes strips of a net on a surface; section and material can be replaced."""
    return partial(make_lamellas, section=section_of(project), material=project.material(), surface=surface)
