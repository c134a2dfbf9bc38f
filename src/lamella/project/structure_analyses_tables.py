"""Tables below [structure]: what is looked at besides the cases, and the order in which the structure is put up."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any, Literal, get_args

from pydantic import BeforeValidator, Field, field_validator, model_validator

from lamella.base.limits import LEAST_STIFFNESS, MOST_STIFFNESS
from lamella.base.number_lists import Refusal
from lamella.base.wording import shown
from lamella.project.values import Direction, Name, Point, Table, length, list_of_tables, number

ConstructionStage = Literal["bent", "joints locked", "cables on", "props away", "loads on"]
STAGES: tuple[str, ...] = get_args(ConstructionStage)

MOST_VALUES = 20
"""Of one quantity that is varied."""

MOST_VARIANTS = 50


Part = Literal["cables", "edge beams"]


def _listed(value: Any) -> Any:
    if value is not None and not isinstance(value, list | tuple):
        raise Refusal(f"{shown(value)} is not a list", "write names in brackets, with commas between them")
    return value


CaseNames = Annotated[Annotated[tuple[Name, ...], Field(strict=False)] | None, BeforeValidator(_listed)]


def _cases() -> Any:
    return Field(
        default=None,
        description="Loads and combinations by name; all combinations where there are any, else all loads.",
        examples=[["snow"]],
    )


class FailureTable(Table):
    """Load factor to failure: cases grow in proportion, past limit points, until the structure gives way."""

    cases: CaseNames = _cases()
    factor_max: float = number("Multiple of a case up to which it is followed.", "", gt=0, le=1e4, default=20.0)


class DisplacementTable(Table):
    """A node is moved as far as is asked for, whatever multiple of a case that takes, past limit points too."""

    case: Name = Field(description="Load or combination by name.", examples=["snow"])
    near: Point = number("The node nearest to this point [x, y, z].", "m", examples=[[0.0, 0.0, 5.0]])
    direction: Direction = number("In which it is moved.", "", default=(0.0, 0.0, -1.0), examples=[[0.0, 0.0, -1.0]])
    by: float = length("How far.", examples=[0.1])
    steps: int = number("Steps to begin with.", "", ge=1, le=1000, default=20)


def _stiffness_list(description: str, unit: str, default: tuple[float, ...]) -> Any:
    return Field(
        default=default,
        description=description,
        json_schema_extra={"unit": unit, "maxItems": MOST_VALUES},
        examples=[list(default)],
    )


class SensitivityTable(Table):
    """Deflection and first buckling factor of the cases with other joints, supports and thickness, as one table."""

    joints: Annotated[tuple[float, ...], Field(strict=False)] = _stiffness_list(
        "Stiffness of all joints about the node's normal.", "N m/rad", (10.0, 100.0, 1000.0)
    )
    supports: Annotated[tuple[float, ...], Field(strict=False)] = _stiffness_list(
        "Springs in place of the shifts that are fixed.", "N/m", (1e5, 1e6, 1e7)
    )
    thickness: float = number(
        "By which the strips are thicker and thinner; 0: as they are.", "m", ge=0, le=0.1, default=0.0001
    )
    cases: CaseNames = _cases()

    @field_validator("joints", "supports")
    @classmethod
    def _stiffnesses(cls, values: tuple[float, ...]) -> tuple[float, ...]:
        if len(values) > MOST_VALUES:
            raise Refusal(f"{len(values)} values are too many (limit {MOST_VALUES})", "leave some out")
        for value in values:
            if not LEAST_STIFFNESS <= value <= MOST_STIFFNESS:
                limits = f"from {LEAST_STIFFNESS:g} to {MOST_STIFFNESS:g}"
                raise Refusal(f"a stiffness of {value:g} is out of range", f"it has to be {limits}")
        return values


class VariantTable(Table):
    """The same structure but for what is given here, beside it in one table; its hardware weighs what it did."""

    name: Name = Field(min_length=1, max_length=100, description="Of the variant.", examples=["one layer, no cables"])
    without: Annotated[Annotated[tuple[Part, ...], Field(strict=False)], BeforeValidator(_listed)] = Field(
        default=(), description='What is left away: "cables", "edge beams".', examples=[["cables"]]
    )
    layers: int | None = number("Of each lamella.", "", ge=1, le=20, default=None)
    thickness: float | None = length("Of the strips.", default=None)
    height: float | None = length("Of the strips.", default=None)
    joints: Literal["locked", "hinged"] | float | None = Field(
        default=None, description='About the node\'s normal: "locked", "hinged" or a stiffness in N m/rad.'
    )
    feet: Literal["fixed", "sliding"] | None = Field(
        default=None,
        description='"fixed": all three shifts of all supports; "sliding": the vertical one alone, and what keeps the '
        "whole from drifting.",
    )

    @model_validator(mode="after")
    def _other(self) -> VariantTable:
        if not self.model_fields_set - {"name"}:
            raise Refusal("nothing is changed", "give without, layers, thickness, height, joints or feet")
        if isinstance(self.joints, float) and not LEAST_STIFFNESS <= self.joints <= MOST_STIFFNESS:
            limits = f"from {LEAST_STIFFNESS:g} to {MOST_STIFFNESS:g} N m/rad"
            raise Refusal(f"a stiffness of {self.joints:g} N m/rad is out of range", f"it has to be {limits}", "joints")
        return self


def check_variants(value: Any) -> Any:
    """A list of variants, before its tables are looked at."""
    return list_of_tables(value, "structure.variant", MOST_VARIANTS)


def check_stages(value: Any) -> Any:
    """Names of stages of construction, before their order is looked at.

    Raises
    ------
    Refusal
    """
    if not isinstance(value, list | tuple):
        raise Refusal(f"{shown(value)} is not a list of stages", "write names in brackets, with commas between them")
    for stage in value:
        if stage not in STAGES:
            listed = ", ".join(f'"{one}"' for one in STAGES)
            raise Refusal(f"{shown(stage)} is no stage", f"choose from {listed}")
    return value


def check_construction(stages: Sequence[str], joints: Any, tightened: str, cables: bool) -> None:
    """Refuse an order of construction that cannot be.

    Parameters
    ----------
    stages : sequence of str
    joints, tightened
        structure.joints and structure.cables.
    cables : bool
        Whether the project has cables; the remedy has the stages that the project can have.

    Raises
    ------
    Refusal
        Stages that are none or come twice; a first one that is not "bent", a last one that is not "loads on"; props
        that stay; joints that are locked, or not, against what the stages say.
    """
    key = "structure.construction"
    idle = {"joints locked": joints != "locked", "cables on": not cables}
    listed = ", ".join(f'"{stage}"' for stage in STAGES if not idle.get(stage))
    remedy = f"write construction = [{listed}], in the order of the site"
    if tightened != "designed":
        raise Refusal("construction says when the cables come", 'leave cables = "let go" out', "structure.cables")
    for stage in stages:
        if list(stages).count(stage) > 1:
            raise Refusal(f"the stage {shown(stage)} comes twice", remedy, key)
    if not stages or stages[0] != "bent" or stages[-1] != "loads on" or "props away" not in stages:
        raise Refusal(
            'it has to begin with "bent", end with "loads on", and the props have to go in between', remedy, key
        )
    if "joints locked" in stages and joints != "locked":
        raise Refusal(
            'joints are not locked, and the construction has the stage "joints locked"',
            'write joints = "locked", or leave the stage out',
            key,
        )
    if "joints locked" not in stages and joints == "locked":
        raise Refusal(
            "joints are locked, and the construction says not when",
            'add the stage "joints locked", or write joints = "hinged"',
            key,
        )
