"""Where the lattice of a net on a surface of elements hangs.

On the surface itself: in an umbilic, or in the fixed point that w turns about around a hole; else in the middle of the
surface's area in the plane of w, which is the same whatever the elements, moves with the surface, and lies on each of
its axes of symmetry. The nodes of a net are nodes of the net with twice the cells, but where w turns around a hole:
there the lattice lies half a cell off the fixed point, which may be on the rim.
Along a loop around a hole w is an angle and has no mean: there the lowest whole number of waves in which the surface's
area is uneven along the loop gives the place.
"""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Complexes, Floats
from lamella.network.isothermic.holonomy import fixed_point_factors, holonomies
from lamella.network.isothermic.isothermic import Isothermic
from lamella.network.pattern import Pattern
from lamella.surface.element.edge_basis import edge_values
from lamella.surface.element.geometry import normal_and_area, tangents
from lamella.surface.element.quadrature import triangle_rule
from lamella.surface.element.rim import nearest_on_edges

# cells; where w turns around what is no umbilic of the net: no lamella ends there
MIDDLE = 0.5 + 0.5j
# of the longest principal line: a shorter period around a hole is none to count cells on
LEAST_PERIOD = 1e-2
# waves around a hole in which the area may be uneven, and how uneven it is at least: far above the elements' errors
AREA_WAVES_MAX, AREA_UNEVEN = 8, 0.03
# of a period: places this near before the rim's start are behind it
AT_START = 1e-3


def lattice_origin(iso: Isothermic, step: float, pattern: Pattern) -> complex:
    """w of a lattice point, sqrt(m): the first odd umbilic, or half a cell from where w turns around a hole."""
    factors = fixed_point_factors(iso)
    if factors.any():
        place = complex(factors @ np.array([piece.shift for piece in iso.transitions]))
        return place if len(iso.odd) else place - complex(pattern.isothermic(np.array([MIDDLE]), step)[0])
    # nothing turns w: an umbilic of even order may be a node
    inside = iso.mesh.umbilics[iso.mesh.umbilics >= 0]
    if len(inside):
        return complex(iso.value[:, :3][iso.mesh.connectivity.faces == inside[0]].mean())
    return _middle_of_area(iso)


def _middle_of_area(iso: Isothermic) -> complex:
    """Mean of w over the surface, sqrt(m); along the loop around a hole the middle of its waves."""
    w, area = _spread(iso)
    period = _period(iso)
    if not period:
        return complex((area * w).sum() / area.sum())
    # in periods along the loop, and across: w that goes over a cut changes the one by 1, the other not
    z = w / period
    along = _along_loop(z.real, area, float((_at_start(iso) / period).real))
    return period * complex(along, float((area * z.imag).sum() / area.sum()))


def _along_loop(place: Floats, area: Floats, start: float) -> float:
    """Where areas (n,) at places (n,) in periods around a hole are thickest, in the lowest wave that they have.

    Of the crests of several waves it is the first one from the rim's start on; where the area is alike all around, as
    on surfaces of revolution, that start itself.
    """
    for waves in range(1, AREA_WAVES_MAX + 1):
        share = complex((area * np.exp(2j * np.pi * waves * place)).sum() / area.sum())
        if abs(share) > AREA_UNEVEN:
            crest = float(np.angle(share)) / (2 * np.pi * waves)
            behind = (crest - start + AT_START) % (1 / waves) - AT_START
            return start + behind
    return start


def _spread(iso: Isothermic) -> tuple[Complexes, Floats]:
    """w at the elements' integration points, sqrt(m), and the area each stands for, m^2, (n,) each."""
    connectivity = iso.mesh.connectivity
    basis = connectivity.basis
    points, weights = triangle_rule(2 * basis.order)
    slopes = basis.basis(points, 1, 0), basis.basis(points, 0, 1)
    _, area = normal_and_area(*tangents(*slopes, iso.mesh.nodes[connectivity.elements]))
    return (iso.value @ basis.basis(points).T).ravel(), np.asarray((area * weights).ravel())


def _period(iso: Isothermic) -> complex:
    """What w gains around the first hole on which it gains much, sqrt(m); 0: there is none."""
    for around in holonomies(iso):
        if around.sign == 1 and abs(around.shift) > LEAST_PERIOD * iso.longest:
            return around.shift
    return 0j


def _at_start(iso: Isothermic) -> complex:
    """w at the start of the outer rim, sqrt(m)."""
    mesh = iso.mesh
    connectivity = mesh.connectivity
    outer = np.flatnonzero(mesh.loop[connectivity.rim_nodes[:, 0]] == 0)
    edge, share = nearest_on_edges(mesh.nodes[connectivity.rim_nodes[outer]], mesh.rim_starts[0])
    element, local = connectivity.rim_elements[outer[edge]], connectivity.rim_edges[outer[edge]]
    along = edge_values(connectivity.basis.order, np.array([share]))[0]
    return complex(along @ iso.value[element, connectivity.basis.edge_nodes[local]])
