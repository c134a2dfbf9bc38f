"""Flat shapes on sheets: lattices of equal ones where these take less than their rectangles, the others in shelves.

Of a shape of which there are many a slab is cut off the sheets, as wide as they are, in which its copies stand in
their densest lattice (`lamella.cutting.lattice`). Slabs are laid first, the longest first; then rectangles of the other
shapes fill what is left (`lamella.cutting.rectangles`). What that takes is compared with rectangles alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.cutting.lanes import LENGTH_ROUNDING
from lamella.cutting.lattice import Lattice, densest_lattice
from lamella.cutting.rectangles import Spread, shelves, spread

LEAST_COPIES = 6
"""Of a shape that has a slab of its own."""
FILLED = 0.85
"""Share of its rectangle above which a shape has none."""


@dataclass(frozen=True, eq=False)
class _Slab:
    """Copies of one shape on a length of sheet: corners (q, 2) from its beginning, m; all turned or none."""

    kind: int
    corners: Floats
    length: float
    turned: bool


def nested(outlines: Sequence[Floats], quantities: Integers, sheet: tuple[float, float], gap: float) -> list[Spread]:
    """Ways of laying shapes on sheets, by their rectangles and by their outlines; none where one is too large.

    Parameters
    ----------
    outlines : sequence of (n, 2)
        Corners of every kind of shape, m.
    quantities : (k,) int
    sheet : (float, float)
        Length along x and width, m.
    gap : float
        Between shapes and to the sheet's edges, m.

    Returns
    -------
    list of Spread
        Of all copies, kind by kind.
    """
    sizes = np.array([np.ptp(outline, axis=0) for outline in outlines]).reshape(-1, 2)
    kinds = np.repeat(np.arange(len(sizes)), quantities)
    plain = spread(sizes[kinds], sheet, gap)
    if plain is None:
        return []
    slabs = [
        slab
        for kind, (outline, quantity) in enumerate(zip(outlines, quantities.tolist(), strict=True))
        if quantity >= LEAST_COPIES and _area(outline) < FILLED * float(np.prod(sizes[kind]))
        for slab in _slabs(kind, outline, quantity, sheet, gap)
    ]
    return [plain, _with_slabs(slabs, sizes, kinds, sheet, gap)] if slabs else [plain]


def _area(outline: Floats) -> float:
    x, y = outline.T
    return abs(float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))) / 2


def _slabs(kind: int, outline: Floats, quantity: int, sheet: tuple[float, float], gap: float) -> list[_Slab]:
    """Slabs of all copies, in the way that takes less of the sheets; none where rectangles take no more."""
    size = np.ptp(outline, axis=0)
    room = np.array(sheet) - 2 * gap
    lattice = densest_lattice(outline, gap)
    ways = []
    for turned in (False, True):
        there = size[::-1] if turned else size
        steps = lattice.steps @ np.array([[0.0, 1.0], [-1.0, 0.0]]) if turned else lattice.steps
        if (there <= room + LENGTH_ROUNDING).all():
            ways.append(_cut_off(kind, Lattice(steps), there, quantity, room, gap, turned))
    best = min(ways, key=lambda way: round(sum(one.length for one in way), 7))
    # by rectangles: shelves across the sheet, lying or standing
    plain = []
    for a, b in (size, size[::-1]):
        if a <= room[0] + LENGTH_ROUNDING and b <= room[1] + LENGTH_ROUNDING:
            across = int((room[1] + gap + LENGTH_ROUNDING) / (b + gap))
            plain.append(-(-quantity // across) * (a + gap))
    return best if sum(one.length for one in best) < min(plain) - LENGTH_ROUNDING else []


def _cut_off(
    kind: int, lattice: Lattice, size: Floats, quantity: int, room: Floats, gap: float, turned: bool
) -> list[_Slab]:
    """Slabs of a lattice across the sheet: whole sheets, and what the last copies take."""
    points = lattice.points(float(room[0] - size[0]), float(room[1] - size[1]))
    found, left = [], quantity
    while left:
        own = points[:left]
        own = own - np.array([own[:, 0].min(), 0.0])
        # what it takes of the sheet's length with the gap after it
        length = float(own[:, 0].max() + size[0] + gap)
        found.append(_Slab(kind, own, length, turned))
        left -= len(own)
    return found


def _with_slabs(slabs: list[_Slab], sizes: Floats, kinds: Integers, sheet: tuple[float, float], gap: float) -> Spread:
    """Slabs on sheets, the longest first; then the rectangles of all other copies."""
    count = len(kinds)
    sheets, corners, turned = np.zeros(count, np.int64), np.zeros((count, 2)), np.zeros(count, bool)
    done = np.zeros(count, bool)
    following = np.searchsorted(kinds, np.arange(len(sizes)))
    ends: list[float] = []
    for slab in sorted(slabs, key=lambda one: (-round(one.length, 7), one.kind)):
        fits = (k for k, end in enumerate(ends) if end + slab.length <= sheet[0] + LENGTH_ROUNDING)
        at = next(fits, len(ends))
        if at == len(ends):
            ends.append(gap)
        own = slice(int(following[slab.kind]), int(following[slab.kind]) + len(slab.corners))
        following[slab.kind] += len(slab.corners)
        sheets[own], turned[own], done[own] = at, slab.turned, True
        corners[own] = slab.corners + np.array([ends[at], gap])
        ends[at] += slab.length
    rest = np.flatnonzero(~done)
    ways = [shelves(sizes[kinds[rest]], sheet, gap, standing=one, begun=ends) for one in (False, True)]
    best = min(ways, key=lambda one: (len(one.ends), round(float(one.ends[-1]), 7)))
    return _joined(best, rest, Spread(sheets, corners, turned, np.array(ends)))


def _joined(found: Spread, rest: Integers, whole: Spread) -> Spread:
    """All copies: those in slabs, and the rest as found."""
    sheets, corners, turned = whole.sheets.copy(), whole.corners.copy(), whole.turned.copy()
    sheets[rest], corners[rest], turned[rest] = found.sheets, found.corners, found.turned
    return Spread(sheets, corners, turned, found.ends)
