"""How a load is carried: by axial forces as a shell does, or by bending as a grillage does (paper, section 3.5)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.result import Result
from lamella.structure.equilibrium import Equilibrium

AXIAL, UPRIGHT = [0], [2, 4]


@dataclass(frozen=True, repr=False, eq=False)
class LoadShares(Result):
    """Shares of the elastic energy of what a load adds to the forces, summing up to 1; all 0 where nothing is added.

    Half the products of the additional strains of each element and the forces that they make; what couples bending
    with twist, in elements that turn along themselves, counts half to either.

    Attributes
    ----------
    axial : float
        Of axial forces of strips, edge beams and cables: what makes it a shell.
    upright : float
        Of bending about the strong axis and its shear: what makes it a grillage.
    other : float
        Of bending about the weak axis, torsion and the rest.
    """

    axial: float
    upright: float
    other: float

    def _line(self) -> str:
        return f"axial {self.axial:.0%}, upright bending {self.upright:.0%}, other {self.other:.0%}"

    @classmethod
    def of(cls, rest: Equilibrium, loaded: Equilibrium) -> LoadShares:
        """Of a state under load, beside that of the same structure without it."""
        strains = loaded.state.strains.values - rest.state.strains.values
        parts = 0.5 * (loaded.structure.beams.law.stress_rate(strains) * strains).sum(1)
        one, other = rest.whole.cables, loaded.whole.cables
        pulled = (other.tension - one.tension) ** 2 * one.cables.length / one.cables.axial
        axial = float(parts[AXIAL].sum() + 0.5 * pulled.sum())
        upright = float(parts[UPRIGHT].sum())
        total = axial + upright + float(np.delete(parts, AXIAL + UPRIGHT).sum())
        if not total > 0:
            return cls(0.0, 0.0, 0.0)
        return cls(axial / total, upright / total, 1 - (axial + upright) / total)
