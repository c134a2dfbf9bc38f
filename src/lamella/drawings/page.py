"""What is on a sheet: lines, filled shapes and texts in mm of the paper, from its lower left corner, y upwards."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike
from reportlab.pdfbase.pdfmetrics import stringWidth

from lamella.base.arrays import Floats

FONT, BOLD = "Helvetica", "Helvetica-Bold"
POINT = 25.4 / 72
"""mm."""
NOTE_EM, TEXT_EM, HEAD_EM, TITLE_EM = 2.4, 3.0, 4.0, 6.0
"""mm: sizes of texts (ems)."""
PENS = {"thick": 0.5, "medium": 0.25, "thin": 0.13, "fine": 0.07, "centre": 0.13}
"""mm; "centre" is dash-dotted."""


@dataclass(frozen=True, eq=False)
class Line:
    """A polyline (n, 2) of a pen; `fill` is a grey from 0 to 1, for its inside."""

    points: Floats
    pen: str
    closed: bool = False


@dataclass(frozen=True, eq=False)
class Shape:
    """An area between rings, even-odd: filled with a grey from 0 to 1."""

    rings: tuple[Floats, ...]
    grey: float
    even_odd: bool = True


@dataclass(frozen=True)
class Label:
    """A text.

    Attributes
    ----------
    text : str
    x, y : float
        Of its anchor on the base line, mm.
    size : float
        Em, mm.
    anchor : str
        "start", "middle" or "end".
    angle : float
        deg, counter-clockwise.
    bold : bool
    """

    text: str
    x: float
    y: float
    size: float = TEXT_EM
    anchor: str = "start"
    angle: float = 0.0
    bold: bool = False

    @property
    def width(self) -> float:
        """mm."""
        return text_width(self.text, self.size, self.bold)


@dataclass(frozen=True)
class Dimension:
    """A length that is told on a drawing: what is written (m), and how far its ends are apart on the paper (mm)."""

    value: float
    drawn: float
    scale: float


@dataclass(eq=False)
class Page:
    """A sheet being drawn.

    Attributes
    ----------
    title : str
    scale : str
        For the title block.
    content : list
        In the order in which it is drawn.
    dimensions : list
    """

    title: str
    scale: str = ""
    content: list[Line | Shape | Label] = field(default_factory=list)
    dimensions: list[Dimension] = field(default_factory=list)

    def line(self, points: ArrayLike, pen: str = "medium", *, closed: bool = False) -> None:
        """Draw a polyline."""
        self.content.append(Line(np.asarray(points, float).reshape(-1, 2), pen, closed))

    def rectangle(self, left: float, low: float, right: float, high: float, pen: str = "thin") -> None:
        """Draw a rectangle."""
        self.line([(left, low), (right, low), (right, high), (left, high)], pen, closed=True)

    def shape(self, rings: Sequence[Floats], grey: float, *, even_odd: bool = True) -> None:
        """Fill an area."""
        self.content.append(Shape(tuple(rings), grey, even_odd))

    def blank(self, left: float, low: float, right: float, high: float) -> None:
        """Cover what has been drawn in a rectangle."""
        self.shape([np.array([(left, low), (right, low), (right, high), (left, high)])], 1.0)

    def label(self, text: str, x: float, y: float, size: float = TEXT_EM, **how: object) -> Label:
        """Write a text."""
        made = Label(text, x, y, size, **how)  # type: ignore[arg-type]
        self.content.append(made)
        return made


def text_width(text: str, size: float, bold: bool = False) -> float:
    """Width of a text, mm."""
    return float(stringWidth(printable(text), BOLD if bold else FONT, size))


def printable(text: str) -> str:
    """A text in characters that the font has (Windows-1252); others are question marks."""
    return text.encode("cp1252", "replace").decode("cp1252")


def shortened(text: str, room: float, size: float, bold: bool = False) -> str:
    """A text that is cut off, with dots, where it is longer than the room, mm."""
    if text_width(text, size, bold) <= room:
        return text
    low, high = 0, len(text)
    while low < high:
        middle = (low + high + 1) // 2
        fits = text_width(text[:middle].rstrip() + "...", size, bold) <= room
        low, high = (middle, high) if fits else (low, middle - 1)
    return text[:low].rstrip() + "..."
