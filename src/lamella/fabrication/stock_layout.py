"""Pieces laid on one kind of stock: rows or bars of straight ones, columns of circular ones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from heapq import heapify, heappop, heappush
from math import ceil, inf

import numpy as np

from lamella.cutting.filling import pack
from lamella.cutting.lanes import Lane
from lamella.fabrication.blanks import Blank, longest_first
from lamella.fabrication.columns import Column, stacked
from lamella.fabrication.rules import LENGTH_ROUNDING
from lamella.fabrication.stock import SAME, Stock, Supply


@dataclass(frozen=True)
class Laid:
    """Where pieces lie.

    Attributes
    ----------
    cost : float
        Of the stock they take.
    stocks : list of Stock
        Of each piece of stock.
    sizes : list of (float, float)
        Length and width of each, m; of a coil what is unrolled of it.
    places : list of (int, int, float, float)
        Number of the piece, number of the piece of stock, and where the origin of the blank's frame lies on it, m.
    """

    cost: float
    stocks: list[Stock]
    sizes: list[tuple[float, float]]
    places: list[tuple[int, int, float, float]]


def lay(blanks: Sequence[Blank], supply: Supply, bow: float) -> Laid:
    """Lay pieces that are alike but for their lengths on what costs least.

    Parameters
    ----------
    blanks : sequence of Blank
        Of one height and radius.
    supply : Supply
    bow : float
        How far outlines leave straight lines or arcs at most, m.

    Returns
    -------
    Laid
        Its cost is infinite where they do not fit any of the stock.
    """
    if not blanks:
        return Laid(0.0, [], [], [])
    ordered = longest_first(list(blanks))
    straight = ordered[0].half_angle == 0.0
    found = []
    bars = [one for one in supply.stocks if _is_lane(one, ordered, straight)]
    if bars:
        found.append(_on_bars(ordered, bars, supply))
    for stock in supply.stocks:
        if stock not in bars:
            found += _rows(ordered, stock, supply) if straight else _columns(ordered, stock, supply, bow)
    return min(found, key=lambda laid: round(laid.cost, 9), default=Laid(inf, [], [], []))


def _is_lane(stock: Stock, blanks: Sequence[Blank], straight: bool) -> bool:
    """Whether it is one row of straight pieces, edge to edge."""
    if not straight or any(blank.bow for blank in blanks):
        return False
    return stock.kind == "bar" or abs(stock.width - blanks[0].height) < SAME


def _on_bars(blanks: Sequence[Blank], stocks: Sequence[Stock], supply: Supply) -> Laid:
    lengths = np.array([2 * blank.half_width for blank in blanks])
    longest = max(stock.length for stock in stocks)
    if lengths.max() > longest + LENGTH_ROUNDING:
        return Laid(inf, [], [], [])
    packing = pack(np.minimum(lengths, longest), [Lane(one.length, supply.cost(one)) for one in stocks], supply.gap)
    laid = Laid(0.0, [stocks[kind] for kind in packing.kinds], [], [])
    cost = 0.0
    for number, lane in enumerate(packing.lanes):
        x = _along(laid, [blanks[cut.strip] for cut in lane], number, 0.0, -blanks[0].bottom, supply.gap)
        stock = laid.stocks[number]
        # of a coil the last one is not unrolled farther than it is needed
        used = x - supply.gap if stock.kind == "coil" else stock.length
        laid.sizes.append((used, stock.width))
        cost += supply.cost(stock) * used / stock.length
    return Laid(cost, laid.stocks, laid.sizes, laid.places)


def _along(laid: Laid, blanks: Sequence[Blank], number: int, x: float, y: float, gap: float) -> float:
    """Put pieces behind each other from x on; where the next one would begin."""
    for blank in blanks:
        laid.places.append((blank.piece, number, x + blank.half_width, y))
        x += 2 * blank.half_width + gap
    return x


def _rows(blanks: Sequence[Blank], stock: Stock, supply: Supply) -> list[Laid]:
    """Straight pieces in the rows of a sheet or coil; none where they do not fit."""
    gap = supply.gap
    # straight pieces that are bowed lean out of their rows on either side
    below = max(-blank.bottom for blank in blanks)
    pitch = below + max(blank.top for blank in blanks) + gap
    rows = int((stock.width - gap + LENGTH_ROUNDING) / pitch)
    room = stock.length - 2 * gap
    lengths = np.array([2 * blank.half_width for blank in blanks])
    if not rows or lengths.max() > room + LENGTH_ROUNDING:
        return []
    if stock.kind == "coil":
        lanes = _even(lengths.tolist(), rows, room, gap)
    else:
        packing = pack(np.minimum(lengths, room), [Lane(room, supply.cost(stock) / rows)], gap)
        lanes = [[cut.strip for cut in lane] for lane in packing.lanes]
    count = ceil(len(lanes) / rows)
    laid = Laid(0.0, [stock] * count, [], [])
    ends = [0.0] * count
    for number, lane in enumerate(lanes):
        y = gap + below + (number % rows) * pitch
        end = _along(laid, [blanks[k] for k in lane], number // rows, gap, y, gap)
        ends[number // rows] = max(ends[number // rows], end)
    return [_priced(laid, ends, supply)]


def _even(lengths: Sequence[float], rows: int, room: float, gap: float) -> list[list[int]]:
    """Pieces in the rows of coils, longest first, each in the emptiest row: all come to nearly the same length."""
    lanes: list[list[int]] = []
    free: list[tuple[float, int]] = []
    for piece, length in enumerate(lengths):
        if not free or free[0][0] + length > room + LENGTH_ROUNDING:
            # a further coil
            free += [(0.0, len(lanes) + k) for k in range(rows)]
            heapify(free)
            lanes += [[] for _ in range(rows)]
        used, lane = heappop(free)
        lanes[lane].append(piece)
        heappush(free, (round(used + length + gap, 9), lane))
    return lanes


def _columns(blanks: Sequence[Blank], stock: Stock, supply: Supply, bow: float) -> list[Laid]:
    """Circular pieces in columns side by side; none where they do not fit."""
    gap = supply.gap
    room = stock.length - 2 * gap
    if any(
        2 * blank.half_width > room + LENGTH_ROUNDING
        or blank.top - blank.bottom + 2 * gap > stock.width + LENGTH_ROUNDING
        for blank in blanks
    ):
        return []
    found = []
    for filled in (False, True):
        columns = stacked(blanks, stock.width, gap, bow, filled=filled)
        widths = np.array([2 * column.half_width for column in columns])
        packing = pack(np.minimum(widths, room), [Lane(room, supply.cost(stock))], gap)
        # all but the last coil are used up: what costs least has the shortest end
        order = sorted(packing.lanes, key=lambda lane: -sum(round(float(widths[cut.strip]), 7) for cut in lane))
        laid = Laid(0.0, [stock] * len(order), [], [])
        ends = []
        for number, lane in enumerate(order):
            ends.append(_beside(laid, [columns[cut.strip] for cut in lane], number, gap))
        found.append(_priced(laid, ends, supply))
    return found


def _beside(laid: Laid, columns: Sequence[Column], number: int, gap: float) -> float:
    """Put columns side by side; where the next one would begin."""
    x = gap
    for column in columns:
        laid.places.extend((blank.piece, number, x + column.half_width, y) for blank, y in column.places)
        x += 2 * column.half_width + gap
    return x


def _priced(laid: Laid, ends: Sequence[float], supply: Supply) -> Laid:
    """With sizes and cost: whole sheets, and coils as far as they are unrolled."""
    sizes = [
        (min(end, stock.length) if stock.kind == "coil" else stock.length, stock.width)
        for stock, end in zip(laid.stocks, ends, strict=True)
    ]
    cost = sum(supply.cost(stock) * size[0] / stock.length for stock, size in zip(laid.stocks, sizes, strict=True))
    return Laid(cost, laid.stocks, sizes, laid.places)
