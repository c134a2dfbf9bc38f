"""Rows of numbers as Python writes them, for scripts that hold a structure."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from lamella.base.arrays import Floats


def rounded(values: ArrayLike) -> Floats:
    """Numbers without digits that differ between processors."""
    return np.asarray(np.round(np.asarray(values, float), 12) + 0.0)


def listed(*columns: ArrayLike) -> list[tuple[object, ...]]:
    """Rows of columns; those of several numbers become tuples, but for the first."""
    parts: list[list[object]] = []
    first, *others = (np.asarray(column) for column in columns)
    rows = first.tolist() if first.ndim > 1 else [[value] for value in first.tolist()]
    for column in others:
        parts.append([tuple(row) if isinstance(row, list) else row for row in column.tolist()])
    return [(*row, *rest) for row, *rest in zip(rows, *parts, strict=True)]


def table(name: str, rows: list[tuple[object, ...]]) -> str:
    """A list of a script, a row a line."""
    return f"{name} = [\n" + "".join(f"    {text(row)},\n" for row in rows) + "]\n"


def text(value: object) -> str:
    """A number, a name, a tuple or a list of them."""
    if isinstance(value, float):
        return f"{value:.10g}"
    if isinstance(value, tuple | list):
        inside = ", ".join(text(one) for one in value)
        if isinstance(value, list):
            return f"[{inside}]"
        return f"({inside},)" if len(value) == 1 else f"({inside})"
    return repr(value)
