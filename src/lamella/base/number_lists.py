"""Lists of numbers and points as people write them in TOML and JSON, checked one by one."""

from __future__ import annotations

import math
from typing import Any

from lamella.base.limits import LEAST_LENGTH, MOST_COORDINATE, MOST_LENGTH, MOST_POINTS
from lamella.base.wording import shown


class Refusal(ValueError):
    """A value refused by a check that knows the key in its table and the remedy."""

    def __init__(self, message: str, remedy: str, key: str = "") -> None:
        super().__init__(message)
        self.remedy, self.key = remedy, key


def two_numbers(value: Any, names: str, of: str) -> tuple[float, float]:
    """Two finite numbers of a list; the list itself is what a message shows."""
    if not isinstance(value, list | tuple):
        raise Refusal(f"{shown(value)} is not {of}", f"write two numbers in m: {names}")
    if len(value) != 2:
        given = "1 number" if len(value) == 1 else f"{len(value)} values"
        raise Refusal(f"{shown(value)} has {given}, needs two", f"write two numbers in m: {names}")
    for x in value:
        if isinstance(x, bool) or not isinstance(x, int | float):
            raise Refusal(f"{shown(x)} is not a number", f"write two numbers in m: {names}")
        if not abs(x) <= MOST_LENGTH:
            limit = f"has to be a finite number up to {MOST_LENGTH:g} m"
            raise Refusal(f"{shown(x)} m is out of range: {limit}", "lengths are in metres")
    return float(value[0]), float(value[1])


def three_numbers(value: Any, called: str = "", most: float = MOST_COORDINATE) -> tuple[float, float, float]:
    """Three finite numbers of a list; a message calls the list by its name."""
    called = f"{called} " if called else ""
    if not isinstance(value, list | tuple):
        raise Refusal(f"{called or 'it '}is {shown(value)}, not three numbers", "write [x, y, z]")
    if len(value) != 3:
        count = "1 number" if len(value) == 1 else f"{len(value)} numbers"
        raise Refusal(f"{called or shown(value) + ' '}has {count}, needs three", "write [x, y, z]")
    for k, x in enumerate(value):
        at = f"{called.rstrip()}[{k}] = {shown(x)}" if called else f"{shown(x)}, number {k} of the list,"
        if isinstance(x, bool) or not isinstance(x, int | float):
            raise Refusal(f"{at} is not a number", "write [x, y, z], numbers without quotes")
        if not -math.inf < x < math.inf:
            raise Refusal(f"{at} is not a finite number", "write finite numbers")
        if abs(x) > most:
            raise Refusal(
                f"{at} m is out of range: has to be at most {most:g} m",
                "lengths are in metres",
            )
    return float(value[0]), float(value[1]), float(value[2])


def read_points(value: Any, most: float = MOST_COORDINATE) -> tuple[tuple[float, float, float], ...]:
    """A list of points, which may be in survey coordinates but not further apart than the largest length.

    Raises
    ------
    Refusal
        What is wrong, by index (from 0) and value.
    """
    if not isinstance(value, list | tuple):
        raise Refusal(f"{shown(value)} is not a list of points", "write [[x, y, z], [x, y, z], ...]")
    if len(value) > MOST_POINTS:
        raise Refusal(f"{len(value):,} points are too many (limit {MOST_POINTS:,})", "leave points out")
    points = tuple(three_numbers(point, f"points[{k}]", most) for k, point in enumerate(value))
    for k, point in enumerate(points):
        for c, (x, first) in enumerate(zip(point, points[0], strict=True)):
            if most < math.inf and abs(x - first) > MOST_LENGTH:
                raise Refusal(
                    f"points[{k}][{c}] = {shown(x)} m is out of range: has to be within {MOST_LENGTH:g} m of that of "
                    "the first point",
                    "lengths are in metres",
                )
    return points


def direction(value: Any) -> tuple[float, float, float]:
    """A vector that is not zero."""
    x, y, z = three_numbers(value)
    if not math.hypot(x, y, z) > LEAST_LENGTH:
        raise Refusal(f"{shown(value)} has no direction: its length is zero", "write a vector, such as [0, 0, 1]")
    return x, y, z
