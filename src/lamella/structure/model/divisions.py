"""Cell edges of a net divided into beam elements: which node each end is, and where on its lamella."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.network.network import SINGULAR, Network

# of a cell edge that a hub may take
HUB_SHARE = 0.4


@dataclass(frozen=True)
class Divisions:
    """e cell edges, each divided into as many elements.

    Attributes
    ----------
    lamella : (e,) int
    stops : (e, 2) int
        Of the network, where the edge begins and ends.
    arclengths : (e, elements + 1)
        Of the elements' ends, from the lamella's start, m.
    hubs : (e, 2) bool
        Whether the edge begins, or ends, on a hub beside its node.
    """

    lamella: Integers
    stops: Integers
    arclengths: Floats
    hubs: Booleans

    @classmethod
    def of(cls, network: Network, elements: int, hub_radius: float) -> Divisions:
        """Of equal length in each edge; next to a singular node they begin at the hub's radius from it."""
        owner = network.stop_owner
        first = np.flatnonzero(owner[1:] == owner[:-1])
        stops = np.stack((first, first + 1), 1)
        arc = network.stop_arclengths[stops]
        hubs = (network.node_kinds[network.stop_nodes[stops]] == SINGULAR) & (hub_radius > 0)
        reach = np.minimum(hub_radius, HUB_SHARE * (arc[:, 1] - arc[:, 0]))[:, None] * hubs
        start, end = arc[:, 0] + reach[:, 0], arc[:, 1] - reach[:, 1]
        share = np.linspace(0, 1, elements + 1)
        arclengths = start[:, None] * (1 - share) + end[:, None] * share
        return cls(owner[first], stops, arclengths, hubs)

    @property
    def elements(self) -> int:
        """In each edge."""
        return int(self.arclengths.shape[1]) - 1

    def numbers(self, network: Network, first: int) -> Integers:
        """Nodes of the elements' ends, (e, elements + 1): those of the network, inner ones from `first` on."""
        numbers = np.empty(self.arclengths.shape, np.int64)
        numbers[:, [0, -1]] = network.stop_nodes[self.stops]
        inner = numbers[:, 1:-1]
        inner[:] = first + np.arange(inner.size).reshape(inner.shape)
        return numbers
