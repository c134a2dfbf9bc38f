"""Where a developable strip that stands upright on a surface exists, and how high it can be."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats
from lamella.strip.darboux_of_polyline import polyline_darboux

# share of a curve's largest curvature below which kg and tg are rounding: along a helix on a cylinder kg is 0
NEGLIGIBLE = 1e-5


def buildable_height(points: Floats, normals: Floats) -> Floats:
    r"""Height up to which the developable strip along a curve is regular, m, (k,).

    Its rulings are r = kg n + tg t (paper, section 2). At the height z above the curve it is regular while

    .. math:: 1 + z (L' - \kappa_n (1 + L^2)) > 0, \qquad L = \tau_g / \kappa_g.

    Where kg = 0 and tg is not, the ruling runs along the curve: no developable strip of positive height exists. Where
    tg = 0 (a principal line, any curve on a sphere) the rulings are normals.

    Parameters
    ----------
    points : (k, 3)
        Of the curve in order, m.
    normals : (k, 3)
        Unit surface normals there, to the side on which the strip stands.

    Returns
    -------
    (k,)
        Infinite where nothing limits it, 0 where kg is 0 or changes its sign and tg is not 0.
    """
    kn, kg, tg, s = polyline_darboux(points, normals)
    # at the ends differences are of first order only
    for values in (kg, tg):
        values[[0, -1]] = values[[1, -2]]
    least = NEGLIGIBLE * np.sqrt(kn**2 + kg**2 + tg**2).max()
    kg, tg = (np.where(np.abs(x) > least, x, 0.0) for x in (kg, tg))
    # times kg^2, so that nothing is divided by a small kg
    bracket = np.gradient(tg, s) * kg - tg * np.gradient(kg, s) - kn * (kg**2 + tg**2)
    height = np.where(bracket < 0, kg**2 / np.where(bracket < 0, -bracket, 1.0), np.inf)
    # L = 0 where both vanish
    straight = (kg == 0) & (tg == 0)
    height[straight] = np.where(kn > 0, 1 / np.where(kn > 0, kn, 1.0), np.inf)[straight]
    turn = np.flatnonzero((kg[1:] * kg[:-1] <= 0) & (np.abs(tg[1:]) + np.abs(tg[:-1]) > 0))
    height[turn] = height[turn + 1] = 0.0
    return np.asarray(height)
