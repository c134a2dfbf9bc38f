"""Results of load cases: .csv tables, and a workbook of what is looked at first."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from lamella.base.drawing_origin import NOWHERE, Origin
from lamella.files.whole import write_whole
from lamella.files.write.table import write_table
from lamella.files.write.xlsx_pages import add_page, new_book
from lamella.structure.analysis.case_result import CaseResult
from lamella.structure.export import result_rows as rows
from lamella.structure.export.further_tables import Page

CSV_TABLES: dict[str, tuple[tuple[str, ...], Callable[[CaseResult, Origin], Iterable[rows.Row]]]] = {
    "nodes": (rows.NODES, lambda case, origin: rows.node_rows(case)),
    "elements": (rows.ELEMENTS, lambda case, origin: rows.element_rows(case)),
    "supports": (rows.SUPPORTS, rows.support_rows),
    "cables": (rows.CABLES, lambda case, origin: rows.cable_rows(case)),
}
"""Header and rows by the table's name."""

CASES = (
    *("case", "reached", "load_factor", "stable", "displacement_mm", "deflection_mm", "von_mises_MPa", "utilisation"),
    *("residual_share", "buckling_factor", "cable_force_max_N", "cables_slack"),
)


def write_result_table(
    path: Path, table: str, cases: Sequence[CaseResult], *, name: str, version: str, origin: Origin = NOWHERE
) -> None:
    """Write one of `CSV_TABLES` of all cases, places as the drawing has them whose `origin` is measured from.

    Raises
    ------
    OSError
        Where the file cannot be written whole.
    """
    header, of = CSV_TABLES[table]
    write_table(path, header, (row for case in cases for row in of(case, origin)), name=name, version=version)


def write_result_book(
    path: Path,
    cases: Sequence[CaseResult],
    pages: Iterable[Page] = (),
    *,
    name: str,
    version: str,
    origin: Origin = NOWHERE,
) -> None:
    """Write the workbook: cases, the most stressed places, lamellas, supports, cables; see `write_result_table`.

    Parameters
    ----------
    path : Path
    cases : sequence of CaseResult
    pages : iterable of Page
        Further ones, after these.
    name, version, origin
        Of the run.

    Raises
    ------
    OSError
        Where the file cannot be written whole.
    """
    book, content = new_book(name, version)
    add_page(book, "cases", CASES, map(_case, cases))
    add_page(book, "most stressed", rows.STRESSED, rows.stressed_rows(cases, origin=origin))
    add_page(book, "lamellas", rows.LAMELLAS, (row for case in cases for row in rows.lamella_rows(case)))
    for title in ("supports", "cables"):
        header, of = CSV_TABLES[title]
        add_page(book, title, header, (row for case in cases for row in of(case, origin)))
    for page in pages:
        add_page(book, *page)
    book.close()
    write_whole(path, content.getvalue())


def _case(case: CaseResult) -> rows.Row:
    return (
        case.name,
        "yes" if case.converged else "no",
        f"{case.load_factor:.6g}",
        "yes" if case.stable else "no",
        f"{rows.MM * case.displacement_max:.6g}",
        f"{rows.MM * case.deflection_max:.6g}",
        f"{rows.MPA * case.von_mises_max:.6g}",
        f"{case.utilisation_max:.6g}",
        f"{case.residual_share:.6g}",
        f"{float(case.buckling[0]):.6g}" if len(case.buckling) else "",
        f"{float(case.cable_forces.max(initial=0.0)):.6g}",
        case.slack,
    )
