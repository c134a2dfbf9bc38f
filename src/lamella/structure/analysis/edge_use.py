"""Stresses of edge beams in an equilibrium."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats
from lamella.structure.beam.columns import turned_product
from lamella.structure.equilibrium import Equilibrium
from lamella.structure.model.model import Model


def edge_use(model: Model, equilibrium: Equilibrium) -> Floats:
    """Utilisation at both ends of the elements of edge beams, (r, 2).

    Von Mises stress of axial force, both bendings and torsion over the strength, elastic. Of tubes bending about both
    axes adds up as a vector; of flat bars corner stresses are added to the shear in the middle of the long face, which
    is on the safe side. Stress of bending beams to their curves before they are mounted is not counted.
    """
    rims, first = model.rims, len(model.lines.length)
    state = equilibrium.state
    on_ends = state.on_ends(state.stress)[:, first:]
    frame_a, frame_b = state.motion.frame[..., first:], state.motion.frame_at_b()[..., first:]
    result = np.zeros((len(rims.nodes), 2))
    axial = np.abs(state.stress[0] / state.beams.law.length)[first:]
    for end, moments in enumerate((turned_product(frame_a, on_ends[3:6]), turned_product(frame_b, on_ends[9:]))):
        for k, kind in enumerate(rims.sections):
            some = rims.section == k
            m_t, m_u, m_n = np.abs(moments[:, some])
            bent = m_u / kind.modulus_u + m_n / kind.modulus_n
            if kind.round:
                bent = np.hypot(m_u, m_n) / kind.modulus_u
            sigma, tau = axial[some] / kind.area + bent, m_t / kind.modulus_t
            result[some, end] = np.sqrt(sigma**2 + 3 * tau**2) / kind.material.strength
    return result
