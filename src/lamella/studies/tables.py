"""The file of a study: a project, what varies in it and how, what is wanted, and what has to hold."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, ValidationError, field_validator, model_validator

from lamella.base.byte_order import unmarked
from lamella.base.errors import InputError
from lamella.base.limits import MOST_LENGTH, MOST_WAVES
from lamella.base.number_lists import Refusal
from lamella.base.wording import cut, shown
from lamella.project.messages import explain, reported_once
from lamella.project.values import Name, Range, Table, file_name, list_of_tables, number

STUDY_BYTES_MAX = 1_000_000
VARIABLES_MAX, GOALS_MAX, VALUES_MAX = 64, 20, 1000
VARIANTS_MAX = 100_000
SOBOL_DIMENSIONS_MAX = 64

Number = float | int
Freedom = Literal["move", "scale", "tilt", "wave"]
"""Of a loop: shift, size and turn about its middle, a wave along it."""


def _checked_values(value: Any) -> Any:
    """A list of numbers, words or flags."""
    if not isinstance(value, list | tuple) or not value or len(value) > VALUES_MAX:
        raise Refusal(
            f"{shown(value)} is not a list of 1 to {VALUES_MAX} values", "write values = [0.06, 0.08], or a range"
        )
    odd = next((one for one in value if not isinstance(one, str | bool | int | float)), None)
    if odd is not None or any(isinstance(one, float) and not math.isfinite(one) for one in value):
        raise Refusal(f"{shown(value)} holds what is no number, text or true or false", "write plain values")
    return value


def _checked_range(value: Any) -> Any:
    """Two numbers."""
    fine = isinstance(value, list | tuple) and len(value) == 2
    numbers = fine and all(isinstance(one, int | float) and not isinstance(one, bool) for one in value)
    if not numbers or not all(map(math.isfinite, value)):
        raise Refusal(f"{shown(value)} is not two numbers", "write range = [lowest, highest]")
    return value


Values = Annotated[
    tuple[Number | str | bool, ...],
    Field(strict=False, json_schema_extra={"minItems": 1}),
    BeforeValidator(_checked_values),
]
TwoNumbers = Annotated[Range, BeforeValidator(_checked_range)]


class VariableTable(Table):
    """A number of the project that varies, by its path, or a freedom of a boundary loop."""

    key: str | None = Field(
        default=None,
        max_length=300,
        description="Path into the project, lists by number from 0 or by the name of a table in them.",
        examples=["surface.boundary.1.circle.radius"],
    )
    loop: str | Annotated[tuple[str, ...], Field(strict=False)] | None = Field(
        default=None,
        description="Name of a boundary loop instead of a key; several change alike.",
        examples=["oculus"],
    )
    freedom: Freedom | None = Field(
        default=None,
        description='What changes of the loop: "move" (m), "scale" (factor), "tilt" (degrees, about the axis through '
        'its middle) or "wave" (m).',
    )
    axis: Literal["x", "y", "z"] = Field(
        default="z", description="Direction of a move or of a wave's shift, or axis of a tilt."
    )
    wave: int = number("Number of waves along the loop.", "", ge=1, le=MOST_WAVES, default=1)
    phase: Literal["cos", "sin"] = Field(
        default="cos", description="Of a wave: cos has its crest at the loop's first point, sin a quarter wave later."
    )
    name: Name = Field(
        default="", max_length=100, description="Column of the table; the key, or loop and freedom, when not given."
    )
    range: TwoNumbers | None = Field(default=None, description="Lowest and highest value.", examples=[[1.0, 1.6]])
    whole: bool = Field(default=False, description="Whole numbers of the range only: of cells, say.")
    values: Values | None = Field(
        default=None,
        description="The values themselves, instead of a range.",
        examples=[["1.4301", "S355"]],
    )

    @model_validator(mode="after")
    def _possible(self) -> VariableTable:
        if (self.key is None) == (self.loop is None):
            given = "key and loop are both given" if self.key else "a variable needs a key or a loop"
            raise Refusal(given, 'write key = "lamella.height", or loop = the name of one and freedom = "scale"')
        if (self.loop is None) != (self.freedom is None):
            missing = 'freedom = "move"' if self.freedom is None else "loop = the name of one"
            raise Refusal("loop and freedom go together", f"add {missing}")
        if (self.range is None) == (self.values is None):
            given = "range and values are both given" if self.range else "a variable needs a range or values"
            raise Refusal(given, "write range = [low, high], or values = [...]")
        if self.range is not None and not self.range[0] < self.range[1]:
            low, high = self.range
            raise Refusal(f"range = [{low:g}, {high:g}] is empty", "write the lower value first", "range")
        if self.values is not None and len(set(map(repr, self.values))) < len(self.values):
            raise Refusal("a value is there twice", "write each value once", "values")
        numbers = [value for value in self.values or self.range or () if not isinstance(value, str | bool)]
        if self.freedom is not None and self.values is not None and len(numbers) < len(self.values):
            raise Refusal("a freedom of a loop takes numbers", "write numbers", "values")
        if self.whole and self.range is not None and math.floor(self.range[1]) < math.ceil(self.range[0]):
            raise Refusal("no whole number is in the range", "widen it", "range")
        if self.freedom == "scale" and min(numbers) <= 0:
            raise Refusal("a scale of 0 or less leaves no loop", "write factors above 0")
        return self

    @property
    def column(self) -> str:
        """Name in the table."""
        if self.name:
            return self.name
        if self.key is not None:
            return self.key
        loops = "+".join((self.loop,) if isinstance(self.loop, str) else self.loop or ())
        detail = {
            "move": f".{self.axis}",
            "scale": "",
            "tilt": f".{self.axis}",
            "wave": f".{self.wave}.{self.phase}.{self.axis}",
        }
        return f"{loops}.{self.freedom}{detail[self.freedom or 'scale']}"


class SamplerTable(Table):
    """Which variants there are."""

    kind: Literal["grid", "latin-hypercube", "sobol"] = Field(
        default="grid",
        description='"grid": all combinations; "latin-hypercube" and "sobol": `count` variants that fill the space.',
    )
    count: int = number(
        "Grid: values of each range; else the number of variants (sobol: best a power of 2).",
        "",
        ge=1,
        le=VARIANTS_MAX,
        default=5,
    )
    seed: int = number(
        "Of latin-hypercube and sobol: the same seed gives the same variants.", "", ge=0, le=2**31, default=0
    )


class ObjectiveTable(Table):
    """A figure that is to be small or large."""

    figure: str = Field(
        max_length=300,
        description='Key in summary.json, "lamellas.utilisation_max" for one; lists by number or by the name of an '
        'entry; or "change": how far the variables are from where they begin, in parts of their ranges.',
        examples=["lamellas.utilisation_max"],
    )
    goal: Literal["min", "max"] = Field(default="min", description="Whether small or large values are wanted.")


class ConstraintTable(Table):
    """What a figure has to keep to."""

    figure: str = Field(max_length=300, description="As of an objective.", examples=["lamellas.utilisation_max"])
    at_most: float | None = number("Highest value.", "", default=None)
    at_least: float | None = number("Lowest value.", "", default=None)

    @model_validator(mode="after")
    def _possible(self) -> ConstraintTable:
        if self.at_most is None and self.at_least is None:
            raise Refusal("a constraint needs at_most or at_least", "write at_most = 1.0")
        if self.at_most is not None and self.at_least is not None and self.at_least > self.at_most:
            raise Refusal(
                f"at_least = {self.at_least:g} is above at_most = {self.at_most:g}", "exchange them", "at_least"
            )
        return self


class HeadroomTable(Table):
    """A place under the surface: its clear height is the figure headroom.NAME."""

    name: Name = Field(min_length=1, max_length=100, description="Of the figure.", examples=["door"])
    at: Annotated[tuple[float, float], Field(strict=False)] = number("Place [x, y].", "m", examples=[[4.0, 0.0]])
    ground: float = number(
        "Height of the ground there.", "m", ge=-MOST_LENGTH, le=MOST_LENGTH, default=0.0, examples=[0.0]
    )


class OptimiseTable(Table):
    """Search for the best variant instead of computing those of a sampler."""

    method: Literal["gradient", "evolution"] | None = Field(
        default=None,
        description='"gradient": sequential quadratic programming (SLSQP) on one objective, with finite differences; '
        '"evolution": a genetic algorithm (NSGA-II) for several objectives, for values that are no range, or for '
        "figures that jump. Gradient where it can be when not given.",
    )
    evaluations: int = number("Variants computed, at most.", "", ge=1, le=VARIANTS_MAX, default=200)
    population: int = number("Of the genetic algorithm: variants of a generation.", "", ge=4, le=10_000, default=24)
    seed: int = number("Of the genetic algorithm.", "", ge=0, le=2**31, default=0)
    tolerance: float = number(
        "Of the gradient method: it ends when the objective changes by less than this share.",
        "",
        gt=0,
        le=0.1,
        default=1e-8,
    )
    step: float = number(
        "Step of the finite differences, as a share of a variable's range.", "", gt=0, le=0.1, default=1e-3
    )
    start: Annotated[tuple[float, ...], Field(strict=False)] | None = Field(
        default=None,
        description="Values the gradient method begins with; those of the project, or the middle of a range, when not "
        "given.",
    )


class StudyTable(Table):
    """A study: what varies, what is computed and what is wanted."""

    project: Annotated[str, file_name((".toml",))] = Field(
        max_length=1000, description="Project file, relative to the study's.", examples=["oculus.toml"]
    )
    until: str | None = Field(
        default=None,
        max_length=40,
        description="Last stage of each variant; as far as the project goes when not given.",
        examples=["lamellas"],
    )
    variable: Annotated[tuple[VariableTable, ...], Field(strict=False)] = Field(
        description="Tables [[variable]].", json_schema_extra={"minItems": 1, "maxItems": VARIABLES_MAX}
    )
    sampler: SamplerTable = Field(default=SamplerTable(), description="Which variants there are.")
    objective: Annotated[tuple[ObjectiveTable, ...], Field(strict=False)] = Field(
        default=(), description="Tables [[objective]]."
    )
    constraint: Annotated[tuple[ConstraintTable, ...], Field(strict=False)] = Field(
        default=(), description="Tables [[constraint]]."
    )
    headroom: Annotated[tuple[HeadroomTable, ...], Field(strict=False)] = Field(
        default=(), description="Tables [[headroom]]."
    )
    optimise: OptimiseTable | None = Field(default=None, description="Search instead of sampling.")

    @field_validator("variable", "objective", "constraint", "headroom", mode="before")
    @classmethod
    def _lists(cls, value: Any, info: Any) -> Any:
        if value in ((), []) and info.field_name != "variable":
            return value
        return list_of_tables(value, info.field_name, VARIABLES_MAX if info.field_name == "variable" else GOALS_MAX)

    @model_validator(mode="after")
    def _possible(self) -> StudyTable:
        names = [variable.column for variable in self.variable]
        twice = next((name for name in names if names.count(name) > 1), None)
        if twice is not None:
            raise Refusal(f"two variables are named {twice!r}", "give one of them another name", "variable")
        if self.optimise is not None:
            _check_optimise(self, self.optimise)
        elif self.sampler.kind == "grid":
            total = 1
            for variable in self.variable:
                total *= len(variable.values) if variable.values is not None else self.sampler.count
            if total > VARIANTS_MAX:
                raise Refusal(
                    f"a grid of {total:,} variants is too large (limit {VARIANTS_MAX:,})",
                    'take fewer values, or kind = "sobol"',
                    "sampler.count",
                )
        return self


STUDY_TABLES: dict[str, type[Table]] = {
    "[[variable]]": VariableTable,
    "[sampler]": SamplerTable,
    "[[objective]]": ObjectiveTable,
    "[[constraint]]": ConstraintTable,
    "[[headroom]]": HeadroomTable,
    "[optimise]": OptimiseTable,
}
"""Tables of the file by how they are written."""


def _explained(error: Any, values: dict[str, Any]) -> tuple[str, str, str]:
    key, message, remedy = explain(error, values, StudyTable)
    if error["type"] == "missing" and key == "variable":
        return (
            key,
            "missing: nothing varies",
            'add a table [[variable]] with key = "lamella.height" and range = [0.06, 0.1]',
        )
    return key, message, remedy


def study_schema() -> dict[str, Any]:
    """JSON schema of the file of a study."""
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **StudyTable.model_json_schema()}


def _check_optimise(study: StudyTable, table: OptimiseTable) -> None:
    if not study.objective:
        remedy = 'write a table [[objective]] with figure = "lamellas.utilisation_max", say'
        raise Refusal("there is nothing to search for", remedy, "objective")
    values = [variable.column for variable in study.variable if variable.values is not None]
    if table.method == "gradient" and (len(study.objective) > 1 or values):
        why = f"{values[0]!r} has values and no range" if values else f"{len(study.objective)} objectives are given"
        text = f'method = "gradient" needs one objective and ranges: {why}'
        raise Refusal(text, 'write method = "evolution"', "optimise.method")
    if table.start is not None:
        if len(table.start) != len(study.variable):
            raise Refusal(
                f"{len(table.start)} values for {len(study.variable)} variables", "write one each", "optimise.start"
            )
        for value, variable in zip(table.start, study.variable, strict=True):
            low, high = variable.range or (-float("inf"), float("inf"))
            if not low <= value <= high:
                raise Refusal(
                    f"{value:g} of {variable.column!r} is not in its range [{low:g}, {high:g}]",
                    "begin inside the ranges",
                    "optimise.start",
                )


def read_study(path: str | Path) -> StudyTable:
    """Read and check the file of a study.

    Parameters
    ----------
    path : str or Path

    Raises
    ------
    InputError
        Whatever is wrong with it, with file and key.
    """
    path = Path(path)
    remedy = "see `lamella study --help` for a study that is"
    try:
        with path.open("rb") as file:
            raw = file.read(STUDY_BYTES_MAX + 1)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"{path} cannot be read: {reason}", "check the path") from None
    if len(raw) > STUDY_BYTES_MAX:
        raise InputError(f"more than {STUDY_BYTES_MAX / 1e6:g} MB long: no study is", remedy, str(path))
    try:
        values = tomllib.loads(unmarked(raw).decode("utf-8"))
    except RecursionError:
        raise InputError("not valid TOML: nested too deep", remedy, str(path)) from None
    except ValueError as error:
        raise InputError(f"not valid TOML: {cut(str(error), 200)}", remedy, str(path)) from None
    return parse_study(values, source=str(path))


def parse_study(values: dict[str, Any], *, source: str = "") -> StudyTable:
    """Check the values of a study given as nested dictionaries.

    Raises
    ------
    InputError
    """
    try:
        return StudyTable.model_validate(values)
    except ValidationError as failure:
        found = failure.errors(include_url=False)[:6]
        errors = reported_once([_explained(error, values) for error in found])
        reported = [InputError(m, r, f"{source}: {key}" if source else key) for key, m, r in errors]
        if len(reported) == 1:
            raise reported[0] from None
        raise InputError("\n".join(str(error) for error in reported)) from None
