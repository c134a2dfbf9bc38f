"""The project file: every key with its unit, default and range, and errors that name the key and the remedy."""

from __future__ import annotations

import math
import re
import tomllib
from difflib import get_close_matches
from pathlib import Path
from typing import Annotated, Any, Literal

import tomli_w
from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator, model_validator
from pydantic_core import ErrorDetails

from lamella.errors import InputError
from lamella.strip.material import MATERIALS, Material, find_material

# a project file is written by hand; anything larger is some other file
MOST_BYTES = 5_000_000


def _number(description: str, unit: str, **limits: Any) -> Any:
    return Field(description=description, json_schema_extra={"unit": unit}, **limits)


def _heights(value: tuple[float, float]) -> tuple[float, float]:
    if value[0] >= value[1]:
        raise ValueError(f"the range [{value[0]:g}, {value[1]:g}] is reversed or empty: z0 has to be below z1")
    return value


class Table(BaseModel):
    """A table of the project file: unknown keys and values of another type are errors."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)


Range = Annotated[tuple[float, float], Field(strict=False)]


class _WithHeight(Table):
    """Checks of the key `height` of surfaces of revolution."""

    @field_validator("height", mode="before", check_fields=False)
    @classmethod
    def _two_numbers(cls, value: Any) -> Any:
        if not isinstance(value, list | tuple):
            raise ValueError("needs two numbers [z0, z1]")
        if len(value) != 2:
            raise ValueError(f"has {len(value)} numbers, needs two: [z0, z1]")
        for z in value:
            if isinstance(z, bool) or not isinstance(z, int | float) or not math.isfinite(z):
                raise ValueError(f"{z!r} is not a finite number")
        return float(value[0]), float(value[1])

    @field_validator("height", check_fields=False)
    @classmethod
    def _in_order(cls, value: tuple[float, float]) -> tuple[float, float]:
        return _heights(value)


class UnduloidTable(_WithHeight):
    """Delaunay's unduloid about the z axis: H = 1 / (neck_radius + bulge_radius), normal towards the axis."""

    kind: Literal["unduloid"]
    neck_radius: float = _number("Smallest radius, at z = 0.", "m", gt=0, examples=[1.6])
    bulge_radius: float = _number("Largest radius; not below neck_radius.", "m", gt=0, examples=[2.8])
    height: Range = _number(
        "Heights [z0, z1] of the rims, z = 0 at a neck; several periods allowed.", "m", examples=[[-3.0, 6.0]]
    )


class NodoidTable(_WithHeight):
    """Neck branch of a nodoid: H = 1 / (bulge_radius - neck_radius), normal away from the axis at the neck."""

    kind: Literal["nodoid"]
    neck_radius: float = _number("Smallest radius, at z = 0.", "m", gt=0, examples=[3.0])
    bulge_radius: float = _number("Largest radius of the whole nodoid; above neck_radius.", "m", gt=0, examples=[9.0])
    height: Range = _number(
        "Heights [z0, z1] of the rims, z = 0 at the neck, |z| below the fold.", "m", examples=[[-1.5, 1.5]]
    )


class CatenoidTable(_WithHeight):
    """Minimal surface of revolution r = c cosh(z / c)."""

    kind: Literal["catenoid"]
    neck_radius: float = _number("Radius c at z = 0.", "m", gt=0, examples=[2.0])
    height: Range = _number("Heights [z0, z1] of the rims, z = 0 at the neck.", "m", examples=[[-2.0, 2.5]])


class CylinderTable(_WithHeight):
    """Circular cylinder, H = 1 / (2 radius); lamellas are helices at 45 degrees."""

    kind: Literal["cylinder"]
    radius: float = _number("Radius.", "m", gt=0, examples=[2.0])
    height: Range = _number("Heights [z0, z1] of the rims.", "m", examples=[[0.0, 4.0]])


class HelicoidTable(Table):
    """Ruled minimal surface; lamellas are its rulings and its helices."""

    kind: Literal["helicoid"]
    pitch: float = _number("Rise of a full turn; negative: left-handed.", "m", examples=[4.0])
    inner_radius: float = _number("Radius of the inner rim.", "m", ge=0, examples=[1.0])
    outer_radius: float = _number("Radius of the outer rim; above inner_radius.", "m", gt=0, examples=[4.0])
    turns: float = _number("Number of full turns.", "", gt=0, le=1000, examples=[1.25])

    @model_validator(mode="after")
    def _possible(self) -> HelicoidTable:
        if self.inner_radius >= self.outer_radius:
            raise ValueError(
                f"inner_radius = {self.inner_radius:g} m is not below outer_radius = {self.outer_radius:g} m"
            )
        if abs(self.pitch) < 1e-6 * self.outer_radius:
            raise ValueError(
                f"pitch = {self.pitch:g} m makes a flat ring: on a plane every point is umbilic (all directions "
                "bend alike), so no net of lamellas is singled out; choose a pitch of the size of the radii"
            )
        return self


class EnneperTable(Table):
    """Enneper's minimal surface of any order; order 3 and above has a singular node in the middle."""

    kind: Literal["enneper"]
    order: int = _number("2 = classical, 3 = one hexagonal node, n has 2 n rays.", "", ge=2, le=12, default=2)
    radius: float = _number("Radius of the parameter disc.", "", gt=0, le=5, examples=[0.9])
    scale: float = _number("Metres per unit of the parametrisation.", "m", gt=0, default=1.0, examples=[4.0])


class ScherkTable(Table):
    """Scherk's minimal surface z = ln(cos y / cos x) over a square."""

    kind: Literal["scherk"]
    extent: float = _number(
        "Half side of the square |x|, |y| <= extent in the parametrisation; below pi / 2 = 1.5708.",
        "",
        gt=0,
        lt=math.pi / 2,
        examples=[1.25],
    )
    scale: float = _number("Metres per unit of the parametrisation.", "m", gt=0, default=1.0, examples=[3.0])


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
        default=None,
        examples=[24],
    )
    spacing: float | None = _number(
        "Wanted median cell edge, instead of cells; the nearest density that closes is taken.",
        "m",
        gt=0,
        default=None,
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

    @model_validator(mode="after")
    def _possible(self) -> NetworkTable:
        if self.cells is not None and self.spacing is not None:
            raise ValueError(f"cells = {self.cells} and spacing = {self.spacing:g} m are both given: keep one of them")
        if self.angle != 90:
            raise ValueError(f"angle = {self.angle:g} deg: only 90 deg is offered, write angle = 90 or leave it out")
        return self


class LamellaTable(Table):
    """Section, material and node marks of the strips."""

    height: float = _number("Height of the strip, along the surface normal.", "m", gt=0, le=5, default=0.1)
    thickness: float = _number("Thickness of one strip.", "m", gt=0, le=0.5, default=0.0015)
    layers: int = _number("Parallel strips of each lamella.", "", ge=1, le=4, default=2)
    offset: float = _number("Distance between the middles of neighbouring layers.", "m", gt=0, le=1, default=0.025)
    material: str = Field(
        default="1.4301", description=f"One of {', '.join(MATERIALS)}, or a table [materials.NAME] of the project."
    )
    marks: Literal["arc-length", "relaxed"] = Field(
        default="arc-length",
        description='"arc-length": nodes marked at the 3D arc length, the nodes then hold the strip stretched; '
        '"relaxed": marks lengthened by the integral of h^2 tg^2 / 24, so that the twisted strip carries no tension.',
    )

    @model_validator(mode="after")
    def _possible(self) -> LamellaTable:
        if self.thickness >= self.height:
            raise ValueError(
                f"thickness = {self.thickness:g} m is not below height = {self.height:g} m: the strip stands on "
                "edge, its height is the larger measure"
            )
        if self.layers > 1 and self.offset <= self.thickness:
            raise ValueError(
                f"offset = {self.offset:g} m leaves no gap between layers of thickness {self.thickness:g} m"
            )
        return self


class FabricationTable(Table):
    """Cutting the strips."""

    sheet: Range = _number("Length and width of a sheet.", "m", default=(12.0, 2.0))
    gap: float = _number("Distance between parts on a sheet, and to its edge.", "m", ge=0, le=1, default=0.01)
    end_distance: float = _number(
        "From the last slot, or the rim node where that lies further out, to the strip's end.",
        "m",
        gt=0,
        le=5,
        default=0.05,
    )
    hub_radius: float = _number("A strip stops this far from a singular node.", "m", ge=0, le=5, default=0.02)
    slot_width: float | None = _number(
        "Width of the slots; 2 x thickness when not given.", "m", gt=0, le=1, default=None
    )

    @field_validator("sheet", mode="before")
    @classmethod
    def _positive(cls, value: Any) -> Any:
        if not isinstance(value, list | tuple) or len(value) != 2:
            raise ValueError("needs two numbers [length, width]")
        for x in value:
            if isinstance(x, bool) or not isinstance(x, int | float) or not 0 < x < 1000:
                raise ValueError(f"{x!r} is not a length between 0 and 1000 m")
        return float(value[0]), float(value[1])


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
        """The project with all defaults filled in, as TOML."""
        return tomli_w.dumps(self.model_dump(mode="json", exclude_none=True))


def project_schema() -> dict[str, Any]:
    """JSON schema (draft 2020-12) of the project file."""
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "$id": "lamella/project/1",
        "title": "lamella project file",
    } | Project.model_json_schema()


def read_project(path: Path) -> Project:
    """Read and check a project file.

    Raises
    ------
    InputError
        Whatever is wrong with it, with file, line and key.
    """
    try:
        if path.is_dir():
            raise InputError(f"{path} is a folder, not a project file", "name the .toml file inside it")
        if path.stat().st_size > MOST_BYTES:
            raise InputError(
                f"{path} has {path.stat().st_size / 1e6:.1f} MB (limit {MOST_BYTES / 1e6:g} MB)",
                "is it a project file?",
            )
        raw = path.read_bytes()
    except FileNotFoundError:
        raise InputError(
            f"{path}: no such file", "check the path, or write a starter project with: lamella new unduloid"
        ) from None
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error.strerror}", "check its permissions") from None
    try:
        text = raw.decode("utf-8-sig")
        values = tomllib.loads(text)
    except UnicodeDecodeError as error:
        raise InputError(
            f"not a text file in UTF-8 (byte {error.start})", "a project file is TOML text", str(path)
        ) from None
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"not valid TOML: {error}", "see `lamella new` for a project that is", str(path)) from None
    project = parse_project(values, source=str(path), text=text)
    return project if project.name else project.model_copy(update={"name": path.stem})


def parse_project(values: dict[str, Any], *, source: str = "", text: str = "") -> Project:
    """Check the values of a project given as nested dictionaries.

    Parameters
    ----------
    values : dict
        As a TOML reader gives them.
    source, text : str, optional
        File name and text, to say where an error is.

    Raises
    ------
    InputError
    """
    if not values:
        raise InputError("the project is empty", "write a starter project with: lamella new unduloid", source)
    try:
        project = Project.model_validate(values)
    except ValidationError as failure:
        errors = [_explain(error, values) for error in failure.errors()]
        where = [_where(source, text, key) for key, _, _ in errors]
        lines = [f"{w}: {message}" for w, (_, message, _) in zip(where, errors, strict=True)]
        remedies = dict.fromkeys(remedy for _, _, remedy in errors if remedy)
        raise InputError("\n".join(lines), "; ".join(remedies)) from None
    try:
        project.material()
    except InputError as error:
        raise InputError(error.message, error.remedy, _where(source, text, error.where)) from None
    return project


def located(error: InputError, path: Path) -> InputError:
    """The same error with the project file's name and line in front of its key."""
    return InputError(error.message, error.remedy, _where(str(path), path.read_text("utf-8-sig"), error.where))


def _where(source: str, text: str, key: str) -> str:
    line = _line_of(text, key)
    file = f"{source}:{line}" if source and line else source
    return ": ".join(part for part in (file, key) if part)


def _line_of(text: str, key: str) -> int:
    """Line of a dotted key in TOML text (0 when it is not there), for tables and plain keys as people write them."""
    parent, _, leaf = key.rpartition(".")
    table, best = "", 0
    for number, line in enumerate(text.splitlines(), 1):
        header = re.match(r"\s*\[+\s*([^\]]+?)\s*\]", line)
        if header:
            table = header[1].replace('"', "")
            if table == key:
                best = number
        elif table == parent and re.match(rf"""\s*["']?{re.escape(leaf)}["']?\s*=""", line):
            return number
    return best


def _fields(model: Any, path: list[str]) -> dict[str, Any]:
    """Fields of the table at a path of keys."""
    fields: dict[str, Any] = Project.model_fields
    for key in path:
        if key == "materials":
            return MaterialTable.model_fields if len(path) > 1 else {}
        if key == "surface":
            kind = model.get("surface", {}).get("kind")
            return SURFACE_TABLES[kind].model_fields if kind in SURFACE_TABLES else {}
        fields = fields[key].annotation.model_fields
    return fields


def _nearest(word: str, known: Any) -> str:
    near = get_close_matches(word, list(known), 1, 0.5)
    return f", did you mean {near[0]!r}?" if near else ""


_PLANNED = {"form-found", "mesh"}
_UMBILIC = {"sphere", "plane", "disc", "disk"}


def explain_kind(kind: object) -> tuple[str, str]:
    """Why a kind of surface cannot be used, and what can; ("", "") when it can."""
    kinds = ", ".join(SURFACE_TABLES)
    if kind in SURFACE_TABLES:
        return "", ""
    if kind is None:
        return "missing: which surface", f"add kind = one of {kinds}"
    if kind in _UMBILIC:
        message = (
            f"kind = {kind!r}: on a sphere or plane every point is umbilic (all directions bend alike), so no net of "
            "lamellas is singled out"
        )
    elif kind in _PLANNED:
        message = f"kind = {kind!r} is not part of this version yet"
    else:
        message = f"unknown kind {kind!r}" + _nearest(str(kind), SURFACE_TABLES)
    return message, f"choose one of {kinds}"


def _explain(error: ErrorDetails, values: dict[str, Any]) -> tuple[str, str, str]:
    """Key, message and remedy of a pydantic error."""
    kind, context = error["type"], error.get("ctx", {})
    if kind in ("union_tag_invalid", "union_tag_not_found") and isinstance(values["surface"], dict):
        return "surface.kind", *explain_kind(values["surface"].get("kind"))
    path = [str(part) for part in error["loc"]]
    if path[0] == "surface" and len(path) > 1:
        del path[1]  # the kind, which pydantic puts in
    key, leaf = ".".join(path), path[-1]
    parent = _fields(values, path[:-1])
    field = parent.get(leaf)
    extra = getattr(field, "json_schema_extra", None) or {}
    unit = f" {extra['unit']}" if extra.get("unit") else ""
    about = getattr(field, "description", None) or ""
    value = error["input"]
    shown = f"{value!r}" if not isinstance(value, dict) else "a table"
    if len(shown) > 80:
        shown = shown[:77] + "..."
    if kind == "missing" and key == "surface":
        return key, "missing: which surface the lamellas lie on", "add a table [surface] with kind = ..."
    if kind == "missing":
        return (
            key,
            "missing" + (f": {about}" if about else ""),
            f"add {leaf} =" + (f" ... (in{unit})" if unit else " ..."),
        )
    if kind == "extra_forbidden":
        known = list(parent)
        return key, "unknown key" + _nearest(leaf, known), f"known here: {', '.join(known)}"
    if kind in ("float_type", "int_type", "string_type", "int_from_float"):
        wanted = {"float_type": "a number", "string_type": "text in quotes"}.get(kind, "a whole number")
        return key, f"{shown} is not {wanted}", f"write {wanted}" + (f" in{unit}" if unit else "")
    if kind == "finite_number":
        return key, f"{shown} is not a finite number", f"write a number{' in' + unit if unit else ''}"
    for name, word in (("gt", "above"), ("ge", "at least"), ("lt", "below"), ("le", "at most")):
        if name in context:
            remedy = "lengths are in metres" if extra.get("unit") == "m" else about
            return key, f"{shown}{unit} is out of range: has to be {word} {context[name]:g}{unit}", remedy
    if kind == "literal_error":
        return key, f"{shown} is not one of {context['expected']}", ""
    if kind in ("model_type", "dict_type", "model_attributes_type", "union_tag_not_found"):
        return key, f"{shown} is not a table", f"write [{key}] and its keys below"
    message = str(context["error"]) if "error" in context else error["msg"]
    return key, message, ""
