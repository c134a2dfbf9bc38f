"""A net divided into connected patches along its lamellas, each light or small enough.

A patch too heavy or too large is cut beside a lamella: its nodes stay on one side, and what crosses it is cut in the
middle of the next cells. Of all lamellas the one is taken that leaves the fewest patches to come, and then the most
even ones. Around a hole one lamella does not divide, two together do. What no lamella divides is cut through the edge
of a spanning tree that divides it most evenly.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil, inf

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.errors import InputError
from lamella.base.wording import rounded
from lamella.network.network import Network

# lamellas tried for one cut, and for pairs
MOST_RUNS, MOST_PAIRED = 64, 20
# a cut whose lesser part comes to less of its limit than the greater one by this share is looked for elsewhere too
MOST_UNEVEN = 0.5
# patches that a cut edge counts, and one that is too short for a splice
EDGE_SHARE, FIRM_COST = 0.01, 0.25


def _directions(count: int) -> Floats:
    """Unit vectors (3, count) spread evenly over half a sphere, on a golden spiral."""
    angle = np.arange(count) * np.pi * (3 - np.sqrt(5))
    z = (np.arange(count) + 0.5) / count
    ring = np.sqrt(1 - z**2)
    return np.stack([ring * np.cos(angle), ring * np.sin(angle), z])


DIRECTIONS = _directions(200)


@dataclass(frozen=True, eq=False)
class Graph:
    """Nodes of a net and the cells of its lamellas between them.

    Attributes
    ----------
    ends : (e, 2) int
        Nodes of each edge, along the lamella.
    lamellas, cells : (e,) int
        Whose it is, and the number of the stop before.
    masses : (n,)
        kg.
    points : (n, 3)
        m.
    reach : (e, 3)
        Middles of the edges, m: where pieces end.
    firm : (e,) bool
        Edges that are cut where nothing else can be: too short for a splice.
    """

    ends: Integers
    lamellas: Integers
    cells: Integers
    masses: Floats
    points: Floats
    reach: Floats
    firm: Booleans

    @classmethod
    def of(cls, network: Network, masses: Floats, least_cell: float = 0.0) -> Graph:
        """Of a network whose nodes have these masses; cells shorter than `least_cell` (m) are best not cut."""
        owner = network.stop_owner
        same = np.flatnonzero(owner[1:] == owner[:-1])
        ends = np.column_stack([network.stop_nodes[same], network.stop_nodes[same + 1]])
        cells = same - network.stop_offsets[owner[same]]
        points = network.node_points
        middles = 0.5 * (points[ends[:, 0]] + points[ends[:, 1]])
        firm = network.stop_arclengths[same + 1] - network.stop_arclengths[same] < least_cell
        return cls(ends, owner[same], cells, masses, points, middles, firm)

    @cached_property
    def _widths(self) -> tuple[Floats, Floats]:
        """How far nodes with their halves of edges reach in `DIRECTIONS`, least and greatest, (n, d) each, m."""
        along = self.points @ DIRECTIONS
        low, high = along.copy(), along.copy()
        middles = self.reach @ DIRECTIONS
        for side in (0, 1):
            np.minimum.at(low, self.ends[:, side], middles)
            np.maximum.at(high, self.ends[:, side], middles)
        return low, high

    def width(self, patch: Booleans) -> float:
        """Extent of a patch in the widest of `DIRECTIONS`, m: at most a hundredth less than its size."""
        low, high = self._widths
        return float((high[patch].max(axis=0) - low[patch].min(axis=0)).max())


@dataclass(frozen=True)
class Limits:
    """What a patch may come to: kg and m, infinite where it is not limited."""

    mass: float = inf
    size: float = inf


def partition(graph: Graph, limits: Limits) -> Integers:
    """Patch of each node, (n,); patches are numbered by their first nodes.

    Raises
    ------
    InputError
        A single node is too heavy or its cells are too large.
    """
    graph, onto = _without_ends(graph)
    kept = onto == np.arange(len(onto))
    todo = _components(graph, kept)
    done: list[Booleans] = []
    while todo:
        patch = todo.pop()
        if _load(graph, patch, limits) <= 1 + 1e-9:
            done.append(patch)
            continue
        if patch.sum() == 1:
            raise _too_much(graph, int(np.flatnonzero(patch)[0]), limits)
        todo += _halves(graph, patch, limits)
    of_node = np.full(len(onto), -1)
    patches = [np.isin(onto, np.flatnonzero(patch)) for patch in done]
    for number, patch in enumerate(sorted(patches, key=lambda one: int(np.flatnonzero(one)[0]))):
        of_node[patch] = number
    return of_node


def _without_ends(graph: Graph) -> tuple[Graph, Integers]:
    """The graph with ends of lamellas on the nodes they hang on, and for each node the one it goes with, (n,).

    Where a lamella ends at the rim and no other one does, its end is no segment of its own.
    """
    count = len(graph.masses)
    edges = np.bincount(graph.ends.ravel(), minlength=count)
    onto = np.arange(count)
    for side in (0, 1):
        # of two ends that hang on each other, one stays
        lone = (edges[graph.ends[:, side]] == 1) & ((edges[graph.ends[:, 1 - side]] > 1) | (side == 1))
        onto[graph.ends[lone, side]] = graph.ends[lone, 1 - side]
    ends = onto[graph.ends]
    inward = ends[:, 0] == ends[:, 1]
    # what was an edge to an end says how far the node now reaches
    last = np.where(onto[graph.ends[:, 0]] != graph.ends[:, 0], graph.ends[:, 0], graph.ends[:, 1])
    reach = np.where(inward[:, None], graph.points[last], graph.reach)
    masses = np.asarray(np.bincount(onto, graph.masses, count), float)
    return replace(graph, ends=ends, masses=masses, reach=reach), onto


def extent(graph: Graph, patch: Booleans) -> float:
    """Greatest distance of two nodes or cut ends of a patch, m."""
    touching = patch[graph.ends].any(axis=1)
    points = np.concatenate([graph.points[patch], graph.reach[touching]])
    return _diameter(points)


def _diameter(points: Floats) -> float:
    """Greatest distance of two points; of many those that lie farthest out in `DIRECTIONS` are compared."""
    if len(points) > 600:
        along = points @ DIRECTIONS
        points = points[np.unique(np.concatenate([along.argmin(axis=0), along.argmax(axis=0)]))]
    square = np.sum((points[:, None] - points) ** 2, axis=2)
    return float(np.sqrt(square.max(initial=0.0)))


def _load(graph: Graph, patch: Booleans, limits: Limits) -> float:
    """Mass or size over its limit."""
    mass = float(graph.masses[patch].sum()) / limits.mass
    if not np.isfinite(limits.size):
        return mass
    return max(mass, extent(graph, patch) / limits.size)


def _too_much(graph: Graph, node: int, limits: Limits) -> InputError:
    """What a node is refused for; the remedy is enough for every node."""
    mass, most = float(graph.masses[node]), float(graph.masses.max())
    if mass > limits.mass:
        return InputError(
            f"node {node} with its strips, cut in the middle of its cells, and its hardware weighs {mass:.4g} kg, more "
            f"than a segment of mass = {limits.mass:g} kg may",
            f"write mass = {rounded(1.05 * most, up=True):g} or more, or choose more cells",
            "mass",
        )
    every = np.arange(len(graph.masses))
    size, largest = extent(graph, every == node), max(extent(graph, every == k) for k in every.tolist())
    return InputError(
        f"the strips of node {node}, cut in the middle of its cells, take {size:.4g} m, more than a segment of size = "
        f"{limits.size:g} m may",
        f"write size = {rounded(1.01 * largest, up=True):g} or more, or choose more cells",
        "size",
    )


def _labels(graph: Graph, inside: Booleans) -> tuple[int, Integers]:
    """Number of connected parts of some nodes, and the part of each node."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    kept = graph.ends[inside[graph.ends].all(axis=1)]
    n = len(inside)
    matrix = coo_array((np.ones(len(kept)), (kept[:, 0], kept[:, 1])), shape=(n, n))
    _, label = connected_components(matrix, directed=False)
    found, compact = np.unique(label[inside], return_inverse=True)
    labels = np.full(n, -1)
    labels[inside] = compact
    return len(found), labels


def _components(graph: Graph, inside: Booleans) -> list[Booleans]:
    count, label = _labels(graph, inside)
    return [label == k for k in range(count)]


def _halves(graph: Graph, patch: Booleans, limits: Limits) -> list[Booleans]:
    """Two connected parts of a patch."""
    runs = _runs(graph, patch)
    some = runs if len(runs) <= MOST_RUNS else [runs[k] for k in np.linspace(0, len(runs) - 1, MOST_RUNS).astype(int)]
    best = min((_rated(graph, patch, other, limits) for other in _beside(graph, patch, some)), default=None)
    if best is None or best[1] > MOST_UNEVEN:
        paired = [runs[k] for k in np.unique(np.linspace(0, len(runs) - 1, MOST_PAIRED).astype(int))] if runs else []
        pairs = [one | two for k, one in enumerate(paired) for two in paired[:k] if not np.any(one & two)]
        found = [_rated(graph, patch, other, limits) for other in _beside(graph, patch, pairs, joined=True)]
        best = min([*found, *([] if best is None else [best])], default=None)
    if best is None or best[1] > MOST_UNEVEN:
        tree = _rated(graph, patch, _subtree(graph, patch), limits)
        best = tree if best is None else min(best, tree)
    other = np.zeros(len(patch), bool)
    other[list(best[2])] = True
    return [patch & ~other, other]


Rated = tuple[tuple[float, float], float, tuple[int, ...]]
"""What a cut is judged by, how uneven it is, and the nodes it cuts off."""


def _rated(graph: Graph, patch: Booleans, other: Booleans, limits: Limits) -> Rated:
    """How good it is to cut off a part; less is better.

    A patch too heavy: patches to come, then the heaviest of them with the edges cut. A patch too large: what its halves
    have left of its square, and how uneven their masses are.
    """
    halves = (patch & ~other, other)
    inside = patch[graph.ends].all(axis=1)
    cut = inside & (other[graph.ends[:, 0]] != other[graph.ends[:, 1]])
    edges, firm = int(cut.sum()), int((cut & graph.firm).sum())
    masses = [float(graph.masses[half].sum()) for half in halves]
    nodes = tuple(np.flatnonzero(other).tolist())
    if graph.width(patch) / limits.size > sum(masses) / limits.mass:
        left = sum(graph.width(half) ** 2 for half in halves) / graph.width(patch) ** 2
        uneven = round(1 - min(masses) / max(masses), 6)
        return (round(left + uneven + FIRM_COST * firm, 6), round(EDGE_SHARE * edges, 6)), uneven, nodes
    counts = [max(ceil(mass / limits.mass - 1e-9), 1) for mass in masses]
    shares = [mass / (limits.mass * count) for mass, count in zip(masses, counts, strict=True)]
    uneven = round(1 - min(shares) / max(shares), 6)
    return (sum(counts) + FIRM_COST * firm, round(max(shares) + EDGE_SHARE * edges, 6)), uneven, nodes


def _runs(graph: Graph, patch: Booleans) -> list[Booleans]:
    """Nodes of a patch that follow each other on one lamella, for every lamella."""
    inside = patch[graph.ends].all(axis=1)
    edges = np.flatnonzero(inside)
    if not len(edges):
        return []
    following = (np.diff(edges) == 1) & (graph.lamellas[edges[1:]] == graph.lamellas[edges[:-1]])
    starts = np.concatenate([[0], np.flatnonzero(~following) + 1, [len(edges)]])
    found = []
    for begin, end in zip(starts[:-1].tolist(), starts[1:].tolist(), strict=True):
        run = np.zeros(len(patch), bool)
        run[graph.ends[edges[begin:end]].ravel()] = True
        found.append(run)
    return found


def _beside(graph: Graph, patch: Booleans, runs: list[Booleans], *, joined: bool = False) -> Iterator[Booleans]:
    """What lies beside runs: parts that the rest of the patch, with the runs, stays connected without."""
    for run in runs:
        count, label = _labels(graph, patch & ~run)
        for k in range(count):
            other = label == k
            if not joined or _labels(graph, patch & ~other)[0] == 1:
                yield other


def _subtree(graph: Graph, patch: Booleans) -> Booleans:
    """Of a spanning tree the branch whose mass is nearest to half of the patch."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import breadth_first_order

    kept = graph.ends[patch[graph.ends].all(axis=1)]
    n = len(patch)
    matrix = coo_array((np.ones(len(kept)), (kept[:, 0], kept[:, 1])), shape=(n, n)).tocsr()
    order, before = breadth_first_order(matrix, int(np.flatnonzero(patch)[0]), directed=False)
    mass = graph.masses.copy()
    for node in order[:0:-1].tolist():
        mass[before[node]] += mass[node]
    half = mass[order[0]] / 2
    root = min(order[1:].tolist(), key=lambda node: (round(abs(float(mass[node]) / half - 1), 6), node))
    inside = np.zeros(n, bool)
    inside[root] = True
    for node in order[1:].tolist():
        inside[node] |= inside[before[node]]
    return inside
