"""What something is coloured by: values, their unit, and the colours of a range."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from lamella.base.arrays import Floats, Integers

FAMILY_COLOURS = {"A": "#2374b8", "B": "#e07a2d"}
MAGNITUDE = ("#2b2f8f", "#6d2da6", "#b23a8e", "#e2616a", "#f7953f", "#f5d547")
"""Dark to bright at even steps of lightness, so that it also reads without hues."""
SIGNED = (FAMILY_COLOURS["B"], "#eab68d", "#d9dade", "#8fb2d2", FAMILY_COLOURS["A"])
"""The ends are the colours of the families: A twists with tg > 0, B with tg < 0."""


@dataclass(frozen=True)
class Quantity:
    """A quantity of the elements of a layer, with its colours.

    Attributes
    ----------
    key : str
        One word; layers with a quantity of the same key are coloured together.
    label, unit, remark : str
        For a legend; the remark may be empty, and follows the value of a constant.
    values : (n,)
        In `unit`; NaN where it is not known.
    low, high : float
        Values of the first and the last colour; equal for a constant.
    least, most : float
        Smallest and largest value, which may lie beyond the colours.
    stops : tuple of str
        Colours at equal steps from `low` to `high`, as #rrggbb.
    """

    key: str
    label: str
    unit: str
    remark: str
    values: Floats
    low: float
    high: float
    least: float
    most: float
    stops: tuple[str, ...]

    @property
    def is_constant(self) -> bool:
        """Whether there is but one colour."""
        return not self.low < self.high

    def of(self, some: Integers) -> Quantity:
        """The same of some elements, with the colours of all."""
        return replace(self, values=self.values[some])


def magnitude(
    key: str, label: str, unit: str, values: Floats, high: float | None = None, stops: tuple[str, ...] = MAGNITUDE
) -> Quantity:
    """A quantity of one sign, coloured from 0 to `high`, or to its largest value where that is not given."""
    least, most = extent(values)
    return Quantity(key, label, unit, "", values, 0.0, most if high is None else high, least, most, stops)


def signed(key: str, label: str, unit: str, values: Floats, stops: tuple[str, ...] = SIGNED) -> Quantity:
    """A quantity of both signs, whose middle colour is 0."""
    least, most = extent(values)
    limit = max(-least, most)
    return Quantity(key, label, unit, "", values, -limit, limit, least, most, stops)


def extent(values: Floats) -> tuple[float, float]:
    """Smallest and largest of those that are finite; 0 and 0 where none is."""
    known = values[np.isfinite(values)]
    return (float(known.min()), float(known.max())) if len(known) else (0.0, 0.0)
