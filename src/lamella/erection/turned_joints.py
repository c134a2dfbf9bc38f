"""Each joint turned to its own angle, all in proportion."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lamella.base.arrays import Floats
from lamella.erection.rigged import Rigged
from lamella.structure.loads import no_loads
from lamella.structure.structure import Structure


@dataclass(frozen=True, eq=False)
class TurnedJoints:
    """All joints, to the angles that they are designed for."""

    @property
    def kind(self) -> str:
        return "angles"

    def up(self, points: Floats) -> Floats | None:
        return None

    def rig(self, structure: Structure) -> Rigged:
        rigged = replace(structure, held_joints=np.ones_like(structure.held_joints))
        motions = np.zeros(structure.poses.unknowns)
        # angles of joints are counted from the designed shape
        motions[len(motions) - len(structure.poses.angles) :] = -structure.poses.angles
        loads = replace(no_loads(rigged), motions=motions)
        return Rigged(rigged, loads, float(np.linalg.norm(motions)), np.zeros(0, np.int64))
