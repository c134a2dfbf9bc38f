r"""How much of a strip's helix energy is left when the strip may bend across its height.

A strip of height b that is bent by kg and twisted by tg would, if it stayed flat across, carry the helix stress of its
twist and the moment that lateral contraction asks for. It takes a deflection across its height instead
(`lamella.strip.plate`). The energy that is left is

.. math:: \tfrac12 \frac{E t b^5}{64} \, p^2 \, \Psi(y), \qquad
   p = \tau_g^2 - \tau_{g0}^2 + \nu \kappa_g (\kappa_g - \kappa_{g0}), \qquad
   y = \frac{3 (1 - \nu^2) b^4}{16 t^2} \kappa_g^2 ,

.. math:: \Psi = \frac{1 - \Phi}{x^4}, \qquad
   \Phi = \frac{\cosh 2x - \cos 2x}{x (\sinh 2x + \sin 2x)}, \qquad x^4 = y

(E. H. Mansfield, Proceedings of the Royal Society A 334 (1973) 279; D. G. Ashwell, Journal of the Royal Aeronautical
Society 54 (1950) 708). Psi falls from 4/45 of a strip that stays flat across, and is analytic in y: the energy has all
derivatives, also where kg changes its sign. As power series in y,

.. math:: \Psi = \sum_{j \ge 1} \frac{4 j \, 16^j y^{j - 1}}{(4j + 2)!} \Big/ \sum_{j \ge 0} \frac{16^j y^j}{(4j + 1)!},

whose terms are all positive.
"""

from __future__ import annotations

from math import factorial
from typing import NamedTuple

import numpy as np
from numpy.polynomial import polynomial

from lamella.base.arrays import Floats

# of y: below it the power series, above it the closed form, in which e^(-2x) is then small
SERIES_UP_TO = 40.0
# of the series: the next one is below rounding at that y
PLATE_POWERS = 16
_ABOVE = np.array([4 * j * 16.0**j / factorial(4 * j + 2) for j in range(1, PLATE_POWERS + 1)])
_BELOW = np.array([16.0**j / factorial(4 * j + 1) for j in range(PLATE_POWERS + 1)])


class Share(NamedTuple):
    """sqrt(Psi), and its first and second derivative with respect to y, each (m,)."""

    value: Floats
    first: Floats
    second: Floats


def root_share(y: Floats) -> Share:
    """sqrt(Psi(y)), whose square is the share of the energy that is left, for y >= 0 (m,)."""
    low, high = _series(np.minimum(y, SERIES_UP_TO)), _closed(np.maximum(y, SERIES_UP_TO))
    psi, first, second = (np.where(y < SERIES_UP_TO, a, b) for a, b in zip(low, high, strict=True))
    root = np.sqrt(psi)
    slope = first / (2 * root)
    return Share(root, slope, (second / 2 - slope**2) / root)


def _series(y: Floats) -> tuple[Floats, Floats, Floats]:
    """Psi, Psi', Psi''."""
    n, n1, n2 = (polynomial.polyval(y, polynomial.polyder(_ABOVE, k)) for k in range(3))
    d, d1, d2 = (polynomial.polyval(y, polynomial.polyder(_BELOW, k)) for k in range(3))
    psi = n / d
    first = (n1 - psi * d1) / d
    return psi, first, (n2 - 2 * first * d1 - psi * d2) / d


def _closed(y: Floats) -> tuple[Floats, Floats, Floats]:
    """Psi, Psi', Psi''."""
    x = np.sqrt(np.sqrt(y))
    decay, c, s = np.exp(-2 * x), np.cos(2 * x), np.sin(2 * x)
    # numerator and denominator of x Phi, over cosh and sinh of large arguments, with two derivatives in x
    n, n1, n2 = 1 + decay**2 - 2 * decay * c, -4 * decay**2 + 4 * decay * (c + s), 16 * decay**2 - 16 * decay * s
    d, d1, d2 = 1 - decay**2 + 2 * decay * s, 4 * decay**2 + 4 * decay * (c - s), -16 * decay**2 - 16 * decay * c
    f = n / d
    f1 = (n1 - f * d1) / d
    f2 = (n2 - 2 * f1 * d1 - f * d2) / d
    in_x = (-4 - f1 + 5 * f / x) / x**5
    in_x_twice = (20 / x - f2 + 10 * f1 / x - 30 * f / x**2) / x**5
    rate = 4 * x**3
    return (x - f) / x**5, in_x / rate, (in_x_twice - 3 * in_x / x) / rate**2
