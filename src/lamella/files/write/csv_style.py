"""CSV files in another style: what stands between columns, and the decimal sign."""

from __future__ import annotations

import csv
import re
from io import StringIO
from pathlib import Path

from lamella.files.whole import write_whole

_NUMBER = re.compile(r"[-+]?\d+\.\d+(?:[eE][-+]?\d+)?|[-+]?\d+[eE][-+]?\d+")
_SEVERAL = re.compile("[; ]")


def restyle(path: Path, separator: str, decimal: str) -> None:
    """Write a file anew with another separator and decimal sign.

    Comment lines stay as they are. A cell is a number, or several with ";" or spaces between, where nothing else stands
    in it: ids and names keep their full stops.

    Parameters
    ----------
    path : Path
        With commas between columns and full stops in numbers.
    separator, decimal : str

    Raises
    ------
    OSError
        Where the file cannot be written whole.
    """
    lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
    comments = [line for line in lines if line.startswith("#")]
    rows = csv.reader(line for line in lines if not line.startswith("#"))
    text = StringIO()
    writer = csv.writer(text, delimiter=separator, lineterminator="\n")
    writer.writerows([_cell(cell, decimal) for cell in row] for row in rows)
    write_whole(path, ("".join(comments) + text.getvalue()).encode())


def _cell(cell: str, decimal: str) -> str:
    if decimal == "." or not all(_NUMBER.fullmatch(one) or one.lstrip("-").isdigit() for one in _SEVERAL.split(cell)):
        return cell
    return cell.replace(".", decimal)
