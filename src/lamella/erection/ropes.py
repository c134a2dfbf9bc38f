"""Cables shortened between two nodes each."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.errors import InputError
from lamella.erection.rigged import Rigged
from lamella.hardware.rules import FILLING, STRAND_MODULUS
from lamella.structure.cables import make_cables
from lamella.structure.loads import no_loads
from lamella.structure.structure import Structure

# of its length that a cable keeps at the least
LEAST_LENGTH_LEFT = 0.01


@dataclass(frozen=True, eq=False)
class Ropes:
    """Strands from node to node, in the strips' middle, wound up together: each by its own length.

    Attributes
    ----------
    nodes : (c, 2) int
    by : (c,)
        What is wound up, m.
    diameter : (c,)
        m.
    """

    nodes: Integers
    by: Floats
    diameter: Floats

    @property
    def kind(self) -> str:
        return "cable"

    def up(self, points: Floats) -> Floats | None:
        return None

    def rig(self, structure: Structure) -> Rigged:
        """Natural lengths are the distances of the ends.

        Raises
        ------
        InputError
            Ends at one node; a cable that is wound up whole.
        """
        for number, (one, other) in enumerate(self.nodes.tolist()):
            if one == other:
                raise InputError(
                    f"both ends of cable {number + 1} are at node {one}", "choose points nearer to two nodes", "cable"
                )
        axial = STRAND_MODULUS * FILLING * np.pi / 4 * self.diameter**2
        cables = make_cables(structure.poses, self.nodes, axial)
        short = np.flatnonzero(self.by > (1 - LEAST_LENGTH_LEFT) * cables.length)
        if len(short):
            one = int(short[0])
            raise InputError(
                f"cable {one + 1} is shortened by {self.by[one]:g} m and is {cables.length[one]:.4g} m long",
                "shorten it by less, so that a hundredth of it is left",
                "cable.by",
            )
        rigged = replace(structure, cables=cables)
        loads = replace(no_loads(rigged), cable_swelling=-self.by / cables.length)
        return Rigged(rigged, loads, float(self.by.max()), self.nodes[:, 0])
