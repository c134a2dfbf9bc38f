r"""Strains of beam elements and their stiffness: the energy is half the sum of stiffness times square.

Of the length L0, natural curvature (tg0, -kn0, kg0) and what `lamella.structure.beam.relative_motion` says:

====================  ==================================================================  =================
strain                formula                                                             stiffness over L0
====================  ==================================================================  =================
stretch               abs(rho) / L0 - 1 + i^2 (tg^2 - tg0^2) / 2                          E A
S-bend sideways       rho_u / abs(rho)                                                    see below, weak
S-bend upright        rho_n / abs(rho)                                                    see below, strong
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
from lamella.base.vectors import lengths
from lamella.structure.beam.plate_action import Share, root_share

COUNT = 7
"""Number of strains."""


@dataclass(frozen=True)
class StrainLaw:
    """What the strains of m elements depend on beside their motion, each (m,) or (m, 3) or (m, 7).

    Attributes
    ----------
    length : (m,)
        L0, m.
    natural : (m, 3)
        tg0, -kn0, kg0, 1/m.
    stiffness : (m, 7)
        Times length, N m.
    gyration, poisson, plate_rate : (m,)
        See `CrossSection`.
    """

    length: Floats
    natural: Floats
    stiffness: Floats
    gyration: Floats
    poisson: Floats
    plate_rate: Floats


@dataclass(frozen=True)
class Strains:
    """Strains and their derivatives with respect to (rho, theta).

    Attributes
    ----------
    values : (m, 7)
        Without dimension, 1/m, and 1/m^2 of the last.
    first : (m, 7, 6)
    """

    law: StrainLaw
    values: Floats
    first: Floats
    _direction: Floats  # (m, 3) rho over its length
    _size: Floats  # (m,)
    _share: Share
    _curvature: Floats  # (m, 3)

    @classmethod
    def of(cls, law: StrainLaw, rho: Floats, theta: Floats) -> Strains:
        """Of relative motions (m, 3), (m, 3)."""
        length, (tg0, kn0, kg0) = law.length, law.natural.T
        size = lengths(rho)
        direction = rho / size[:, None]
        curvature = theta / length[:, None]
        tg, kn, kg = curvature.T
        share = root_share(law.plate_rate * kg**2)
        twisted = tg**2 - tg0**2
        across = twisted + law.poisson * kg * (kg - kg0)
        values = np.stack(
            (
                size / length - 1 + law.gyration * twisted / 2,
                direction[:, 1],
                direction[:, 2],
                tg - tg0,
                kn - kn0,
                kg - kg0,
                across * share.value,
            ),
            1,
        )
        first = np.zeros((len(size), COUNT, 6))
        first[:, 0, :3] = direction / length[:, None]
        first[:, 0, 3] = law.gyration * tg / length
        for i in (1, 2):
            first[:, i, :3] = -direction * direction[:, i, None] / size[:, None]
            first[:, i, i] += 1 / size
        for i in (3, 4, 5):
            first[:, i, i] = 1 / length
        first[:, 6, 3] = 2 * tg * share.value / length
        first[:, 6, 5] = (
            law.poisson * (2 * kg - kg0) * share.value + across * share.first * 2 * law.plate_rate * kg
        ) / length
        return cls(law, values, first, direction, size, share, curvature)

    def second(self, stress: Floats) -> Floats:
        """Second derivative of the sum of stress (m, 7) times strain with respect to (rho, theta), (m, 6, 6)."""
        law, d, size = self.law, self._direction, self._size
        result = np.zeros((len(size), 6, 6))
        eye, square = np.eye(3), d[:, :, None] * d[:, None, :]
        pull = stress[:, 0] / (law.length * size)
        side = np.zeros_like(d)
        side[:, 1:] = stress[:, 1:3] / (size**2)[:, None]
        lean = np.einsum("mi,mi->m", side, d)[:, None, None]
        skew = side[:, :, None] * d[:, None, :]
        result[:, :3, :3] = pull[:, None, None] * (eye - square) - skew - np.swapaxes(skew, 1, 2)
        result[:, :3, :3] -= lean * (eye - 3 * square)
        (tg, _, kg), (tg0, _, kg0), nu, rate = self._curvature.T, law.natural.T, law.poisson, law.plate_rate
        share, across = self._share, tg**2 - tg0**2 + law.poisson * kg * (kg - kg0)
        slope = nu * (2 * kg - kg0)
        turn = 2 * rate * kg * share.first
        by_square = 1 / law.length**2
        result[:, 3, 3] = (stress[:, 0] * law.gyration + stress[:, 6] * 2 * share.value) * by_square
        result[:, 3, 5] = result[:, 5, 3] = stress[:, 6] * 2 * tg * turn * by_square
        result[:, 5, 5] = (
            stress[:, 6]
            * by_square
            * (
                2 * nu * share.value
                + 2 * slope * turn
                + across * (2 * rate * share.first + 4 * (rate * kg) ** 2 * share.second)
            )
        )
        return result
