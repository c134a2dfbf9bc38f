"""Which lamella meets which, and where they end: the net as combinatorics, before any metric."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.ragged import ragged_ranges
from lamella.network.lattice.domain import RIM_TOLERANCE, Domain, Lines, Rim
from lamella.network.network import BOUNDARY, REGULAR, SINGULAR, A

# cells; how far from its end a line may meet the rim tolerance: lines that graze the rim do so at a small angle
LINE_NEAR_END = 0.02


@dataclass(frozen=True)
class Lattice:
    """Lines with their stops; a stop is a node of the net on a line.

    Attributes
    ----------
    lines : Lines
        (m,) lamellas.
    offsets : (m + 1,) int
        Where each line's stops begin.
    t : (q,)
        Cell coordinate of each stop along its line.
    nodes : (q,) int
        Node index of each stop.
    kinds : (n,) int
        Kind of each node (`lamella.network.network.NODE_KINDS`).
    rim : Rim
        Rim data of every node (meaningful for boundary nodes).
    """

    lines: Lines
    offsets: Integers
    t: Floats
    nodes: Integers
    kinds: Integers
    rim: Rim

    @property
    def owner(self) -> Integers:
        """Line of each stop, (q,)."""
        return np.repeat(np.arange(len(self.offsets) - 1), np.diff(self.offsets))


def build_lattice(domain: Domain, lines: Lines) -> Lattice:
    """Nodes where lines of the two families cross and where lines end.

    A crossing is a node when both families have a line there; a crossing within `RIM_TOLERANCE` cells of the
    rim is one boundary node for both.

    Parameters
    ----------
    domain : Domain
    lines : Lines
        Some or all of ``domain.lines()``.
    """
    first = np.ceil(lines.start - LINE_NEAR_END).astype(np.int64)
    count = np.maximum(np.floor(lines.end + LINE_NEAR_END).astype(np.int64) - first + 1, 0)
    line = np.repeat(np.arange(len(count)), count)
    t = (first[line] + ragged_ranges(count)).astype(float)
    place = domain.place(lines.sheet[line], lines.base[line] + t * lines.direction[line])
    on_rim = np.abs(domain.rim(place).distance) <= RIM_TOLERANCE
    seen = on_rim | ((t >= lines.start[line]) & (t <= lines.end[line]))
    line, t, on_rim = line[seen], t[seen], on_rim[seen]
    point = lines.base[line] + t * lines.direction[line]
    names = domain.canonical(lines.sheet[line], point)

    # one integer a lattice point
    low = names.min(0) if len(names) else np.zeros(3, np.int64)
    span = (names.max(0) - low + 1) if len(names) else np.ones(3, np.int64)
    key = ((names[:, 0] - low[0]) * span[1] + (names[:, 1] - low[1])) * span[2] + (names[:, 2] - low[2])
    _, crossing = np.unique(key, return_inverse=True)
    crossings = int(crossing.max()) + 1 if len(crossing) else 0
    is_a = lines.family[line] == A
    degree_a = np.bincount(crossing[is_a], minlength=crossings)
    degree_b = np.bincount(crossing[~is_a], minlength=crossings)

    singular = lines.singular[line] & (t == 0)
    # judged once for both lines of a crossing, whose places differ by rounding
    on_rim = np.bincount(crossing, on_rim, minlength=crossings)[crossing] > 0
    on_rim &= ~singular
    at_start = singular | (on_rim & (t <= lines.start[line] + LINE_NEAR_END))
    at_end = on_rim & (t >= lines.end[line] - LINE_NEAR_END)
    # on the rim and at a line's end a lattice point is a node even when the other family is missing
    node_here = at_start | at_end | ((degree_a > 0) & (degree_b > 0))[crossing]

    # ends that are no lattice point
    has_start, has_end = lines.closed.copy(), lines.closed.copy()
    has_start[line[at_start]] = True
    has_end[line[at_end]] = True
    free = np.r_[np.flatnonzero(~has_start), np.flatnonzero(~has_end)]
    free_t = np.r_[lines.start[~has_start], lines.end[~has_end]]

    stop_line = np.r_[line[node_here], free]
    stop_t = np.r_[t[node_here], free_t]
    stop_crossing = np.r_[crossing[node_here], crossings + np.arange(len(free))]
    stop_kind = np.r_[
        np.where(singular, SINGULAR, np.where(on_rim, BOUNDARY, REGULAR))[node_here],
        np.full(len(free), BOUNDARY),
    ]
    order = np.lexsort((stop_t, stop_line))
    stop_line, stop_t = stop_line[order], stop_t[order]
    used, at, nodes = np.unique(stop_crossing[order], return_index=True, return_inverse=True)
    # number the nodes in the order in which the lamellas meet them
    rank = np.empty(len(used), np.int64)
    rank[np.argsort(at, kind="stable")] = np.arange(len(used))
    nodes = rank[nodes]
    kinds = np.zeros(len(used), np.int64)
    np.maximum.at(kinds, nodes, stop_kind[order])

    representative = np.empty(len(used), np.int64)
    representative[rank] = at
    where = domain.place(lines.sheet[stop_line], lines.base[stop_line] + stop_t * lines.direction[stop_line])[
        representative
    ]
    offsets = np.r_[0, np.cumsum(np.bincount(stop_line, minlength=len(count)))]
    return Lattice(lines, offsets, stop_t, nodes, kinds, domain.rim(where))
