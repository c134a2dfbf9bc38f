"""The tangent stiffness of an equilibrium, factored."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.sparse import Factor, SingularError
from lamella.structure.eigenvalues import least_ratios, require_stable
from lamella.structure.equilibrium import Equilibrium
from lamella.structure.mechanism import refuse_mechanism
from lamella.structure.newton import pull_of


@dataclass(frozen=True)
class Tangent:
    """Tangent stiffness in an equilibrium.

    Attributes
    ----------
    equilibrium : Equilibrium
    blocks : list of (m, k, k)
        Of the elements, in the groups of `Structure.unknowns`.
    entries : (nnz,)
        Of the matrix in the free unknowns, see `Structure.pattern`.
    factor : Factor
    """

    equilibrium: Equilibrium
    blocks: list[Floats]
    entries: Floats
    factor: Factor

    @classmethod
    def of(cls, equilibrium: Equilibrium) -> Tangent:
        """Of an equilibrium.

        Raises
        ------
        InputError
            A motion meets no resistance.
        """
        structure = equilibrium.structure
        blocks = equilibrium.whole.stiffness(equilibrium.whole.stress)
        entries = structure.entries(blocks)
        try:
            factor = structure.pattern.factor(entries)
        except SingularError:
            refuse_mechanism(structure, blocks)
            raise InputError(
                f"a motion meets no resistance at the load factor {equilibrium.factor:.6g}",
                "hold what moves freely, or start below a critical load",
                "structure",
            ) from None
        return cls(equilibrium, blocks, entries, factor)

    def motion(self) -> Floats:
        """Motion by one unit of load factor, (6 n + k,)."""
        structure, loads = self.equilibrium.structure, self.equilibrium.loads
        pull = pull_of(structure, loads, self.equilibrium.state)
        pull = pull - structure.multiplied(self.blocks, loads.motions)
        motion = loads.motions.copy()
        motion[structure.free] += self.factor.solve(pull[structure.free])
        return motion

    def modes(self, other: list[Floats], count: int) -> tuple[Floats, Floats]:
        """Smallest positive ratios of the stiffness to another matrix of element blocks, and their motions.

        Returns
        -------
        ratios, motions : (c,), (c, 6 n + k)
            Motions have their largest number 1.

        Raises
        ------
        InputError
            The equilibrium is unstable.
        """
        structure = self.equilibrium.structure
        require_stable(self.factor.negative, self.equilibrium.factor)
        pattern = structure.pattern
        ratios, vectors = least_ratios(pattern, self.entries, self.factor, structure.entries(other), count)
        motions = np.zeros((len(ratios), structure.poses.unknowns))
        motions[:, structure.free] = vectors.T
        largest = np.take_along_axis(motions, np.abs(motions).argmax(1)[:, None], 1)
        return ratios, motions / largest
