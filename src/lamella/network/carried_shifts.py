"""Whole shifts carried from one surface to a near one, which may be cut in another way.

A correction of the coordinates with given shifts is a field on the surface, and its derivatives by u and v depend
neither on the cut nor on the signs of w. So the shifts to be put right on the near surface are those whose field is
most like the one on the first surface.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from lamella.network.isothermic import Isothermic
from lamella.network.whole_shifts import WholeShifts
from lamella.surface.points import Complexes, Floats

_MIDDLE = np.array([[1 / 3, 1 / 3]])
# of a whole number: what is farther from the next one is not told apart
UNSURE = 0.4


def carried(
    old: Isothermic, change: Complexes, new: Isothermic, shifts: Complexes, whole: WholeShifts
) -> Complexes | None:
    """The whole shifts of a near surface that stand for those of another one.

    Parameters
    ----------
    old : Isothermic
        On the first surface.
    change : (t,) complex
        What its shifts lack to the whole ones, in cells.
    new : Isothermic
        On the near surface.
    shifts : (s,) complex
        Its shifts, in cells.
    whole : WholeShifts
        Of the near surface.

    Returns
    -------
    (s,) complex, or None where they are not told apart.
    """
    if not len(whole.basis):
        return whole.offset
    there, _, fields = _derivatives(old)
    here, area, own = _derivatives(new)
    _, nearest = cKDTree(there).query(here)
    wanted = np.einsum("t,tek->ek", change, fields[:, nearest])
    weight = np.sqrt(area)[:, None]
    system = (np.einsum("dt,tek->dek", whole.basis, own) * weight).reshape(len(whole.basis), -1).T
    found = np.linalg.lstsq(system.astype(complex), (wanted * weight).ravel(), rcond=None)[0]
    place = whole.coordinates(shifts - whole.offset) + found
    rounded = np.round(place)
    if np.abs(np.concatenate([(place - rounded).real, (place - rounded).imag])).max() > UNSURE:
        return None
    return np.asarray(whole.offset + rounded @ whole.basis, np.complex128)


def _derivatives(iso: Isothermic) -> tuple[Floats, Floats, Floats]:
    """Middles (m, 3) and areas (m,) of the elements, and there the derivatives by (u, v) of `moves`, (t, m, 2)."""
    connectivity = iso.mesh.connectivity
    basis = connectivity.basis
    value, x, y = (basis.basis(_MIDDLE, *d)[0] for d in ((0, 0), (1, 0), (0, 1)))
    nodes = iso.mesh.nodes[connectivity.elements]
    a, b = np.tensordot(nodes, x, (1, 0)), np.tensordot(nodes, y, (1, 0))
    area = np.linalg.norm(np.cross(a, b), axis=1)
    w_x, w_y = iso.value @ x, iso.value @ y
    f_x, f_y = iso.moves @ x, iso.moves @ y
    turned = w_x.real * w_y.imag - w_x.imag * w_y.real
    # where the coordinates all but stand still there is nothing to compare
    usable = turned > 1e-6 * area * np.median(turned / area)
    turned = np.where(usable, turned, 1.0)
    by_u = (f_x * w_y.imag - f_y * w_x.imag) / turned
    by_v = (f_y * w_x.real - f_x * w_y.real) / turned
    fields = np.where(usable[:, None], np.stack([by_u, by_v], 2), 0.0)
    return np.tensordot(nodes, value, (1, 0)), np.where(usable, area, 0.0), fields
