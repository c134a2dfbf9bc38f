"""Values in messages: short, whatever was given."""

from __future__ import annotations

import math
from datetime import date, datetime, time
from typing import Any


def readable(text: str) -> str:
    """Text for a terminal: control characters, and those that turn the direction of writing, as question marks.

    Line breaks stay, and so do bytes of a file name that are no text: streams write them as escapes.
    """
    return "".join(c if c.isprintable() or c == "\n" or is_byte(c) else "?" for c in text)


def is_byte(character: str) -> bool:
    """Whether a character stands for a byte of a file name that is no text."""
    return "\ud800" <= character <= "\udfff"


def one_line(text: str) -> str:
    """Text for a field of a file: on one line, without control characters and those that turn the direction."""
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


def cut(text: str, most: int = 80) -> str:
    """One line of text that fits a message."""
    line = "".join(c if c.isprintable() else "?" for c in text)
    return line if len(line) <= most else line[: most - 3] + "..."


def rounded(value: float, *, up: bool, digits: int = 3) -> float:
    """A number to some digits, never to the wrong side: what is offered as a limit has to keep it."""
    if value <= 0:
        return -rounded(-value, up=not up, digits=digits) if value else 0.0
    scale = 10.0 ** (digits - 1 - math.floor(math.log10(value)))
    # what is whole but for rounding stays
    count = value * scale
    whole = math.ceil(count * (1 - 1e-12)) if up else math.floor(count * (1 + 1e-12))
    return float(f"{whole / scale:.{digits}g}")


def counted(number: int, one: str, several: str = "") -> str:
    """A number with its noun: 1 vertex, 2 vertices, 1,234 faces."""
    return f"{number:,} {one if number == 1 else several or one + 's'}"


def loop_names(count: int) -> list[str]:
    """What the border loops of a mesh are called, the outer one first."""
    return ["border"] if count == 1 else ["outer border", *(f"border {k}" for k in range(2, count + 1))]


def shown(value: Any) -> str:
    """A value as TOML writes it, or what it is."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, dict):
        return "a table"
    if isinstance(value, date | datetime | time):
        return value.isoformat()
    if isinstance(value, float):
        return f"{value:.10g}"
    if isinstance(value, list | tuple):
        return cut(f"[{', '.join(shown(x) for x in value[:8])}{', ...' if len(value) > 8 else ''}]")
    if isinstance(value, int):
        return str(value) if abs(value) < 1e40 else "a number of over 40 digits"
    return cut(repr(value))
