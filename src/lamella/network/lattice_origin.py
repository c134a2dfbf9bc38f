"""Where the lattice of a net on a surface of elements hangs."""

from __future__ import annotations

import numpy as np

from lamella.network.holonomy import fixed_point_factors
from lamella.network.isothermic import Isothermic
from lamella.network.pattern import Pattern
from lamella.surface.element.umbilics import ASKEW
from lamella.surface.vectors import crosses, lengths

# cells; where w turns around what is no umbilic of the net: no lamella ends there
MIDDLE = 0.5 + 0.5j


def lattice_origin(iso: Isothermic, step: float, pattern: Pattern) -> complex:
    """w of a lattice point, sqrt(m): the first odd umbilic, or half a cell from where w turns around a hole."""
    factors = fixed_point_factors(iso)
    if factors.any():
        place = complex(factors @ np.array([piece.shift for piece in iso.transitions]))
        return place if len(iso.odd) else place - complex(pattern.isothermic(np.array([MIDDLE]), step)[0])
    # nothing turns w: an umbilic of even order may be a node
    corner = iso.value[:, :3]
    faces = iso.mesh.connectivity.faces
    inside = iso.mesh.umbilics[iso.mesh.umbilics >= 0]
    if len(inside):
        return complex(corner[faces == inside[0]].mean())
    # next to the mean over the surface, so that the net does not hang on its elements; rows of nodes follow each other
    # by half of l0, and both ends of the longest principal line of a symmetric surface are midway between two
    one, two, three = iso.mesh.nodes[faces].transpose(1, 0, 2)
    area = lengths(crosses(two - one, three - one))
    w, place = corner.mean(1), (one + two + three) / 3 @ ASKEW
    middle = complex(area @ w / area.sum())
    along = 1 if np.ptp(corner.real) > np.ptp(corner.imag) else 1j
    # -w serves as well as w: which of the two it is must not hang on the elements either
    rises = ((w - middle) / along).real @ (area * (place - area @ place / area.sum())) >= 0
    return middle + step / 4 * along * (1 if rises else -1)
