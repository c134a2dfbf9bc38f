"""Closing a net by rounding: integer transitions by the smallest change of the isothermic coordinates."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from lamella.base.arrays import Booleans, Complexes, Floats
from lamella.base.drawing_origin import coordinates
from lamella.base.errors import InputError
from lamella.network.elements.integer_grid_map import IntegerGridMap
from lamella.network.elements.lattice import Lattice
from lamella.network.isothermic.integer_transitions import IntegerTransitions
from lamella.network.isothermic.isothermic import Isothermic
from lamella.network.isothermic.seamless_transitions import FoldedError, with_shifts
from lamella.network.pattern import Pattern

# the nearest whole numbers may put two umbilics on one node; then the next ones are tried
MOST_WAYS = 8
# a finer lattice that can be rounded is looked for in steps of this factor, so far
FINER_FACTOR, FINEST_FACTOR = 1.12, 5.0


def rounded_coordinates(
    iso: Isothermic, lattice: Lattice, pattern: Pattern, finer: Callable[[int], Lattice]
) -> tuple[Isothermic, Complexes]:
    """The coordinates with the nearest whole shifts that do not fold them, and these shifts (t,) in cells.

    Parameters
    ----------
    iso : Isothermic
    lattice : Lattice
    pattern : Pattern
    finer : callable
        The lattice of a number of cells, for the number that a refusal offers.

    Raises
    ------
    InputError
        Rounding folds the coordinates: it takes more cells than there are between two umbilics, or around a hole.
    """
    raw = IntegerGridMap.of(iso, lattice.origin, lattice.step, pattern)
    whole = IntegerTransitions.of(iso, iso.gram)
    try:
        return _nearest(iso, raw, whole, lattice)
    except FoldedError as folded:
        worst = float(largest_part(raw.shifts - whole.nearest(raw.shifts, 1)[0]).max())
        cells = _finer(iso, whole, lattice, pattern, finer)
        raise InputError(
            f"closing the net by rounding takes up to {worst:.2g} cells, and folds it near "
            f"({coordinates(folded.place)}) m",
            (
                f"no number of cells up to {int(FINEST_FACTOR * lattice.cells)} that was tried does: "
                if cells is None
                else f"write cells = {cells}, "
            )
            + 'change the boundary, or choose closing = "open"',
            "closing",
        ) from None


def _nearest(
    iso: Isothermic, raw: IntegerGridMap, whole: IntegerTransitions, lattice: Lattice
) -> tuple[Isothermic, Complexes]:
    """The coordinates with the nearest whole shifts, else the first failure."""
    folded: FoldedError | None = None
    for wanted in whole.nearest(raw.shifts, MOST_WAYS):
        try:
            parts = np.where(stubs(iso), np.nan, np.stack([wanted.real, wanted.imag]))
            return with_shifts(iso, *turned(raw, parts, lattice)), wanted
        except FoldedError as error:
            folded = folded or error
    assert folded
    raise folded


def _finer(
    iso: Isothermic, whole: IntegerTransitions, lattice: Lattice, pattern: Pattern, finer: Callable[[int], Lattice]
) -> int | None:
    """A larger number of cells whose lattice is rounded without a fold; None: none that was tried."""
    wanted, last = float(lattice.cells), lattice.cells
    while wanted < FINEST_FACTOR * lattice.cells:
        wanted = max(FINER_FACTOR * wanted, last + 1.0)
        try:
            other = finer(round(wanted))
            if other.cells > last:
                last = other.cells
                _nearest(iso, IntegerGridMap.of(iso, other.origin, other.step, pattern), whole, other)
                return last
        except FoldedError:
            continue
        except InputError:
            # too many nodes
            return None
    return None


def largest_part(shifts: Complexes) -> Floats:
    """Larger one of the real and the imaginary part, (t,)."""
    return np.maximum(np.abs(shifts.real), np.abs(shifts.imag))


def stubs(iso: Isothermic) -> Booleans:
    """Which pieces of the cut are no joints, (t,)."""
    return np.array([piece.stub for piece in iso.transitions], bool)


def turned(raw: IntegerGridMap, wanted: Floats, lattice: Lattice) -> tuple[Floats, complex]:
    """Both parts (2, t) of shifts of w, sqrt(m), turned by a factor as cells are, of shifts in cells; the factor."""
    turn, every = raw.pattern.factor, np.array(raw.pattern.every[::-1])
    hung = (raw.signs - 1) * lattice.origin * turn
    return wanted * (every[:, None] * lattice.step) - np.stack([hung.real, hung.imag]), turn
