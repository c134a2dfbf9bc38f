"""Rectangles on sheets: shelves across the sheet, the highest first (first fit decreasing height).

E. G. Coffman, M. R. Garey, D. S. Johnson, R. E. Tarjan, Performance bounds for level-oriented two-dimensional packing
algorithms, SIAM J. Comput. 9 (1980) 808: at most 17/10 of the least height, and one shelf more.
"""

from __future__ import annotations

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
    plain, across = np.all(grown <= room, axis=1), np.all(grown[:, ::-1] <= room, axis=1)
    if not np.all(plain | across):
        return None
    found = []
    for standing in (False, True):
        # a shelf runs across the sheet, along y
        wanted = (sizes[:, 0] > sizes[:, 1] + LENGTH_ROUNDING) != standing
        turned = np.where(wanted, across, ~plain)
        found.append(_shelves(np.where(turned[:, None], grown[:, ::-1], grown), room, gap, turned))
    return min(found, key=lambda one: (len(one.ends), round(float(one.ends[-1]), 7) if len(one.ends) else 0.0))


def _shelves(grown: Floats, room: Floats, gap: float, turned: Booleans) -> Spread:
    """First fit of rectangles with their gap, (n, 2), by decreasing depth along x."""
    order = np.lexsort((np.arange(len(grown)), -np.round(grown[:, 1], 7), -np.round(grown[:, 0], 7)))
    sheets, corners = np.zeros(len(grown), np.int64), np.zeros((len(grown), 2))
    # of each open shelf: sheet, x, where the next one would begin
    shelves: list[list[float]] = []
    ends: list[float] = []
    for k in order.tolist():
        depth, length = grown[k].tolist()
        shelf = next((one for one in shelves if one[2] + length <= room[1] + gap), None)
        if shelf is None:
            at = next((number for number, end in enumerate(ends) if end + depth <= room[0] + gap), len(ends))
            if at == len(ends):
                ends.append(gap)
            shelf = [at, ends[at], gap]
            shelves.append(shelf)
            ends[at] += depth
        sheets[k], corners[k] = int(shelf[0]), (shelf[1], shelf[2])
        shelf[2] += length
        # shelves with no room for the smallest are closed
        if shelf[2] + float(grown[:, 1].min()) > room[1] + gap:
            shelves = [one for one in shelves if one is not shelf]
    return Spread(sheets, corners, turned, np.array(ends))
