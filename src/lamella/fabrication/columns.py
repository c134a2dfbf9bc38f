"""Circular pieces of one radius stacked into each other."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, pi, sin, sqrt

from lamella.fabrication.blanks import Blank
from lamella.fabrication.rules import LENGTH_ROUNDING


@dataclass(frozen=True)
class Column:
    """Pieces above each other.

    Attributes
    ----------
    half_width : float
        Of the widest one, the lowest, m.
    places : list of (Blank, float)
        Pieces from below, and y of their frames' origins on the sheet, m.
    """

    half_width: float
    places: list[tuple[Blank, float]]


def stacked(blanks: Sequence[Blank], width: float, gap: float, bow: float, *, filled: bool = False) -> list[Column]:
    """Columns of circular pieces, each moved down into the one below as far as the gap allows.

    Parameters
    ----------
    blanks : sequence of Blank
        Of one radius, longest first.
    width : float
        Of the sheet, m, across which they are stacked.
    gap : float
        Between pieces and to the sheet's edge, m.
    bow : float
        How far outlines leave their arcs at most, m.
    filled : bool
        Whether what is left above a column gets the longest one of the shorter pieces that fits; else the next piece
        begins a new column.
    """
    columns: list[Column] = []
    left = list(blanks)
    limit = width - gap + LENGTH_ROUNDING
    while left:
        lowest = left.pop(0)
        column = Column(lowest.half_width, [(lowest, gap - lowest.bottom)])
        columns.append(column)
        while left:
            below, y = column.places[-1]

            def fits(blank: Blank, below: Blank = below, y: float = y) -> bool:
                return y + _rise(below, blank, gap, bow) + blank.top <= limit

            # the shorter a piece the less it needs; without filling the next one alone is looked at
            chosen = bisect_left(left, True, key=fits) if filled else int(not fits(left[0]))
            if chosen >= (len(left) if filled else 1):
                break
            above = left.pop(chosen)
            column.places.append((above, y + _rise(below, above, gap, bow)))
    return columns


def _rise(below: Blank, above: Blank, gap: float, bow: float) -> float:
    """How far ``above``, which is no longer, has to be moved up from ``below``.

    Its lower edge, of radius ro, has to stay inside the circle of radius ri - gap about the centre of
    the one below, where ri is that one's inner radius. The distance from that centre is largest at the
    tips, at the half angle phi: ro^2 - 2 ro d cos(phi) + d^2 = (ri - gap)^2 for the least move d.
    """
    boxes = below.top - above.bottom + gap
    outer, inner = above.radius + 0.5 * above.height + bow, below.radius - 0.5 * below.height - bow
    reach = inner - gap
    across = outer * sin(above.half_angle)
    # beyond a half circle, and where tips come above the centre, the circle says nothing
    if below.half_angle >= 0.5 * pi or reach <= across or inner * cos(below.half_angle) < gap:
        return boxes
    nested = outer * cos(above.half_angle) - sqrt(reach * reach - across * across)
    return min(boxes, nested)
