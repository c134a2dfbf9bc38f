"""A structure in equilibrium."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.result import Result
from lamella.structure.beam.beams import BeamState
from lamella.structure.beam.poses import NODE_UNKNOWNS, Poses
from lamella.structure.loads import Loads
from lamella.structure.state import StructureState
from lamella.structure.structure import Structure


@dataclass(frozen=True, repr=False, eq=False)
class Equilibrium(Result):
    """A pose in which a structure's forces balance its loads.

    Attributes
    ----------
    structure : Structure
    loads : Loads
    factor : float
        Load factor.
    poses : Poses
    negative : int
        Negative eigenvalues of the tangent stiffness: 0 where the equilibrium is stable.
    iterations : int
        Factorisations that it took from the last one.
    """

    structure: Structure
    loads: Loads
    factor: float
    poses: Poses
    negative: int
    iterations: int

    def _line(self) -> str:
        stable = "stable" if self.negative == 0 else f"unstable in {self.negative} ways"
        return f"load factor {self.factor:.6g}, {stable}, energy {self.energy:.6g} J"

    @cached_property
    def whole(self) -> StructureState:
        """Beams, cables and springs, with the natural curvature and the line loads of this load factor."""
        return self.loads.state(self.structure, self.factor, self.poses)

    @property
    def state(self) -> BeamState:
        """The beams of `whole`."""
        return self.whole.beams

    @property
    def energy(self) -> float:
        """Elastic energy, J."""
        return self.whole.energy

    @cached_property
    def internal(self) -> Floats:
        """Derivative of elastic energy and line loads' potential with respect to the unknowns, (6 n + k,)."""
        return self.structure.vector(self.whole.forces())

    @property
    def reactions(self) -> Floats:
        """Forces (N) and moments (N m) of supports and springs on the nodes, global, (n, 6); 0 where there are none."""
        nodes = slice(0, NODE_UNKNOWNS * len(self.poses.points))
        out = np.where(self.structure.held_unknowns, self.internal - self.loads.forces_at(self.factor), 0.0)
        result = out[nodes].reshape(-1, NODE_UNKNOWNS)
        result[self.structure.node_springs.nodes] -= self.whole.node_springs.forces().T
        return np.asarray(result)

    @property
    def displacements(self) -> Floats:
        """Shifts of the nodes from the structure's own poses, m, (n, 3)."""
        return np.asarray(self.poses.points - self.structure.poses.points)

    @property
    def resultants(self) -> Floats:
        """Of each element, constant along it, (7, m).

        Axial force N (of the mean fibre), shear along u and n, torsion moment without the helix part, bending moments
        about u and about n without that of the plate action, and the stress resultant across.
        """
        return np.asarray(self.state.stress / self.structure.beams.law.length)
