r"""Consistent mass of beam elements.

Kinetic energy of the motion that belongs to the ends' motion: along the element and about it linear, across it the
cubic of a beam that shears (J. S. Przemieniecki, Theory of Matrix Structural Analysis, McGraw-Hill 1968, sections 5.6
and 11.3), whose elastic energy is that of `lamella.structure.beam.strains`. The element is taken along its middle
tangent; frequencies are of the fourth order in its length where it is straight.
"""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats
from lamella.structure.beam.attachment import END_UNKNOWNS
from lamella.structure.beam.beams import BeamState
from lamella.structure.beam.columns import product, turned_product
from lamella.structure.beam.rotations import exponential

# exact for the square of a cubic
_PLACES, _WEIGHTS = np.polynomial.legendre.leggauss(4)


def consistent_mass(state: BeamState) -> list[Floats]:
    """Mass matrices in the groups of `Beams.unknowns`, kg, kg m, kg m^2."""
    beams = state.beams
    middle = exponential(0.5 * state.motion.local_theta.T)
    middle = product(state.motion.frame, np.moveaxis(middle, 0, -1))
    turned = np.einsum("iam,paqbm->piqbm", middle, _local_mass(state))
    ends = np.einsum("jbm,piqbm->piqjm", middle, turned).reshape(END_UNKNOWNS, END_UNKNOWNS, -1)
    if state.levers is None:
        return [ends, np.zeros((END_UNKNOWNS + 2, END_UNKNOWNS + 2, 0))]
    lever = state.levers.first()
    return [ends[..., beams.direct], turned_product(lever, product(ends[..., beams.indirect], lever))]


def _local_mass(state: BeamState) -> Floats:
    """In the axes t, u, n of the element's middle, (4, 3, 4, 3, m)."""
    beams, length = state.beams, state.beams.law.length

    def of(name: str) -> Floats:
        return np.array([getattr(section, name) for section in beams.sections], float)[beams.section]

    mass = np.stack([of("mass")] * 3 + [of("inertia_t"), of("inertia_u"), of("inertia_n")])
    slack_u = 12 * of("bending_n") / (of("shear_u") * length**2)
    slack_n = 12 * of("bending_u") / (of("shear_n") * length**2)
    result = np.zeros((END_UNKNOWNS, END_UNKNOWNS, len(length)))
    for place, weight in zip((1 + _PLACES) / 2, _WEIGHTS / 2, strict=True):
        shape = _shape(float(place), length, slack_u, slack_n)
        result += turned_product(shape, (weight * length * mass)[:, None] * shape)
    return result.reshape(4, 3, 4, 3, -1)


def _shape(s: float, length: Floats, slack_u: Floats, slack_n: Floats) -> Floats:
    """Shift and rotation at the share s of the length by the motion of the ends, (6, 12, m)."""
    result = np.zeros((6, END_UNKNOWNS, len(length)))
    for along in (0, 3):
        result[along, along], result[along, along + 6] = 1 - s, s
    # a slope towards u is a rotation about n; one towards n a rotation about -u
    for shift, turn, sign, slack in ((1, 5, 1.0, slack_u), (2, 4, -1.0, slack_n)):
        whole = 1 + slack
        bulge = slack * (s - s**2) / 2
        result[shift, shift] = (1 - 3 * s**2 + 2 * s**3 + slack * (1 - s)) / whole
        result[shift, shift + 6] = (3 * s**2 - 2 * s**3 + slack * s) / whole
        result[shift, turn] = sign * length * (s - 2 * s**2 + s**3 + bulge) / whole
        result[shift, turn + 6] = sign * length * (s**3 - s**2 - bulge) / whole
        slope = 6 * (s - s**2) / (length * whole)
        result[turn, shift], result[turn, shift + 6] = -sign * slope, sign * slope
        result[turn, turn] = (1 - 4 * s + 3 * s**2 + slack * (1 - s)) / whole
        result[turn, turn + 6] = (3 * s**2 - 2 * s + slack * s) / whole
    return result
