"""Elliptic functions and integrals at the accuracy the closed forms need.

`scipy.special.ellipeinc` returned wrong values at isolated arguments (0.477 for 0.40337 at
phi = 0.4125760989875492, m = 0.7975); Carlson's symmetric forms do not. Arguments are reduced by whole
periods first, so that surfaces of many periods keep full accuracy.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.special import ellipe, ellipj, ellipkm1, elliprd, elliprf

from lamella.base.arrays import Floats


class Jacobi(NamedTuple):
    """Jacobi's functions of one argument."""

    sn: Floats
    cn: Floats
    dn: Floats


def quarter_period(m1: float) -> float:
    """Complete integral K(m) from the complementary parameter m1 = 1 - m."""
    return float(ellipkm1(m1))


def jacobi(x: Floats, m1: float) -> Jacobi:
    """Jacobi's sn, cn and dn for any real x.

    Parameters
    ----------
    x : (...)
        Argument.
    m1 : float
        Complementary parameter 1 - m, 0 < m1 <= 1; given itself because m is near 1 on thin necks.
    """
    m = 1.0 - m1
    quarter = quarter_period(m1)
    turns = np.round(x / (2 * quarter))
    sn, cn, _, _ = ellipj(x - turns * 2 * quarter, m)
    sign = 1.0 - 2.0 * (turns % 2)
    return Jacobi(sign * sn, sign * cn, np.sqrt(m1 + m * np.square(cn)))


def epsilon(x: Floats, f: Jacobi, m1: float) -> Floats:
    """Jacobi's epsilon E(am x | m) for any real x, given f = jacobi(x, m1).

    Notes
    -----
    E(phi | m) = s RF(c^2, 1 - m s^2, 1) - (m / 3) s^3 RD(c^2, 1 - m s^2, 1) (Carlson), |phi| <= pi / 2;
    epsilon(x + 2 K) = epsilon(x) + 2 E(m) (DLMF 22.16.26).
    """
    m = 1.0 - m1
    turns = np.round(x / (2 * quarter_period(m1)))
    sn = f.sn * (1.0 - 2.0 * (turns % 2))
    c2, d2 = np.square(f.cn), np.square(f.dn)
    return np.asarray(sn * elliprf(c2, d2, 1.0) - m / 3 * sn**3 * elliprd(c2, d2, 1.0) + 2 * turns * float(ellipe(m)))


def first_kind(sine: Floats, m: float) -> Floats:
    """Incomplete integral F(phi | m) for sin phi = `sine`, |phi| <= pi / 2 (Carlson's RF)."""
    s2 = np.square(sine)
    return np.asarray(sine * elliprf(np.maximum(1.0 - s2, 0.0), 1.0 - m * s2, 1.0))
