"""Diagonals of a net's cells, which follow the principal curves (paper, 2.3): lines of nodes that cables run along.

In a cell of two A and two B lamellas each of the two diagonals joins opposite nodes. At a node the diagonals of the
four cells around it go on across it, so that they form lines of two kinds: those between the A and the B direction of
the node's frame, and those beside it.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Booleans, Integers
from lamella.hardware.node_frames import NodeFrames
from lamella.network.network import Network


@dataclass(frozen=True, eq=False)
class Diagonal:
    """A line of diagonals.

    Attributes
    ----------
    nodes : (k,) int
        In order; a line that closes repeats its first node.
    first : bool
        Whether it lies between the A and the B direction, counter-clockwise from A, at its nodes.
    """

    nodes: Integers
    first: bool

    @property
    def closed(self) -> bool:
        """Whether it comes back to its first node."""
        return len(self.nodes) > 2 and self.nodes[0] == self.nodes[-1]


def diagonals(network: Network, frames: NodeFrames, every: int) -> list[Diagonal]:
    """Every n-th line of diagonals of either kind, in the order of their least nodes.

    Lines are counted from the one with the most nodes, by how many cells they are away.

    Parameters
    ----------
    network : Network
    frames : NodeFrames
        The nodes that lines go through.
    every : int
        1 takes all of them.
    """
    ends, first = _diagonals(network, frames)
    found = []
    for kind in (True, False):
        lines = _lines(ends[first == kind])
        level = _levels(network, lines)
        found += [Diagonal(np.array(line), kind) for line, k in zip(lines, level, strict=True) if k % every == 0]
    return found


def _diagonals(network: Network, frames: NodeFrames) -> tuple[Integers, Booleans]:
    """Pairs of opposite nodes of all cells of four, (d, 2), and of which kind each is."""
    size = np.diff(network.face_offsets)
    cells = network.face_nodes[network.face_offsets[:-1][size == 4][:, None] + np.arange(4)]
    ends = np.concatenate([cells[:, [0, 2]], cells[:, [1, 3]]])
    number = np.full(len(network.node_points), -1)
    number[frames.nodes] = np.arange(len(frames))
    ends = ends[(number[ends] >= 0).all(axis=1)]
    ends = np.unique(np.sort(ends, axis=1), axis=0)
    first = np.empty((len(ends), 2), bool)
    for column in range(2):
        at = number[ends[:, column]]
        along = network.node_points[ends[:, 1 - column]] - frames.origins[at]
        x, y = (np.einsum("ij,ij->i", along, frames.axes[at, row]) for row in range(2))
        first[:, column] = np.mod(np.arctan2(y, x), np.pi) < frames.angles[at]
    # the families keep their names across a cell: where both ends disagree it is none of a lattice
    agree = first[:, 0] == first[:, 1]
    return ends[agree], first[agree, 0]


def _lines(ends: Integers) -> list[list[int]]:
    """Lines of diagonals of one kind, each from one end to the other."""
    beside: dict[int, list[int]] = {}
    for a, b in ends.tolist():
        beside.setdefault(a, []).append(b)
        beside.setdefault(b, []).append(a)
    # more than two of a kind at a node are none of a lattice
    beside = {node: others for node, others in beside.items() if len(others) <= 2}
    beside = {node: [other for other in others if other in beside] for node, others in beside.items()}
    lines: list[list[int]] = []
    done: set[int] = set()
    starts = [node for node in sorted(beside) if len(beside[node]) == 1] + sorted(beside)
    for start in starts:
        if start in done or not beside[start]:
            continue
        line = [start]
        done.add(start)
        while following := [node for node in beside[line[-1]] if node not in done]:
            line.append(following[0])
            done.add(following[0])
        if len(line) > 2 and start in beside[line[-1]]:
            line.append(start)
        lines.append(line)
    return lines


def _levels(network: Network, lines: list[list[int]]) -> list[int]:
    """How many cells away from the longest line each one is; 0 for one of its own in every connected part."""
    line_of = np.full(len(network.node_points), -1)
    for k, line in enumerate(lines):
        line_of[np.array(line)] = k
    owner, nodes = network.stop_owner, network.stop_nodes
    same = owner[1:] == owner[:-1]
    pairs = line_of[np.column_stack([nodes[:-1][same], nodes[1:][same]])]
    beside: list[set[int]] = [set() for _ in lines]
    for a, b in pairs[(pairs >= 0).all(axis=1)].tolist():
        if a != b:
            beside[a].add(b)
            beside[b].add(a)
    level = [-1] * len(lines)
    for start in sorted(range(len(lines)), key=lambda k: (-len(lines[k]), lines[k][0])):
        if level[start] >= 0:
            continue
        level[start] = 0
        queue = deque([start])
        while queue:
            current = queue.popleft()
            for other in sorted(beside[current]):
                if level[other] < 0:
                    level[other] = level[current] + 1
                    queue.append(other)
    return level
