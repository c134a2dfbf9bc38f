"""The workbook of a net's model in the Structural Analysis Format."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

import xlsxwriter

from lamella.base.drawing_origin import NOWHERE, Origin, measured_from
from lamella.base.wording import one_line
from lamella.files.whole import write_whole
from lamella.files.write.xlsx_pages import new_book
from lamella.structure.actions.combinations import PERMANENT, Combination
from lamella.structure.analysis.analyse import Analysis
from lamella.structure.export.saf import load_sheets, model_sheets
from lamella.structure.export.saf.columns import COLUMNS, VERSION
from lamella.structure.export.saf.load_sheets import Case
from lamella.structure.export.straight_model import StraightModel, straight_loads, straight_model
from lamella.structure.model.case_loads import case_loads

ABSENT = (
    "Not in SAF, and so not in this file: the twist of strips and its stresses, the helix effect, the play of joints."
)
"""What the description of the model says."""


def write_saf(
    path: Path,
    analysis: Analysis,
    categories: Mapping[str, str],
    combinations: Sequence[Combination],
    *,
    name: str,
    version: str,
    origin: Origin = NOWHERE,
) -> None:
    """Write the workbook.

    Parameters
    ----------
    path : Path
    analysis : Analysis
    categories : mapping
        Category of EN 1990 of each load by its name; permanent where none is given.
    combinations : sequence of Combination
        Of these loads.
    name, version : str
        Of the project and of the program.
    origin : Origin
        Point of the drawing that the model is measured from, which the description says.

    Raises
    ------
    OSError
        Where the file cannot be written whole.
    """
    model = straight_model(analysis.model)
    combined = {one.name for one in combinations}
    cases = [
        Case(
            case.name,
            categories.get(case.name, PERMANENT),
            straight_loads(analysis.model, model, case_loads(analysis.model, case, analysis.node_masses)),
        )
        for case in analysis.loads
        if case.name not in combined
    ]
    book, content = new_book(name, version)
    about = ABSENT + (f" {measured_from(origin)}" if any(origin) else "")
    for title, properties in _project(one_line(name), version, about).items():
        _write(book, title, properties)
    for title, header, rows in _sheets(model, cases, combinations):
        first = next(rows, None)
        if first is not None:
            _write(book, title, _with(header, first, rows))
    book.close()
    write_whole(path, content.getvalue())


def _with(header: tuple[str, ...], first: Sequence[object], rows: Iterable[Sequence[object]]) -> Iterator[object]:
    yield header
    yield first
    yield from rows


def _sheets(
    model: StraightModel, cases: Sequence[Case], combinations: Sequence[Combination]
) -> Iterator[tuple[str, tuple[str, ...], Iterator[Sequence[object]]]]:
    """Title, header and rows of all sheets."""
    made: dict[str, Iterable[Sequence[object]]] = {
        "StructuralMaterial": model_sheets.material_rows(model),
        "StructuralCrossSection": model_sheets.section_rows(model),
        "StructuralPointConnection": model_sheets.node_rows(model),
        "StructuralCurveMember": model_sheets.member_rows(model),
        "StructuralPointSupport": model_sheets.support_rows(model),
        "RelConnectsStructuralMember": model_sheets.hinge_rows(model),
        "RelConnectsRigidCross": model_sheets.cross_rows(model),
        "RelConnectsRigidLink": model_sheets.link_rows(model),
        "StructuralLoadGroup": load_sheets.group_rows(cases),
        "StructuralLoadCase": load_sheets.case_rows(cases),
        "StructuralLoadCombination": load_sheets.combination_rows(combinations),
        "StructuralPointAction": load_sheets.force_rows(cases),
        "StructuralPointMoment": load_sheets.moment_rows(cases),
        "StructuralCurveAction": load_sheets.line_rows(model, cases),
        "StructuralCurveActionThermal": load_sheets.thermal_rows(model, cases),
        "StructuralPointSupportDef": load_sheets.settlement_rows(cases),
    }
    for title, header in COLUMNS.items():
        more = load_sheets.combination_header(combinations) if title == "StructuralLoadCombination" else ()
        yield title, (*header, *more), iter(made[title])


def _project(name: str, version: str, about: str) -> dict[str, list[Sequence[object]]]:
    """Sheets "Project" and "Model", whose rows are what other sheets have as columns."""
    model: list[Sequence[object]] = [
        ("Name", name),
        ("Description", about),
        ("Discipline", "Load-bearing structure"),
        ("Source type", "Structural analysis model"),
        ("Source application", f"lamella {version}"),
        ("SAF Version", VERSION),
        ("Global coordinate system", "Z vertical"),
        ("LCS of cross-section", "ZYX"),
        ("System of units", "Metric"),
        ("National code", "EC-Standard-EN"),
    ]
    return {"Project": [("Name", name)], "Model": model}


def _write(book: xlsxwriter.Workbook, title: str, rows: Iterable[object]) -> None:
    """A sheet: numbers as numbers, texts as texts, nothing as an empty cell."""
    page = book.add_worksheet(title)
    for k, row in enumerate(rows):
        for column, value in enumerate(row):  # type: ignore[arg-type,var-annotated]
            if isinstance(value, str):
                page.write_string(k, column, value)
            elif value is not None:
                page.write_number(k, column, value)
