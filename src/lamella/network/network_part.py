"""A part of a network as a network of its own."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from lamella.base.arrays import Booleans, Integers
from lamella.base.errors import InputError
from lamella.network.network import BOUNDARY, REGULAR, Network

ALONG = (
    "sample_points",
    "sample_normals",
    "sample_tangents",
    "sample_mean_curvature",
    "sample_slopes",
    "sample_where",
)
"""Arrays of a network along its samples, beside arc lengths and curvatures."""


@dataclass(frozen=True, eq=False)
class NetworkPart:
    """A part, and where it is in the whole.

    Attributes
    ----------
    network : Network
    nodes : (n,) int
        Of the whole.
    lamellas : (m,) int
        Of the whole, of which each one is a piece.
    """

    network: Network
    nodes: Integers
    lamellas: Integers


def network_part(network: Network, inside: Booleans) -> NetworkPart:
    """The lamellas between nodes of a part.

    Parameters
    ----------
    network : Network
    inside : (n,) bool
        Nodes of the part. Cell edges with both ends among them are kept, and the pieces of lamellas they make; ids of
        several pieces of one lamella are "A1.1", "A1.2", ....

    Returns
    -------
    NetworkPart
        Its end nodes are boundary nodes; without periods.

    Raises
    ------
    InputError
        No cell edge is inside.
    """
    first, last = _runs(network, inside)
    if not len(first):
        raise InputError("no cell edge has both its nodes inside", "choose more nodes", "inside")
    owner = network.stop_owner[first]
    stops = _ranges(first, last)
    begin = network.sample_offsets[owner] + network.stop_samples[first]
    end = network.sample_offsets[owner] + network.stop_samples[last]
    samples = _ranges(begin, end)
    run_of_stop = np.repeat(np.arange(len(first)), last - first + 1)
    run_of_sample = np.repeat(np.arange(len(first)), end - begin + 1)
    nodes, numbers = np.unique(network.stop_nodes[stops], return_inverse=True)
    start = network.stop_arclengths[first]
    whole = (first == network.stop_offsets[owner]) & (last == network.stop_offsets[owner + 1] - 1)
    darboux = type(network.sample_darboux)(*(values[samples] for values in network.sample_darboux))
    along: dict[str, Any] = {name: getattr(network, name)[samples] for name in ALONG}
    along |= _faces(network, nodes)
    part = replace(
        network,
        **along,
        periods=(),
        left_out=0,
        node_points=network.node_points[nodes],
        node_normals=network.node_normals[nodes],
        node_kinds=_kinds(network, nodes, numbers, run_of_stop, whole & network.closed[owner]),
        ids=_ids(network, owner),
        families=network.families[owner],
        closed=whole & network.closed[owner],
        sample_offsets=_offsets(end - begin + 1),
        sample_darboux=darboux,
        sample_arclengths=network.sample_arclengths[samples] - start[run_of_sample],
        stop_offsets=_offsets(last - first + 1),
        stop_nodes=numbers,
        stop_samples=network.stop_samples[stops] - network.stop_samples[first][run_of_stop],
        stop_arclengths=network.stop_arclengths[stops] - start[run_of_stop],
        faces_left_out=np.zeros(0, np.int64),
        figures={},
        notes=(),
    )
    return NetworkPart(part, nodes, owner)


def _runs(network: Network, inside: Booleans) -> tuple[Integers, Integers]:
    """First and last stop of each piece of a lamella inside."""
    owner = network.stop_owner
    kept = inside[network.stop_nodes]
    edge = kept[:-1] & kept[1:] & (owner[1:] == owner[:-1])
    change = np.diff(np.concatenate(([0], edge.astype(np.int64), [0])))
    return np.flatnonzero(change == 1), np.flatnonzero(change == -1)


def _ranges(first: Integers, last: Integers) -> Integers:
    """All numbers from each first to its last one, both counted, one after the other."""
    counts = last - first + 1
    return np.asarray(np.arange(int(counts.sum())) - np.repeat(np.cumsum(counts) - counts - first, counts))


def _offsets(counts: Integers) -> Integers:
    return np.concatenate((np.zeros(1, np.int64), np.cumsum(counts)))


def _ids(network: Network, owner: Integers) -> tuple[str, ...]:
    pieces = np.bincount(owner, minlength=len(network.ids))
    number = np.arange(len(owner)) - np.searchsorted(owner, owner)
    return tuple(
        network.ids[k] if pieces[k] == 1 else f"{network.ids[k]}.{n + 1}"
        for k, n in zip(owner.tolist(), number.tolist(), strict=True)
    )


def _kinds(network: Network, nodes: Integers, numbers: Integers, run_of_stop: Integers, closed: Booleans) -> Integers:
    """Regular nodes where no lamella goes on any more are boundary nodes."""
    ends = np.ones(len(run_of_stop), bool)
    ends[1:-1] = (run_of_stop[1:-1] != run_of_stop[:-2]) | (run_of_stop[1:-1] != run_of_stop[2:])
    ends &= ~closed[run_of_stop]
    passed = np.bincount(numbers[~ends], minlength=len(nodes)) > 0
    crossed = np.bincount(numbers, minlength=len(nodes)) > 1
    kinds = network.node_kinds[nodes]
    return np.where((kinds == REGULAR) & ~(passed & crossed), BOUNDARY, kinds)


def _faces(network: Network, nodes: Integers) -> dict[str, Integers]:
    """Faces with all their nodes inside."""
    number = np.full(len(network.node_points), -1)
    number[nodes] = np.arange(len(nodes))
    corners = np.diff(network.face_offsets)
    face = np.repeat(np.arange(len(corners)), corners)
    missing = np.bincount(face, number[network.face_nodes] < 0, len(corners)) > 0
    return {
        "face_offsets": _offsets(corners[~missing]),
        "face_nodes": number[network.face_nodes[~missing[face]]],
    }
