"""Strips cut into pieces and laid in lanes at once: where a strip is cut is chosen so that lanes are used up.

A strip may be cut at its bounds, into as few pieces as the longest lane allows, or into more where that saves more than
a splice is worth. Lanes are filled one after the other: the strip that is hardest to place begins, and pieces of others
fill what is left, best to the unit. A strip that is cut is there again with its rest. Cutting stock is NP-hard; several
fillings are made, and the cheapest one is kept, never one that costs more than first-fit-decreasing.
"""

from __future__ import annotations

from bisect import bisect_left, insort
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from heapq import heapify, heappop, heappush

import numpy as np

from lamella.base.arrays import Floats
from lamella.cutting.lanes import Cut, Lane, Measures, Packing

# of a lane: what may be left of it so that no better filling is looked for
TOLERANCES = (0.0005, 0.004, 0.02)
# a piece of a strip that is cut once more than it has to be has this many cells at least, and so has its rest
LEAST_CELLS = 2
# strips looked at for a piece that fills what is left of a lane
STRIPS_LOOKED_AT = 24
# places of a strip's first cut that are tried
FIRST_CUTS = 12


def pack(lengths: Floats, lanes: Sequence[Lane], gap: float) -> Packing:
    """Lay pieces in lanes.

    Parameters
    ----------
    lengths : (n,)
        m; each at most that of the longest lane.
    lanes : sequence of Lane
    gap : float
        Between pieces, m.

    Returns
    -------
    Packing
        Its cuts have the bounds 0 and 1 of strips that are the pieces.
    """
    return cut_and_pack([np.array([0.0, length]) for length in np.asarray(lengths).tolist()], lanes, gap, 0.0, 0.0)


def cut_and_pack(
    strips: Sequence[Floats], lanes: Sequence[Lane], gap: float, longest: float, splice_cost: float
) -> Packing:
    """Cut strips and lay their pieces in lanes.

    Parameters
    ----------
    strips : sequence of (b,)
        Ascending stations of each one's bounds, m: its ends and where it may be cut.
    lanes : sequence of Lane
    gap : float
        Between pieces, m.
    longest : float
        Piece allowed, m; the longest lane is another limit. 0: the lane alone.
    splice_cost : float
        What a cut costs.

    Returns
    -------
    Packing

    Raises
    ------
    ValueError
        No bounds of a strip are near enough to each other.
    """
    if not strips:
        return Packing((), (), 0.0)
    measures = Measures.of(lanes, gap)
    own = [_Strip.of(bounds, measures, (longest or np.inf) * (1 + 1e-12)) for bounds in strips]
    fillings = [_first_fit(own, measures)]
    free = any(len(strip.bounds) > 2 for strip in own)
    for extra in (False, True) if free and splice_cost < np.inf else (False,):
        for share in TOLERANCES if len(own) > 1 else TOLERANCES[:1]:
            filling = _Filling(own, measures, share, splice_cost if extra else np.inf)
            fillings.append(_packing(own, measures, filling.lanes()))
    return min(fillings, key=lambda packing: _cost(packing, splice_cost, len(own)))


def _cost(packing: Packing, splice_cost: float, strips: int) -> tuple[float, int]:
    pieces = sum(map(len, packing.lanes))
    more = pieces - strips
    return round(packing.cost + (splice_cost * more if more else 0.0), 9), pieces


@dataclass(frozen=True)
class _Strip:
    """Bounds of a strip, and the least number of pieces from each of them to its end."""

    bounds: Floats
    needed: list[int]
    longest: float
    measures: Measures
    known: dict[int, list[tuple[int, int]]] = field(default_factory=dict)

    @classmethod
    def of(cls, bounds: Floats, measures: Measures, longest: float) -> _Strip:
        strip = cls(bounds, [0] * len(bounds), longest, measures)
        reach = min(longest, max(measures.capacities) * measures.unit)
        far = np.searchsorted(bounds, bounds + reach, side="right")
        for k in range(len(bounds) - 2, -1, -1):
            ends = range(k + 1, int(far[k]))
            takes = strip.takes(k, ends)
            # what pieces take grows with their length
            end = k + bisect_left(takes, np.inf)
            if end == k:
                raise ValueError("no bounds near enough to each other")
            strip.needed[k] = 1 + strip.needed[end]
        return strip

    def takes(self, begin: int, ends: range) -> list[float]:
        """What pieces from a bound to others take; infinite where they are too long for any lane."""
        lengths = self.bounds[ends.start : ends.stop] - self.bounds[begin]
        most = max(self.measures.capacities)
        takes = self.measures.takes(lengths)
        return [
            take if take <= most and length <= self.longest else np.inf
            for take, length in zip(takes, lengths.tolist(), strict=True)
        ]

    def pieces(self, begin: int) -> list[tuple[int, int]]:
        """What first pieces from a bound on take, and where they end, with which no more pieces are needed."""
        if begin not in self.known:
            wanted = self.needed[begin] - 1
            ends = range(begin + 1, len(self.bounds))
            found = [
                (int(take), end)
                for take, end in zip(self.takes(begin, ends), ends, strict=True)
                if take < np.inf and self.needed[end] == wanted
            ]
            self.known[begin] = found[-FIRST_CUTS:]
        return self.known[begin]

    def further(self, begin: int, room: int) -> tuple[int, int] | None:
        """The longest first piece within a room that takes one cut more than needed."""
        ends = range(begin + LEAST_CELLS, len(self.bounds) - LEAST_CELLS)
        takes = self.takes(begin, ends)
        k = bisect_left(takes, room + 1) - 1
        return (int(takes[k]), ends[k]) if k >= 0 else None


def _packing(strips: Sequence[_Strip], measures: Measures, lanes: Iterable[tuple[Cut, ...]]) -> Packing:
    """Lanes by what their pieces really come to."""

    def length(cuts: tuple[Cut, ...]) -> float:
        bounds = ((strips[cut.strip].bounds[cut.begin], strips[cut.strip].bounds[cut.end]) for cut in cuts)
        return sum(float(end - begin) for begin, end in bounds) + measures.gap * (len(cuts) - 1)

    return measures.packing((cuts, length(cuts)) for cuts in lanes)


def _first_fit(strips: Sequence[_Strip], measures: Measures) -> Packing:
    """Strips cut as early as they have to be, longest pieces first, each in the fullest lane that has room for it."""
    pieces = []
    for number, strip in enumerate(strips):
        begin = 0
        while begin < len(strip.bounds) - 1:
            take, end = strip.pieces(begin)[-1]
            pieces.append((-take, number, begin, end))
            begin = end
    most = max(measures.capacities)
    free: list[tuple[int, int]] = []
    lanes: list[list[Cut]] = []
    for take, number, begin, end in sorted(pieces):
        at = bisect_left(free, (-take, -1))
        room, lane = free.pop(at) if at < len(free) else (most, len(lanes))
        if lane == len(lanes):
            lanes.append([])
        lanes[lane].append(Cut(number, begin, end))
        insort(free, (room + take, lane))
    return _packing(strips, measures, map(tuple, lanes))


class _Filling:
    """One filling of lanes while it is made."""

    def __init__(self, strips: Sequence[_Strip], measures: Measures, share: float, splice_cost: float) -> None:
        self.strips, self.measures = strips, measures
        self.share, self.splice_cost = share, splice_cost
        self.begin = [0] * len(strips)
        # by what a piece takes: the strips that have one, and where it ends
        self.offers: dict[int, dict[int, int]] = {}
        self.bits, self.mirrored, self.size = 0, 0, max(measures.capacities)
        self.hardest: list[tuple[int, int, int]] = []
        for number in range(len(strips)):
            self._offer(number)
            self._queue(number)
        heapify(self.hardest)
        self.longest = sorted(range(len(strips)), key=lambda k: (-round(float(np.ptp(strips[k].bounds)), 7), k))

    def lanes(self) -> Iterator[tuple[Cut, ...]]:
        """Lanes as they are filled."""
        while self.hardest:
            _, number, begin = heappop(self.hardest)
            if self.begin[number] != begin:
                continue
            yield self._lane(number)

    def _queue(self, number: int) -> None:
        options = self.strips[number].pieces(self.begin[number])
        heappush(self.hardest, (-options[0][0], number, self.begin[number]))

    def _offer(self, number: int) -> None:
        for take, end in self.strips[number].pieces(self.begin[number]):
            at = self.offers.setdefault(take, {})
            if not at:
                self.bits |= 1 << take
                self.mirrored |= 1 << (self.size - take)
            at[number] = end

    def _withdraw(self, number: int) -> None:
        for take, _ in self.strips[number].pieces(self.begin[number]):
            at = self.offers[take]
            del at[number]
            if not at:
                self.bits ^= 1 << take
                self.mirrored ^= 1 << (self.size - take)

    def _lane(self, seed: int) -> tuple[Cut, ...]:
        """Fill a lane that a piece of a strip begins: of all kinds the one of least cost for what it holds."""
        self._withdraw(seed)
        best: tuple[float, int, list[tuple[int, int, int]]] | None = None
        for capacity, cost in zip(self.measures.capacities, self.measures.costs, strict=True):
            tolerance = int(self.share * capacity)
            for take, end in reversed(self.strips[seed].pieces(self.begin[seed])):
                if take > capacity:
                    continue
                others = self._fill(capacity - take, tolerance)
                taken = take + sum(other[0] for other in others)
                value = cost / taken
                if best is None or value < best[0] * (1 - 1e-9):
                    best = value, capacity, [(take, seed, end), *others]
                if capacity - taken <= tolerance:
                    break
        assert best is not None
        _, capacity, chosen = best
        for _, number, _ in chosen[1:]:
            self._withdraw(number)
        chosen += self._further(capacity - sum(take for take, _, _ in chosen), {number for _, number, _ in chosen})
        cuts = []
        for _, number, end in chosen:
            cuts.append(Cut(number, self.begin[number], end))
            self.begin[number] = end
            if end < len(self.strips[number].bounds) - 1:
                self._offer(number)
                self._queue(number)
        return tuple(cuts)

    def _fill(self, room: int, tolerance: int) -> list[tuple[int, int, int]]:
        """Pieces of different strips that fill a room: the longest one again and again, then the best pair."""
        chosen: list[tuple[int, int, int]] = []
        while True:
            found = self._exact(room, tolerance)
            if found:
                chosen += found
                break
            take = (self.bits & ((1 << (room + 1)) - 1)).bit_length() - 1 if room > 0 else -1
            if take <= 0:
                break
            number, end = next(iter(self.offers[take].items()))
            chosen.append((take, number, end))
            self._withdraw(number)
            room -= take
        for _, number, _ in chosen if not found else chosen[: len(chosen) - len(found)]:
            self._offer(number)
        return chosen

    def _exact(self, room: int, tolerance: int) -> list[tuple[int, int, int]]:
        """One or two pieces of different strips that leave at most a tolerance; none where there are none."""
        for target in range(room, max(room - tolerance, 0) - 1, -1):
            if target <= 0:
                return []
            if self.bits >> target & 1:
                number, end = next(iter(self.offers[target].items()))
                return [(target, number, end)]
            pairs = self.bits & (self.mirrored >> (self.size - target))
            while pairs:
                one = pairs.bit_length() - 1
                pairs ^= 1 << one
                for first, end in self.offers[one].items():
                    for second, other in self.offers[target - one].items():
                        if first != second:
                            return [(one, first, end), (target - one, second, other)]
                    break
        return []

    def _further(self, room: int, taken: set[int]) -> list[tuple[int, int, int]]:
        """A piece of a strip that is cut once more than it has to be, where the room is worth more than that."""
        worth = min(
            cost / capacity for cost, capacity in zip(self.measures.costs, self.measures.capacities, strict=True)
        )
        if room * worth <= self.splice_cost:
            return []
        best: tuple[int, int, int] | None = None
        # strips that are laid whole go from the list as they are met
        self.longest = [
            number
            for number in self.longest[:STRIPS_LOOKED_AT]
            if self.begin[number] < len(self.strips[number].bounds) - 1
        ] + self.longest[STRIPS_LOOKED_AT:]
        for number in [one for one in self.longest[:STRIPS_LOOKED_AT] if one not in taken]:
            found = self.strips[number].further(self.begin[number], room)
            if found and (best is None or found[0] > best[0]):
                best = found[0], number, found[1]
        if best is None or best[0] * worth <= self.splice_cost:
            return []
        self._withdraw(best[1])
        return [best]
