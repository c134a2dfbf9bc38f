r"""What elements resist with in OpenSees: laws of its beams and fibres, and hinges of slots.

A strip with the helix effect is a beam on its axis and two fibres at the distance i, the polar radius of gyration, on
either side. With all of E A in the fibres, a fibre's length is that of the strip's stretch
:math:`\varepsilon + i^2 \tau_g^2 / 2`, and :math:`E A \, i^2` is the strong-axis stiffness :math:`E I_u` of a strip.
The S-bend with its shear is in the beam: its law in the middle and at the outer two of three Gauss points differ, so
that :math:`\tfrac49 k_m + \tfrac59 k_e` is the stiffness of uniform bending and :math:`k_e` that of bending that
changes its sign. What slots take from the strong-axis stiffness is in hinges at the element's ends; what they take from
the others, in the laws. (A beam of negative stiffness beside the fibres did not converge in a net with cables.)

What the helix stress deviates from its mean has with the twist the moment
:math:`2 S \Psi \tau_g (\tau_g^2 - \tau_{g0}^2 + \nu \kappa_g (\kappa_g - \kappa_{g0}))`, see
`lamella.structure.beam.strains`, whose cube follows the twist as strips untwist; that of weak-axis bending is linear
about the designed shape, and how each depends on the other is left out (to let it in linearly, by bars across the
strip, was farther off: strips lose half of their twist at free ends).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.structure.beam.beams import Beams, BeamState
from lamella.structure.beam.columns import turned_product
from lamella.structure.export.script_rows import rounded

# of what it is beside: a law that only keeps the system regular
SOFT = 1e-6


@dataclass(frozen=True, eq=False)
class ElementLaws:
    """Of m elements.

    Attributes
    ----------
    beams : list of tuples
        Axial: stiffness and initial strain; torsion: the same, what it has by the twist and by its cube, and the twist;
        strong and weak: stiffness at the outer Gauss points and in the
        middle, and initial curvature.
    axial : (m,)
        E A, N.
    fibre_strains : (2, m)
        Of the upper and the lower fibre.
    radius : (m,)
        Distance of the fibres, m; 0: none.
    hinges : (m,)
        What slots make the elements turn by about their strong axis, rad/(N m), half of it at either end.
    """

    beams: list[tuple[tuple[float, ...], ...]]
    axial: Floats
    fibre_strains: Floats
    radius: Floats
    hinges: Floats

    @classmethod
    def of(cls, state: BeamState) -> ElementLaws:
        """Of elements in the designed shape."""
        law, strains = state.beams.law, state.strains
        stiffness = law.stiffness / law.length
        # strips have the helix effect, edge beams nearly none
        helix = law.stiffness[6] > 0
        radius: Floats = np.where(helix, np.sqrt(law.gyration), 0.0)
        theta = state.motion.local_theta / law.length
        moments = turned_product(strains.first, state.stress)[3:]
        stretch, strong_strain = strains.values[0], strains.values[4]
        weak = stiffness[5] + _plate_bending(state)
        constant, cubic = _plate_torsion(state)
        left, s_strong, hinges = _strong(state.beams)
        left = left - np.where(helix, stiffness[0] * law.gyration, 0.0)
        s_weak = stiffness[1] * law.length**2 / 12
        laws = (
            np.where(helix, SOFT, 1.0) * stiffness[0],
            np.where(helix, 0.0, stretch),
            stiffness[3],
            strains.values[3],
            constant,
            cubic,
            theta[0],
            s_strong,
            (left - 5 / 9 * s_strong) * 9 / 4,
            -strong_strain,
            s_weak,
            (weak - 5 / 9 * s_weak) * 9 / 4,
            moments[2] / weak,
        )
        beams: list[tuple[tuple[float, ...], ...]] = []
        for row in zip(*(rounded(values).tolist() for values in laws), strict=True):
            beams.append((row[:2], row[2:7], row[7:10], row[10:]))
        strain = np.stack([stretch + side * radius * strong_strain for side in (1, -1)])
        return cls(beams, stiffness[0], strain, radius, hinges)


def slot_hinges(beams: Beams) -> Floats:
    """What slots make elements turn by about their strong axis beside what whole strips do, rad/(N m), (m,)."""
    law = beams.law
    whole = np.array([kind.bending_u for kind in beams.sections], float)[beams.section]
    hinges = law.length**2 / law.stiffness[4] - law.length / whole
    return np.where(hinges * whole > SOFT * law.length, hinges, 0.0)


def _strong(beams: Beams) -> tuple[Floats, Floats, Floats]:
    """Strong-axis stiffness of bending and of bending that changes its sign, of whole strips, N m2; `slot_hinges`."""
    law, hinges = beams.law, slot_hinges(beams)
    whole, flexible = (
        np.array(values, float)[beams.section]
        for values in zip(*((kind.bending_u, 1 / kind.shear_n) for kind in beams.sections), strict=True)
    )
    bent = np.where(hinges > 0, whole, law.stiffness[4] / law.length)
    s_bent = 1 / (1 / whole + 12 * flexible / law.length**2)
    return bent, np.where(hinges > 0, s_bent, law.stiffness[2] * law.length / 12), hinges


def _plate_bending(state: BeamState) -> Floats:
    """Weak-axis stiffness that the helix stress's deviation from its mean adds, N m2, (m,)."""
    law, strains = state.beams.law, state.strains
    only = np.zeros_like(state.stress)
    only[6] = state.stress[6]
    bent = law.stiffness[6] * strains.first[6, 5] ** 2
    return np.asarray((bent + strains.second(only)[5, 5]) * law.length)


def _plate_torsion(state: BeamState) -> tuple[Floats, Floats]:
    """Torsional moment of the same, by the twist and by its cube: N m2 and N m4, (m,) each."""
    law, strains = state.beams.law, state.strains
    _, _, kg = state.motion.local_theta / law.length
    tg0, _, kg0 = law.natural.T
    rate = 2 * law.stiffness[6] / law.length * strains.share.value**2
    return rate * (law.poisson * kg * (kg - kg0) - tg0**2), rate
