"""A structure in a pose: beams, cables and springs together, in the groups of `Structure.unknowns`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.result import Lean
from lamella.structure.beam.beams import BeamState
from lamella.structure.beam.mass import consistent_mass
from lamella.structure.cables import CableState
from lamella.structure.joint_springs import JointSprings
from lamella.structure.node_springs import NodeSpringState


class Stress(NamedTuple):
    """Of beams, stiffness times strain times length (7, m), and the forces of cables, N, (c,)."""

    beams: Floats
    cables: Floats


@dataclass(frozen=True)
class StructureState(Lean):
    """Beams, cables and springs in a pose.

    Attributes
    ----------
    beams : BeamState
    cables : CableState
    node_springs : NodeSpringState
    joint_springs : JointSprings
    joint_turns : (s,)
        `JointSprings.beyond`.
    """

    beams: BeamState
    cables: CableState
    node_springs: NodeSpringState
    joint_springs: JointSprings
    joint_turns: Floats

    @property
    def stress(self) -> Stress:
        """Of this pose."""
        return Stress(self.beams.stress, self.cables.force)

    @property
    def energy(self) -> float:
        """Elastic energy, J."""
        parts = (self.beams.energy, self.cables.energy, self.node_springs.energy)
        return float(sum(part.sum() for part in parts) + self.joint_springs.energy(self.joint_turns).sum())

    def forces(self) -> list[Floats]:
        """Derivative of elastic energy and line loads' potential with respect to the unknowns."""
        springs = [self.node_springs.forces(), self.joint_springs.forces(self.joint_turns)]
        return [*self.beams.forces(), self.cables.forces(), *springs]

    def stiffness(self, stress: Stress) -> list[Floats]:
        """Tangent stiffness with a stress of beams and cables, symmetric; see `BeamState.stiffness`."""
        springs = [self.node_springs.stiffness(), self.joint_springs.tangent(self.joint_turns)]
        return [*self.beams.stiffness(stress.beams), self.cables.stiffness(stress.cables), *springs]

    def geometric_stiffness(self, stress: Stress) -> list[Floats]:
        """The part of `stiffness` that a stress and the line loads make, linear in them; that of springs is left
        out."""
        return [*self.beams.geometric_stiffness(stress.beams), self.cables.geometric_stiffness(stress.cables)]

    def stress_rate(self, motions: list[Floats]) -> Stress:
        """What a motion, in the groups of the unknowns, adds to the stress, linearly; slack cables stay slack."""
        cables = self.cables.force_rate(motions[2])
        beams = self.beams.beams.law.stress_rate(self.beams.strain_rate(motions[:2]))
        return Stress(beams, np.where(self.cables.tight(self.cables.force), cables, 0.0))

    def expected(self, motions: list[Floats]) -> Stress:
        """The stress after a motion, linearly; a slack cable may become tight."""
        beams = self.beams.beams.law.stress(self.beams.strains.values + self.beams.strain_rate(motions[:2]))
        return Stress(beams, self.cables.force + self.cables.force_rate(motions[2]))

    def mass(self) -> list[Floats]:
        """Consistent mass of beams and cables, kg, kg m, kg m^2."""
        return [*consistent_mass(self.beams), self.cables.mass()]
