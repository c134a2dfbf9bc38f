"""Sizes that a building cannot have: the unit is wrong, and that is the first thing to say."""

from __future__ import annotations

import math

from lamella.base.errors import InputError
from lamella.base.units import METRES

LARGEST, SMALLEST = 250.0, 0.1
"""m. The largest timber gridshells span well under 200 m; a lamella is as high as the smallest is wide."""

_UNITS = [{unit: METRES[unit] for unit in units} for units in (("mm", "cm", "m"), ("in", "ft"))]
_ROOMY, _USUAL = 12.0, (1.0, 150.0)
"""m; of the units in which a size is usual, metric ones first, the one in which it is nearest to this is named."""


def likely_unit(size: float, metres: float) -> tuple[str, float]:
    """The unit in which a size makes a building, and its size then, m.

    Parameters
    ----------
    size : float
        m, as it was read.
    metres : float
        Metres per unit as it was read.
    """
    numbers = size / metres
    found: list[tuple[str, float]] = []
    for units in _UNITS:
        sizes = [(unit, numbers * scale) for unit, scale in units.items() if abs(scale / metres - 1) > 1e-6]
        found = found or [one for one in sizes if _USUAL[0] <= one[1] <= _USUAL[1]]
    found = found or [(unit, numbers * scale) for unit, scale in _UNITS[0].items() if abs(scale / metres - 1) > 1e-6]
    return min(found, key=lambda one: (abs(math.log(one[1] / _ROOMY)), one[0]))


def is_doubtful(size: float) -> bool:
    """Whether a size, m, says that the unit is wrong."""
    return not SMALLEST <= size <= LARGEST


def refuse_doubtful(what: str, size: float, metres: float, unit: str, key: str) -> None:
    """Refuse a file of such a size whose unit the project does not say.

    Parameters
    ----------
    what : str
        What was read.
    size : float
        m.
    metres : float
        Metres per unit that it was read with.
    unit : str
        Its name.
    key : str
        Where the project would say the unit.

    Raises
    ------
    InputError
    """
    if not is_doubtful(size):
        return
    better, there = likely_unit(size, metres)
    raise InputError(
        f"{what} is {size:,.4g} m large if its unit is {unit}: no gridshell is (limits {SMALLEST:g} to {LARGEST:g} m); "
        f"in {better} it would be {there:.3g} m",
        f'write unit = "{better}"; if it is {unit} indeed, write unit = "{unit}"',
        key,
    )
