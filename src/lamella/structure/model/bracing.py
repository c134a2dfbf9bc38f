"""Cables on the diagonals of a net's cells, as its hardware has them."""

from __future__ import annotations

import numpy as np

from lamella.hardware.cables import STRAND_DENSITY
from lamella.hardware.diagonals import diagonals
from lamella.hardware.node_frames import NodeFrames
from lamella.hardware.rules import FILLING, STRAND_MODULUS, CableRules
from lamella.network.network import Network
from lamella.structure.beam.poses import Poses
from lamella.structure.cables import Cables, make_cables, no_cables

CABLES_OF_A_LINE = 2
"""One on either side of the bolts."""


def brace(network: Network, poses: Poses, rules: CableRules | None, height: float) -> Cables:
    """Both cables of every line as one, from node to node where clamps hold them, above the strips' upper edges.

    Parameters
    ----------
    network : Network
    poses : Poses
        In which the cables have their prestress; the network's nodes come first.
    rules : CableRules, optional
        None: there are none.
    height : float
        Of the strips, m.
    """
    if rules is None:
        return no_cables()
    lines = diagonals(network, NodeFrames.of(network), rules.every)
    pairs = [np.stack((line.nodes[:-1], line.nodes[1:]), 1) for line in lines]
    if not pairs:
        return no_cables()
    metal = FILLING * np.pi / 4 * rules.diameter**2
    above = np.zeros((2, 3))
    above[:, 2] = height / 2 + rules.diameter / 2
    return make_cables(
        poses,
        np.concatenate(pairs),
        CABLES_OF_A_LINE * STRAND_MODULUS * metal,
        prestress=CABLES_OF_A_LINE * rules.prestress,
        mass=CABLES_OF_A_LINE * STRAND_DENSITY * metal,
        offsets=above,
    )
