"""A structure with what drives it: nodes, joints or cables' lengths that go from where they are to an end."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.structure.beam.poses import NODE_UNKNOWNS
from lamella.structure.equilibrium import Equilibrium
from lamella.structure.loads import Loads
from lamella.structure.structure import Structure


@dataclass(frozen=True, eq=False)
class Rigged:
    """A structure as it is driven.

    Attributes
    ----------
    structure : Structure
        Its poses are those that the way begins in; what is moved is held.
    loads : Loads
        Of the whole way: motions of what is held, strains of cables. What acts all the time is constant.
    travel : float
        Length of the way, of the unit that the drive is conjugate to: m, of joints rad.
    nodes : (p,) int
        Those that are moved; of cables the first end of each.
    """

    structure: Structure
    loads: Loads
    travel: float
    nodes: Integers

    def motions(self) -> Floats:
        """Of the moved nodes on the whole way, m, (p, 3)."""
        rows = self.loads.motions[: NODE_UNKNOWNS * len(self.structure.poses.points)].reshape(-1, NODE_UNKNOWNS)
        return np.asarray(rows[self.nodes, :3])

    def forces(self, equilibrium: Equilibrium) -> Floats:
        """Of each cable its tension, or what moves each node along its way, N, (p,)."""
        if np.any(self.loads.cable_swelling):
            return np.asarray(equilibrium.whole.cables.tension)
        motions = self.motions()
        size = np.linalg.norm(motions, axis=1)
        return np.asarray((self._held_forces(equilibrium) * motions).sum(1) / np.where(size > 0, size, 1.0))

    def drive(self, equilibrium: Equilibrium) -> float:
        """What is conjugate to the travel: its work is the change of energy, N, or N m of joints.

        Of cables that is so along the distance of their ends.
        """
        if np.any(self.loads.cable_swelling):
            shorter = -np.asarray(self.loads.cable_swelling) * equilibrium.structure.cables.length
            return float(shorter @ equilibrium.whole.cables.tension / self.travel)
        held = equilibrium.internal - self.loads.forces_at(equilibrium.factor)
        return float(held @ self.loads.motions / self.travel)

    def _held_forces(self, equilibrium: Equilibrium) -> Floats:
        held = equilibrium.internal - self.loads.forces_at(equilibrium.factor)
        rows = held[: NODE_UNKNOWNS * len(self.structure.poses.points)].reshape(-1, NODE_UNKNOWNS)
        return np.asarray(rows[self.nodes, :3])


class Device(Protocol):
    """What drives a net on site.

    Attributes
    ----------
    kind : str
        As the project file names it.
    """

    @property
    def kind(self) -> str: ...

    def up(self, points: Floats) -> Floats | None:
        """Direction that the device takes for z, (3,); None: the normal of the plane that the net lies in."""

    def rig(self, structure: Structure) -> Rigged:
        """A structure with free joints, in the pose that the way begins in, with z upwards."""
