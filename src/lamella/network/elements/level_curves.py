"""Lamellas as chains of pieces with a running coordinate, from the level lines of both families."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.triangle import CORNERS
from lamella.network.elements.integer_grid_map import IntegerGridMap
from lamella.network.elements.level_chains import CLOSED, SINGULAR_END, Chains
from lamella.network.elements.small_triangles import SmallTriangles
from lamella.network.network import A, B
from lamella.surface.element.places import Places

# Newton steps to a place on an element's edge, and of the edge: the step after one as small as this is rounding
EDGE_STEPS, EDGE_FINE = 8, 1e-7


@dataclass(frozen=True)
class LevelCurves:
    """Chains of both families with a running coordinate tau in cells, A before B."""

    family: Integers  # of each chain
    ends: Integers  # (c, 2)
    owner: Integers  # chain of each link
    triangle: Integers
    level: Integers
    start: Floats
    direction: Floats  # +-1: how the other coordinate runs along the chain
    tau: Floats  # at the link's start, counted from the chain's
    span: Floats
    local_start: Floats
    local_end: Floats
    element: Integers

    @cached_property
    def first(self) -> Integers:
        """First link of each chain."""
        return np.searchsorted(self.owner, np.arange(len(self.family)))

    @cached_property
    def last(self) -> Integers:
        """Last link of each chain."""
        return np.searchsorted(self.owner, np.arange(len(self.family)), side="right") - 1

    @cached_property
    def links(self) -> Integers:
        """Number of links of each chain."""
        return self.last - self.first + 1

    def arranged(self, chains: Integers, backward: Booleans, rolled: Integers) -> LevelCurves:
        """Some of the chains in another order.

        Parameters
        ----------
        chains : (c,) int
        backward : (c,) bool
            Which of these run the other way.
        rolled : (c,) int
            Which link of each goes first; on a chain that does not close the first or the last one.
        """
        first, count = self.first[chains], self.links[chains]
        owner = np.repeat(np.arange(len(chains)), count)
        place = np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)
        back = backward[owner]
        place = np.where(back, rolled[owner] - place, rolled[owner] + place)
        link = first[owner] + place % count[owner]
        end = self.start + self.direction * self.span
        span = self.span[link]
        running = np.cumsum(span) - span
        begin = np.searchsorted(owner, np.arange(len(chains)))
        return LevelCurves(
            self.family[chains],
            np.where(backward[:, None], self.ends[chains][:, ::-1], self.ends[chains]),
            owner,
            self.triangle[link],
            self.level[link],
            np.where(back, end[link], self.start[link]),
            np.where(back, -self.direction[link], self.direction[link]),
            running - running[begin][owner] if len(begin) else running,
            span,
            np.where(back[:, None], self.local_end[link], self.local_start[link]),
            np.where(back[:, None], self.local_start[link], self.local_end[link]),
            self.element[link],
        )


def make_level_curves(small: SmallTriangles, chains: tuple[Chains, Chains]) -> LevelCurves:
    """Chains of the families A and B with their running coordinate."""
    counts = [len(c.offsets) - 1 for c in chains]
    owner = np.concatenate([chains[A].owner, chains[B].owner + counts[0]])

    def both(name: str) -> NDArray[np.generic]:
        return np.concatenate([getattr(c, name) for c in chains])

    start, end = both("start").astype(float), both("end").astype(float)
    span = np.abs(end - start)
    running = np.cumsum(span) - span
    first = np.searchsorted(owner, np.arange(sum(counts)))
    triangle = both("triangle").astype(np.int64)
    return LevelCurves(
        np.repeat([A, B], counts),
        both("ends").astype(np.int64),
        owner,
        triangle,
        both("level").astype(np.int64),
        start,
        np.where(end >= start, 1.0, -1.0),
        running - running[first][owner],
        span,
        both("local_start").astype(float),
        both("local_end").astype(float),
        small.element[triangle],
    )


def singular_ends(cells: IntegerGridMap, level_curves: LevelCurves) -> Integers:
    """Row of the umbilic in `cells.mesh.umbilics` at each end of the chains, (c, 2), -1 where there is none."""
    result = np.full(level_curves.ends.shape, -1)
    mesh = cells.mesh
    inside = np.flatnonzero(mesh.umbilics >= 0)
    for side, (link, local) in enumerate(
        ((level_curves.first, level_curves.local_start), (level_curves.last, level_curves.local_end))
    ):
        mine = np.flatnonzero(level_curves.ends[:, side] == SINGULAR_END)
        if len(mine):
            at = cells.tangents(Places(level_curves.element[link[mine]], local[link[mine]]))[0]
            apart = np.linalg.norm(at[:, None] - mesh.nodes[mesh.umbilics[inside]], axis=2)
            result[mine, side] = inside[apart.argmin(1)]
    return result


def rim_tips(cells: IntegerGridMap, level_curves: LevelCurves) -> tuple[Floats, Places]:
    """Exact tau of the chains' ends, (c, 2), where the boundary edge has the chain's level, and their places (2 c)."""
    last = level_curves.last
    tips = np.stack([np.zeros(len(last)), level_curves.tau[last] + level_curves.span[last]], 1)
    local = np.stack([level_curves.local_start[level_curves.first], level_curves.local_end[last]], 1)
    for side, link in enumerate((level_curves.first, last)):
        mine = np.flatnonzero((level_curves.ends[:, side] != SINGULAR_END) & (level_curves.ends[:, side] != CLOSED))
        tips[mine, side], local[mine, side] = _on_edges(cells, level_curves, link[mine], local[mine, side])
    element = level_curves.element[np.stack([level_curves.first, last], 1)]
    return tips, Places(element.ravel(), local.reshape(-1, 2))


def passages(cells: IntegerGridMap, level_curves: LevelCurves) -> tuple[Integers, Floats]:
    """Chain and exact tau of every place where a chain goes over from one element to the next, closed ones twice.

    A closed chain's come again a whole way further on, where it is passed beyond its first place.
    """
    following = np.arange(1, len(level_curves.owner) + 1)
    closed = level_curves.ends[:, 0] == CLOSED
    following[level_curves.last] = np.where(closed, level_curves.first, level_curves.last)
    link = np.flatnonzero(level_curves.element != level_curves.element[following])
    # element by element they are found sooner
    link = link[np.argsort(level_curves.element[link], kind="stable")]
    tau, _ = _on_edges(cells, level_curves, link, level_curves.local_end[link])
    chain = level_curves.owner[link]
    again = closed[chain]
    last = level_curves.last[chain[again]]
    return np.r_[chain, chain[again]], np.r_[tau, tau[again] + level_curves.tau[last] + level_curves.span[last]]


def _on_edges(cells: IntegerGridMap, level_curves: LevelCurves, link: Integers, local: Floats) -> tuple[Floats, Floats]:
    """Exact tau (n,) and place (n, 2) of places (n, 2) of links on edges: where the edge has the chain's level."""
    basis = CORNERS
    barycentric = np.column_stack([1 - local.sum(1), local])
    edge = (barycentric.argmin(1) + 1) % 3
    begin, along = basis[edge], basis[(edge + 1) % 3] - basis[edge]
    share = ((local - begin) * along).sum(1) / (along**2).sum(1)
    element, level = level_curves.element[link], level_curves.level[link]
    is_a = level_curves.family[level_curves.owner[link]] == A
    for _ in range(EDGE_STEPS):
        chi, chi_x, chi_y = cells.jet(Places(element, begin + share[:, None] * along))
        slope = chi_x * along[:, 0] + chi_y * along[:, 1]
        residual = np.where(is_a, chi.imag, chi.real) - level
        before, share = share, np.clip(share - residual / np.where(is_a, slope.imag, slope.real), 0, 1)
        if np.abs(share - before).max(initial=0.0) < EDGE_FINE:
            break
    there = begin + share[:, None] * along
    chi, _, _ = cells.jet(Places(element, there))
    other = np.where(is_a, chi.real, chi.imag)
    return np.asarray(level_curves.tau[link] + (other - level_curves.start[link]) * level_curves.direction[link]), there
