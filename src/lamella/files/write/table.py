"""Tables of text with columns that are declared once, for the file and for its documentation."""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Generic, TypeVar

from lamella.files.write.text import csv_comment

Of = TypeVar("Of")


@dataclass(frozen=True)
class Column(Generic[Of]):
    """A column of a table.

    Attributes
    ----------
    name : str
        With its unit.
    meaning : str
        For the documentation, Markdown.
    value : callable
        What stands in a row.
    """

    name: str
    meaning: str
    value: Callable[[Of], object]


def write_table(
    path: Path, header: Sequence[str], rows: Iterable[Sequence[object]], *, name: str, version: str
) -> None:
    """Write a CSV table: a comment with version and project, the header, a line a row.

    Raises
    ------
    OSError
        Where the file cannot be written whole.
    """
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        file.write(f"# lamella {csv_comment(version)} · project {csv_comment(name)}\n")
        writer.writerow(header)
        writer.writerows(rows)
