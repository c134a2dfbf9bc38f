"""What the values of a project file have in common: tables, lengths, points, and how a value is refused."""

from __future__ import annotations

from functools import partial
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field

from lamella.base.limits import LEAST_LENGTH, MOST_LENGTH
from lamella.base.number_lists import Refusal, direction, read_points, three_numbers
from lamella.base.wording import one_line, shown


def number(description: str, unit: str, **limits: Any) -> Any:
    """A key that holds a number, with its unit for messages and documentation."""
    return Field(description=description, json_schema_extra={"unit": unit}, **limits)


def length(description: str, **limits: Any) -> Any:
    """A key that holds a length."""
    return number(description, "m", ge=LEAST_LENGTH, le=MOST_LENGTH, **limits)


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
"""Those of `lamella.base.units.PROJECT_UNITS`."""


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
