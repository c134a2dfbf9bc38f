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
    reach = longest * (1 + 1e-12)
    if end - start <= reach:
        return np.empty(0)
    middles = 0.5 * (nodes[1:] + nodes[:-1])
    bounds = np.concatenate(([start], middles[(middles > start) & (middles < end)], [end]))
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
