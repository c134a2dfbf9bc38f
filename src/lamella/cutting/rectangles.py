"""Rectangles on sheets: shelves across the sheet, the highest first (first fit decreasing height).

E. G. Coffman, M. R. Garey, D. S. Johnson, R. E. Tarjan, Performance bounds for level-oriented two-dimensional packing
algorithms, SIAM J. Comput. 9 (1980) 808: at most 17/10 of the least height, and one shelf more.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.cutting.lanes import LENGTH_ROUNDING


@dataclass(frozen=True)
class Spread:
    """Where rectangles lie.

    Attributes
    ----------
    sheets : (n,) int
        Sheet of each.
    corners : (n, 2)
        Lower left corner on it, m.
    turned : (n,) bool
        Whether its sides have changed places.
    ends : (s,)
        How far each sheet is used along its length, m.
    """

    sheets: Integers
    corners: Floats
    turned: Booleans
    ends: Floats


def spread(sizes: Floats, sheet: tuple[float, float], gap: float) -> Spread | None:
    """Lay rectangles on sheets, each as it is or turned by 90 degrees.

    Parameters
    ----------
    sizes : (n, 2)
        Along x and y, m.
    sheet : (float, float)
        Length along x and width, m.
    gap : float
        Between rectangles and to the sheet's edges, m.

    Returns
    -------
    Spread or None
        None where one is larger than a sheet. Of lying and standing rectangles what takes fewer sheets.
    """
    room = np.array(sheet) - gap + LENGTH_ROUNDING
    grown = sizes + gap
    if not np.all(np.all(grown <= room, axis=1) | np.all(grown[:, ::-1] <= room, axis=1)):
        return None
    found = [shelves(sizes, sheet, gap, standing=one) for one in (False, True)]
    return min(found, key=lambda one: (len(one.ends), round(float(one.ends[-1]), 7) if len(one.ends) else 0.0))


def shelves(
    sizes: Floats, sheet: tuple[float, float], gap: float, *, standing: bool, begun: Sequence[float] = ()
) -> Spread:
    """Lay rectangles that fit on sheets in shelves across them, lying or standing where they can.

    Parameters
    ----------
    sizes, sheet, gap
        As of `spread`.
    standing : bool
        Whether the longer sides lie along x.
    begun : sequence of float
        Sheets that something is on already: up to where along x, the gap after it included, m.
    """
    room = np.array(sheet) - gap + LENGTH_ROUNDING
    grown = sizes + gap
    plain, across = np.all(grown <= room, axis=1), np.all(grown[:, ::-1] <= room, axis=1)
    # a shelf runs across the sheet, along y
    wanted = (sizes[:, 0] > sizes[:, 1] + LENGTH_ROUNDING) != standing
    turned = np.where(wanted, across, ~plain)
    return _shelves(np.where(turned[:, None], grown[:, ::-1], grown), room, gap, turned, list(begun))


def _shelves(grown: Floats, room: Floats, gap: float, turned: Booleans, ends: list[float]) -> Spread:
    """First fit of rectangles with their gap, (n, 2), by decreasing depth along x, on sheets used up to `ends`."""
    order = np.lexsort((np.arange(len(grown)), -np.round(grown[:, 1], 7), -np.round(grown[:, 0], 7)))
    sheets, corners = np.zeros(len(grown), np.int64), np.zeros((len(grown), 2))
    # of each open shelf: sheet, x, where the next one would begin
    open_ones: list[list[float]] = []
    for k in order.tolist():
        depth, length = grown[k].tolist()
        shelf = next((one for one in open_ones if one[2] + length <= room[1] + gap), None)
        if shelf is None:
            at = next((number for number, end in enumerate(ends) if end + depth <= room[0] + gap), len(ends))
            if at == len(ends):
                ends.append(gap)
            shelf = [at, ends[at], gap]
            open_ones.append(shelf)
            ends[at] += depth
        sheets[k], corners[k] = int(shelf[0]), (shelf[1], shelf[2])
        shelf[2] += length
        # shelves with no room for the smallest are closed
        if shelf[2] + float(grown[:, 1].min()) > room[1] + gap:
            open_ones = [one for one in open_ones if one is not shelf]
    return Spread(sheets, corners, turned, np.array(ends))
