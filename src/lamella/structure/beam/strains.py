r"""Strains of beam elements and their stiffness: the energy is half the sum of stiffness times square.

Of the length L0, natural curvature (tg0, -kn0, kg0) and what `lamella.structure.beam.relative_motion` says:

====================  ==================================================================  =================
strain                formula                                                             stiffness over L0
====================  ==================================================================  =================
stretch               abs(rho) / L0 - 1 + i^2 (tg^2 - tg0^2) / 2 - swelling               E A
S-bend sideways       rho_u / abs(rho) - natural one                                      see below, weak
S-bend upright        rho_n / abs(rho) - natural one                                      see below, strong
twist                 tg - tg0                                                            G J
strong-axis bending   -kn + kn0                                                           E I_u
weak-axis bending     kg - kg0                                                            E I_n
across                (tg^2 - tg0^2 + nu kg (kg - kg0)) Psi(y)^(1/2)                      E t b^5 / 64
====================  ==================================================================  =================

with (tg, -kn, kg) = theta / L0. The stretch is that of the mean fibre: a fibre at the distance r from the centroid is
longer by r^2 (tg^2 - tg0^2) / 2, and i^2 is the mean of r^2 (H. Wagner 1936; N. S. Trahair, Journal of Structural
Engineering 131 (2005) 1135). The last one is what fibres deviate from it, see `lamella.structure.beam.plate_action`.

S-bends. Of a bending moment that changes along the element the mean is in the bending strains. What is linear about
that mean bends the element to an S, whose ends are turned against the chord by rho_u / abs(rho); with the stiffness
1 / (1 / (G A_s) + L0^2 / (12 E I)) per length the linear element is exact at its nodes (R. H. MacNeal, Computers &
Structures 8 (1978) 175: residual bending flexibility).
The chord's stretch, and not rho_t, is taken, so that a pull does not buckle the shear.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.structure.beam.columns import add_unit, dot, outer, product, symmetric, turned_product
from lamella.structure.beam.plate_action import Share, root_share

COUNT = 7
"""Number of strains."""


@dataclass(frozen=True)
class StrainLaw:
    """What the strains of m elements depend on beside their motion.

    Attributes
    ----------
    length : (m,)
        L0, m.
    natural : (m, 3)
        tg0, -kn0, kg0, 1/m.
    stiffness : (7, m)
        Times length, N m.
    gyration, poisson, plate_rate : (m,)
        See `CrossSection`.
    swelling : (m,) or float
        Stretch that needs no force: of a change of temperature.
    bends : (2, m) or float
        S-bends sideways and upright of the natural shape.
    coupling : (5, 5, m) or None
        Stiffness, times length, that S-bends, twist and bendings have besides, coupled with each other, against what
        `measures` differ from `reference`; see `lamella.structure.beam.turning`.
    reference : (5, m) or None
    """

    length: Floats
    natural: Floats
    stiffness: Floats
    gyration: Floats
    poisson: Floats
    plate_rate: Floats
    swelling: Floats | float = 0.0
    bends: Floats | float = 0.0
    coupling: Floats | None = None
    reference: Floats | None = None

    def measures(self, values: Floats) -> Floats:
        """S-bends, and twist and curvatures whatever is natural, of strains (7, m): (5, m)."""
        whole = values[1:6].copy()
        whole[2:] += self.natural.T
        return whole

    def stress(self, values: Floats) -> Floats:
        """What is conjugate to strains (7, m): derivatives of the energy, (7, m)."""
        result = self.stiffness * values
        if self.coupling is not None and self.reference is not None:
            result[1:6] += product(self.coupling, self.measures(values) - self.reference)
        return np.asarray(result)

    def stress_rate(self, rate: Floats) -> Floats:
        """Its change by a change of the strains, (7, m)."""
        result = self.stiffness * rate
        if self.coupling is not None:
            result[1:6] += product(self.coupling, rate[1:6])
        return np.asarray(result)

    def energy(self, values: Floats) -> Floats:
        """J, (m,)."""
        result = 0.5 * (self.stiffness * values**2).sum(0)
        if self.coupling is not None and self.reference is not None:
            apart = self.measures(values) - self.reference
            result += 0.5 * (apart * product(self.coupling, apart)).sum(0)
        return np.asarray(result)

    def elastic(self, first: Floats) -> Floats:
        """Second derivative of the energy but for that of the strains, with their first ones (7, k, m): (k, k, m)."""
        result = turned_product(first, self.stiffness[:, None] * first)
        if self.coupling is not None:
            result += turned_product(first[1:6], product(self.coupling, first[1:6]))
        return result


@dataclass(frozen=True)
class Strains:
    """Strains and their derivatives with respect to rho and theta in the frame at a; the element is the last axis.

    Attributes
    ----------
    values : (7, m)
        Without dimension, 1/m, and 1/m^2 of the last.
    first : (7, 6, m)
    """

    law: StrainLaw
    values: Floats
    first: Floats
    _direction: Floats  # (3, m) rho over its length
    _size: Floats  # (m,)
    share: Share
    _curvature: Floats  # (3, m)
    _across: Floats  # (m,) the last strain over the share's root

    @classmethod
    def of(cls, law: StrainLaw, rho: Floats, theta: Floats) -> Strains:
        """Of relative motions (3, m), (3, m)."""
        length, (tg0, kn0, kg0) = law.length, law.natural.T
        size = np.sqrt(dot(rho, rho))
        direction, curvature = rho / size, theta / length
        tg, kn, kg = curvature
        share = root_share(law.plate_rate * kg**2)
        twisted = tg**2 - tg0**2
        across = twisted + law.poisson * kg * (kg - kg0)
        values = np.empty((COUNT, len(length)))
        values[0] = size / length - 1 + law.gyration * twisted / 2 - law.swelling
        values[1:3] = direction[1:] - law.bends
        values[3], values[4], values[5], values[6] = tg - tg0, kn - kn0, kg - kg0, across * share.value
        first = np.zeros((COUNT, 6, len(length)))
        first[0, :3] = direction / length
        first[0, 3] = law.gyration * tg / length
        for i in (1, 2):
            first[i, :3] = -direction * (direction[i] / size)
            first[i, i] += 1 / size
        for i in (3, 4, 5):
            first[i, i] = 1 / length
        first[6, 3] = 2 * tg * share.value / length
        slope = law.poisson * (2 * kg - kg0) * share.value + across * share.first * 2 * law.plate_rate * kg
        first[6, 5] = slope / length
        return cls(law, values, first, direction, size, share, curvature, across)

    def second(self, stress: Floats) -> Floats:
        """Second derivative of the sum of stress (7, m) times strain with respect to rho and theta, (6, 6, m)."""
        law, d, size, share = self.law, self._direction, self._size, self.share
        result = np.zeros((6, 6, len(size)))
        pull = stress[0] / (law.length * size)
        side = np.zeros_like(d)
        side[1:] = stress[1:3] / size**2
        lean = dot(side, d)
        # the unit matrix, the square of the direction, and what leans to the side
        result[:3, :3] = outer((3 * lean - pull) * d, d) - 2 * symmetric(outer(side, d))
        add_unit(result[:3, :3], pull - lean)
        (tg, _, kg), (_, _, kg0), nu, rate = self._curvature, law.natural.T, law.poisson, law.plate_rate
        turn, slope = 2 * rate * kg * share.first, nu * (2 * kg - kg0)
        bent = 2 * nu * share.value + 2 * slope * turn
        bent += self._across * (2 * rate * share.first + 4 * (rate * kg) ** 2 * share.second)
        by_square = 1 / law.length**2
        result[3, 3] = (stress[0] * law.gyration + stress[6] * 2 * share.value) * by_square
        result[3, 5] = result[5, 3] = stress[6] * 2 * tg * turn * by_square
        result[5, 5] = stress[6] * bent * by_square
        return result
