"""Numbers as text: whole arrays at once, in full double precision."""

from __future__ import annotations

import numpy as np
import orjson
from numpy.typing import NDArray

from lamella.base.arrays import Floats
from lamella.base.wording import one_line


def csv_comment(text: str) -> str:
    """Text for a comment line of a table: no character that a spreadsheet takes for the end of a cell.

    What follows one would be a cell of its own, and a formula if it begins like one.
    """
    return one_line("".join(" " if c in ',;|"' else c for c in one_line(text)))


def require_finite(*arrays: Floats) -> None:
    """Raise ValueError where a number to be written is not finite: no format here can hold it."""
    for array in arrays:
        if not np.isfinite(array).all():
            row = int(np.argwhere(~np.isfinite(array))[0][0])
            raise ValueError(f"row {row} holds a number that is not finite: {array[row]}")


def dumped(array: NDArray[np.generic]) -> bytes:
    """Return an array as JSON: the shortest digits that read back as the same double."""
    return orjson.dumps(np.ascontiguousarray(array), option=orjson.OPT_SERIALIZE_NUMPY)


def rows(array: NDArray[np.generic], head: bytes = b"", between: bytes = b" ") -> bytes:
    """Return a table of numbers as lines of text.

    Parameters
    ----------
    array : (n, d)
        Finite numbers.
    head, between : bytes
        Written in front of each line, and between its numbers.

    Returns
    -------
    bytes
        n lines, each with its line end.
    """
    if not len(array):
        return b""
    inner = dumped(array)[2:-2].replace(b"],[", b"\n" + head)
    return head + inner.replace(b",", between) + b"\n"
