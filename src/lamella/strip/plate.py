r"""Stresses across the height of a thin strip that is bent and twisted, with its plate action.

A strip of height h and thickness t, bent about its weak axis by kg and twisted by tg, does not stay flat across: it
takes a deflection f(z) out of the ruled strip. A fibre at the height z is strained by
:math:`\varepsilon = e_0 + \tau_g^2 z^2 / 2 - \kappa_g f` (its way around the twisted axis, and its depth in the bend),
and the strip's energy per length is

.. math:: \int \tfrac12 E t \varepsilon^2 + \tfrac12 D (\kappa_g^2 + 2 \nu \kappa_g f'' + f''^2) \, dz,
   \qquad D = \frac{E t^3}{12 (1 - \nu^2)}

(von Karman's plate in one dimension). It is least where f is the deflection of a beam across the height on an elastic
foundation, :math:`D f'''' + E t \kappa_g^2 f = E t \kappa_g (e_0 + \tau_g^2 z^2 / 2)`, with free edges,
:math:`f'' = -\nu \kappa_g` and :math:`f''' = 0`: sums of products of circular and hyperbolic functions of
:math:`y = \beta z`, :math:`\beta^4 = 3 (1 - \nu^2) \kappa_g^2 / t^2` (Hetenyi, Beams on Elastic Foundation, 1946).

Left out is the part :math:`\tau_g^2 f^2 / 2` of the strain. Against a solution with it (`tests/strip/plate_strip.py`;
strips of 50 x 1 to 200 x 3 mm, kg to 3/m, tg to 3/m, held and free) the largest von Mises stress is right within 1 % as
long as it is below 0.35 % of E (700 MPa in steel). Beyond that, where no strip stays elastic, the error grows: 2 % at
twice as much, 20 % at seven times as much.
"""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.material import Material

# of x = beta h / 2: below it the strip stays flat across within rounding
FLAT_ACROSS = 1e-3
# isotropic materials; others (timber) are taken without lateral contraction
MOST_POISSON = 0.5


class Across(NamedTuple):
    """At one height: membrane stress (Pa) and curvature across the strip (1/m), each (k,)."""

    stress: Floats
    curvature: Floats


def poisson_ratio(material: Material) -> float:
    """nu = E / 2G - 1; 0 for what is not isotropic (timber), where that is no Poisson ratio."""
    ratio = material.youngs_modulus / (2 * material.shear_modulus) - 1
    return ratio if 0 <= ratio <= MOST_POISSON else 0.0


class Plate:
    """Strips as plates, at samples where they are bent and twisted; what heights share is computed once.

    Parameters
    ----------
    material : Material
    height, thickness : float or (k,)
        m.
    kg, tg : (k,)
        1/m.
    """

    def __init__(
        self, material: Material, height: float | Floats, thickness: float | Floats, kg: Floats, tg: Floats
    ) -> None:
        self._nu, self._kg, self._tg = poisson_ratio(material), np.abs(kg), tg
        # beta h / 2
        rate = np.sqrt(3 * (1 - self._nu**2)) / thickness
        reach = np.asarray(0.5 * height * np.sqrt(self._kg * rate))
        self._flat = reach < FLAT_ACROSS
        self._x = np.maximum(reach, FLAT_ACROSS)
        self._strain = tg**2 + self._nu * self._kg**2
        self._modulus, self._height = material.youngs_modulus, height
        self._at = {1.0: _functions(self._x, 1.0)}

    def across(self, share: float, held: bool) -> Across:
        """Membrane stress along the strip, and its curvature across, at a height.

        Parameters
        ----------
        share : float
            Height above the centre line over h / 2: 1 at the edges, 0 on the centre line.
        held : bool
            Whether nodes hold the centre line at its length (it is then without strain). Else the strip is free to
            shorten, and the stress has no resultant.
        """
        nu, kg, flat = self._nu, self._kg, self._flat
        shape, spread = self._held(share) if held else self._free(share)
        limit = share**2 / 2 - (0.0 if held else 1 / 6)
        stress = self._modulus * self._strain * self._height**2 / 4 * np.where(flat, limit, shape)
        rise = np.where(flat, 0.0, (1 - spread) / np.where(flat, 1.0, kg))
        return Across(stress, np.asarray(self._tg**2 * rise - nu * kg * np.where(flat, 1.0, spread)))

    def mean_tension(self) -> Floats:
        """Mean over the height of the membrane stress with a held centre line, Pa, (k,); E h^2 tg^2 / 24 at kg = 0."""
        x, edge = self._x, self._at[1.0]
        # from the jump of the shear force on the centre line
        share = (edge.ch * edge.s - edge.sh * edge.c) * np.exp(-x) / (8 * x**3 * self._whole_held)
        strain = self._strain * self._height**2 * np.where(self._flat, 1 / 24, share)
        return np.asarray(self._modulus * strain)

    @cached_property
    def _whole_held(self) -> Floats:
        edge = self._at[1.0]
        return np.asarray(edge.ch**2 + edge.c**2 * edge.decay)

    @cached_property
    def _whole_free(self) -> Floats:
        """Sinh 2x + sin 2x over e^(2x)."""
        edge = self._at[1.0]
        return np.asarray(2 * (edge.sh * edge.ch + edge.s * edge.c * edge.decay))

    def _functions(self, share: float) -> _Functions:
        if share not in self._at:
            self._at[share] = _functions(self._x, share)
        return self._at[share]

    def _free(self, share: float) -> tuple[Floats, Floats]:
        """Stress over E (tg^2 + nu kg^2) h^2 / 4, and the share of the edge's added curvature: without a resultant."""
        edge, own, whole = self._at[1.0], self._functions(share), self._whole_free
        less, more = edge.sh * edge.c - edge.ch * edge.s, edge.ch * edge.s + edge.sh * edge.c
        stress = (less * own.ch * own.c + more * own.sh * own.s) * own.reach / (self._x**2 * whole)
        return stress, 2 * (more * own.ch * own.c - less * own.sh * own.s) * own.reach / whole

    def _held(self, share: float) -> tuple[Floats, Floats]:
        """The same with a centre line that has no strain."""
        edge, own, whole = self._at[1.0], self._functions(share), self._whole_held
        both, less = edge.ch * edge.c, edge.ch * edge.s - edge.sh * edge.c
        bent = less * (own.ch * own.s - own.sh * own.c)
        stress = (2 * both * own.sh * own.s + bent) * own.reach / (2 * self._x**2 * whole)
        return stress, (2 * both * own.ch * own.c + less * (own.ch * own.s + own.sh * own.c)) * own.reach / whole


class _Functions(NamedTuple):
    """Of y = share x: cosh and sinh over e^y, cos and sin, e^(y - x) and e^(-2 y)."""

    ch: Floats
    sh: Floats
    c: Floats
    s: Floats
    reach: Floats
    decay: Floats


def _functions(x: Floats, share: float) -> _Functions:
    y = share * x
    decay = np.exp(-2 * y)
    return _Functions((1 + decay) / 2, -np.expm1(-2 * y) / 2, np.cos(y), np.sin(y), np.exp(y - x), decay)
