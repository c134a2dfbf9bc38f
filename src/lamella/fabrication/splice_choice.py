"""Where lamellas are cut into pieces, chosen together with the stock they are cut from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.cutting.filling import cut_and_pack
from lamella.cutting.lanes import Lane
from lamella.fabrication.blanks import plain_blanks
from lamella.fabrication.flat import longest_fitting
from lamella.fabrication.rules import LARGEST_TURN, Rules
from lamella.fabrication.splitting import cut_bounds
from lamella.fabrication.stock import SAME, Stock, Supply
from lamella.fabrication.stock_layout import lay

# columns of arcs side by side on a sheet for which lengths are tried: the shorter arcs are, the flatter they are
MOST_COLUMNS = 6


@dataclass(frozen=True)
class Choice:
    """Where each strip is cut.

    Attributes
    ----------
    cuts : list of (c,)
        Ascending stations, m.
    cost : float
        Of stock and splices.
    """

    cuts: list[Floats]
    cost: float


def choose_splices(bounds: Sequence[Floats], supply: Supply, rules: Rules, quantity: int) -> Choice:
    """Cut strips so that stock and splices cost least.

    Straight ones are cut so that bars, or rows of sheets, are used up (`lamella.cutting.filling`); arcs into pieces so
    short that as many columns lie side by side on a sheet as pay. Pieces nearly equal, as long as the stock allows, are
    always among what is compared.

    Parameters
    ----------
    bounds : sequence of (b,)
        Ascending stations of each strip's ends and of where it may be cut, m.
    supply : Supply
    rules : Rules
    quantity : int
        Equal strips of each.

    Returns
    -------
    Choice
    """
    longest = min(rules.transport_length, rules.longest_ring)
    splice_cost = supply.splice_cost(rules.height)
    found: list[Choice] = []

    def add(cuts: list[Floats] | None) -> None:
        if cuts is None:
            return
        lengths = [np.diff(np.concatenate(([b[0]], c, [b[-1]]))) for b, c in zip(bounds, cuts, strict=True)]
        blanks = plain_blanks(np.repeat(np.concatenate(lengths), quantity), rules.height, rules.curvature, rules.bow)
        cost = lay(blanks, supply, rules.bow).cost + splice_cost * quantity * sum(map(len, cuts))
        found.append(Choice(cuts, cost))

    for room in _rooms(supply, rules):
        add(_equal(bounds, min(room, longest)))
    if not rules.curvature:
        for lanes in _lanes(supply, rules):
            add(_used_up(bounds, lanes, supply.gap, longest, splice_cost))
    if not found:
        # a cell too long for any stock: what is left is cut as often as it can be
        return Choice([b[1:-1] for b in bounds], np.inf)
    return min(found, key=lambda one: (round(one.cost, 9), sum(map(len, one.cuts))))


def _rooms(supply: Supply, rules: Rules) -> list[float]:
    """Longest pieces that each kind of stock has room for, on sheets with several of them side by side, m."""
    found = []
    height = rules.height + 2 * rules.bow
    for stock in supply.stocks:
        if _is_lane(stock, rules):
            found.append(stock.length)
            continue
        width, depth = stock.length - 2 * supply.gap, stock.width - 2 * supply.gap
        for columns in range(1, MOST_COLUMNS + 1 if rules.curvature else 2):
            room = (width - (columns - 1) * supply.gap) / columns
            found.append(longest_fitting(room, depth, height, rules.curvature, LARGEST_TURN))
    return sorted({round(room, 9) for room in found if room > 0}, reverse=True)


def _lanes(supply: Supply, rules: Rules) -> list[list[Lane]]:
    """Bars and coils of the strips' own width together, and the rows of each other stock."""
    bars = [Lane(one.length, supply.cost(one)) for one in supply.stocks if _is_lane(one, rules)]
    found = [bars] if bars else []
    pitch = rules.height + 2 * rules.bow + supply.gap
    for one in supply.stocks:
        if not _is_lane(one, rules):
            rows = int((one.width - supply.gap + SAME) / pitch)
            if rows:
                found.append([Lane(one.length - 2 * supply.gap, supply.cost(one) / rows)])
    return found


def _is_lane(stock: Stock, rules: Rules) -> bool:
    return (stock.kind == "bar" or abs(stock.width - rules.height) < SAME) and not rules.bow and not rules.curvature


def _equal(bounds: Sequence[Floats], longest: float) -> list[Floats] | None:
    return _all_or_none([cut_bounds(one, longest) for one in bounds])


def _used_up(
    bounds: Sequence[Floats], lanes: Sequence[Lane], gap: float, longest: float, splice_cost: float
) -> list[Floats] | None:
    try:
        packing = cut_and_pack(bounds, lanes, gap, longest if np.isfinite(longest) else 0.0, splice_cost)
    except ValueError:
        return None
    return [one[cuts] for one, cuts in zip(bounds, packing.cuts(len(bounds)), strict=True)]


def _all_or_none(cuts: list[Floats | None]) -> list[Floats] | None:
    found = [one for one in cuts if one is not None]
    return found if len(found) == len(cuts) else None
