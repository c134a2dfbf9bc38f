"""parts.xlsx: strips, hardware, sheets and totals as one workbook, the same bytes in every run."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from lamella.fabrication.part import Parts
from lamella.fabrication.schedule import COLUMNS as PART_COLUMNS
from lamella.fabrication.schedule import schedule_rows
from lamella.fabrication.sheet import Nesting
from lamella.files.whole import write_whole
from lamella.files.write.xlsx_pages import add_page, new_book
from lamella.hardware.item import Hardware
from lamella.hardware.lists import COLUMNS as HARDWARE_COLUMNS
from lamella.hardware.rules import MM
from lamella.network.network import Network
from lamella.strip.lamellas import Lamellas

CUT_PLAN = ("sheet", "length_mm", "width_mm", "part", "copy", "x_mm", "y_mm", "turned_deg")
TOTALS = ("what", "pieces", "different", "mass_kg")


@dataclass(frozen=True)
class Page:
    """A page of a workbook.

    Attributes
    ----------
    title : str
    header : sequence of str
    rows : sequence of sequence
        Numbers, and text that stands for numbers or not.
    """

    title: str
    header: Sequence[str]
    rows: Sequence[Sequence[object]]


def write_workbook(
    path: Path,
    parts: Parts,
    nesting: Nesting,
    network: Network,
    lamellas: Lamellas,
    hardware: Hardware,
    further: Iterable[Page] = (),
    *,
    name: str,
    version: str,
) -> None:
    """Write the workbook: pages "strips", "hardware", "cut plan" and "totals", and further ones.

    Parameters
    ----------
    path : Path
    parts : Parts
    nesting : Nesting
        Of those parts.
    network : Network
    lamellas : Lamellas
        Of that network.
    hardware : Hardware
    further : iterable of Page
    name, version : str
        Of the project and of the program.

    Raises
    ------
    OSError
        Where the file cannot be written whole.
    """
    rows = list(schedule_rows(parts, nesting, network, lamellas))
    book, content = new_book(name, version)
    items = ([column.value(item) for column in HARDWARE_COLUMNS] for item in hardware)
    add_page(book, "strips", [column.name for column in PART_COLUMNS], rows)
    add_page(book, "hardware", [column.name for column in HARDWARE_COLUMNS], items)
    add_page(book, "cut plan", CUT_PLAN, _cut_plan(parts, nesting))
    add_page(book, "totals", TOTALS, _totals(parts, rows, hardware))
    for page in further:
        add_page(book, page.title, page.header, page.rows)
    book.close()
    write_whole(path, content.getvalue())


def _cut_plan(parts: Parts, nesting: Nesting) -> Iterable[Sequence[object]]:
    order = sorted(range(len(nesting.parts)), key=lambda k: (int(nesting.sheets[k]), k))
    for k in order:
        sheet = int(nesting.sheets[k])
        length, width = (MM * float(size) for size in nesting.sizes[sheet])
        place = [round(MM * float(nesting.x[k]), 4), round(MM * float(nesting.y[k]), 4), float(nesting.rotations[k])]
        yield [sheet + 1, length, width, parts.parts[int(nesting.parts[k])].id, int(nesting.copies[k]), *place]


def _totals(parts: Parts, rows: Sequence[Sequence[object]], hardware: Hardware) -> Iterable[Sequence[object]]:
    same = [column.name for column in PART_COLUMNS].index("same_as")
    yield ["strips", parts.pieces, sum(not row[same] for row in rows), parts.mass]
    for kind in dict.fromkeys(item.kind for item in hardware):
        items = hardware.of(kind)
        mass = sum(item.quantity * item.mass for item in items)
        yield [kind, sum(item.quantity for item in items), len(items), mass]
    yield ["all", "", "", parts.mass + hardware.mass]
