"""The tables [[load]] and [[combination]]: what acts on the structure."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches
from typing import Annotated, Any, Literal, get_args

from pydantic import Field, field_validator, model_validator

from lamella.base.limits import LOAD_LIMITS
from lamella.base.number_lists import Refusal, direction, three_numbers
from lamella.base.wording import shown
from lamella.project.structure_tables import MOST_TABLES, PlacedTable, StructureTable, SupportTable, check_list
from lamella.project.values import Direction, Name, Point, Table, Triple, length, number

LoadKind = Literal["self_weight", "area", "line", "point", "temperature", "settlement"]
Category = Literal[
    "permanent",
    "settlement",
    "A",
    "B",
    "C",
    "D",
    "E",
    "F",
    "G",
    "H",
    "snow",
    "snow above 1000 m",
    "wind",
    "temperature",
]


class RegionTable(Table):
    """A part of the surface with a coefficient of its own; what is given has to hold together."""

    coefficient: float = number("Of the load here, a pressure coefficient.", "", ge=-10, le=10, examples=[-0.8])
    near: Point | None = number("Around this point [x, y, z] ...", "m", default=None)
    radius: float | None = length("... up to this far.", default=None)
    low: Point | None = number("In a box from this corner [x, y, z] ...", "m", default=None)
    high: Point | None = number("... to this one.", "m", default=None)
    facing: Direction | None = number(
        "Where the surface's normal turns towards this direction.", "", default=None, examples=[[1.0, 0.0, 0.0]]
    )

    @model_validator(mode="after")
    def _possible(self) -> RegionTable:
        for one, other in (("near", "radius"), ("low", "high")):
            if (getattr(self, one) is None) != (getattr(self, other) is None):
                raise Refusal(f"{one} and {other} go together", "give both, or neither", other)
        if self.near is None and self.low is None and self.facing is None:
            raise Refusal("no place is given", "add near and radius, low and high, or facing")
        if self.low is not None and self.high is not None:
            for axis, a, b in zip("xyz", self.low, self.high, strict=True):
                if not a < b:
                    raise Refusal(f"high is {b:g} m in {axis}, not above low with {a:g} m", "exchange them", "high")
        return self


def _normal_or_direction(value: Any) -> Any:
    if value == "normal":
        return value
    if isinstance(value, str):
        raise Refusal(f"{shown(value)} is no direction", 'write [x, y, z] or "normal"')
    return direction(value)


_KEYS: dict[str, tuple[set[str], set[str]]] = {
    "self_weight": (set(), {"value", "direction"}),
    "area": ({"value"}, {"direction", "per", "coefficient", "region"}),
    "line": ({"value", "boundary"}, {"direction"}),
    "point": ({"near"}, {"value", "direction", "radius", "moment"}),
    "temperature": ({"value"}, set()),
    "settlement": ({"value"}, {"direction", "boundary", "ground", "tolerance", "near", "radius"}),
}
"""Keys that a kind of load needs, and those it may have; all may have name, kind, category, psi and group."""

_DEFAULTS: dict[str, Any] = {"value": 1.0, "direction": (0.0, 0.0, -1.0), "per": "true"}
"""Of the keys that a kind of load has; a size of its own has self-weight alone."""

_OWN_CATEGORY: dict[str, Category] = {
    "self_weight": "permanent",
    "temperature": "temperature",
    "settlement": "settlement",
}


class LoadTable(PlacedTable):
    """A load, a case of its own: self-weight, on areas, along boundaries, at points, a temperature or a settlement."""

    name: Name = Field(min_length=1, max_length=100, description="Name of the case.", examples=["snow"])
    kind: LoadKind = Field(description="What it is.", examples=["area"])
    category: Category | None = Field(
        default=None,
        description="Of the action, for combinations of EN 1990: A to H are imposed loads of its table A1.1. Of "
        "self-weight, temperature and settlement it is their own.",
    )
    value: float | None = number(
        "Size: N/m2 of an area load, N/m, N, K, m of a settlement, multiples of the weight (1 when not given). "
        "Negative: the other way.",
        "by kind",
        default=None,
        examples=[500.0],
    )
    direction: Literal["normal"] | Annotated[Triple, Field(strict=False)] | None = Field(
        default=None,
        description='[x, y, z] of any length, [0, 0, -1] when not given; of an area load also "normal": a pressure '
        "that pushes along the surface's normal.",
        examples=[[0.0, 0.0, -1.0]],
    )
    per: Literal["plan", "true"] | None = Field(
        default=None,
        description='An area load\'s area: "plan", as it is seen along the direction (snow), or "true", the default '
        "(cladding; pressures always are).",
        examples=["plan"],
    )
    coefficient: float | None = number(
        "An area load is multiplied by it outside all regions; 1 when not given, with regions 0.",
        "",
        ge=-10,
        le=10,
        default=None,
    )
    region: Annotated[tuple[RegionTable, ...], Field(strict=False)] | None = Field(
        default=None,
        description="Tables [[load.region]] with coefficients of an area load; where several hold a place, the first.",
        json_schema_extra={"minItems": 1, "maxItems": MOST_TABLES},
    )
    moment: Point | None = number("Of a point load, about the global axes.", "N m", default=None)
    psi: Annotated[tuple[float, float, float], Field(strict=False)] | None = number(
        "psi0, psi1, psi2 of this action where they are not those of EN 1990, table A1.1.", "", default=None
    )
    group: Name | None = Field(
        default=None,
        max_length=100,
        description="Loads of one group never act together in a combination of EN 1990; those of wind, snow and "
        "temperature are one group each when not given.",
    )

    @model_validator(mode="before")
    @classmethod
    def _default(cls, values: Any) -> Any:
        kind = values.get("kind") if isinstance(values, dict) else None
        if not isinstance(kind, str) or kind not in _KEYS:
            return values
        has = _KEYS[kind][1]
        defaults = {key: value for key, value in _DEFAULTS.items() if key in has}
        if kind != "self_weight":
            defaults.pop("value", None)
        return defaults | values

    _direction = field_validator("direction", mode="before")(_normal_or_direction)

    @field_validator("region", mode="before")
    @classmethod
    def _regions(cls, value: Any) -> Any:
        return check_list(value, "load.region")

    @field_validator("moment", mode="before")
    @classmethod
    def _moment(cls, value: Any) -> Any:
        return three_numbers(value, most=1e9)

    @field_validator("psi", mode="before")
    @classmethod
    def _psi(cls, value: Any) -> Any:
        psi = three_numbers(value)
        if not 1 >= psi[0] >= psi[1] >= psi[2] >= 0:
            raise Refusal(f"{shown(value)}: psi0, psi1, psi2 fall from 1 to 0 at most", "write psi = [0.7, 0.5, 0.3]")
        return psi

    @model_validator(mode="after")
    def _possible(self) -> LoadTable:
        needed, further = _KEYS[self.kind]
        given = self.model_fields_set
        for key in sorted(needed):
            if getattr(self, key) is None:
                raise Refusal(f"missing: a load of kind {self.kind!r} needs it", f"add {key} = ...", key)
        for key in sorted(set().union(*(a | b for a, b in _KEYS.values())) - needed - further):
            if key in given and getattr(self, key) is not None:
                raise Refusal(f"a load of kind {self.kind!r} has no {key}", f"leave {key} out", key)
        self.check_place(needed=self.kind in ("line", "point", "settlement"))
        self._check_value()
        self._check_direction()
        own = _OWN_CATEGORY.get(self.kind)
        if own and self.category not in (None, own):
            raise Refusal(f"a load of kind {self.kind!r} is of category {own!r}", "leave category out", "category")
        return self

    @property
    def acts_as(self) -> str:
        """Category of the action; permanent where nothing says otherwise."""
        return self.category or _OWN_CATEGORY.get(self.kind, "permanent")

    def _check_value(self) -> None:
        """Refuse sizes that are meant in another unit."""
        unit, least, most = LOAD_LIMITS[self.kind]
        if self.value is None:
            if self.kind == "point" and self.moment is None:
                raise Refusal("missing: a point load has value or moment", "add value = ..., in N", "value")
            return
        if not least <= abs(self.value) <= most:
            remedy = "loads are in N and m, not kN or mm" if unit not in ("K", "times the weight") else "mend the value"
            raise Refusal(
                f"{self.value:g} {unit} is out of range: its size has to be from {least:g} to {most:g} {unit}",
                remedy,
                "value",
            )

    def _check_direction(self) -> None:
        """Refuse pressures of what is no area load, and areas of pressures in plan."""
        if self.direction != "normal":
            return
        if self.kind != "area":
            raise Refusal('"normal" is the direction of area loads', "write [x, y, z]", "direction")
        if self.per == "plan":
            raise Refusal("a pressure along the normal acts on the true area", 'write per = "true"', "per")


class CombinationTable(Table):
    """Loads that act together, each with its factor."""

    name: Name = Field(min_length=1, max_length=100, description="Name of the combination.", examples=["uls"])
    factors: dict[Name, float] = Field(
        description="Factor by the load's name: {self_weight = 1.35, snow = 1.5}.", examples=[{"snow": 1.5}]
    )

    @field_validator("factors", mode="after")
    @classmethod
    def _some(cls, factors: dict[str, float]) -> dict[str, float]:
        if not factors:
            raise Refusal("no load is named", "write factors = {snow = 1.5}")
        for name, factor in factors.items():
            if abs(factor) > 100:
                raise Refusal(f"the factor {factor:g} of {shown(name)} is out of range: at most 100", "lower it")
        return factors


ACTION_TABLES: dict[str, type[Table]] = {"support": SupportTable, "load": LoadTable, "combination": CombinationTable}
"""Tables that may be there several times, [[support]] and so on."""


def check_actions(
    structure: StructureTable, loads: Sequence[LoadTable], combinations: Sequence[CombinationTable]
) -> None:
    """Refuse loads and combinations that do not go together.

    Raises
    ------
    Refusal
        Two of one name; a factor of a load that is not there; loads of no category where they are combined by it.
    """
    _check_names([("load", load.name) for load in loads] + [("combination", one.name) for one in combinations])
    known = [load.name for load in loads]
    for k, combination in enumerate(combinations):
        for name in combination.factors:
            if name not in known:
                near = get_close_matches(name, known, 1, 0.5)
                raise Refusal(
                    f"there is no load {shown(name)}" + (f", did you mean {shown(near[0])}?" if near else ""),
                    f"loads are {', '.join(known) or 'none'}: add a table [[load]], or mend the name",
                    f"combination[{k}].factors.{name}",
                )
    by_category = structure.combinations != "listed" or structure.serviceability != "none"
    for k, load in enumerate(loads):
        if by_category and load.category is None and load.kind not in _OWN_CATEGORY:
            raise Refusal(
                f"missing: combinations of EN 1990 need the category of {shown(load.name)}",
                f"add category, one of {', '.join(get_args(Category))}",
                f"load[{k}].category",
            )


def _check_names(named: list[tuple[str, str]]) -> None:
    """Refuse a name of two tables; keys and names, in the order of the lists."""
    names = [name for _, name in named]
    for k, (key, name) in enumerate(named):
        if name in names[:k]:
            raise Refusal(
                f"the name {shown(name)} is there twice",
                "give each load and each combination a name of its own",
                f"{key}[{sum(other == key for other, _ in named[:k])}].name",
            )
