"""Nesting: where every piece lies on which sheet."""

from __future__ import annotations

from bisect import bisect_left, insort
from collections.abc import Sequence
from dataclasses import dataclass, field
from math import cos, sin, sqrt

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.result import Shown
from lamella.base.wording import counted
from lamella.fabrication.part import Part, Parts
from lamella.fabrication.rules import LENGTH_ROUNDING


@dataclass(frozen=True, eq=False, repr=False)
class Nesting(Shown):
    """Places of all pieces, (p,) arrays; pieces of one part follow each other in the order of the parts.

    Attributes
    ----------
    parts : (p,) int
        Index of the piece's part.
    copies : (p,) int
        1, 2, ... among the pieces of its part.
    sheets : (p,) int
        Index of the piece's sheet.
    x, y : (p,)
        Where the origin of the part's frame lies on the sheet, m from its lower left corner.
    rotations : (p,)
        Angle by which the part is turned, degrees: 0 or 180.
    sizes : (s, 2)
        Length and width of each sheet, m.
    oversize : int
        How many of the sheets, the last ones, are larger than requested: each has one piece that fits no other.
    gap : float
        Between pieces and to the sheet's edge, m.
    source : Parts
        The parts.

    Examples
    --------
    >>> import lamella
    >>> parts = lamella.net(lamella.Catenoid(2.5, (-2.0, 3.0)), cells=12).strips().parts()
    >>> nesting = parts.nest(sheet=(12.0, 1.5))
    >>> nesting
    Nesting(48 pieces on 4 sheets)
    >>> print(nesting.sizes[0], nesting.sheets[:3])
    [12.   1.5] [0 0 0]
    """

    parts: Integers
    copies: Integers
    sheets: Integers
    x: Floats
    y: Floats
    rotations: Floats
    sizes: Floats
    oversize: int
    gap: float
    source: Parts = field(compare=False)

    def _line(self) -> str:
        larger = f", {self.oversize} of them larger than requested" if self.oversize else ""
        return f"{counted(len(self.parts), 'piece')} on {counted(self.sheet_count, 'sheet')}{larger}"

    @property
    def sheet_count(self) -> int:
        """Number of sheets."""
        return len(self.sizes)


@dataclass(frozen=True)
class _Blank:
    """A piece turned so that it opens upwards: its tips, not its middle, are its highest points."""

    piece: int
    half_width: float
    bow: float
    top: float
    bottom: float
    length: float
    half_angle: float
    radius: float
    height: float
    turned: bool


def nest(parts: Parts, *, sheet: tuple[float, float] = (12.0, 2.0), gap: float = 0.01) -> Nesting:
    """Lay all pieces on sheets.

    Straight pieces fill rows, longest first, each into the fullest row that has room for it. Circular ones
    are stacked into columns, longest first, each moved down into the one below as far as the gap allows. Layers that
    are cut to their own curvature are laid like the straight lines or arcs they are near to, with room for the most
    bowed one.

    Parameters
    ----------
    parts : Parts
    sheet : (float, float)
        Length and width, m; the longer one is laid along x.
    gap : float
        Between pieces and to the sheet's edge, m.

    Returns
    -------
    Nesting
    """
    quantities = np.array([part.quantity for part in parts.parts], dtype=np.int64)
    of_part = np.repeat(np.arange(len(quantities)), quantities)
    copies = np.arange(len(of_part)) - np.repeat(np.cumsum(quantities) - quantities, quantities) + 1
    plan = _Plan(len(of_part), max(sheet), min(sheet), gap)
    straight: list[_Blank] = []
    rounds: dict[tuple[float, float], list[_Blank]] = {}
    bow = max((part.bow for part in parts.parts), default=0.0)
    blanks = [_blank(part) for part in parts.parts]
    for piece, index in enumerate(of_part.tolist()):
        blank = _Blank(piece, *blanks[index])
        if not plan.fits(blank):
            plan.alone(blank)
        elif blank.half_angle == 0.0:
            straight.append(blank)
        else:
            rounds.setdefault((round(blank.radius, 9), blank.height), []).append(blank)
    for height in sorted({blank.height for blank in straight}):
        plan.rows(_longest_first([blank for blank in straight if blank.height == height]))
    for key in sorted(rounds):
        plan.columns(_longest_first(rounds[key]), bow)
    # sheets of the asked size come first
    order = np.argsort(plan.oversize, kind="stable")
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    turned = np.array([blanks[index][-1] for index in of_part.tolist()], dtype=bool)
    return Nesting(
        of_part,
        copies,
        rank[plan.sheets] if len(order) else plan.sheets,
        plan.x,
        plan.y,
        np.where(turned, 180.0, 0.0),
        np.array(plan.sizes, dtype=float).reshape(-1, 2)[order],
        sum(plan.oversize),
        gap,
        parts,
    )


def _blank(part: Part) -> tuple[float, float, float, float, float, float, float, float, bool]:
    """The fields of a part's `_Blank` behind the piece's number."""
    left, low, right, high = part.bounds
    turned = part.curvature < 0
    if turned:
        low, high = -high, -low
    curvature = abs(part.curvature)
    radius = 1 / curvature if curvature else 0.0
    half_angle = 0.5 * curvature * part.length
    return max(right, -left), part.bow, high, low, part.length, half_angle, radius, part.height, turned


def _longest_first(blanks: list[_Blank]) -> list[_Blank]:
    # rounded, so that noise in equal lengths does not reorder pieces
    return sorted(blanks, key=lambda blank: (-round(blank.length, 7), blank.piece))


class _Plan:
    """Sheets while they are being filled."""

    def __init__(self, pieces: int, length: float, width: float, gap: float) -> None:
        self.length, self.width, self.gap = length, width, gap
        self.sheets = np.zeros(pieces, dtype=np.int64)
        self.x, self.y = np.zeros(pieces), np.zeros(pieces)
        self.sizes: list[tuple[float, float]] = []
        self.oversize: list[bool] = []

    def fits(self, blank: _Blank) -> bool:
        """Whether a piece fits a sheet of the asked size."""
        return (
            2 * blank.half_width + 2 * self.gap <= self.length + LENGTH_ROUNDING
            and blank.top - blank.bottom + 2 * self.gap <= self.width + LENGTH_ROUNDING
        )

    def sheet(self, length: float = 0.0, width: float = 0.0) -> int:
        """Begin a sheet; its index."""
        self.oversize.append(length > 0)
        self.sizes.append((length or self.length, width or self.width))
        return len(self.sizes) - 1

    def put(self, blank: _Blank, sheet: int, x: float, y: float) -> None:
        self.sheets[blank.piece], self.x[blank.piece], self.y[blank.piece] = sheet, x, y

    def alone(self, blank: _Blank) -> None:
        """A piece on a sheet of its own, as large as it needs."""
        length = max(self.length, 2 * blank.half_width + 2 * self.gap)
        width = max(self.width, blank.top - blank.bottom + 2 * self.gap)
        self.put(blank, self.sheet(length, width), self.gap + blank.half_width, self.gap - blank.bottom)

    def rows(self, blanks: Sequence[_Blank]) -> None:
        """Best fit of straight pieces of one height into rows."""
        # straight pieces that are bowed lean out of their rows on either side
        below = max(-blank.bottom for blank in blanks)
        pitch = below + max(blank.top for blank in blanks) + self.gap
        rows_a_sheet = int((self.width - self.gap + LENGTH_ROUNDING) / pitch)
        free: list[tuple[float, int]] = []
        rows = 0
        sheet = 0
        places: list[tuple[int, float]] = []
        for blank in blanks:
            need = 2 * blank.half_width + self.gap
            slot = bisect_left(free, (need - LENGTH_ROUNDING, -1))
            if slot < len(free):
                room, row = free.pop(slot)
            else:
                room, row = self.length - self.gap, rows
                if rows % rows_a_sheet == 0:
                    sheet = self.sheet()
                places.append((sheet, self.gap + below + (rows % rows_a_sheet) * pitch))
                rows += 1
            on, y = places[row]
            self.put(blank, on, self.length - room + blank.half_width, y)
            insort(free, (room - need, row))

    def columns(self, blanks: Sequence[_Blank], bow: float) -> None:
        """Circular pieces of one radius, within `bow` (m), stacked into columns side by side."""
        sheet, left, right = -1, 0.0, np.inf
        below: _Blank | None = None
        y = 0.0
        for blank in blanks:
            if below is not None:
                y += self._rise(below, blank, bow)
            if below is None or y + blank.top > self.width - self.gap + LENGTH_ROUNDING:
                left = right + self.gap
                if sheet < 0 or left + 2 * blank.half_width > self.length - self.gap + LENGTH_ROUNDING:
                    sheet, left = self.sheet(), self.gap
                right = left + 2 * blank.half_width
                y = self.gap - blank.bottom
            self.put(blank, sheet, 0.5 * (left + right), y)
            below = blank

    def _rise(self, below: _Blank, above: _Blank, bow: float) -> float:
        """How far ``above``, which is no longer, has to be moved up from ``below``.

        Its lower edge, of radius ro, has to stay inside the circle of radius ri - gap about the centre of
        the one below, where ri is that one's inner radius. The distance from that centre is largest at the
        tips, at the half angle phi: ro^2 - 2 ro d cos(phi) + d^2 = (ri - gap)^2 for the least move d.
        """
        boxes = below.top - above.bottom + self.gap
        outer, inner = above.radius + 0.5 * above.height + bow, below.radius - 0.5 * below.height - bow
        reach = inner - self.gap
        across = outer * sin(above.half_angle)
        # beyond a half circle, and where tips come above the centre, the circle says nothing
        if below.half_angle >= 0.5 * np.pi or reach <= across or inner * cos(below.half_angle) < self.gap:
            return boxes
        nested = outer * cos(above.half_angle) - sqrt(reach * reach - across * across)
        return min(boxes, nested)
