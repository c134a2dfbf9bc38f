"""The parts list: strips and hardware with their number and mass."""

from __future__ import annotations

from collections.abc import Iterator

from lamella.drawings.built import Built
from lamella.drawings.page import Page
from lamella.drawings.paper import Paper
from lamella.drawings.strip_sheets import different_strips
from lamella.drawings.table import table_pages
from lamella.drawings.terms import Terms

WIDTHS = (34.0, 36.0, 10.0, 6.0, 7.0, 7.0)
"""Columns, as shares of the sheet."""
COLUMNS = ("id", "description", "material", "quantity", "mass_each", "mass_all")


def list_pages(built: Built, paper: Paper, words: Terms) -> Iterator[Page]:
    """Strips that are cut alike in one row, then the hardware, then the sum."""
    rows = [*_strips(built, words), *_hardware(built, words)]
    total = built.parts.mass + built.hardware.mass
    rows.append((words("sum"), "", "", "", "", words.number(total, 1)))
    yield from table_pages(words("parts_list"), paper, tuple(words(key) for key in COLUMNS), rows, WIDTHS)


def _strips(built: Built, words: Terms) -> Iterator[tuple[str, ...]]:
    parts = built.parts.parts
    for first, same in different_strips(built.parts).items():
        part, count = parts[first], sum(parts[k].quantity for k in same)
        text = words(
            "strip_described",
            height=words.mm(part.height),
            thickness=words.mm(part.thickness),
            length=words.mm(part.length),
            slots=len(part.slots),
        )
        ids = ", ".join(parts[k].label for k in same)
        yield ids, text, built.material, *_numbers(words, count, part.mass)


def _hardware(built: Built, words: Terms) -> Iterator[tuple[str, ...]]:
    for item in built.hardware:
        text = words.description(item.description)
        yield item.id, text, item.material, *_numbers(words, item.quantity, item.mass)


def _numbers(words: Terms, count: int, mass: float) -> tuple[str, str, str]:
    return str(count), words.number(mass, 3), words.number(count * mass, 2)
