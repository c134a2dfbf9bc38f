"""Slots where two lamellas do not cross at a right angle.

In the tangent plane of the node the layer of a lamella with unit tangent t that lies d to its side, towards u = n x t,
is the line d u + x t. It crosses the layer d' of the other lamella, of tangent t', where

    x = (d' - d cos) / sin,       cos = t . t',     sin = t . (n x t'),

so that layers are slotted at stations of their own, shifted by -d cot, and slots lie 1 / |sin| as far from each other.
A slot that is w wide at a right angle is (w + T |cos|) / |sin| wide for a strip of thickness T that goes through askew.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.network.network import Network

# deg: a net whose angles are nowhere farther off is one of right angles, its layers are cut alike
RIGHT = 0.5


@dataclass(frozen=True)
class Oblique:
    """How lamellas cross at their stops; at a right angle where there is no other lamella.

    Attributes
    ----------
    cosine : (q,)
        t . t', of the lamella's tangent and the other one's.
    sine : (q,)
        t . (n x t').
    """

    cosine: Floats
    sine: Floats

    @classmethod
    def of(cls, network: Network) -> Oblique:
        """The crossings of a net."""
        count = len(network.stop_nodes)
        if network.pattern.normal_curvature is None or (90 - network.node_angles).max(initial=0.0) <= RIGHT:
            return cls(np.zeros(count), np.ones(count))
        owner, node = network.stop_owner, network.stop_nodes
        tangent = network.sample_tangents[network.sample_offsets[owner] + network.stop_samples]
        is_a = network.families[owner] == "A"
        # of each family at each node
        of_node = np.zeros((2, len(network.node_points), 3))
        of_node[0, node[is_a]], of_node[1, node[~is_a]] = tangent[is_a], tangent[~is_a]
        other = of_node[is_a.astype(np.int64), node]
        alone = (other == 0).all(1)
        cosine = (tangent * other).sum(1)
        sine = (tangent * np.cross(network.node_normals[node], other)).sum(1)
        return cls(np.where(alone, 0.0, cosine), np.where(alone, 1.0, sine))

    @property
    def right(self) -> bool:
        """Whether all crossings are at right angles."""
        return not self.cosine.any()

    @property
    def stretch(self) -> Floats:
        """Distance of slots over the distance of the layers that go through them, (q,)."""
        return np.asarray(1 / np.abs(self.sine))

    def shift(self, offset: float) -> Floats:
        """How much farther on the layer `offset` to the side is crossed, m, (q,)."""
        return np.asarray(-offset * self.cosine / self.sine)

    def width(self, slot_width: float, thickness: float) -> Floats:
        """Width of slots that are `slot_width` wide at a right angle, m, (q,)."""
        return np.asarray((slot_width + thickness * np.abs(self.cosine)) * self.stretch)
