"""Which variants no other one is better than: the Pareto front."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Booleans, Floats


def pareto_front(costs: Floats) -> Booleans:
    """Whether no row is as good in all columns and better in one, (n,).

    Parameters
    ----------
    costs : (n, m)
        Small is good; rows with a NaN are on no front. Equal rows are on it together.
    """
    count = len(costs)
    front = np.zeros(count, bool)
    valid = np.flatnonzero(np.isfinite(costs).all(1))
    # sorted by the first cost, a row is dominated by earlier ones and by those equal in it only
    order = valid[np.lexsort(costs[valid].T[::-1])]
    best = np.zeros((0, costs.shape[1]))
    for row in order:
        here = costs[row]
        if not ((best <= here).all(1) & (best < here).any(1)).any():
            front[row] = True
            best = np.vstack([best, here])
    return front
