"""Lists of unequal length, one after the other in one array."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Integers


def ragged_ranges(counts: Integers) -> Integers:
    """0..counts[0]-1, 0..counts[1]-1, ... one after the other."""
    ends = np.cumsum(counts)
    return np.arange(ends[-1] if len(ends) else 0) - np.repeat(ends - counts, counts)
