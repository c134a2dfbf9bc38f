"""Symmetric quadrature rules on the triangle (0, 0), (1, 0), (0, 1).

Dunavant, High degree efficient symmetrical Gaussian quadrature rules for the triangle, Int. J. Numer. Meth. Eng. 21
(1985), 1129-1148, doi:10.1002/nme.1620210612. The test integrates every monomial.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from lamella.base.arrays import Floats

# weight (of area 1), barycentric coordinates a, b of one point of the orbit; c = 1 - a - b
_ORBITS = {
    4: (
        (0.223381589678011, 0.445948490915965, 0.445948490915965),
        (0.109951743655322, 0.091576213509771, 0.091576213509771),
    ),
    6: (
        (0.116786275726379, 0.249286745170910, 0.249286745170910),
        (0.050844906370207, 0.063089014491502, 0.063089014491502),
        (0.082851075618374, 0.053145049844817, 0.310352451033784),
    ),
    8: (
        (0.144315607677787, 1 / 3, 1 / 3),
        (0.095091634267285, 0.459292588292723, 0.459292588292723),
        (0.103217370534718, 0.170569307751760, 0.170569307751760),
        (0.032458497623198, 0.050547228317031, 0.050547228317031),
        (0.027230314174435, 0.008394777409958, 0.263112829634638),
    ),
    10: (
        (0.090817990382754, 1 / 3, 1 / 3),
        (0.036725957756467, 0.485577633383657, 0.485577633383657),
        (0.045321059435528, 0.109481575485037, 0.109481575485037),
        (0.072757916845420, 0.141707219414880, 0.307939838764121),
        (0.028327242531057, 0.025003534762686, 0.246672560639903),
        (0.009421666963733, 0.009540815400299, 0.066803251012200),
    ),
}


@lru_cache
def triangle_rule(degree: int) -> tuple[Floats, Floats]:
    """Points (q, 2) and weights (q,), which sum to 1/2, of a rule exact for polynomials of `degree` (4, 6, 8 or 10)."""
    points, weights = [], []
    for weight, a, b in _ORBITS[degree]:
        c = 1 - a - b
        orbit = {(a, b), (b, a), (a, c), (c, a), (b, c), (c, b)} if a != b else {(a, b), (a, c), (c, a)}
        if abs(a - 1 / 3) < 1e-12:
            orbit = {(a, b)}
        points += sorted(orbit)
        weights += [weight / 2] * len(orbit)
    return np.array(points), np.array(weights)
