"""Where to cut a net that overlaps when it is laid flat: along which lamella, and whether its parts lie then."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components, dijkstra

from lamella.base.arrays import Floats, Integers
from lamella.base.errors import InputError
from lamella.erection.erection import Erection
from lamella.erection.flat_shape import FlatShape, overlapping_nodes
from lamella.erection.free_net import free_net
from lamella.erection.laid_flat import laid_flat
from lamella.network.network import Network
from lamella.network.network_part import network_part
from lamella.strip.lamellas import Lamellas
from lamella.structure.loads import no_loads
from lamella.structure.static import at_rest

# overlaps that are looked at, evenly chosen
OVERLAPS_LOOKED_AT = 64


@dataclass(frozen=True)
class Cut:
    """A net cut along a lamella.

    Attributes
    ----------
    lamella : str
        Id of the one to cut along: it belongs to one side, what crosses it is cut there.
    parts : int
        That the net falls into.
    left : int or None
        Pairs of lamellas that overlap still when each part is laid flat; None where one of them does not come to rest.
    """

    lamella: str
    parts: int
    left: int | None


def proposed_cut(erection: Erection, remake: Callable[[Network], Lamellas]) -> Cut | None:
    """The lamella midway between what overlaps, and what is left of the overlaps once the net is cut along it.

    For each overlap the shortest way through the net from one place to the other is looked for: the lamella that
    crosses most of these ways in their middle is proposed.

    Parameters
    ----------
    erection : Erection
        From the flat state on.
    remake : callable
        Makes the lamellas of a part of the net.

    Returns
    -------
    Cut or None
        None where nothing overlaps, or no lamella lies between.
    """
    model = erection.model
    network = model.lamellas.network
    pairs = overlapping_nodes(model, erection.states[0].poses, erection.flat.plane)
    if not len(pairs):
        return None
    chosen = np.unique(np.linspace(0, len(pairs) - 1, OVERLAPS_LOOKED_AT).round().astype(np.int64))
    lamella = _between(network, pairs[chosen])
    if lamella is None:
        return None
    on_it = network.stop_nodes[network.stop_owner == lamella]
    inside = np.ones(len(network.node_points), bool)
    inside[on_it] = False
    one, other, _ = _edges(network)
    kept = inside[one] & inside[other]
    _, part = connected_components(
        _graph(len(inside), one[kept], other[kept], np.ones(int(kept.sum()))), directed=False
    )
    parts = [part == k for k in np.unique(part[np.unique(np.concatenate((one[kept], other[kept])))])]
    left = 0
    for nodes in parts:
        try:
            left += _overlaps(remake(network_part(network, nodes & inside).network), model.rules.elements)
        except InputError:
            return Cut(network.ids[lamella], len(parts), None)
    return Cut(network.ids[lamella], len(parts), left)


def _overlaps(lamellas: Lamellas, elements: int) -> int:
    """Pairs of lamellas that overlap when a net is laid flat; none of what has no joints."""
    try:
        model = free_net(lamellas, elements)
    except InputError:
        return 0
    free = model.structure
    locked = at_rest(replace(free, held_joints=np.ones_like(free.held_joints)), no_loads(free))
    return len(FlatShape.of(model, laid_flat(locked, free).poses).overlaps)


def _between(network: Network, pairs: Integers) -> int | None:
    """The lamella that crosses most shortest ways between pairs of nodes (p, 2) in their middle."""
    one, other, owner = _edges(network)
    count = len(network.node_points)
    lengths = np.linalg.norm(network.node_points[one] - network.node_points[other], axis=1)
    graph = _graph(count, one, other, lengths)
    sources, row = np.unique(pairs[:, 0], return_inverse=True)
    _, before = dijkstra(graph, directed=False, indices=sources, return_predecessors=True)
    along = {(a, b): k for a, b, k in zip(one.tolist(), other.tolist(), owner.tolist(), strict=True)}
    votes = np.zeros(len(network.ids), np.int64)
    for source, target in zip(row.tolist(), pairs[:, 1].tolist(), strict=True):
        way = [target]
        while way[-1] >= 0:
            way.append(int(before[source, way[-1]]))
        way = way[:-1]
        if len(way) < 3:
            continue
        middle = len(way) // 2
        a, b = way[middle - 1], way[middle]
        followed = along.get((a, b), along.get((b, a)))
        crossing = np.unique(network.stop_owner[network.stop_nodes == b])
        votes[crossing[crossing != followed]] += 1
    return int(votes.argmax()) if votes.any() else None


def _edges(network: Network) -> tuple[Integers, Integers, Integers]:
    """Nodes at the ends of all cell edges, and the lamella of each."""
    owner = network.stop_owner
    same = owner[1:] == owner[:-1]
    return network.stop_nodes[:-1][same], network.stop_nodes[1:][same], owner[1:][same]


def _graph(count: int, one: Integers, other: Integers, weights: Floats) -> csr_array:
    return csr_array((weights, (one, other)), shape=(count, count))
