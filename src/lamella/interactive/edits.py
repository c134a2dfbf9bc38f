"""What a designer does, as changes of the project's text."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from lamella.base.errors import InputError
from lamella.interactive.handles import Handle, decimals_of, handles_of
from lamella.project.read import project_of_text, toml_values
from lamella.project.tables import FormFoundTable, Project
from lamella.project.text_edits import with_item, with_table, with_values, without_item, without_key, without_table
from lamella.project.text_places import Path as KeyPath

BOUNDARY = "surface.boundary"
LEAST_POINTS = 3
# shapes that a loop of points does not have
OTHER_SHAPES = ("circle", "file", "layer", "id", "place", "corner_radius", "part")


@dataclass(frozen=True)
class Design:
    """A project with its text, and what can be dragged of it."""

    text: str
    values: Mapping[str, Any]
    project: Project
    handles: tuple[Handle, ...]

    @classmethod
    def of(cls, text: str, file: Path) -> Design:
        """Of a text that is to be a file's.

        Raises
        ------
        InputError
            What is wrong with it.
        """
        project = project_of_text(text, file)
        values = toml_values(text, str(file))
        return cls(text, values, project, tuple(handles_of(project, values, file.parent)))

    @property
    def decimals(self) -> int:
        """Of coordinates in m."""
        return decimals_of(self.handles)


def edited(design: Design, edit: Mapping[str, Any]) -> str:
    """The text after an edit.

    Parameters
    ----------
    design : Design
    edit : mapping
        "do" names one of `EDITS`; what else it needs is beside it.

    Raises
    ------
    InputError
        The edit is none, or cannot be.
    """
    name = edit.get("do")
    if not isinstance(name, str) or name not in EDITS:
        raise InputError(f"unknown edit {str(name)[:40]!r}", f"choose one of {', '.join(EDITS)}", "do")
    try:
        return EDITS[name](design, edit)
    except (KeyError, IndexError, TypeError, AttributeError) as error:
        raise InputError(
            f"the edit {name!r} lacks something: {type(error).__name__} {str(error)[:80]}", "see docs/studio.md", "do"
        ) from None


def _move(design: Design, edit: Mapping[str, Any]) -> str:
    """Handles to other places: {"handles": {id: [x, y, z]}}, m."""
    by_id = {handle.id: handle for handle in design.handles}
    values: dict[KeyPath, Any] = {}
    for name, to in edit["handles"].items():
        if name not in by_id:
            raise InputError(f"there is no handle {str(name)[:40]!r}", "load the page anew", "handles")
        values |= by_id[name].values(_point(to), design.decimals)
    return with_values(design.text, values)


def _set(design: Design, edit: Mapping[str, Any]) -> str:
    """Values of keys: {"values": [[path, value], ...]}; null takes the key out."""
    text, given = design.text, [(tuple(path), value) for path, value in edit["values"]]
    for path, value in given:
        if not path or not all(isinstance(key, str | int) for key in path):
            raise InputError(f"{path!r} is no path of keys", "give a list of keys", "values")
        if value is None:
            text = without_key(text, path)
    return with_values(text, {path: value for path, value in given if value is not None})


def _insert(design: Design, edit: Mapping[str, Any]) -> str:
    """A point on a loop behind another one: {"loop": k, "after": i}."""
    loop, after = _points_of(design, edit["loop"]), int(edit["after"])
    points, count = np.array(loop.points), len(loop.points)
    # of the cubic through four neighbours; of a polyline the middle of the side
    weights = (-1, 9, 9, -1) if loop.interpolation == "spline" and count > LEAST_POINTS else (0, 8, 8, 0)
    middle = sum(w / 16 * points[(after + j) % count] for w, j in zip(weights, (-1, 0, 1, 2), strict=True))
    handle = next(one for one in design.handles if one.id == f"{edit['loop']}.points.{after % count}")
    (value,) = handle.values(middle.tolist(), design.decimals).values()
    return with_item(design.text, handle.paths[0][:-1], after % count + 1, value)


def _delete(design: Design, edit: Mapping[str, Any]) -> str:
    """A point of a loop goes: {"loop": k, "index": i}."""
    loop = _points_of(design, edit["loop"])
    if len(loop.points) <= LEAST_POINTS:
        raise InputError(f"{loop.name!r} has {len(loop.points)} points: at least {LEAST_POINTS} are needed", "keep it")
    return without_item(design.text, (*BOUNDARY.split("."), int(edit["loop"]), "points"), int(edit["index"]))


def _shift(design: Design, edit: Mapping[str, Any]) -> str:
    """A whole loop: {"loop": k, "by": [x, y, z]}, m."""
    by = np.array(_point(edit["by"]))
    moved = [one for one in design.handles if one.loop == edit["loop"] and one.kind in ("point", "center", "shift")]
    values: dict[KeyPath, Any] = {}
    for handle in moved:
        values |= handle.values((np.array(handle.at) + by).tolist(), design.decimals)
    return with_values(design.text, values)


def _add_hole(design: Design, edit: Mapping[str, Any]) -> str:
    """A circle as one more hole: {"center": [x, y, z], "radius": r}, m; level where no normal is given."""
    _form_found(design)
    circle = {
        "center": [round(x, design.decimals) for x in _point(edit["center"])],
        "radius": round(float(edit["radius"]), design.decimals),
    }
    if edit.get("normal"):
        circle["normal"] = list(_point(edit["normal"]))
    return with_table(design.text, BOUNDARY, {"circle": circle})


def _remove_loop(design: Design, edit: Mapping[str, Any]) -> str:
    """A hole goes: {"loop": k}."""
    table, loop = _form_found(design), int(edit["loop"])
    if not 0 < loop < len(table.boundary):
        raise InputError("the outer loop bounds the surface", "change it, or take out a hole", BOUNDARY)
    return without_table(design.text, BOUNDARY, loop)


def _sketch(design: Design, edit: Mapping[str, Any]) -> str:
    """A loop drawn point by point: {"points": [...], "as": "outer" or "hole"}, m."""
    _form_found(design)
    points = [[round(x, design.decimals) + 0.0 for x in _point(point)] for point in edit["points"]]
    if len(points) < LEAST_POINTS:
        raise InputError(f"{len(points)} points: at least {LEAST_POINTS} are needed", "click some more", "points")
    shape = {"interpolation": "polyline"} if edit.get("interpolation") == "polyline" else {}
    if edit.get("as") == "hole":
        return with_table(design.text, BOUNDARY, {"points": points, **shape})
    base: KeyPath = (*BOUNDARY.split("."), 0)
    text = design.text
    for key in (*OTHER_SHAPES, "unit", "interpolation"):
        text = without_key(text, (*base, key))
    text = without_key(text, (*base, "points"))
    return with_values(text, {(*base, "points"): points, **{(*base, key): value for key, value in shape.items()}})


EDITS: dict[str, Callable[[Design, Mapping[str, Any]], str]] = {
    "move": _move,
    "set": _set,
    "insert_point": _insert,
    "delete_point": _delete,
    "shift": _shift,
    "add_hole": _add_hole,
    "remove_loop": _remove_loop,
    "sketch": _sketch,
}
"""By the name that the page gives."""


def _point(value: Any) -> Sequence[float]:
    if not (isinstance(value, list | tuple) and len(value) == 3):
        raise InputError(f"{str(value)[:60]} is no point", "give three numbers in m")
    point = [float(x) for x in value]
    if not all(map(math.isfinite, point)):
        raise InputError(f"{str(value)[:60]} is no point", "give three finite numbers in m")
    return point


def _form_found(design: Design) -> FormFoundTable:
    if not isinstance(design.project.surface, FormFoundTable):
        raise InputError(
            f'a surface of kind = "{design.project.surface.kind}" has no boundary curves',
            'write kind = "form-found"',
            "surface.kind",
        )
    return design.project.surface


def _points_of(design: Design, number: Any) -> Any:
    loop = _form_found(design).boundary[int(number)]
    if loop.points is None:
        raise InputError(f"{loop.name!r} is no curve through points", "draw it through points", BOUNDARY)
    return loop
