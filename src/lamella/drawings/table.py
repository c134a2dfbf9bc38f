"""Tables on sheets."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from lamella.drawings.page import NOTE_EM, TEXT_EM, Page, shortened
from lamella.drawings.paper import Paper

TABLE_ROW = 5.0
"""mm: height of a row."""


def table_pages(
    title: str, paper: Paper, head: Sequence[str], rows: Sequence[Sequence[str]], widths: Sequence[float]
) -> Iterator[Page]:
    """A table over as many sheets as it needs.

    Parameters
    ----------
    title : str
    paper : Paper
    head : sequence of str
    rows : sequence of sequences of str
        Columns of numbers stand at the right.
    widths : sequence of float
        Shares of the sheet's width.
    """
    left, low, right, high = paper.room
    total = sum(widths)
    columns = [(right - left) * width / total for width in widths]
    held = max(int((high - low) / TABLE_ROW) - 1, 1)
    for start in range(0, max(len(rows), 1), held):
        page = Page(title)
        draw_table(page, left, high, columns, head, rows[start : start + held])
        yield page


def draw_table(
    page: Page, left: float, top: float, columns: Sequence[float], head: Sequence[str], rows: Sequence[Sequence[str]]
) -> None:
    """A table whose upper left corner is given, mm."""
    right = left + sum(columns)
    numeric = [
        all(_is_number(row[k]) for row in rows if row[k]) and any(row[k] for row in rows) for k in range(len(head))
    ]
    for number, row in enumerate((head, *rows)):
        low = top - TABLE_ROW * (number + 1)
        x = left
        size, bold = (NOTE_EM, False) if number else (TEXT_EM, True)
        for text, width, right_hand in zip(row, columns, numeric, strict=True):
            shown = shortened(text, width - 2, size, bold)
            if right_hand:
                page.label(shown, x + width - 1.5, low + 1.5, size, anchor="end", bold=bold)
            else:
                page.label(shown, x + 0.5, low + 1.5, size, bold=bold)
            x += width
        page.line([(left, low), (right, low)], "fine" if number else "medium")


def _is_number(text: str) -> bool:
    """Whether a text is a whole or a decimal number."""
    return text.replace(",", "").replace(".", "").isdigit()
