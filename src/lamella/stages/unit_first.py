"""A net that is refused where the surface's size looks like a wrong unit: that comes first."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from lamella.base.errors import InputError
from lamella.base.plausible_size import is_doubtful, likely_unit
from lamella.base.vectors import diagonal
from lamella.surface.surface import Surface


@contextmanager
def unit_first(surface: Surface[Any]) -> Iterator[None]:
    """Say in a refusal of a net that the surface's size looks like a wrong unit, before what is refused."""
    try:
        yield
    except InputError as error:
        size = diagonal(surface.check_points().position)
        if not is_doubtful(size):
            raise
        better, there = likely_unit(size, 1.0)
        raise InputError(
            f"the surface is {size:,.4g} m large: was {better} meant for its lengths ({there:.3g} m)? As it is: "
            f"{error.message}",
            f'check the unit of the boundary or mesh first (unit = "{better}"); if it is right: {error.remedy}',
            error.where,
        ) from None
