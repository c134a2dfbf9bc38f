r"""Stresses in the fibres of strips that beam elements stand for.

The energy of `lamella.structure.beam.strains` is that of the strip of `lamella.strip.plate`: its twist and weak-axis
moment are the integrals over the height of the stresses of `lamella.strip.stress`, free to shorten, and the axial force
is their mean. So both say the same stress where curvatures are the same.
"""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.material import Material
from lamella.strip.stress import Stresses, stresses
from lamella.structure.beam.beams import BeamState


def curvatures_at_ends(state: BeamState) -> Floats:
    """tg, -kn, kg at both ends of each element, 1/m, (m, 2, 3).

    The mean of the element, and what its shear forces make bending moments change by:
    :math:`M_n' = -Q_u`, :math:`M_u' = Q_n`.
    """
    law = state.beams.law
    mean = state.motion.local_theta / law.length
    # Q L / 2 over E I; stress and stiffness both hold the length
    half = law.length / 2
    about_u, about_n = (half * state.stress[i] / law.stiffness[j] for i, j in ((2, 4), (1, 5)))
    change = np.stack((np.zeros_like(half), about_u, -about_n))
    return np.stack(((mean - change).T, (mean + change).T), 1)


def strip_stresses(state: BeamState, material: Material, height: float, thickness: float) -> Stresses:
    """Stresses at the ends of elements that are strips of one section.

    Parameters
    ----------
    state : BeamState
    material : Material
    height, thickness : float
        m.

    Returns
    -------
    Stresses
        Each (2 m,): both ends of the first element, then of the second one. `layer` is all of the strong-axis bending,
        `restraint` 0: the axial force is in the von Mises stress.
    """
    law = state.beams.law
    at_ends = curvatures_at_ends(state)
    tg, kn, kg = at_ends.reshape(-1, 3).T
    axial = state.stress[0] / law.length / (height * thickness)
    return stresses(
        material,
        height,
        thickness,
        curvature_error=np.zeros_like(tg),
        layer_curvature=kn - np.repeat(law.natural[:, 1], 2),
        kg=kg,
        tg=tg,
        held=False,
        axial=np.repeat(axial, 2),
    )
