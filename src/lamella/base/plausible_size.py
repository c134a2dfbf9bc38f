"""Sizes that a building cannot have: the unit is wrong, and that is the first thing to say."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Protocol

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError

LARGEST, SMALLEST = 250.0, 0.1
"""m. The largest timber gridshells span well under 200 m; a lamella is as high as the smallest is wide."""

_UNITS = {"mm": 1e-3, "cm": 1e-2, "m": 1.0}, {"in": 0.0254, "ft": 0.3048}
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


class HasPosition(Protocol):
    """Points (n, 3), m."""

    @property
    def position(self) -> Floats: ...


class HasCheckPoints(Protocol):
    """A surface that gives points spread all over it."""

    def check_points(self) -> HasPosition: ...


@contextmanager
def unit_first(surface: HasCheckPoints) -> Iterator[None]:
    """Say in a refusal of a net that the surface's size looks like a wrong unit, before what is refused."""
    try:
        yield
    except InputError as error:
        size = float(np.linalg.norm(np.ptp(surface.check_points().position, axis=0)))
        if not is_doubtful(size):
            raise
        better, there = likely_unit(size, 1.0)
        raise InputError(
            f"the surface is {size:,.4g} m large: was {better} meant for its lengths ({there:.3g} m)? As it is: "
            f"{error.message}",
            f'check the unit of the boundary or mesh first (unit = "{better}"); if it is right: {error.remedy}',
            error.where,
        ) from None
