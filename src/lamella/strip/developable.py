"""Where a developable strip that stands upright on a surface exists, and how high it can be."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lamella.strip.darboux_of_polyline import polyline_darboux

Floats = NDArray[np.float64]


def buildable_height(points: Floats, normals: Floats) -> Floats:
    r"""Height up to which the developable strip along a curve is regular, m, (k,).

    Its rulings are r = kg n + tg t (paper, section 2). At the height z above the curve it is regular while

    .. math:: 1 + z (L' - \kappa_n (1 + L^2)) > 0, \qquad L = \tau_g / \kappa_g.

    Where kg = 0 and tg is not, the ruling runs along the curve: no developable strip of positive height exists.

    Parameters
    ----------
    points : (k, 3)
        Of the curve in order, m.
    normals : (k, 3)
        Unit surface normals there, to the side on which the strip stands.

    Returns
    -------
    (k,)
        Infinite where nothing limits it, 0 where kg changes its sign.
    """
    kn, kg, tg, s = polyline_darboux(points, normals)
    # times kg^2, so that nothing is divided by a small kg
    bracket = np.gradient(tg, s) * kg - tg * np.gradient(kg, s) - kn * (kg**2 + tg**2)
    height = np.where(bracket < 0, kg**2 / np.where(bracket < 0, -bracket, 1.0), np.inf)
    turn = np.flatnonzero((kg[1:] * kg[:-1] <= 0) & (np.abs(tg[1:]) + np.abs(tg[:-1]) > 0))
    height[turn] = height[turn + 1] = 0.0
    return np.asarray(height)
