"""A commented project file to start from, generated from the schema."""

from __future__ import annotations

import math
import textwrap
from typing import Any

import tomli_w
from pydantic import BaseModel
from pydantic.fields import FieldInfo

from lamella.project.tables import FURTHER_TABLES, SURFACE_TABLES, Project
from lamella.project.text_edits import written

# the film between a saddle-shaped rim of 12 x 9 m and a ring
_BOUNDARY = """\
# Closed boundary curves: the outer loop, then the holes. Each has points, a circle, a file or parts.
[[surface.boundary]]
name = "outer"
points = [ # [m] splined; the first is not repeated
{points}
]
#   interpolation = "spline" # or "polyline"
#   corner_radius = 0.4 # [m] of the fillets at a polyline's corners

[[surface.boundary]]
name = "oculus"
circle = {{center = [0.0, 0.0, 2.0], radius = 1.3}} # [m]
#   file = "curves.3dm" # or .dxf, .json, instead of points or circle, with
#   layer = "boundary"
#   id = "oculus"
#   unit = "mm" # when the file does not say
#   place = {{shift = [0.0, 0.0, 1.0], scale = 1.0, turn = [0.0, 0.0, 0.0]}} # [m], [degrees]: the file's curve, moved
#   adjust = {{move = 0.3, scale = 0.1, tilt = 5}} # at most [m], share, [degrees], for network.closing = "adjust"
#   slide = {{point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0]}} # free to slide on a plane, or with {{direction = ..}}
# A loop of several parts has a table [[surface.boundary.part]] for each, with points or arc, and slide."""


def _boundary() -> str:
    turns = [2 * math.pi * k / 24 for k in range(24)]
    points = [(6 * math.cos(t), 4.5 * math.sin(t), 2.5 - 2.5 * math.cos(2 * t)) for t in turns]
    # + 0.0 makes a zero of a negative one
    rows = [f"  [{', '.join(f'{round(x, 4) + 0.0}' for x in point)}]," for point in points]
    return _BOUNDARY.format(points="\n".join(rows))


# keys that come with a value of their own in a new project: one layer, as a pair asks for choices of its own, and a
# strip that is not overstressed in it
_ACTIVE: dict[str, Any] = {
    "network.cells": 24,
    "lamella.height": 0.08,
    "lamella.thickness": 0.001,
    "lamella.layers": 1,
}
_NO_BREAK = "\N{NO-BREAK SPACE}"

# with 24 cells nodes of these come within millimetres of the rim, or strips meet beyond it
_OWN: dict[str, dict[str, Any]] = {"unduloid": {"network.cells": 25}, "mesh": {"network.cells": 16}}


def _key(table: str, name: str, field: FieldInfo, active: dict[str, Any], plain: dict[str, Any]) -> str:
    extra = field.json_schema_extra
    unit = str(extra.get("unit", "")) if isinstance(extra, dict) else ""
    lines = _comment((field.description or "") + (f" [{unit}]" if unit else ""), unit)
    required = field.is_required()
    # a commented key stands at its default; what has none shows an example
    shown = required or field.default is None or name == "scale"
    value: Any = field.examples[0] if field.examples and shown else field.default
    value = active.get(f"{table}.{name}", value)
    if value is None:
        return "\n".join([*lines, f"# {name} ="])
    if isinstance(value, BaseModel) and isinstance(plain.get(name), str):
        # a table that a word stands for
        value = plain[name]
    if isinstance(value, BaseModel):
        return "\n".join([*lines, f"# {name} = {written(value.model_dump(exclude_none=True))}"])
    line = f"{name} = {written(value)}"
    plainly = required or f"{table}.{name}" in active or (bool(field.examples) and name == "scale")
    return "\n".join([*lines, line if plainly else f"# {line}"])


def _comment(text: str, unit: str = "") -> list[str]:
    """A text as lines of a comment; a unit at its end stays beside the word before it."""
    words = " ".join(text.split())
    if unit:
        own = unit.replace(" ", _NO_BREAK)
        words = words.removesuffix(f" [{unit}]") + f"{_NO_BREAK}[{own}]"
    lines = textwrap.wrap(words, 98, initial_indent="# ", subsequent_indent="# ")
    return [line.replace(_NO_BREAK, " ") for line in lines]


def _table(name: str, model: type[BaseModel], active: dict[str, Any], skip: frozenset[str] = frozenset()) -> str:
    plain = model.model_construct().model_dump(mode="json", warnings=False)
    keys = [_key(name, key, field, active, plain) for key, field in model.model_fields.items() if key not in skip]
    about = _comment(model.__doc__ or "")
    field = Project.model_fields[name]
    # a table that changes what is made by being there stands as a comment
    header = f"# [{name}]" if field.default is None and not field.is_required() else f"[{name}]"
    return "\n".join([*about, header, *keys])


_STOCK = """\
# What strips and plates are cut from, instead of fabrication.sheet; there may be several of these tables.
# [[stock]]
#   kind = "bar" # of the strips' own section; "sheet" and "coil" for plates and curved strips too
#   length = 6.0 # [m] of a bar or coil
#   width = 0.1 # [m] of a coil
#   size = [3.0, 1.5] # [m] of a sheet
#   thickness = 0.0015 # [m] of every thickness when not given
#   material = "1.4301" # of every material when not given
#   price = 120.0 # of one piece, for all stock or for none
#   weight = 53.3 # [kg] of one piece"""


_ACTIONS = """\
# What holds it and what acts on it; each of these tables may be there several times.
# [[support]]
#   boundary = "rim" # or the name of a curve; or ground, or near
#   ground = 0.0 # [m] nodes below this height, up to
#   tolerance = 0.01 # [m] above it
#   near = [0.0, 0.0, 0.0] # [m] the nearest node, or all
#   radius = 1.0 # [m] around it
#   fixed = ["x", "y", "z"] # and "rx", "ry", "rz"
#   spring = {z = 1e6} # [N/m], [N m/rad]

# [[load]]
#   name = "snow"
#   kind = "area" # or "self_weight", "line", "point", "temperature", "settlement"
#   category = "snow" # or "permanent", "wind", "H", ... for combinations of EN 1990
#   value = 500 # [N/m2], [N/m], [N], [K], [m] by kind
#   direction = [0.0, 0.0, -1.0] # or "normal": a pressure
#   per = "plan" # or "true": area as seen along the direction, or of the surface
#   coefficient = 0.8 # outside all tables [[load.region]] with their coefficients
#   region = [{coefficient = -0.5, facing = [1.0, 0.0, 0.0]}] # or near and radius, low and high [m]
#   psi = [0.5, 0.2, 0.0] # where they are not those of EN 1990
#   group = "snow" # loads of one group never act together
# Line loads have a boundary, point loads a place near and a moment = [0.0, 0.0, 0.0] [N m], settlements a place:
#   boundary = "rim" # or ground with tolerance [m], or near with radius [m]
#   ground = 0.0
#   tolerance = 0.01
#   near = [0.0, 0.0, 0.0]
#   radius = 1.0
#   moment = [0.0, 0.0, 0.0]

# [[combination]]
#   name = "snow full"
#   factors = {snow = 1.5}"""


def starter(kind: str, name: str, mesh: str = "surface.obj") -> str:
    """A project file for a kind of surface; keys with a default are there as comments.

    Parameters
    ----------
    kind : str
        One of `lamella.project.tables.SURFACE_TABLES`.
    name : str
        Name of the project.
    mesh : str
        File of the mesh, where the surface is one.
    """
    model = SURFACE_TABLES[kind]
    active = _ACTIVE | _OWN.get(kind, {}) | ({"surface.file": mesh} if kind == "mesh" else {})
    surface = _table("surface", model, active, frozenset({"kind", "boundary"}))
    surface = surface.replace("[surface]", f'[surface]\nkind = "{kind}"', 1)
    if kind == "form-found":
        surface += f"\n\n{_boundary()}"
    parts = [
        "# A lamella project. Lengths in metres, angles in degrees, stresses in Pa.\n"
        f"# Run it with:  lamella run FILE\n{tomli_w.dumps({'name': name}).strip()}",
        surface,
        *(_table(name, model, active) for name, model in FURTHER_TABLES.items()),
        _STOCK,
        _ACTIONS,
        "# A material of your own (SI units), named in lamella.material:\n"
        '# [materials."my steel"]\n# density = 7850\n# youngs_modulus = 210e9\n# shear_modulus = 81e9\n'
        "# strength = 420e6",
    ]
    return "\n\n".join(parts) + "\n"


def starter_mesh() -> str:
    """A mesh to start from, as .obj in metres: 12 x 8 quads of half a catenoid with a neck of 2 m."""
    around, along = 13, 9
    rows = []
    for k in range(along):
        z = -1.8 + 3.6 * k / (along - 1)
        radius = 2.0 * math.cosh(z / 2.0)
        turns = (math.pi * j / (around - 1) for j in range(around))
        rows += [f"v {radius * math.cos(t):.6f} {radius * math.sin(t):.6f} {z:.6f}" for t in turns]
    corners = (1 + k * around + j for k in range(along - 1) for j in range(around - 1))
    faces = [f"f {one} {one + 1} {one + around + 1} {one + around}" for one in corners]
    return "\n".join(["# half a catenoid, metres", *rows, *faces]) + "\n"
