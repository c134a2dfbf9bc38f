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


def across(
    material: Material, height: float, thickness: float, kg: Floats, tg: Floats, share: float, held: bool
) -> Across:
    """Membrane stress along the strip, and its curvature across, at a height.

    Parameters
    ----------
    material : Material
    height, thickness : float
        m.
    kg, tg : (k,)
        1/m.
    share : float
        Height above the centre line over h / 2: 1 at the edges, 0 on the centre line.
    held : bool
        Whether nodes hold the centre line at its length (it is then without strain). Else the strip is free to shorten,
        and the stress has no resultant.
    """
    nu, kg = poisson_ratio(material), np.abs(kg)
    x = _reach(material, height, thickness, kg)
    bent = np.maximum(x, FLAT_ACROSS)
    shape, spread = _held(bent, share) if held else _free(bent, share)
    flat = x < FLAT_ACROSS
    limit = share**2 / 2 - (0.0 if held else 1 / 6)
    stress = material.youngs_modulus * (tg**2 + nu * kg**2) * height**2 / 4 * np.where(flat, limit, shape)
    rise = np.where(flat, 0.0, (1 - spread) / np.where(flat, 1.0, kg))
    return Across(stress, np.asarray(tg**2 * rise - nu * kg * np.where(flat, 1.0, spread)))


def mean_tension(material: Material, height: float, thickness: float, kg: Floats, tg: Floats) -> Floats:
    """Mean over the height of the membrane stress with the centre line held, Pa, (k,); E h^2 tg^2 / 24 at kg = 0."""
    nu, x = poisson_ratio(material), _reach(material, height, thickness, kg)
    bent = np.maximum(x, FLAT_ACROSS)
    ch, sh, c, s, _ = _functions(bent, 1.0)
    # from the jump of the shear force on the centre line
    share = (ch * s - sh * c) * np.exp(-bent) / (8 * bent**3 * (ch**2 + c**2 * np.exp(-2 * bent)))
    strain = (tg**2 + nu * kg**2) * height**2 * np.where(x < FLAT_ACROSS, 1 / 24, share)
    return np.asarray(material.youngs_modulus * strain)


def _reach(material: Material, height: float, thickness: float, kg: Floats) -> Floats:
    """x = beta h / 2."""
    rate = np.sqrt(3 * (1 - poisson_ratio(material) ** 2)) / thickness
    return np.asarray(0.5 * height * np.sqrt(np.abs(kg) * rate))


def _functions(x: Floats, share: float) -> tuple[Floats, ...]:
    """cosh and sinh over e^y, cos and sin, of y = share x, and e^(y - x)."""
    y = share * x
    decay = np.exp(-2 * y)
    return (1 + decay) / 2, -np.expm1(-2 * y) / 2, np.cos(y), np.sin(y), np.exp(y - x)


def _free(x: Floats, share: float) -> tuple[Floats, Floats]:
    """Stress over E (tg^2 + nu kg^2) h^2 / 4, and the share of the edge's added curvature: without a resultant."""
    ch, sh, c, s, _ = _functions(x, 1.0)
    ch_y, sh_y, c_y, s_y, reach = _functions(x, share)
    less, more = sh * c - ch * s, ch * s + sh * c
    # sinh 2x + sin 2x over e^(2x)
    whole = 2 * (sh * ch + s * c * np.exp(-2 * x))
    stress = (less * ch_y * c_y + more * sh_y * s_y) * reach / (x**2 * whole)
    return stress, 2 * (more * ch_y * c_y - less * sh_y * s_y) * reach / whole


def _held(x: Floats, share: float) -> tuple[Floats, Floats]:
    """The same with a centre line that has no strain."""
    ch, sh, c, s, _ = _functions(x, 1.0)
    ch_y, sh_y, c_y, s_y, reach = _functions(x, share)
    both, less = ch * c, ch * s - sh * c
    whole = ch**2 + c**2 * np.exp(-2 * x)
    stress = (2 * both * sh_y * s_y + less * (ch_y * s_y - sh_y * c_y)) * reach / (2 * x**2 * whole)
    return stress, (2 * both * ch_y * c_y + less * (ch_y * s_y + sh_y * c_y)) * reach / whole
