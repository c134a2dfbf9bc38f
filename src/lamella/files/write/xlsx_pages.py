"""Workbooks of tables, the same bytes in every run."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from datetime import UTC, datetime
from io import BytesIO

import xlsxwriter

from lamella.base.wording import one_line

NOON = datetime(2000, 1, 1, 12, tzinfo=UTC).replace(tzinfo=None)
"""When a workbook says it was made: the time of a run would make equal ones differ."""

CHARACTERS = 60
"""Widest column."""


def new_book(name: str, version: str) -> tuple[xlsxwriter.Workbook, BytesIO]:
    """An empty workbook of a project (name) by a version of the program, and its bytes once it is closed."""
    content = BytesIO()
    book = xlsxwriter.Workbook(content, {"in_memory": True})
    book.set_properties({"title": one_line(name), "comments": f"lamella {one_line(version)}", "created": NOON})
    return book, content


def add_page(book: xlsxwriter.Workbook, title: str, header: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    """Add a page: a bold header that stays, numbers as numbers, columns as wide as what is in them."""
    page = book.add_worksheet(title)
    bold = book.add_format({"bold": True})
    page.write_row(0, 0, header, bold)
    page.freeze_panes(1, 1)
    width = [len(text) for text in header]
    for k, row in enumerate(rows):
        for column, value in enumerate(row):
            number = _number(value)
            if value == "":
                continue
            if number is None:
                page.write_string(k + 1, column, str(value))
            else:
                page.write_number(k + 1, column, number)
            width[column] = min(max(width[column], len(str(value))), CHARACTERS)
    for column, characters in enumerate(width):
        page.set_column(column, column, characters + 1)


def _number(value: object) -> float | None:
    """A number that stands in a cell; None for text."""
    if isinstance(value, int | float):
        return value
    text = str(value)
    # ids such as "1E5" are text: numbers begin with a digit or a sign and have no letter but an exponent's
    if not text or text[0] not in "-0123456789" or any(c.isalpha() and c != "e" for c in text):
        return None
    try:
        return float(text)
    except ValueError:
        return None
