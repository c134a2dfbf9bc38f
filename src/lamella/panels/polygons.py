"""Polygons over the nodes of a net, stored one after the other."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lamella.base.arrays import Integers


@dataclass(frozen=True, eq=False)
class Polygons:
    """Polygons, counter-clockwise about the surface normal.

    Attributes
    ----------
    offsets : (p + 1,) int
    nodes : (e,) int
        Corners of polygon k from ``offsets[k]`` to ``offsets[k + 1]``.
    centres : (p,) int
        The node that a polygon is laid around, -1 where there is none.
    around : (p,) bool
        Whether it goes all around that node.
    """

    offsets: Integers
    nodes: Integers
    centres: Integers
    around: np.ndarray[tuple[int], np.dtype[np.bool_]]

    def __len__(self) -> int:
        return len(self.centres)

    @property
    def sizes(self) -> Integers:
        """Number of corners, (p,)."""
        return np.diff(self.offsets)

    @cached_property
    def owner(self) -> Integers:
        """Polygon of each corner, (e,)."""
        return np.repeat(np.arange(len(self)), self.sizes)

    def by_size(self) -> Iterator[tuple[Integers, Integers]]:
        """For each number of corners n the polygons (q,) and where their corners are stored, (q, n)."""
        sizes = self.sizes
        for n in np.unique(sizes).tolist():
            some = np.flatnonzero(sizes == n)
            yield some, self.offsets[:-1][some][:, None] + np.arange(n)

    def following(self) -> Integers:
        """Where the next corner around each polygon is stored, (e,)."""
        last = self.offsets[1:] - 1
        following = np.arange(1, len(self.nodes) + 1)
        following[last] = self.offsets[:-1]
        return following

    def kept(self, some: Integers) -> Polygons:
        """Some of them, by their numbers."""
        sizes = self.sizes[some]
        starts = np.repeat(self.offsets[:-1][some] - np.r_[0, np.cumsum(sizes)[:-1]], sizes)
        nodes = self.nodes[starts + np.arange(int(sizes.sum()))]
        return Polygons(np.r_[0, np.cumsum(sizes)], nodes, self.centres[some], self.around[some])

    @classmethod
    def joined(cls, parts: list[Polygons]) -> Polygons:
        """All of some lists, one after the other."""
        sizes = np.concatenate([part.sizes for part in parts])
        return cls(
            np.r_[0, np.cumsum(sizes)],
            *(np.concatenate([getattr(part, name) for part in parts]) for name in ("nodes", "centres", "around")),
        )
