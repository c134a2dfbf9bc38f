"""Where the lamellas of one family cross those of the other."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.ragged import ragged_ranges
from lamella.network.elements.level_curves import LevelCurves
from lamella.network.network import A


class Crossings(NamedTuple):
    """Crossings of an A chain and a B chain each.

    Attributes
    ----------
    chain : (2, n) int
        The A and the B chain.
    tau : (2, n)
        Where along these, cells.
    """

    chain: Integers
    tau: Floats

    def take(self, some: Booleans) -> Crossings:
        """Some of them."""
        return Crossings(self.chain[:, some], self.tau[:, some])

    def of(self, chains: Booleans) -> Crossings:
        """Those of some of the chains (c,)."""
        a, b = self.chain
        return self.take(chains[a] & chains[b])


def find_crossings(level_curves: LevelCurves) -> Crossings:
    """Every whole number of the other coordinate that a chain passes where a chain of the other family does so too."""
    end = level_curves.start + level_curves.direction * level_curves.span
    low, high = np.minimum(level_curves.start, end), np.maximum(level_curves.start, end)
    first, last = np.floor(low).astype(np.int64) + 1, np.ceil(high).astype(np.int64) - 1
    count = np.maximum(last - first + 1, 0)
    link = np.repeat(np.arange(len(count)), count)
    whole = first[link] + ragged_ranges(count)
    is_a = level_curves.family[level_curves.owner[link]] == A
    levels = [np.where(is_a, level_curves.level[link], whole), np.where(is_a, whole, level_curves.level[link])]
    parts = [level_curves.triangle[link], *(level - level.min(initial=0) for level in levels)]
    name = np.ravel_multi_index(parts, [int(part.max(initial=0)) + 1 for part in parts])
    _, number = np.unique(name, return_inverse=True)
    number = number.ravel()
    names = int(number.max(initial=-1)) + 1
    both = (np.bincount(number[is_a], minlength=names) == 1) & (np.bincount(number[~is_a], minlength=names) == 1)
    tau = level_curves.tau[link] + np.abs(whole - level_curves.start[link])
    of_family = [np.flatnonzero(both[number] & mine) for mine in (is_a, ~is_a)]
    pairs = np.stack([at[np.argsort(number[at], kind="stable")] for at in of_family])
    return Crossings(level_curves.owner[link][pairs], tau[pairs])
