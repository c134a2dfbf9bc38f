"""Lamellas as chains of pieces with a running coordinate, from the level lines of both families."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.network.elements.integer_grid_map import CellMap
from lamella.network.elements.level_lines import CLOSED, SINGULAR_END, Chains, SmallTriangles
from lamella.network.network import A, B
from lamella.surface.element.places import Places

# Newton steps to a place on an element's edge, and of the edge: the step after one as small as this is rounding
EDGE_STEPS, EDGE_FINE = 8, 1e-7


@dataclass(frozen=True)
class Tracks:
    """Chains of both families with a running coordinate tau in cells, A before B."""

    family: Integers  # of each chain
    ends: Integers  # (c, 2)
    owner: Integers  # chain of each link
    triangle: Integers
    level: Integers
    start: Floats
    way: Floats  # +-1: how the other coordinate runs along the chain
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

    def arranged(self, chains: Integers, backward: Booleans, rolled: Integers) -> Tracks:
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
        end = self.start + self.way * self.span
        span = self.span[link]
        running = np.cumsum(span) - span
        begin = np.searchsorted(owner, np.arange(len(chains)))
        return Tracks(
            self.family[chains],
            np.where(backward[:, None], self.ends[chains][:, ::-1], self.ends[chains]),
            owner,
            self.triangle[link],
            self.level[link],
            np.where(back, end[link], self.start[link]),
            np.where(back, -self.way[link], self.way[link]),
            running - running[begin][owner] if len(begin) else running,
            span,
            np.where(back[:, None], self.local_end[link], self.local_start[link]),
            np.where(back[:, None], self.local_start[link], self.local_end[link]),
            self.element[link],
        )


def make_tracks(small: SmallTriangles, chains: tuple[Chains, Chains]) -> Tracks:
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
    return Tracks(
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


def singular_ends(cells: CellMap, tracks: Tracks) -> Integers:
    """Row of the umbilic in `cells.mesh.umbilics` at each end of the chains, (c, 2), -1 where there is none."""
    result = np.full(tracks.ends.shape, -1)
    mesh = cells.mesh
    inside = np.flatnonzero(mesh.umbilics >= 0)
    for side, (link, local) in enumerate(((tracks.first, tracks.local_start), (tracks.last, tracks.local_end))):
        mine = np.flatnonzero(tracks.ends[:, side] == SINGULAR_END)
        if len(mine):
            at = cells.tangents(Places(tracks.element[link[mine]], local[link[mine]]))[0]
            apart = np.linalg.norm(at[:, None] - mesh.nodes[mesh.umbilics[inside]], axis=2)
            result[mine, side] = inside[apart.argmin(1)]
    return result


def rim_tips(cells: CellMap, tracks: Tracks) -> tuple[Floats, Places]:
    """Exact tau of the chains' ends, (c, 2), where the boundary edge has the chain's level, and their places (2 c)."""
    last = tracks.last
    tips = np.stack([np.zeros(len(last)), tracks.tau[last] + tracks.span[last]], 1)
    local = np.stack([tracks.local_start[tracks.first], tracks.local_end[last]], 1)
    for side, link in enumerate((tracks.first, last)):
        mine = np.flatnonzero((tracks.ends[:, side] != SINGULAR_END) & (tracks.ends[:, side] != CLOSED))
        tips[mine, side], local[mine, side] = _on_edges(cells, tracks, link[mine], local[mine, side])
    element = tracks.element[np.stack([tracks.first, last], 1)]
    return tips, Places(element.ravel(), local.reshape(-1, 2))


def passages(cells: CellMap, tracks: Tracks) -> tuple[Integers, Floats]:
    """Chain and exact tau of every place where a chain goes over from one element to the next, closed ones twice.

    A closed chain's come again a whole way further on, where it is passed beyond its first place.
    """
    following = np.arange(1, len(tracks.owner) + 1)
    closed = tracks.ends[:, 0] == CLOSED
    following[tracks.last] = np.where(closed, tracks.first, tracks.last)
    link = np.flatnonzero(tracks.element != tracks.element[following])
    # element by element they are found sooner
    link = link[np.argsort(tracks.element[link], kind="stable")]
    tau, _ = _on_edges(cells, tracks, link, tracks.local_end[link])
    chain = tracks.owner[link]
    again = closed[chain]
    last = tracks.last[chain[again]]
    return np.r_[chain, chain[again]], np.r_[tau, tau[again] + tracks.tau[last] + tracks.span[last]]


def _on_edges(cells: CellMap, tracks: Tracks, link: Integers, local: Floats) -> tuple[Floats, Floats]:
    """Exact tau (n,) and place (n, 2) of places (n, 2) of links on edges: where the edge has the chain's level."""
    basis = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    barycentric = np.column_stack([1 - local.sum(1), local])
    edge = (barycentric.argmin(1) + 1) % 3
    begin, along = basis[edge], basis[(edge + 1) % 3] - basis[edge]
    share = ((local - begin) * along).sum(1) / (along**2).sum(1)
    element, level = tracks.element[link], tracks.level[link]
    is_a = tracks.family[tracks.owner[link]] == A
    for _ in range(EDGE_STEPS):
        chi, chi_x, chi_y = cells.jet(Places(element, begin + share[:, None] * along))
        slope = chi_x * along[:, 0] + chi_y * along[:, 1]
        miss = np.where(is_a, chi.imag, chi.real) - level
        before, share = share, np.clip(share - miss / np.where(is_a, slope.imag, slope.real), 0, 1)
        if np.abs(share - before).max(initial=0.0) < EDGE_FINE:
            break
    there = begin + share[:, None] * along
    chi, _, _ = cells.jet(Places(element, there))
    other = np.where(is_a, chi.real, chi.imag)
    return np.asarray(tracks.tau[link] + (other - tracks.start[link]) * tracks.way[link]), there
