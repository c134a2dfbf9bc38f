"""Integer transitions matched from one surface to a near one, which may be cut in another way.

A correction of the coordinates with given shifts is a field on the surface, and its derivatives by u and v depend
neither on the cut nor on the signs of w. So the shifts to be put right on the near surface are those whose field is
most like the one on the first surface.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from lamella.base.arrays import Complexes, Floats
from lamella.network.isothermic.integer_transitions import IntegerTransitions
from lamella.network.isothermic.isothermic import Isothermic

_MIDDLE = np.array([[1 / 3, 1 / 3]])
# of a whole number: what is farther from the next one is not told apart
UNSURE = 0.4


class TransitionMatcher:
    """Carries changes of shifts from one surface to a near one.

    Parameters
    ----------
    old : Isothermic
        On the first surface.
    new : Isothermic
        On the near surface.
    whole : IntegerTransitions
        Of the near surface.
    """

    def __init__(self, old: Isothermic, new: Isothermic, whole: IntegerTransitions) -> None:
        self.whole = whole
        there, _, fields = _derivatives(old)
        here, area, own = _derivatives(new)
        _, nearest = cKDTree(there).query(here)
        self._fields, self._weight = fields[:, nearest], np.sqrt(area)[:, None]
        count = len(whole.basis)
        self._system = (np.einsum("dt,tek->dek", whole.basis, own) * self._weight).reshape(count, -1).T

    def coordinates(self, changes: Complexes) -> Complexes:
        """Changes of the first surface's shifts (t, c) in the lattice of the near surface's, (d, c)."""
        if not len(self.whole.basis):
            return np.zeros((0, changes.shape[1]), complex)
        wanted = np.tensordot(changes.T, self._fields, 1) * self._weight
        wanted = wanted.reshape(len(wanted), -1).T
        found = np.linalg.lstsq(self._system, np.hstack([wanted.real, wanted.imag]), rcond=None)[0]
        one, other = np.split(found, 2, 1)
        return np.asarray(one + 1j * other, np.complex128)

    def match(self, change: Complexes, shifts: Complexes) -> Complexes | None:
        """The whole shifts of the near surface that stand for those of the first one.

        Parameters
        ----------
        change : (t,) complex
            What the first surface's shifts lack to the whole ones, in cells.
        shifts : (s,) complex
            Those of the near surface, in cells.

        Returns
        -------
        (s,) complex, or None where they are not told apart.
        """
        if not len(self.whole.basis):
            return self.whole.offset
        place = self.whole.coordinates(shifts - self.whole.offset) + self.coordinates(change[:, None])[:, 0]
        rounded = np.round(place)
        if np.abs(np.concatenate([(place - rounded).real, (place - rounded).imag])).max() > UNSURE:
            return None
        return np.asarray(self.whole.offset + rounded @ self.whole.basis, np.complex128)


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
