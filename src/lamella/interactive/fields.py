"""Numbers and choices of a project that have a slider or a list on the page, with the schema's help and limits."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Literal, get_args, get_origin

from pydantic.fields import FieldInfo

from lamella.interactive.handles import Handle
from lamella.project.tables import (
    FURTHER_TABLES,
    LIST_TABLES,
    SURFACE_TABLES,
    BoundaryTable,
    FormFoundTable,
    Project,
    Table,
)

Field = dict[str, Any]

# of the tables [network] and [lamella]
NETWORK = ("closing", "kind", "minimum_length", "angle")
LAMELLA = ("height", "thickness", "layers", "offset", "marks", "layer_curves", "layer_lengths")
# of a form-found surface or a mesh
FOUND = ("tolerance",)
# a slider reaches from the value over this to the value times it
SLIDER_REACH = 3.0


def fields_of(project: Project, values: Mapping[str, Any], handles: tuple[Handle, ...], size: float) -> list[Field]:
    """The fields of a project.

    Parameters
    ----------
    project : Project
    values : mapping
        As they are written.
    handles : tuple of Handle
    size : float
        Of the surface, m.

    Returns
    -------
    list of dict
        "group", "path", "label", "kind" ("number", "integer" or "choice"), "value", "unit", "help"; numbers with "min",
        "max" of a slider; choices with "choices". "without" are keys that are taken out when it is set; a "shift" is
        not a key but the height of a whole loop.
    """
    return [
        *_surface(project, size),
        *_heights(project, handles, size),
        *_network(project),
        *_lamella(project),
    ]


def _surface(project: Project, size: float) -> Iterator[Field]:
    table = project.surface
    model = type(table)
    if isinstance(table, FormFoundTable):
        curvature, volume = table.mean_curvature, table.volume
        path = ["surface", "mean_curvature"]
        if table.normal_curvature is not None:
            path = ["surface", "normal_curvature"]
            curvature = table.normal_curvature
        if volume is None:
            reach = max(4 / size, 2 * abs(curvature or 0.0))
            label = path[-1].replace("_", " ").capitalize()
            yield _number(model, path, label, curvature or 0.0, (-reach, reach))
        else:
            reach = 3 * abs(volume) or size**3
            yield _number(model, ["surface", "volume"], "Volume", volume, (-reach, reach))
    names = FOUND if project.surface.kind in ("form-found", "mesh") else tuple(model.model_fields)
    for name in names:
        value = getattr(table, name)
        label = name.replace("_", " ").capitalize()
        if isinstance(value, tuple):
            for k, (one, end) in enumerate(zip(value, ("from", "to"), strict=False)):
                reach = max(abs(one), 1.0)
                field = _number(model, ["surface", name], f"{label} {end}", one, (one - 2 * reach, one + 2 * reach))
                yield field | {"path": ["surface", name, k]}
        elif isinstance(value, int | float) and not isinstance(value, bool):
            yield _number(model, ["surface", name], label, value)


def _heights(project: Project, handles: tuple[Handle, ...], size: float) -> Iterator[Field]:
    """Height and radius of each loop."""
    for k, loop in enumerate(getattr(project.surface, "boundary", ())):
        own = [handle for handle in handles if handle.loop == k and handle.kind in ("point", "center", "shift")]
        if not own:
            continue
        height = sum(handle.at[2] for handle in own) / len(own)
        yield {
            "group": "Boundary",
            "path": ["surface", "boundary", k],
            "shift": k,
            "label": f"Height of {loop.name}",
            "kind": "number",
            "value": height,
            "unit": "m",
            "help": "Moves the whole loop up or down.",
            "min": height - size / 2,
            "max": height + size / 2,
        }
        radius = next((handle for handle in handles if handle.id == f"{k}.circle.radius"), None)
        if radius is not None and loop.circle is not None:
            value = loop.circle.radius / radius.metres
            field = _number(type(loop.circle), ["surface", "boundary"], f"Radius of {loop.name}", value, key="radius")
            yield field | {"group": "Boundary", "path": ["surface", "boundary", k, "circle", "radius"]}


def _network(project: Project) -> Iterator[Field]:
    table = project.network
    model = type(table)
    if table.spacing is None:
        field = _number(model, ["network", "cells"], "Cells", table.cells or 0, (3, 3 * max(table.cells or 0, 8)))
        yield field | {"without": [["network", "spacing"]], "kind": "integer"}
    else:
        field = _number(model, ["network", "spacing"], "Spacing", table.spacing)
        yield field | {"without": [["network", "cells"]]}
    yield from _some(model, "network", table, NETWORK)


def _lamella(project: Project) -> Iterator[Field]:
    table = project.lamella
    yield from _some(type(table), "lamella", table, LAMELLA)
    info = type(table).model_fields["material"]
    yield {
        "group": "Lamella",
        "path": ["lamella", "material"],
        "label": "Material",
        "kind": "choice",
        "value": table.material,
        "unit": "",
        "help": info.description,
        "choices": sorted(project.known_materials()),
    }


def _some(model: type[Table], name: str, table: Any, keys: tuple[str, ...]) -> Iterator[Field]:
    for key in keys:
        value, label = getattr(table, key), key.replace("_", " ").capitalize()
        choices = _choices(model.model_fields[key])
        if choices:
            yield {
                "group": name.capitalize(),
                "path": [name, key],
                "label": label,
                "kind": "choice",
                "value": value,
                "unit": "",
                "help": model.model_fields[key].description,
                "choices": choices,
            }
        else:
            yield _number(model, [name, key], label, value)


def _choices(info: FieldInfo) -> list[str]:
    return list(get_args(info.annotation)) if get_origin(info.annotation) is Literal else []


def _number(
    model: type[Table],
    path: list[str],
    label: str,
    value: float,
    reach: tuple[float, float] | None = None,
    key: str | None = None,
) -> Field:
    info = model.model_fields[key or path[-1]]
    low, high = reach or (value / SLIDER_REACH, value * SLIDER_REACH)
    for limit in info.metadata:
        low = max([low, *(getattr(limit, name) for name in ("ge", "gt") if getattr(limit, name, None) is not None)])
        high = min([high, *(getattr(limit, name) for name in ("le", "lt") if getattr(limit, name, None) is not None)])
    is_whole = info.annotation is int or isinstance(value, int)
    return {
        "group": path[0].capitalize(),
        "path": path,
        "label": label,
        "kind": "integer" if is_whole else "number",
        "value": value,
        "unit": _unit(info),
        "help": info.description,
        "min": low,
        "max": high,
    }


def _unit(info: FieldInfo) -> str:
    extra = info.json_schema_extra
    return str(extra.get("unit", "")) if isinstance(extra, dict) else ""


def key_help(kind: str) -> dict[str, dict[str, str]]:
    """Help on every key of a project with a kind of surface: "network.cells" to its meaning and unit."""
    found: dict[str, dict[str, str]] = {}
    _collect(found, "", Project)
    if kind in SURFACE_TABLES:
        _collect(found, "surface.", SURFACE_TABLES[kind])
        if kind == "form-found":
            _collect(found, "surface.boundary.", BoundaryTable)
    for name, model in {**FURTHER_TABLES, **LIST_TABLES}.items():
        _collect(found, f"{name}.", model)
    return found


def _collect(found: dict[str, dict[str, str]], prefix: str, model: type[Table]) -> None:
    for name, info in model.model_fields.items():
        found[prefix + name] = {"help": (info.description or "").split("\n")[0], "unit": _unit(info)}
        for inner in (info.annotation, *get_args(info.annotation)):
            if isinstance(inner, type) and issubclass(inner, Table) and prefix.count(".") < 3:
                _collect(found, f"{prefix}{name}.", inner)
