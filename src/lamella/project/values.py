"""What the values of a project file have in common: tables, lengths, points, and how a value is refused."""

from __future__ import annotations

import math
from functools import partial
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field

from lamella.base.wording import one_line, shown

# m; a thousand times smaller and larger than any model or building, so that no figure can overflow
LEAST_LENGTH, MOST_LENGTH = 1e-6, 1e6
# in the unit of a table: survey coordinates in millimetres
MOST_COORDINATE = 1e11
# of one list; a curve drawn by hand has hundreds
MOST_POINTS = 10_000


class Refusal(ValueError):
    """A value refused by a check that knows the key in its table and the remedy."""

    def __init__(self, message: str, remedy: str, key: str = "") -> None:
        super().__init__(message)
        self.remedy, self.key = remedy, key


def number(description: str, unit: str, **limits: Any) -> Any:
    """A key that holds a number, with its unit for messages and documentation."""
    return Field(description=description, json_schema_extra={"unit": unit}, **limits)


def length(description: str, **limits: Any) -> Any:
    """A key that holds a length."""
    return number(description, "m", ge=LEAST_LENGTH, le=MOST_LENGTH, **limits)


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


def file_of(value: Any, suffixes: tuple[str, ...]) -> Any:
    """A file name with one of the endings that can be read."""
    if isinstance(value, str) and not value.lower().endswith(suffixes):
        raise Refusal(f"{shown(value)} is no file that can be read", f"name a file that ends in {', '.join(suffixes)}")
    if isinstance(value, str) and "\0" in value:
        raise Refusal(f"{shown(value)} is no file name", "take out the NUL character")
    return value


def file_name(suffixes: tuple[str, ...]) -> BeforeValidator:
    """The check of a key that names a file with one of these endings."""
    return BeforeValidator(lambda value: file_of(value, suffixes))


class Table(BaseModel):
    """A table of the project file: unknown keys and values of another type are errors."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)


Range = Annotated[tuple[float, float], Field(strict=False)]
Triple = Annotated[tuple[float, float, float], Field(strict=False)]
Point = Annotated[Triple, BeforeValidator(three_numbers)]
Shift = Annotated[Triple, BeforeValidator(partial(three_numbers, most=MOST_LENGTH))]
Direction = Annotated[Triple, BeforeValidator(direction)]
Points = Annotated[tuple[tuple[float, float, float], ...], Field(strict=False), BeforeValidator(read_points)]
Name = Annotated[str, AfterValidator(one_line)]
"""Text for people, which goes into files and messages: without control characters."""

Unit = Literal["m", "mm", "cm", "dm", "ft", "in"]
METRES: dict[str, float] = {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "dm": 0.1, "ft": 0.3048, "in": 0.0254}
"""Metres per unit, by the names a project file uses."""


def list_of_tables(value: Any, name: str, most: int) -> Any:
    """A list of tables, before its tables are looked at."""
    if isinstance(value, dict):
        raise Refusal("it is one table, has to be a list of tables", f"write [[{name}]] with double brackets")
    if not isinstance(value, list | tuple):
        raise Refusal(f"{shown(value)} is not a list of tables", f"write [[{name}]] and its keys below")
    if not value:
        raise Refusal("the list is empty", f"write [[{name}]] and its keys below")
    if len(value) > most:
        raise Refusal(f"{len(value):,} tables are too many (limit {most})", "leave some out")
    for k, table in enumerate(value):
        if not isinstance(table, dict | Table):
            raise Refusal(f"{shown(table)}, number {k} of the list, is not a table", f"write [[{name}]] for each")
    return value
