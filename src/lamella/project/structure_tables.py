"""The tables [structure] and [[support]]: the structural model, and what it stands on."""

from __future__ import annotations

from typing import Annotated, Any, Literal, get_args

from pydantic import Field, field_validator, model_validator

from lamella.base.limits import LEAST_STIFFNESS, MOST_STIFFNESS
from lamella.base.number_lists import Refusal
from lamella.base.wording import shown
from lamella.project.structure_analyses_tables import (
    MOST_VARIANTS,
    ConstructionStage,
    DisplacementTable,
    FailureTable,
    SensitivityTable,
    VariantTable,
    check_stages,
    check_variants,
)
from lamella.project.values import Name, Point, Table, length, list_of_tables, number

MOST_TABLES = 200
"""Supports, loads or combinations of a project."""


def check_list(value: Any, name: str) -> Any:
    """A list of tables that there may be so many of, before they are looked at."""
    return list_of_tables(value, name, MOST_TABLES)


def list_key(model: type[Table]) -> Any:
    """A key with such a list that may be left out."""
    return Field(
        default=None,
        description=(model.__doc__ or "").strip(),
        json_schema_extra={"minItems": 1, "maxItems": MOST_TABLES},
    )


Way = Literal["x", "y", "z", "rx", "ry", "rz"]
JointHold = Literal["locked", "hinged"]
Export = Literal["opensees", "saf"]


def _stiffness(description: str, unit: str) -> Any:
    return number(description, unit, ge=LEAST_STIFFNESS, le=MOST_STIFFNESS, default=None, examples=[1e6])


class JointStiffnessTable(Table):
    """Joints that are springs about the node's normal."""

    stiffness: float = number(
        "Moment that turns a joint by 1 rad.", "N m/rad", ge=LEAST_STIFFNESS, le=MOST_STIFFNESS, examples=[100.0]
    )
    gap: float = number(
        "By which it turns freely to either side before that: the play of its slot.", "deg", ge=0, le=90, default=0.0
    )


class PartialFactorsTable(Table):
    """Partial factors of the combinations of EN 1990; national annexes give others."""

    permanent: float = number("Of unfavourable permanent actions.", "", ge=1, le=3, default=1.35)
    favourable: float = number("Of favourable permanent actions.", "", ge=0, le=1, default=1.0)
    variable: float = number("Of unfavourable variable actions.", "", ge=1, le=3, default=1.5)
    settlement: float = number("Of settlements.", "", ge=1, le=3, default=1.35)
    reduction: float = number(
        "Of unfavourable permanent actions beside a leading one, xi in 6.10b.", "", gt=0, le=1, default=0.85
    )


class StructureTable(Table):
    """The structural model: how fine it is, what its joints hold, and which combinations of loads are looked at."""

    elements: int = number("Beam elements of each cell edge.", "", ge=1, le=32, default=4)
    joints: JointHold | JointStiffnessTable = Field(
        default="locked",
        description='About the node\'s normal: "locked" at the angle they have, "hinged" or {stiffness = N m/rad}.',
    )
    layers: Literal["combined", "each"] = Field(
        default="combined",
        description='"combined": the layers of a lamella are one line of beams, with the stiffness of all of them '
        'beside each other; "each": every layer is a line of its own, coupled by nodes and shear blocks.',
    )
    slots: Literal["reduced", "whole"] = Field(
        default="reduced",
        description='"reduced": a slot turns like a notch of half the height under strong-axis bending; "whole": slots '
        "take nothing from the strips' stiffness. Stresses count the half that is left either way.",
    )
    cables: Literal["designed", "let go"] = Field(
        default="designed",
        description='When the cables of [cables] get their prestress: "designed": in the designed shape, which they '
        'then help to keep; "let go": once the net is off its props and has sprung back.',
    )
    modes: int = number("Buckling factors of each case, and natural frequencies.", "", ge=0, le=50, default=3)
    combinations: Literal["listed", "EN 1990 6.10", "EN 1990 6.10a/b"] = Field(
        default="listed",
        description='"listed": those of [[combination]] alone; else those of EN 1990 for persistent situations as '
        "well, made from the categories of the loads.",
    )
    exports: Annotated[tuple[Export, ...], Field(strict=False)] = Field(
        default=("opensees", "saf"),
        description='Programs that the model is written for: "opensees" a script, "saf" a workbook of the Structural '
        "Analysis Format (SCIA Engineer, Allplan, AxisVM, Dlubal RFEM, FEM-Design and others).",
        examples=[["opensees", "saf"]],
    )
    serviceability: Literal["none", "characteristic", "frequent", "quasi-permanent"] = Field(
        default="none", description="Combinations of EN 1990 for the serviceability limit state, besides."
    )
    factors: PartialFactorsTable = Field(
        default=PartialFactorsTable(), description="Partial factors {permanent, favourable, variable, ...}."
    )
    steps: int | None = number(
        "Load steps of each case, which results show one by one; 1 when not given.", "", ge=1, le=100, default=None
    )
    construction: Annotated[tuple[ConstructionStage, ...], Field(strict=False)] | None = Field(
        default=None,
        description='How it is put up: "bent" on props, "joints locked", "cables on", "props away", "loads on", in the '
        "order of the site. Not given: all is in place when the designed shape is let go.",
        examples=[["bent", "joints locked", "cables on", "props away", "loads on"]],
    )
    failure: FailureTable | None = Field(default=None, description=(FailureTable.__doc__ or "").strip())
    displacement: DisplacementTable | None = Field(default=None, description=(DisplacementTable.__doc__ or "").strip())
    sensitivity: SensitivityTable | None = Field(default=None, description=(SensitivityTable.__doc__ or "").strip())
    variant: Annotated[tuple[VariantTable, ...], Field(strict=False)] | None = Field(
        default=None,
        description=(VariantTable.__doc__ or "").strip(),
        json_schema_extra={"minItems": 1, "maxItems": MOST_VARIANTS},
    )

    @field_validator("construction", mode="before")
    @classmethod
    def _stages(cls, value: Any) -> Any:
        return None if value is None else check_stages(value)

    @field_validator("variant", mode="before")
    @classmethod
    def _variants(cls, value: Any) -> Any:
        return None if value is None else check_variants(value)

    @field_validator("variant")
    @classmethod
    def _names(cls, value: tuple[VariantTable, ...] | None) -> tuple[VariantTable, ...] | None:
        names = [one.name for one in value or ()]
        for name in names:
            if names.count(name) > 1:
                raise Refusal(f"two variants are called {shown(name)}", "give each a name of its own")
        return value

    @field_validator("joints", mode="before")
    @classmethod
    def _hold(cls, value: Any) -> Any:
        if isinstance(value, JointStiffnessTable) or value in get_args(JointHold):
            return value
        remedy = 'write "locked", "hinged" or {stiffness = 100.0}, N m/rad, with gap = ... in degrees or without'
        if not isinstance(value, dict) or not {"stiffness"} <= set(value) <= {"stiffness", "gap"}:
            raise Refusal(f"{shown(value)} says not what joints hold", remedy)
        for key, unit, least, most in (
            ("stiffness", "N m/rad", LEAST_STIFFNESS, MOST_STIFFNESS),
            ("gap", "deg", 0, 90),
        ):
            given = value.get(key, least)
            if isinstance(given, bool) or not isinstance(given, int | float):
                raise Refusal(f"a {key} of {shown(given)} is not a number", remedy)
            if not least <= given <= most:
                limits = f"from {least:g} to {most:g}"
                raise Refusal(f"a {key} of {shown(given)} {unit} is out of range: has to be {limits}", remedy)
        return JointStiffnessTable(**{key: float(given) for key, given in value.items()})


class SpringTable(Table):
    """Springs along and about the global axes."""

    x: float | None = _stiffness("Along x.", "N/m")
    y: float | None = _stiffness("Along y.", "N/m")
    z: float | None = _stiffness("Along z.", "N/m")
    rx: float | None = _stiffness("About x.", "N m/rad")
    ry: float | None = _stiffness("About y.", "N m/rad")
    rz: float | None = _stiffness("About z.", "N m/rad")

    def given(self) -> dict[str, float]:
        """Stiffness by direction, of those that are given."""
        return {key: value for key, value in self if value is not None}


_BOUNDARY = (
    'Name of a boundary curve, or "rim" for all of them; on a surface without named ones "outer border", "border 2", '
    '..., between two rings "lower" and "upper".'
)


class PlacedTable(Table):
    """Nodes by their place."""

    boundary: Name | None = Field(default=None, max_length=100, description=_BOUNDARY, examples=["rim"])
    ground: float | None = number(
        "Nodes below this height z, and up to tolerance above it.", "m", ge=-1e7, le=1e7, default=None, examples=[0.0]
    )
    tolerance: float | None = length(
        "How far above the ground nodes still stand on it; 0.01 m when not given.", default=None
    )
    near: Point | None = number("Nodes around this point [x, y, z].", "m", default=None, examples=[[0.0, 0.0, 0.0]])
    radius: float | None = length("How far around it; the nearest node alone when not given.", default=None)

    def check_place(self, needed: bool = True) -> None:
        """Refuse several places, and none where one is needed."""
        given = [key for key in ("boundary", "ground", "near") if getattr(self, key) is not None]
        if len(given) > 1:
            raise Refusal(
                f"{' and '.join(given)} are given", "keep one of them, and write a table for each place", given[1]
            )
        if needed and not given:
            raise Refusal("no place is given", "add boundary, ground or near")
        for key, other in (("tolerance", "ground"), ("radius", "near")):
            if getattr(self, key) is not None and getattr(self, other) is None:
                raise Refusal(f"{key} goes with {other}", f"leave {key} out, or give {other}", key)


class SupportTable(PlacedTable):
    """What holds the structure: nodes by boundary, ground or point, and which shifts and rotations are held there."""

    fixed: Annotated[tuple[Way, ...], Field(strict=False)] | None = Field(
        default=None,
        description='Held shifts "x", "y", "z" and rotations "rx", "ry", "rz", global axes; all three shifts where '
        "neither this nor spring is given.",
        examples=[["x", "y", "z"]],
    )
    spring: SpringTable | None = Field(
        default=None, description="Springs {x, y, z, rx, ry, rz} to the ground, N/m and N m/rad.", examples=[{"z": 1e6}]
    )

    @model_validator(mode="before")
    @classmethod
    def _default(cls, values: Any) -> Any:
        if isinstance(values, dict) and "fixed" not in values and "spring" not in values:
            return values | {"fixed": ("x", "y", "z")}
        return values

    @field_validator("fixed", mode="before")
    @classmethod
    def _list(cls, value: Any) -> Any:
        if not isinstance(value, list | tuple):
            raise Refusal(f"{shown(value)} is not a list", 'write fixed = ["x", "y", "z"]')
        return value

    @model_validator(mode="after")
    def _possible(self) -> SupportTable:
        self.check_place()
        springs = self.spring.given() if self.spring is not None else {}
        both = [way for way in self.fixed or () if way in springs]
        if both:
            raise Refusal(f"{both[0]} is fixed and on a spring", "keep one of the two", f"spring.{both[0]}")
        if not self.fixed and not springs:
            raise Refusal("nothing is held", 'write fixed = ["x", "y", "z"] or spring = {z = 1e6}', "fixed")
        return self
