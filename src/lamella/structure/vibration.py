"""Natural frequencies about an equilibrium, with a consistent mass matrix."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.result import Result
from lamella.structure.equilibrium import Equilibrium
from lamella.structure.tangent import Tangent


@dataclass(frozen=True, repr=False, eq=False)
class Vibration(Result):
    """Small vibrations about an equilibrium.

    Attributes
    ----------
    equilibrium : Equilibrium
    frequencies : (c,)
        Hz, ascending.
    modes : (c, 6 n + k)
        Motions, of largest number 1.
    """

    equilibrium: Equilibrium
    frequencies: Floats
    modes: Floats

    def _line(self) -> str:
        return ", ".join(f"{frequency:.4g}" for frequency in self.frequencies) + " Hz"


def vibration(equilibrium: Equilibrium, count: int = 1) -> Vibration:
    """Lowest natural frequencies about a stable equilibrium, loaded or not.

    Raises
    ------
    InputError
        The equilibrium is unstable, or a motion meets no resistance.
    """
    ratios, modes = Tangent.of(equilibrium).modes(equilibrium.whole.mass(), count)
    return Vibration(equilibrium, np.sqrt(ratios) / (2 * np.pi), modes)
