"""More samples where a lamella turns sharply: past an umbilic that is no node it turns within a fraction of a cell."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lamella.base.vectors import crosses, dots, lengths

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

# angle between the tangents of following samples, and how many times more samples a piece may get for it: at a kink, as
# in a corner of the boundary, no number is enough
TURN, MOST = 0.06, 32


def more_samples(first: Integers, count: Integers, given: Integers, tangents: Floats) -> Integers:
    """Numbers of samples on pieces of lamella with which the tangent turns by no more than `TURN` from one to the next.

    Parameters
    ----------
    first : (s,) int
        Parts into which samples divide each piece where nothing turns.
    count : (s,) int
        Parts into which these samples divide them.
    given : (s,) int
        Samples each piece has in `tangents`: its start and what follows, and its end if no piece follows on it.
    tangents : (k, 3)
        Unit tangents, piece after piece. A lamella's pieces follow each other.

    Returns
    -------
    (s,) int
        At least `count`, and at most `MOST` times `first`.
    """
    if not len(tangents):
        return count
    before, after = tangents[:-1], tangents[1:]
    turn = np.r_[np.arctan2(lengths(crosses(before, after)), dots(before, after)), 0.0]
    end = np.cumsum(given)
    # from the last sample of a lamella to the first one of the next nothing turns
    turn[end[given > count] - 1] = 0.0
    largest = np.maximum.reduceat(turn, end - given)
    times = np.maximum(np.ceil(largest / TURN - 1e-6), 1).astype(np.int64)
    return np.asarray(np.minimum(count * times, np.maximum(MOST * first, count)))
