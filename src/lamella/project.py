"""The project file's schema: every key with its unit, default and range."""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

import tomli_w
from pydantic import BaseModel, ConfigDict, Field, field_validator, model_validator

from lamella.strip.material import MATERIALS, Material, find_material
from lamella.wording import shown

# m; a thousand times smaller and larger than any model or building, so that no figure can overflow
LEAST_LENGTH, MOST_LENGTH = 1e-6, 1e6
# of a helicoid: the longer side of its parameter rectangle over the shorter one
MOST_ELONGATED = 10_000
# of Enneper's surface: |g| = radius^(order - 1) on the rim, the metric there is 1 + |g|^2 times that in the middle
MOST_ENNEPER_GROWTH = 100


class Refusal(ValueError):
    """A value refused by a check that knows the key in its table and the remedy."""

    def __init__(self, message: str, remedy: str, key: str = "") -> None:
        super().__init__(message)
        self.remedy, self.key = remedy, key


def _number(description: str, unit: str, **limits: Any) -> Any:
    return Field(description=description, json_schema_extra={"unit": unit}, **limits)


def _length(description: str, **limits: Any) -> Any:
    return _number(description, "m", ge=LEAST_LENGTH, le=MOST_LENGTH, **limits)


def _two_numbers(value: Any, names: str, of: str) -> tuple[float, float]:
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


class Table(BaseModel):
    """A table of the project file: unknown keys and values of another type are errors."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)


Range = Annotated[tuple[float, float], Field(strict=False)]


class _WithHeight(Table):
    """Checks of the key `height` of surfaces of revolution."""

    @field_validator("height", mode="before", check_fields=False)
    @classmethod
    def _in_order(cls, value: Any) -> Any:
        z0, z1 = _two_numbers(value, "[z0, z1]", "a range of heights")
        if z0 >= z1:
            remedy = f"write [{z1:g}, {z0:g}]" if z0 > z1 else "write two different heights, the lower one first"
            state = "reversed" if z0 > z1 else "empty"
            raise Refusal(f"the range [{z0:g}, {z1:g}] is {state}: z0 has to be below z1", remedy)
        if z1 - z0 < LEAST_LENGTH:
            raise Refusal(f"the range is only {z1 - z0:g} m long (limit {LEAST_LENGTH:g} m)", "lengths are in metres")
        return z0, z1


class UnduloidTable(_WithHeight):
    """Delaunay's unduloid about the z axis: H = 1 / (neck_radius + bulge_radius), normal towards the axis."""

    kind: Literal["unduloid"]
    neck_radius: float = _length("Smallest radius, at z = 0.", examples=[1.6])
    bulge_radius: float = _length("Largest radius; not below neck_radius.", examples=[2.8])
    height: Range = _number(
        "Heights [z0, z1] of the rims, z = 0 at a neck; several periods allowed.", "m", examples=[[-3.0, 6.0]]
    )


class NodoidTable(_WithHeight):
    """Neck branch of a nodoid: H = 1 / (bulge_radius - neck_radius), normal away from the axis at the neck."""

    kind: Literal["nodoid"]
    neck_radius: float = _length("Smallest radius, at z = 0.", examples=[3.0])
    bulge_radius: float = _length("Largest radius of the whole nodoid; above neck_radius.", examples=[9.0])
    height: Range = _number(
        "Heights [z0, z1] of the rims, z = 0 at the neck, |z| below the fold.", "m", examples=[[-1.5, 1.5]]
    )


class CatenoidTable(_WithHeight):
    """Minimal surface of revolution r = c cosh(z / c)."""

    kind: Literal["catenoid"]
    neck_radius: float = _length("Radius c at z = 0.", examples=[2.0])
    height: Range = _number("Heights [z0, z1] of the rims, z = 0 at the neck.", "m", examples=[[-2.0, 2.5]])

    @model_validator(mode="after")
    def _possible(self) -> CatenoidTable:
        limit = self.neck_radius * math.acosh(max(MOST_LENGTH / self.neck_radius, 1.0))
        for z in self.height:
            if abs(z) > limit:
                raise Refusal(
                    f"at z = {z:g} m a catenoid of neck_radius = {self.neck_radius:g} m is wider than "
                    f"{MOST_LENGTH:g} m (limit |z| <= {limit:.4g} m)",
                    "shorten the range or widen the neck",
                    "height",
                )
        return self


class CylinderTable(_WithHeight):
    """Circular cylinder, H = 1 / (2 radius); lamellas are helices at 45 degrees."""

    kind: Literal["cylinder"]
    radius: float = _length("Radius.", examples=[2.0])
    height: Range = _number("Heights [z0, z1] of the rims.", "m", examples=[[0.0, 4.0]])


class HelicoidTable(Table):
    """Ruled minimal surface; lamellas are its rulings and its helices."""

    kind: Literal["helicoid"]
    pitch: float = _number(
        "Rise of a full turn; negative: left-handed.", "m", ge=-MOST_LENGTH, le=MOST_LENGTH, examples=[4.0]
    )
    inner_radius: float = _number("Radius of the inner rim.", "m", ge=0, le=MOST_LENGTH, examples=[1.0])
    outer_radius: float = _length("Radius of the outer rim; above inner_radius.", examples=[4.0])
    turns: float = _number("Number of full turns.", "", ge=0.001, le=1000, examples=[1.25])

    @model_validator(mode="after")
    def _possible(self) -> HelicoidTable:
        if self.inner_radius >= self.outer_radius:
            raise Refusal(
                f"inner_radius = {self.inner_radius:g} m is not below outer_radius = {self.outer_radius:g} m",
                "lower inner_radius, or raise outer_radius",
                "inner_radius",
            )
        if abs(self.pitch) < 1e-6 * self.outer_radius:
            raise Refusal(
                f"pitch = {self.pitch:g} m makes a flat ring (limit {1e-6 * self.outer_radius:g} m for this "
                "outer_radius): on a plane every point is umbilic (all directions bend alike), so no net of lamellas "
                "is singled out",
                "choose a pitch of the size of the radii",
                "pitch",
            )
        # sides of the rectangle of conformal parameters, which the lamellas run along
        c = abs(self.pitch) / (2 * math.pi)
        across = math.asinh(self.outer_radius / c) - math.asinh(self.inner_radius / c)
        along = 2 * math.pi * self.turns
        if along > MOST_ELONGATED * across:
            raise Refusal(
                f"the strip between inner_radius = {self.inner_radius:g} m and outer_radius = {self.outer_radius:g} m "
                f"is too narrow for pitch = {self.pitch:g} m and {self.turns:g} turns: over {MOST_ELONGATED:,} times "
                "as many cells along as across",
                "widen the radii, or lower turns or pitch",
                "outer_radius",
            )
        if across > MOST_ELONGATED * along:
            raise Refusal(
                f"turns = {self.turns:g} makes a sliver: over {MOST_ELONGATED:,} times as many cells across as along",
                "raise turns",
                "turns",
            )
        return self


class EnneperTable(Table):
    """Enneper's minimal surface of any order; order 3 and above has a singular node in the middle."""

    kind: Literal["enneper"]
    order: int = _number("2 = classical, 3 = one hexagonal node, n has 2 n rays.", "", ge=2, le=12, default=2)
    radius: float = _number("Radius of the parameter disc.", "", ge=0.001, le=5, examples=[0.9])
    scale: float = _length("Metres per unit of the parametrisation.", default=1.0, examples=[4.0])

    @model_validator(mode="after")
    def _possible(self) -> EnneperTable:
        limit = MOST_ENNEPER_GROWTH ** (1 / (self.order - 1))
        if self.radius > limit:
            raise Refusal(
                f"radius = {self.radius:g} is out of range: at most {limit:.4g} for order {self.order}, where the "
                f"rim's cells are {MOST_ENNEPER_GROWTH**2:,} times those in the middle",
                "lower radius; beyond a radius of about 1 the surface cuts through itself anyway",
                "radius",
            )
        return self


class ScherkTable(Table):
    """Scherk's minimal surface z = ln(cos y / cos x) over a square."""

    kind: Literal["scherk"]
    extent: float = _number(
        "Half side of the square |x|, |y| <= extent in the parametrisation; below pi / 2 = 1.5708.",
        "",
        ge=0.001,
        lt=math.pi / 2,
        examples=[1.25],
    )
    scale: float = _length("Metres per unit of the parametrisation.", default=1.0, examples=[3.0])


SURFACE_TABLES: dict[str, type[Table]] = {
    "unduloid": UnduloidTable,
    "nodoid": NodoidTable,
    "catenoid": CatenoidTable,
    "cylinder": CylinderTable,
    "helicoid": HelicoidTable,
    "enneper": EnneperTable,
    "scherk": ScherkTable,
}
SurfaceTable = UnduloidTable | NodoidTable | CatenoidTable | CylinderTable | HelicoidTable | EnneperTable | ScherkTable


class NetworkTable(Table):
    """How dense the net is."""

    cells: int | None = _number(
        "Number of A lamellas that cross a loop once around the axis; on a simply connected surface, number of "
        "cells along its longest principal line. 24 when spacing is not given either.",
        "",
        ge=3,
        le=10**12,
        default=None,
        examples=[24],
    )
    spacing: float | None = _length(
        "Wanted median cell edge, instead of cells; the nearest whole number of cells is taken.",
        default=None,
        examples=[0.5],
    )
    angle: float = _number(
        "Angle between the families at the nodes; other than 90 is not offered yet.", "deg", default=90.0
    )
    closing: Literal["open", "round", "adjust"] = Field(
        default="open",
        description="What to do where a net does not close by itself; every net of a closed-form surface closes.",
    )
    minimum_length: float = _number(
        "Lamellas shorter than this many median cell edges are left out.", "cells", ge=0, le=100, default=0.5
    )

    @model_validator(mode="before")
    @classmethod
    def _default(cls, values: Any) -> Any:
        if isinstance(values, dict) and "cells" not in values and "spacing" not in values:
            return values | {"cells": 24}
        return values

    @model_validator(mode="after")
    def _possible(self) -> NetworkTable:
        if self.cells is not None and self.spacing is not None:
            raise Refusal(
                f"cells = {self.cells} and spacing = {self.spacing:g} m are both given", "keep one of them", "spacing"
            )
        if self.angle != 90:
            raise Refusal(
                f"angle = {self.angle:g} deg: only 90 deg is offered", "write angle = 90 or leave it out", "angle"
            )
        return self


class LamellaTable(Table):
    """Section, material and node marks of the strips."""

    height: float = _number("Height of the strip, along the surface normal.", "m", ge=1e-4, le=5, default=0.1)
    thickness: float = _number("Thickness of one strip.", "m", ge=1e-6, le=0.5, default=0.0015)
    layers: int = _number("Parallel strips of each lamella.", "", ge=1, le=4, default=2)
    offset: float = _number("Distance between the middles of neighbouring layers.", "m", gt=0, le=1, default=0.025)
    material: str = Field(
        default="1.4301",
        max_length=100,
        description=f"One of {', '.join(MATERIALS)}, or a table [materials.NAME] of the project.",
    )
    marks: Literal["arc-length", "relaxed"] = Field(
        default="arc-length",
        description='"arc-length": nodes marked at the 3D arc length, the nodes then hold the strip stretched; '
        '"relaxed": marks lengthened by the integral of h^2 tg^2 / 24, so that the twisted strip carries no tension.',
    )

    layer_lengths: Literal["alike", "own"] = Field(
        default="alike",
        description='"alike": every layer is marked at the node distances of the centre line; "own": each at those of '
        "its own curve to the side, as a part of its own.",
    )

    @model_validator(mode="after")
    def _possible(self) -> LamellaTable:
        if self.thickness >= self.height:
            raise Refusal(
                f"thickness = {self.thickness:g} m is not below height = {self.height:g} m: the strip stands on "
                "edge, its height is the larger measure",
                f"choose a thickness below {self.height:g} m",
                "thickness",
            )
        if self.layers > 1 and self.offset <= self.thickness:
            raise Refusal(
                f"offset = {self.offset:g} m leaves no gap between layers of thickness {self.thickness:g} m",
                f"choose an offset above {self.thickness:g} m, or layers = 1",
                "offset",
            )
        return self


class FabricationTable(Table):
    """Cutting the strips."""

    sheet: Range = _number("Length and width of a sheet.", "m", default=(12.0, 2.0))
    gap: float = _number("Distance between parts on a sheet, and to its edge.", "m", gt=0, le=1, default=0.01)
    end_distance: float | None = _number(
        "Least distance from the last slot to the strip's end; the larger of 0.05 m and two slot widths when not "
        "given.",
        "m",
        gt=0,
        le=5,
        default=None,
        examples=[0.05],
    )
    rim_overhang: float = _number(
        "Least distance from the rim's node to the strip's end.", "m", ge=0, le=5, default=0.01
    )
    hub_radius: float | None = _number(
        "A strip stops this far from a singular node; when not given 0.02 m, or more where the strips of "
        "neighbouring rays would run into each other.",
        "m",
        ge=0,
        le=5,
        default=None,
        examples=[0.05],
    )
    slot_width: float | None = _number(
        "Width of the slots; 2 x thickness when not given.", "m", gt=0, le=1, default=None, examples=[0.003]
    )

    @field_validator("sheet", mode="before")
    @classmethod
    def _positive(cls, value: Any) -> Any:
        sides = _two_numbers(value, "[length, width]", "a sheet")
        for x in sides:
            if not 0 < x <= 1000:
                remedy = "lengths are in metres, not millimetres" if x > 0 else "write both sides in metres"
                raise Refusal(f"a side of {x:g} m is out of range: has to be above 0 and at most 1000 m", remedy)
        return sides

    @model_validator(mode="after")
    def _possible(self) -> FabricationTable:
        if min(self.sheet) <= 2 * self.gap:
            raise Refusal(
                f"the sheet is {min(self.sheet):g} m wide, nothing of it is left between gaps of {self.gap:g} m at "
                "either edge",
                "choose a larger sheet or a smaller gap",
                "sheet",
            )
        return self


class MaterialTable(Table):
    """A material of the project's own, SI units."""

    density: float = _number("Density.", "kg/m3", gt=0, le=30000)
    youngs_modulus: float = _number("Young's modulus along the strip.", "Pa", ge=1e6, le=1e13)
    shear_modulus: float = _number("Shear modulus.", "Pa", ge=1e5, le=1e13)
    strength: float = _number("Limit of the normal (von Mises) stress.", "Pa", ge=1e3, le=1e11)
    shear_strength: float | None = _number(
        "Limit of the shear stress where it is not that of von Mises (timber).", "Pa", ge=1e3, le=1e11, default=None
    )


class Project(Table):
    """A whole project file."""

    name: str = Field(default="", description="Name of the project; the file's name when not given.", max_length=200)
    surface: Annotated[SurfaceTable, Field(discriminator="kind")]
    network: NetworkTable = NetworkTable()
    lamella: LamellaTable = LamellaTable()
    fabrication: FabricationTable = FabricationTable()
    materials: dict[str, MaterialTable] = Field(default={}, description="Materials by name.")

    def material(self) -> Material:
        """The material of the lamellas."""
        own = {name: Material(**table.model_dump()) for name, table in self.materials.items()}
        return find_material(self.lamella.material, own)

    def to_toml(self) -> str:
        """The project with its defaults filled in, as TOML (`Results.project` has those of the pipeline as well)."""
        return tomli_w.dumps(self.model_dump(mode="json", exclude_none=True))


def project_schema() -> dict[str, Any]:
    """JSON schema (draft 2020-12) of the project file."""
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "$id": "lamella/project/1",
        "title": "lamella project file",
    } | Project.model_json_schema()
