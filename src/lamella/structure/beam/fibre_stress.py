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
from lamella.structure.beam.columns import turned_product

# of the stiffness of a section: what stress has to leave of it
LEAST_LEFT = 0.2


def curvatures_at_ends(state: BeamState) -> Floats:
    """tg, -kn, kg at both ends of each element, 1/m, (m, 2, 3).

    The mean of the element, and what the moments at the ends differ from its mean moment, by the tangent stiffness of
    twist and both bendings: those balance the loads at the nodes, which makes them more exact than the element's own
    change of curvature where a strip is under tension. Errors are of the second order.
    """
    law, frame = state.beams.law, state.motion.frame
    mean = state.motion.local_theta / law.length
    # what belongs to the mean curvature, whatever moment turning elements have at their middle
    mean_moment = turned_product(state.strains.first, law.stiffness * state.strains.values)[3:]
    on_ends = state.on_ends(state.stress)
    frame_b = state.motion.frame_at_b()
    moments = (-turned_product(frame, on_ends[3:6]), turned_product(frame_b, on_ends[9:]))
    tangent = _tangent(state)
    ends = []
    for moment in moments:
        turn = np.linalg.solve(tangent, (moment - mean_moment).T[..., None])[..., 0]
        ends.append((mean + turn.T / law.length).T)
    return np.stack(ends, 1)


def _tangent(state: BeamState) -> Floats:
    """Derivative of twist and bending moments with respect to turns at an unchanged axial force, (m, 3, 3).

    Where the stress takes most of the stiffness away, that of the section alone.
    """
    law, first = state.beams.law, state.strains.first[3:, 3:]
    of_section = np.einsum("kim,km,kjm->mij", first, law.stiffness[3:], first)
    whole = of_section + np.moveaxis(state.strains.second(law.stiffness * state.strains.values)[3:, 3:], -1, 0)
    scale = 1 / np.sqrt(np.einsum("mii->mi", of_section))
    left = np.linalg.eigvalsh(scale[:, :, None] * whole * scale[:, None, :])[:, 0]
    return np.asarray(np.where((left > LEAST_LEFT)[:, None, None], whole, of_section))


def strip_stresses(
    state: BeamState,
    material: Material,
    height: float,
    thickness: float,
    *,
    layers: int = 1,
    beside: Floats | float = 0.0,
) -> Stresses:
    """Stresses at the ends of elements that are strips of one section.

    Parameters
    ----------
    state : BeamState
    material : Material
    height, thickness : float
        m.
    layers : int
        Strips beside each other that an element stands for; they share its forces.
    beside : (2 m,) or float
        Strong-axis curvature that layers beside the centre line have besides, 1/m.

    Returns
    -------
    Stresses
        Each (2 m,): both ends of the first element, then of the second one. `layer` is all of the strong-axis bending,
        that of the moment, whatever the element's stiffness is reduced by; `restraint` 0: the axial force is in the
        von Mises stress.
    """
    law = state.beams.law
    at_ends = curvatures_at_ends(state)
    tg, kn, kg = at_ends.reshape(-1, 3).T
    axial = state.stress[0] / law.length / (height * thickness * layers)
    whole = np.array([section.bending_u for section in state.beams.sections])[state.beams.section]
    share = np.repeat(law.stiffness[4] / law.length / whole, 2)
    return stresses(
        material,
        height,
        thickness,
        curvature_error=np.zeros_like(tg),
        layer_curvature=np.abs(share * (kn - np.repeat(law.natural[:, 1], 2))) + beside,
        kg=kg,
        tg=tg,
        held=False,
        axial=np.repeat(axial, 2),
    )
