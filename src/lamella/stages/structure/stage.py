"""The stage "structure": what the net does as a structure, let go and under loads."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

from lamella import __version__
from lamella.base.drawing_origin import drawing_origin
from lamella.base.errors import InputError
from lamella.base.message import Message
from lamella.base.progress import Progress
from lamella.base.wording import counted
from lamella.project.structure_tables import StructureTable
from lamella.project.tables import Project
from lamella.stages.keys import keys
from lamella.stages.stage import File, Missing, Stage, Upstream
from lamella.stages.structure.figures import FIGURES, REPORT
from lamella.stages.structure.output import StructureOutput
from lamella.surface.surface import Surface

if TYPE_CHECKING:
    from lamella.structure.analysis.analyse import Analysis
    from lamella.view.scene.scene import Shown


MOST_CHECKED = 20_000
"""Elements of lamellas times cases that are analysed in a few seconds."""


class StructureStage(Stage[StructureOutput]):
    """See `lamella.stages.stage.Stage`."""

    name = "structure"
    sliders = ("cases", "steps", "buckling", "swinging")
    quantities = ("case_use", "case_mises", "cable_force")
    needs = ("surface", "network", "lamellas", "fabrication")
    writes = (
        (
            "structure/results.json",
            "where `[structure]`, `[[support]]` or `[[load]]` is given: what each case does to every node",
        ),
        (
            "structure/nodes.csv, structure/elements.csv, structure/supports.csv, structure/cables.csv, "
            "structure/results.xlsx",
            "displacements, forces and stresses of all cases, and a workbook of the largest",
        ),
        ("structure/envelope.csv", "the smallest and the largest of all cases at every place of the strips"),
        (
            "structure/paths.csv, structure/failure.csv",
            "where `[structure.failure]` or `[structure.displacement]` is given: load factor and shift on the way, and "
            "the factors of yield, branch and limit point",
        ),
        ("structure/construction.csv", "where `structure.construction` is given: a row a stage"),
        (
            "structure/sensitivity.csv, structure/variants.csv",
            "where `[structure.sensitivity]` or `[[structure.variant]]` is given: the structure with other joints, "
            "supports or strips, or without some parts, beside the designed one",
        ),
        ("structure/curvatures.csv", "what the strips of each element were bent and twisted by"),
        ("structure/opensees.py", "the model as a script for OpenSees, where `structure.exports` names it"),
        ("structure/saf.xlsx", "the same as a workbook of the Structural Analysis Format"),
    )
    figures = FIGURES
    report = ("Structure", REPORT)

    def reads(self, project: Project, wanted: tuple[str, ...]) -> tuple[str, ...]:
        return ("structure", "support", "load", "combination", "joint", "cables", "edge_beam", "surface")

    def missing(self, project: Project) -> Missing | None:
        if project.structure is not None:
            return None
        reason = "the project has no table [structure], [[support]] or [[load]]"
        return Missing("a table of the project", reason, "add [structure]", "structure", unasked=True)

    def check(self, project: Project, surface: Surface[Any] | None) -> None:
        if project.load and not project.support:
            raise InputError(
                f"{counted(len(project.load), 'load')} and no support: nothing holds the structure",
                'add a table [[support]] with boundary = "rim", ground = 0.0 or near = [x, y, z]',
                "support",
            )
        if project.structure is not None:
            from lamella.stages.structure.asked_cases import check_asked_cases

            check_asked_cases(project)

    def takes_long(self, up: Upstream) -> str:
        from lamella.stages.actions_of_tables import combinations_of

        cases = 1 + len(up.project.load or ()) + len(combinations_of(up.project))
        elements = _elements(up)
        if cases * elements <= MOST_CHECKED:
            return ""
        return (
            f"what the structure does under {cases} cases: about {elements:,} elements, {_memory(elements, cases)} of "
            f"memory (checked up to {MOST_CHECKED:,} elements times cases)"
        )

    def heading(self, up: Upstream) -> str:
        from lamella.stages.actions_of_tables import combinations_of

        loads, elements = len(up.project.load or ()), _elements(up)
        memory = _memory(elements, 1 + loads + len(combinations_of(up.project)))
        return f"about {elements:,} elements, {counted(loads, 'load')}, up to {memory} of memory"

    def run(self, up: Upstream, progress: Progress) -> StructureOutput:
        from lamella.stages.actions_of_tables import actions_of
        from lamella.stages.structure.further_analyses import further_analyses
        from lamella.stages.structure.model_of_tables import model_of
        from lamella.structure.analysis.analyse import analyse

        project, network = up.project, up.outputs["network"].network
        actions = actions_of(project, network, up.surface)
        modelled = model_of(up, actions)
        table = project.structure or StructureTable()
        with keys("structure", supports="support", loads="load", prestress="cables.prestress"):
            analysis = analyse(
                modelled.model,
                modelled.cases,
                node_masses=modelled.node_masses,
                cables_later=modelled.cables_later,
                construction=modelled.construction,
                buckling=table.modes,
                frequencies=table.modes,
                steps=table.steps or 1,
                progress=progress,
            )
        return further_analyses(up, actions, analysis, progress)

    def result(self, figures: Mapping[str, Any], out: StructureOutput) -> str:
        return (
            f"{counted(len(figures['cases']), 'case')}, utilisation up to {figures['utilisation_max']:.2f}, "
            f"springs back by {1e3 * figures['spring_back']:.3g} mm"
        )

    def warnings(self, out: StructureOutput, up: Upstream, progress: Progress) -> Iterator[Message]:
        from lamella.stages.structure.export_remarks import export_remarks
        from lamella.stages.structure.warnings import structure_warnings

        for remark in export_remarks(up.project):
            progress(remark)
        yield from structure_warnings(out)

    def files(self, out: StructureOutput, up: Upstream) -> Iterator[File]:
        from lamella.stages.structure.results_file import write_results

        signed: Any = {"name": up.project.name, "version": __version__}
        yield File("structure/results.json", lambda path: write_results(path, out.analysis, **signed))
        placed = signed | {"origin": drawing_origin(up.surface)}
        yield from _exports(out, placed)
        yield from _for_programs(out.analysis, up.project, placed)

    def scene(self, out: StructureOutput, up: Upstream) -> Iterator[Shown]:
        from lamella.stages.structure.frames import structure_frames
        from lamella.stages.structure.scene import supports_scene

        yield from supports_scene(out.analysis.model)
        yield from structure_frames(out.analysis)


def _elements(up: Upstream) -> int:
    """About how many elements lamellas have."""
    table = up.project.structure or StructureTable()
    lines = up.project.lamella.layers if table.layers == "each" else 1
    return table.elements * len(up.outputs["network"].network.cell_edges) * lines


def _memory(elements: int, cases: int) -> str:
    from lamella.structure.analysis.size import structure_memory

    return f"{structure_memory(elements, cases):.2g} GB"


def _exports(out: StructureOutput, signed: Any) -> Iterator[File]:
    """Tables."""
    from lamella.structure.export.further_tables import FurtherTables, write_page
    from lamella.structure.export.imposed_curvatures import write_imposed_curvatures
    from lamella.structure.export.result_tables import CSV_TABLES, write_result_book, write_result_table

    model, cases = out.analysis.model, out.analysis.cases
    further = FurtherTables(out.analysis, out.failures, out.driven, out.sensitivity, out.variants)
    plain = {key: value for key, value in signed.items() if key != "origin"}
    for table in CSV_TABLES:
        yield File(f"structure/{table}.csv", partial(write_result_table, table=table, cases=cases, **signed))
    for page in further.files():
        yield File(f"structure/{page[0]}.csv", partial(write_page, page=page, **plain))
    yield File("structure/results.xlsx", lambda path: write_result_book(path, cases, further.pages(), **signed))
    yield File("structure/curvatures.csv", lambda path: write_imposed_curvatures(path, model, **signed))


def _for_programs(analysis: Analysis, project: Project, signed: Any) -> Iterator[File]:
    """The model in the formats of other programs, those that are asked for."""
    from lamella.stages.actions_of_tables import combinations_of
    from lamella.structure.export.opensees import write_opensees
    from lamella.structure.export.saf.workbook import write_saf

    exports = (project.structure or StructureTable()).exports
    if "opensees" in exports:
        yield File("structure/opensees.py", lambda path: write_opensees(path, analysis, **signed))
    if "saf" in exports:
        acting = {load.name: load.acts_as for load in project.load or ()}
        combinations = combinations_of(project)
        yield File("structure/saf.xlsx", lambda path: write_saf(path, analysis, acting, combinations, **signed))
