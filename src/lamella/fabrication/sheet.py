"""Nesting: where every piece lies on which sheet."""

from __future__ import annotations

from bisect import bisect_left, insort
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.result import Shown
from lamella.base.wording import counted
from lamella.fabrication.blanks import Blank, blank_of, longest_first
from lamella.fabrication.columns import stacked
from lamella.fabrication.part import Parts
from lamella.fabrication.rules import LENGTH_ROUNDING
from lamella.fabrication.stock import Stock


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
    stocks : tuple of Stock
        What each sheet is of, where it is cut from given stock (a bar, a coil as far as it is unrolled); else empty.

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
    stocks: tuple[Stock, ...] = ()

    def _line(self) -> str:
        larger = f", {self.oversize} of them larger than requested" if self.oversize else ""
        return f"{counted(len(self.parts), 'piece')} on {counted(self.sheet_count, 'sheet')}{larger}"

    @property
    def sheet_count(self) -> int:
        """Number of sheets."""
        return len(self.sizes)


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
    of_part, copies = pieces_of(parts)
    plan = _Plan(len(of_part), max(sheet), min(sheet), gap)
    straight: list[Blank] = []
    rounds: dict[tuple[float, float], list[Blank]] = {}
    bow = max((part.bow for part in parts.parts), default=0.0)
    blanks = [blank_of(part) for part in parts.parts]
    for piece, index in enumerate(of_part.tolist()):
        blank = replace(blanks[index], piece=piece)
        if not plan.fits(blank):
            plan.alone(blank)
        elif blank.half_angle == 0.0:
            straight.append(blank)
        else:
            rounds.setdefault((round(blank.radius, 9), blank.height), []).append(blank)
    for height in sorted({blank.height for blank in straight}):
        plan.rows(longest_first([blank for blank in straight if blank.height == height]))
    for key in sorted(rounds):
        plan.columns(longest_first(rounds[key]), bow)
    # sheets of the asked size come first
    order = np.argsort(plan.oversize, kind="stable")
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    turned = np.array([blanks[index].turned for index in of_part.tolist()], dtype=bool)
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


def pieces_of(parts: Parts) -> tuple[Integers, Integers]:
    """Of all pieces, part by part: the part's index, and the number among its equal ones from 1, (p,)."""
    quantities = np.array([part.quantity for part in parts.parts], dtype=np.int64)
    of_part = np.repeat(np.arange(len(quantities)), quantities)
    return of_part, np.arange(len(of_part)) - np.repeat(np.cumsum(quantities) - quantities, quantities) + 1


class _Plan:
    """Sheets while they are being filled."""

    def __init__(self, pieces: int, length: float, width: float, gap: float) -> None:
        self.length, self.width, self.gap = length, width, gap
        self.sheets = np.zeros(pieces, dtype=np.int64)
        self.x, self.y = np.zeros(pieces), np.zeros(pieces)
        self.sizes: list[tuple[float, float]] = []
        self.oversize: list[bool] = []

    def fits(self, blank: Blank) -> bool:
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

    def put(self, blank: Blank, sheet: int, x: float, y: float) -> None:
        self.sheets[blank.piece], self.x[blank.piece], self.y[blank.piece] = sheet, x, y

    def alone(self, blank: Blank) -> None:
        """A piece on a sheet of its own, as large as it needs."""
        length = max(self.length, 2 * blank.half_width + 2 * self.gap)
        width = max(self.width, blank.top - blank.bottom + 2 * self.gap)
        self.put(blank, self.sheet(length, width), self.gap + blank.half_width, self.gap - blank.bottom)

    def rows(self, blanks: Sequence[Blank]) -> None:
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

    def columns(self, blanks: Sequence[Blank], bow: float) -> None:
        """Circular pieces of one radius, within `bow` (m), stacked into columns side by side."""
        sheet, right = -1, np.inf
        for column in stacked(blanks, self.width, self.gap, bow):
            left = right + self.gap
            if sheet < 0 or left + 2 * column.half_width > self.length - self.gap + LENGTH_ROUNDING:
                sheet, left = self.sheet(), self.gap
            right = left + 2 * column.half_width
            for blank, y in column.places:
                self.put(blank, sheet, 0.5 * (left + right), y)
