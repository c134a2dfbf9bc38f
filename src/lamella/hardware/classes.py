"""Sizes of parts that are nearly equal, made alike."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats, Integers

GRAIN = 1e-6
"""m and deg: what sizes are rounded to before they are compared, so that rounding errors decide nothing."""


def classes(values: Floats, step: float, *, lowest: bool = False) -> tuple[Integers, Floats]:
    """Group values that differ by at most `step`, from the smallest one on.

    Parameters
    ----------
    values : (q,)
    step : float
    lowest : bool
        Whether a group's size is its lowest value; its middle otherwise, a whole number of half steps.

    Returns
    -------
    kind : (q,) int
        The group of each value.
    sizes : (k,)
        Of the groups, ascending.
    """
    levels, of_level = np.unique(np.round(values / GRAIN) * GRAIN, return_inverse=True)
    kind = np.zeros(len(levels), np.int64)
    begin, number = 0, 0
    found = []
    while begin < len(levels):
        end = int(np.searchsorted(levels, levels[begin] + step + GRAIN / 2, side="right"))
        kind[begin:end] = number
        middle = np.round((levels[begin] + levels[end - 1]) / step) * step / 2
        found.append(levels[begin] if lowest else middle)
        begin, number = end, number + 1
    return kind[of_level], np.array(found)


def rounded_down(sizes: Floats, step: float) -> Floats:
    """Whole numbers of a step that are not larger."""
    return np.asarray(np.floor(sizes / step + GRAIN) * step)
