"""Whether an equilibrium is stable, free or with a weighted sum of unknowns held."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats
from lamella.structure.equilibrium import Equilibrium


def is_stable(equilibrium: Equilibrium, held: Floats | None = None) -> bool:
    """Whether all small motions cost energy.

    Parameters
    ----------
    equilibrium : Equilibrium
    held : (6 n + k,), optional
        Weights w of a sum of unknowns that is held. That takes one negative eigenvalue of the stiffness K away where
        w K^-1 w is negative: where its force falls as the sum grows, past a limit point.
    """
    if equilibrium.negative == 0 or held is None or equilibrium.negative > 1:
        return equilibrium.negative == 0
    structure, whole = equilibrium.structure, equilibrium.whole
    factor = structure.pattern.factor(structure.entries(whole.stiffness(whole.stress)))
    weights = held[structure.free]
    return bool(weights @ np.asarray(factor.solve(weights)) < 0)
