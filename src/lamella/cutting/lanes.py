"""Lanes: bars, or rows of a sheet, that pieces are cut from one after the other.

Lengths become whole numbers of a unit, pieces rounded up and lanes down, so that sums are exact and sets of lengths
are the bits of one integer: "is there a pair of pieces that fills this gap" is a shift and an AND.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats

# units of the longest lane: the more, the less is lost to rounding, and the longer a search takes
UNITS = 16384
# of a unit: lengths that are whole numbers of it but for rounding errors are taken as such
WHOLE = 1e-6
# m; what computed lengths of parts differ by in rounding
LENGTH_ROUNDING = 1e-9


@dataclass(frozen=True)
class Lane:
    """A kind of lane.

    Attributes
    ----------
    length : float
        From the first piece's begin to the last one's end at most, m.
    cost : float
        Of one, in whatever the others' is.
    """

    length: float
    cost: float


@dataclass(frozen=True)
class Cut:
    """A piece: of which strip, and from which to which of its bounds."""

    strip: int
    begin: int
    end: int


@dataclass(frozen=True)
class Packing:
    """Pieces in lanes.

    Attributes
    ----------
    lanes : tuple of tuple of Cut
        Of each lane, in order.
    kinds : tuple of int
        Its kind.
    cost : float
        Of all lanes.
    """

    lanes: tuple[tuple[Cut, ...], ...]
    kinds: tuple[int, ...]
    cost: float

    def cuts(self, strips: int) -> list[list[int]]:
        """Bounds at which each strip is cut."""
        found: list[list[int]] = [[] for _ in range(strips)]
        for lane in self.lanes:
            for cut in lane:
                if cut.begin:
                    found[cut.strip].append(cut.begin)
        return [sorted(one) for one in found]


@dataclass(frozen=True)
class Measures:
    """Lanes and pieces in units.

    Attributes
    ----------
    unit : float
        m.
    gap : float
        Between pieces, m.
    capacities : tuple of int
        Of the lanes: what pieces with a gap each may come to.
    lanes : tuple of Lane
    """

    unit: float
    gap: float
    capacities: tuple[int, ...]
    lanes: tuple[Lane, ...]

    @classmethod
    def of(cls, lanes: Sequence[Lane], gap: float) -> Measures:
        """Of lanes, and a gap between pieces (m)."""
        unit = (max(lane.length for lane in lanes) + gap) / UNITS
        return cls(unit, gap, tuple(int((lane.length + gap) / unit + WHOLE) for lane in lanes), tuple(lanes))

    @property
    def costs(self) -> tuple[float, ...]:
        """Of the lanes."""
        return tuple(lane.cost for lane in self.lanes)

    def takes(self, lengths: Floats) -> list[int]:
        """What pieces of these lengths (m) take of a lane, with a gap each."""
        units: list[int] = np.ceil((np.asarray(lengths) + self.gap) / self.unit - WHOLE).astype(np.int64).tolist()
        return units

    def packing(self, lanes: Iterable[tuple[tuple[Cut, ...], float]]) -> Packing:
        """Of lanes and their length used, m: each the cheapest kind that is long enough."""
        order = sorted(range(len(self.lanes)), key=lambda kind: (self.lanes[kind].cost, self.lanes[kind].length))
        cuts, kinds = [], []
        for pieces, used in lanes:
            cuts.append(pieces)
            kinds.append(next(kind for kind in order if self.lanes[kind].length + LENGTH_ROUNDING >= used))
        return Packing(tuple(cuts), tuple(kinds), sum(self.lanes[kind].cost for kind in kinds))
