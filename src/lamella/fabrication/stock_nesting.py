"""All pieces on the stock that costs least."""

from __future__ import annotations

from dataclasses import replace
from math import isfinite

import numpy as np

from lamella.base.errors import InputError
from lamella.fabrication.blanks import Blank, blank_of
from lamella.fabrication.part import Parts
from lamella.fabrication.sheet import Nesting, nest, pieces_of
from lamella.fabrication.stock import Supply
from lamella.fabrication.stock_layout import Laid, lay


def nest_on_stock(parts: Parts, supply: Supply) -> Nesting:
    """Lay all pieces on stock: on one sheet or coil, or on bars of several lengths, whatever costs least.

    Parameters
    ----------
    parts : Parts
    supply : Supply

    Returns
    -------
    Nesting

    Raises
    ------
    InputError
        A part is larger than all of the stock.
    """
    of_part, copies = pieces_of(parts)
    blanks = [blank_of(part) for part in parts.parts]
    bow = max((part.bow for part in parts.parts), default=0.0)
    pieces = [replace(blanks[index], piece=piece) for piece, index in enumerate(of_part.tolist())]
    laid = _all_laid(pieces, supply, bow)
    if not isfinite(laid.cost):
        raise _too_large(parts, supply, bow)
    simple = _sheet_after_sheet(parts, supply)
    if simple is not None and simple[0] < laid.cost * (1 - 1e-9):
        return simple[1]
    places = np.array(sorted(laid.places), dtype=float).reshape(-1, 4)
    turned = np.array([blanks[index].turned for index in of_part.tolist()], dtype=bool)
    return Nesting(
        of_part,
        copies,
        places[:, 1].astype(np.int64),
        places[:, 2],
        places[:, 3],
        np.where(turned, 180.0, 0.0),
        np.array(laid.sizes, dtype=float).reshape(-1, 2),
        0,
        supply.gap,
        parts,
        tuple(laid.stocks),
    )


def _all_laid(pieces: list[Blank], supply: Supply, bow: float) -> Laid:
    """Pieces of each radius on stock of their own: on levels the families' radii differ."""
    groups: dict[tuple[float, float], list[Blank]] = {}
    for blank in pieces:
        groups.setdefault((round(blank.radius, 9), blank.height), []).append(blank)
    found = Laid(0.0, [], [], [])
    for key in sorted(groups):
        own = lay(groups[key], supply, bow)
        places = [(piece, number + len(found.stocks), x, y) for piece, number, x, y in own.places]
        found = Laid(found.cost + own.cost, found.stocks + own.stocks, found.sizes + own.sizes, found.places + places)
    return found


def _sheet_after_sheet(parts: Parts, supply: Supply) -> tuple[float, Nesting] | None:
    """What one size of sheet alone comes to, filled one after the other; its cost."""
    found = []
    for stock in supply.stocks:
        if stock.kind == "sheet":
            nesting = nest(parts, sheet=(stock.length, stock.width), gap=supply.gap)
            if not nesting.oversize:
                cost = nesting.sheet_count * supply.cost(stock)
                found.append((cost, replace(nesting, stocks=(stock,) * nesting.sheet_count)))
    return min(found, key=lambda one: one[0], default=None)


def _too_large(parts: Parts, supply: Supply, bow: float) -> InputError:
    """The longest part that fits none of the stock; where each fits some, together they fit none."""
    longest = max(parts.parts, key=lambda part: round(part.length, 7))
    labels = ", ".join(stock.label for stock in supply.stocks)
    half_width, depth = 0.5 * (longest.bounds[2] - longest.bounds[0]), longest.bounds[3] - longest.bounds[1]
    return InputError(
        f"{longest.id}, {longest.length:.4g} m long, fits none of the stock ({labels}): it takes "
        f"{2 * half_width:.4g} x {depth:.4g} m, and on sheets {supply.gap:g} m to each edge",
        f"add stock that is {2 * (half_width + supply.gap):.4g} m long or longer, or choose more cells, between which "
        "lamellas are cut",
        "stock",
    )
