"""Where a strip too long for its sheet is cut: between nodes, into few and nearly equal pieces."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats

# of the strip: of two cuts whose distances from that of equal pieces differ by less the later one is taken
TIE = 1e-9


def cut_stations(start: float, end: float, nodes: Floats, longest: float) -> Floats | None:
    """Stations at which to cut a strip so that no piece is longer than ``longest``.

    Cuts lie midway between neighbouring nodes. The number of pieces is the least possible; cuts nearest to
    equal pieces are taken where these fit.

    Parameters
    ----------
    start, end : float
        Stations of the strip's ends, m.
    nodes : (n,)
        Ascending stations of its nodes, m.
    longest : float
        Length of the longest piece allowed, m.

    Returns
    -------
    (c,) array or None
        Ascending stations, m, empty where the strip is short enough; None where a single cell is too long.
    """
    return cut_bounds(bounds_between(start, end, nodes), longest)


def bounds_between(start: float, end: float, nodes: Floats, slots: Floats | None = None, reach: float = 0.0) -> Floats:
    """Stations where a strip may be cut, midway between nodes, and those of its ends, ascending, m.

    Parameters
    ----------
    start, end, nodes
        As in `cut_stations`.
    slots : (k,), optional
        Ascending stations of the slots' axes, m.
    reach : float
        Least distance from a cut to a slot's axis, m.
    """
    middles = 0.5 * (nodes[1:] + nodes[:-1])
    middles = middles[(middles > start) & (middles < end)]
    if slots is not None and len(slots):
        after = np.searchsorted(slots, middles)
        behind = np.where(after > 0, middles - slots[after - 1], np.inf)
        ahead = np.where(after < len(slots), slots[np.minimum(after, len(slots) - 1)] - middles, np.inf)
        middles = middles[np.minimum(behind, ahead) >= reach]
    return np.concatenate(([start], middles, [end]))


def cut_bounds(bounds: Floats, longest: float) -> Floats | None:
    """Where to cut a strip that may be cut at some stations (b,), m, the first and last of which are its ends.

    See `cut_stations`.
    """
    start, end = float(bounds[0]), float(bounds[-1])
    reach = longest * (1 + 1e-12)
    if end - start <= reach:
        return np.empty(0)
    chosen = [0]
    while chosen[-1] < len(bounds) - 1:
        step = int(np.searchsorted(bounds, bounds[chosen[-1]] + reach, side="right")) - 1
        if step == chosen[-1]:
            return None
        chosen.append(step)
    pieces = len(chosen) - 1
    targets = start + (end - start) * np.arange(1, pieces) / pieces
    after = np.clip(np.searchsorted(bounds, targets), 1, len(bounds) - 1)
    # the earlier one of two equally near, whatever rounding says: equal lamellas are to be cut alike
    nearer = bounds[after] - targets < targets - bounds[after - 1] - TIE * (end - start)
    nearest = np.where(nearer, after, after - 1)
    equal = np.concatenate(([start], bounds[nearest], [end]))
    lengths = np.diff(equal)
    if np.all(lengths > 0) and np.all(lengths <= reach):
        return np.asarray(equal[1:-1])
    return np.asarray(bounds[chosen[1:-1]])
