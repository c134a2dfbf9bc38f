"""What is wrong with the values of a project, in words: the key, the value, the limit and the remedy."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches
from typing import Any, get_args

from pydantic_core import ErrorDetails

from lamella.base.number_lists import Refusal
from lamella.base.wording import cut, shown
from lamella.project.list_tables import LIST_TABLES
from lamella.project.tables import (
    FURTHER_TABLES,
    SURFACE_TABLES,
    BoundaryTable,
    MaterialTable,
    Project,
    Table,
)


def _fields(values: dict[str, Any], path: list[str], model: type[Table]) -> dict[str, Any]:
    """Fields of the table at a path of keys; indices of lists are part of their keys: boundary[1]."""
    fields: dict[str, Any] = model.model_fields
    for key in path:
        name = key.partition("[")[0]
        if name == "materials":
            return MaterialTable.model_fields if len(path) > 1 else {}
        if name == "surface":
            kind = values.get("surface", {}).get("kind")
            fields = SURFACE_TABLES[kind].model_fields if kind in SURFACE_TABLES else {}
            continue
        table = _model_of(fields[name].annotation) if name in fields else None
        if table is None:
            return {}
        fields = table.model_fields
    return fields


def _model_of(annotation: Any) -> type[Table] | None:
    """The table an annotation stands for, in lists and options too."""
    if isinstance(annotation, type) and issubclass(annotation, Table):
        return annotation
    return next(filter(None, map(_model_of, get_args(annotation))), None)


def _keys(path: Iterable[int | str]) -> list[str]:
    """Keys of a path, each with its index in a list: boundary[1]."""
    keys: list[str] = []
    for part in path:
        if isinstance(part, int) and keys:
            keys[-1] += f"[{part}]"
        else:
            keys.append(str(part))
    return keys


def _nearest(word: str, known: Any) -> str:
    """The nearest known word, whatever its case and hyphens; "" where none is near."""
    by_plain = {name.lower(): name for name in known}
    near = get_close_matches(word[:100].lower().replace("-", "_"), by_plain, 1, 0.5)
    return by_plain[near[0]] if near else ""


def _meant(near: str) -> str:
    return f", did you mean {near!r}?" if near else ""


_UMBILIC = {"sphere", "plane", "disc", "disk"}


def explain_kind(kind: object) -> tuple[str, str]:
    """Why a kind of surface cannot be used, and what can; ("", "") when it can."""
    kinds = ", ".join(SURFACE_TABLES)
    if kind is None:
        return "missing: which surface", f"add kind = one of {kinds}"
    if not isinstance(kind, str):
        return f"{shown(kind)} is not text in quotes", f"choose one of {kinds}"
    if kind in SURFACE_TABLES:
        return "", ""
    if kind.lower() in _UMBILIC:
        message = (
            f"kind = {kind!r}: on a sphere or plane every point is umbilic (all directions bend alike), so no net of "
            "lamellas is singled out"
        )
    else:
        message = f"unknown kind {shown(kind)}" + _meant(_nearest(kind, SURFACE_TABLES))
    return message, f"choose one of {kinds}"


Reported = tuple[str, str, str]


def reported_once(errors: list[Reported]) -> list[Reported]:
    """Errors without those that follow from a misspelt key: the key it was meant to be is not missing as well."""
    meant = {
        f"{key.rpartition('.')[0]}.{message.split(chr(39))[1]}".lstrip(".")
        for key, message, _ in errors
        if message.startswith("unknown key, did you mean")
    }
    return [error for error in errors if not (error[0] in meant and error[1].startswith("missing"))]


def _unknown(leaf: str, parent: dict[str, Any], at_top: bool) -> tuple[str, str]:
    """Message and remedy of an unknown key: misspelt, or in another table than its own."""
    known = ", ".join(parent)
    near = _nearest(leaf, parent)
    if leaf in Project.model_fields and not at_top:
        return "unknown key in this table", f"write {leaf} above all [tables]; keys of this table: {known}"
    if leaf in BoundaryTable.model_fields and _model_of(getattr(parent.get("boundary"), "annotation", None)):
        return "unknown key here: it belongs in a table [[surface.boundary]]", "move it below [[surface.boundary]]"
    homes = [name for name, model in FURTHER_TABLES.items() if leaf in model.model_fields]
    if homes:
        return f"unknown key here: it belongs in the table [{homes[0]}]", f"move it below [{homes[0]}]"
    lists = [name for name, model in LIST_TABLES.items() if leaf in model.model_fields]
    if lists:
        return f"unknown key here: it belongs in a table [[{lists[0]}]]", f"move it below [[{lists[0]}]]"
    if near:
        return "unknown key" + _meant(near), f"write {near}; keys here: {known}"
    return "unknown key", f"keys here: {known}"


def _range(field: Any, unit: str) -> str:
    """The limits of a number, as "from 3 to 10 m"."""
    words = []
    for limit in field.metadata:
        for name, word in (("gt", "above"), ("ge", "at least"), ("lt", "below"), ("le", "at most")):
            if getattr(limit, name, None) is not None:
                words.append(f"{word} {getattr(limit, name):.10g}")
    return " and ".join(words) + unit


def explain(error: ErrorDetails, values: dict[str, Any], model: type[Table] = Project) -> Reported:
    """Key, message and remedy of a pydantic error in the values of a project, or of the file of another model."""
    kind, context = error["type"], error.get("ctx", {})
    if kind in ("union_tag_invalid", "union_tag_not_found") and isinstance(values["surface"], dict):
        return "surface.kind", *explain_kind(values["surface"].get("kind"))
    place = list(error["loc"])
    if len(place) > 1 and place[0] == "surface":
        del place[1]  # the kind, which pydantic puts in
    path = _keys(place)
    refusal = context.get("error")
    if isinstance(refusal, Refusal):
        # one about several tables has no place of its own
        return ".".join([*path, refusal.key] if refusal.key else path), str(refusal), refusal.remedy
    key, leaf = ".".join(path), path[-1]
    parent = _fields(values, path[:-1], model)
    field = parent.get(leaf)
    extra = getattr(field, "json_schema_extra", None) or {}
    unit = f" {extra['unit']}" if extra.get("unit") else ""
    about = (getattr(field, "description", None) or "").rstrip(".")
    value = error["input"]
    reported = shown(value)
    if kind == "missing" and key == "surface":
        return key, "missing: which surface the lamellas lie on", "add a table [surface] with kind = ..."
    if kind == "missing" and leaf == "boundary":
        return key, f"missing: {about}", f"add a table [[{key}]] with points, circle, file or part"
    if kind == "missing":
        example = f"{leaf} = {shown(field.examples[0]) if field and field.examples else '...'}"
        return key, f"missing: {about}", f"add {example}" + (f" (in{unit})" if unit else "")
    if kind == "extra_forbidden" and model is not Project:
        return key, "unknown key" + _meant(_nearest(leaf, parent)), f"keys here: {', '.join(parent)}"
    if kind == "extra_forbidden":
        return key, *_unknown(leaf, parent, len(path) == 1)
    if kind == "float_type" and isinstance(value, int) and not isinstance(value, bool):
        return key, f"{reported} is out of range", f"lower {leaf}"
    if kind in ("float_type", "int_type", "string_type", "int_from_float"):
        wanted = {"float_type": "a number", "string_type": "text in quotes"}.get(kind, "a whole number")
        remedy = f"write {wanted}" + (f" in{unit}" if unit else "")
        if isinstance(value, str) and kind != "string_type":
            remedy += ", without quotes or unit"
        return key, f"{reported} is not {wanted}", remedy
    if kind == "finite_number":
        return key, f"{reported} is not a finite number", f"write a number{' in' + unit if unit else ''}"
    if kind == "string_too_long":
        limit = context["max_length"]
        return key, f"{len(value)} characters are too many (limit {limit})", f"shorten it to {limit} characters"
    if {"gt", "ge"} & set(context):
        return key, f"{reported}{unit} is out of range: has to be {_range(field, unit)}", f"raise {leaf}"
    if {"lt", "le"} & set(context):
        remedy = f"lower {leaf}" + ("; lengths are in metres, not millimetres" if unit == " m" else "")
        return key, f"{reported}{unit} is out of range: has to be {_range(field, unit)}", remedy
    if kind == "literal_error":
        return key, f"{reported} is not one of {context['expected']}", f"choose one of {context['expected']}"
    if kind in ("model_type", "dict_type", "model_attributes_type", "union_tag_not_found"):
        inside, below = f"{cut(leaf)} = {{...}} with its keys inside", f"[{cut(key)}] and its keys below"
        return key, f"{reported} is not a table", f"write {inside if '[' in key else below}"
    where = f"[{path[0]}] in `lamella new`" if model is Project else f"{path[0]} in the documentation"
    return key, cut(error["msg"], 200), f"see the keys of {where}"
