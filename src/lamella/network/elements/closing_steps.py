"""Which spacings l0 of the lattice let a net close, with its umbilics on nodes.

A net closes where certain lengths of the isothermic plane, periods around holes and distances between umbilics, are
whole numbers of l0 (`lamella.network.isothermic.integer_transitions`). One spacing makes one of them whole; all are
only where the surface is symmetric, or where its boundary was adjusted.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Complexes, Floats
from lamella.network.isothermic.holonomy import fixed_point_factors
from lamella.network.isothermic.integer_transitions import IntegerTransitions
from lamella.network.isothermic.isothermic import Isothermic
from lamella.network.pattern import Pattern

# of a cell: a shift nearer to whole numbers closes the net (docs/files.md)
CLOSES = 1e-3


@dataclass(frozen=True)
class ClosingLengths:
    """What has to be whole.

    Attributes
    ----------
    values : (k,) complex
        sqrt(m): both parts are whole multiples of l0 where the net closes, signs of no meaning.
    """

    values: Complexes

    @classmethod
    def of(cls, iso: Isothermic, pattern: Pattern) -> ClosingLengths:
        """Of a surface's coordinates, in kept cells of the pattern."""
        signs = np.array([piece.sign for piece in iso.transitions], np.int64)
        shifts = np.array([piece.shift for piece in iso.transitions], complex)
        place = complex(fixed_point_factors(iso) @ shifts)
        # shortest sums of what the pieces of the cut ask for: alike for all cuts
        needed = IntegerTransitions.of(iso, iso.dirichlet).coordinates(pattern.cells(shifts + (signs - 1) * place, 1.0))
        apart = pattern.cells(_even(iso) - place, 1.0)
        if len(apart) and not len(iso.odd):
            apart = apart[1:] - apart[0]
        return cls(np.concatenate([needed, apart]))

    def residual(self, step: float) -> float:
        """The largest distance from a whole number at l0 = step (sqrt(m)), cells: 0 to 0.5.

        What rounding would put into one place, two umbilics or a hole's two sides, misses by 0.5.
        """
        cells = self.values / step
        whole = np.rint(cells)
        off = np.maximum(np.abs((cells - whole).real), np.abs((cells - whole).imag))
        return float(np.where((whole == 0) & (off > CLOSES), 0.5, off).max(initial=0.0))

    def steps(self, least: float, most: float) -> Floats:
        """Spacings between two, sqrt(m), at which one of the lengths is whole."""
        lengths = np.abs(np.concatenate([self.values.real, self.values.imag])).tolist()
        found = [value / np.arange(max(np.ceil(value / most), 1), np.floor(value / least) + 1) for value in lengths]
        return np.unique(np.concatenate([np.zeros(0), *found]))


def _even(iso: Isothermic) -> Complexes:
    """w of the umbilics of even order off the rim, sqrt(m), each on the sheet of one of its elements."""
    mesh = iso.mesh
    inside = mesh.umbilics[mesh.umbilics >= 0]
    vertices = inside[~np.isin(inside, iso.odd)]
    corner, faces = iso.value[:, :3], mesh.connectivity.faces
    return np.array([corner[faces == vertex][0] for vertex in vertices.tolist()], complex)
