"""Setting the variables of a study in the values of a project."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from lamella.base.errors import InputError
from lamella.base.wording import shown
from lamella.project.read import parse_project
from lamella.project.tables import FormFoundTable
from lamella.stages.surface.boundary_of_tables import adjustable_film, changed_table
from lamella.studies.tables import VariableTable
from lamella.surface.boundary.adjustable_film import AdjustableFilm
from lamella.surface.boundary.film_changes import curve_waved, placed, sized, tilted, waved
from lamella.surface.boundary.waves import wave_rows

AXES = {"x": 0, "y": 1, "z": 2}


def changed_values(
    values: Mapping[str, Any], variables: Sequence[VariableTable], chosen: Sequence[Any], folder: Path
) -> dict[str, Any]:
    """The values of a project with the variables of a study set.

    Parameters
    ----------
    values : mapping
        Of the project, as TOML holds them.
    variables : sequence of VariableTable
    chosen : sequence
        A value each. Freedoms of loops act on the loop as the project has it, after all keys are set, in the order of
        the variables.
    folder : Path
        Where the files that the project names are looked for.

    Raises
    ------
    InputError
        There is no such key or loop.
    """
    changed = copy.deepcopy(dict(values))
    for variable, value in zip(variables, chosen, strict=True):
        if variable.key is not None:
            set_value(changed, variable.key, value)
    freedoms = [(one, value) for one, value in zip(variables, chosen, strict=True) if one.freedom is not None]
    if freedoms:
        changed["surface"] = _with_freedoms(changed, freedoms, folder)
    return changed


def present_value(values: Mapping[str, Any], key: str) -> Any:
    """The value at a path of keys; None where there is none."""
    place: Any = values
    for name in key.split("."):
        if isinstance(place, list | tuple):
            number = _number_in(place, name)
            place = None if number is None else place[number]
        elif isinstance(place, Mapping):
            place = place.get(name)
        else:
            return None
    return place


def set_value(values: dict[str, Any], key: str, value: Any) -> None:
    """Set the value at a path of keys; tables that are not there are made, entries of lists are not.

    Raises
    ------
    InputError
    """
    place: Any = values
    names = key.split(".")
    for depth, name in enumerate(names):
        above = ".".join(names[:depth])
        if isinstance(place, list):
            number = _number_in(place, name)
            if number is None:
                raise InputError(
                    f"{key}: {above} has {len(place)} entries and none is {shown(name)}",
                    "write the number of an entry, from 0, or its name",
                    "variable.key",
                )
            where: Any = number
        elif isinstance(place, dict):
            where = name
        else:
            raise InputError(
                f"{key}: {above} is {shown(place)}, and has no {name}", "write a key of the project", "variable.key"
            )
        if depth == len(names) - 1:
            place[where] = value
        else:
            if isinstance(place, dict):
                place.setdefault(where, {})
            place = place[where]


def _number_in(entries: Sequence[Any], name: str) -> int | None:
    """The number of an entry of a list, by its number from 0 or by its name."""
    if name.isdigit():
        return int(name) if int(name) < len(entries) else None
    named = [k for k, entry in enumerate(entries) if isinstance(entry, Mapping) and entry.get("name") == name]
    return named[0] if named else None


def _with_freedoms(
    values: dict[str, Any], freedoms: Sequence[tuple[VariableTable, Any]], folder: Path
) -> dict[str, Any]:
    """[surface] with its loops changed."""
    table = parse_project(values).surface
    if not isinstance(table, FormFoundTable):
        raise InputError(
            f"a freedom of a loop needs a surface between boundary loops, and this one is of kind {table.kind!r}",
            'take a key instead, or kind = "form-found"',
            "variable.loop",
        )
    # loops are turned and sized about their middle: a curve of a file has to be read for its waves only
    film = adjustable_film(table, folder)
    for variable, value in freedoms:
        names = (variable.loop,) if isinstance(variable.loop, str) else variable.loop or ()
        for name in names:
            film = _changed(film, _loop(film, name), variable, float(value))
    changed = changed_table(table, film).model_dump(mode="json", exclude_none=True)
    # what was not written stays so: defaults of the table are made anew
    return {key: value for key, value in changed.items() if key in values["surface"]}


def _loop(film: AdjustableFilm, name: str) -> int:
    for number, curve in enumerate(film.curves):
        if name == curve.name or name == str(number):
            if curve.slides:
                raise InputError(f"the loop {name!r} slides and cannot be placed", "vary another", "variable.loop")
            return number
    known = ", ".join(repr(curve.name) for curve in film.curves)
    raise InputError(f"there is no loop {shown(name)}", f"choose one of {known}, or a number from 0", "variable.loop")


def _changed(film: AdjustableFilm, index: int, variable: VariableTable, value: float) -> AdjustableFilm:
    """The film with one loop changed."""
    along = np.zeros(3)
    along[AXES[variable.axis]] = 1.0
    if variable.freedom == "move":
        return placed(index)(film, value * along)
    if variable.freedom == "scale":
        return sized(index)(film, np.array([value - 1.0]))
    if variable.freedom == "tilt":
        return tilted(index)(film, np.radians(value) * along)
    number = 2 * (variable.wave - 1) + (1 if variable.phase == "cos" else 2)
    curve = film.curves[index]
    if curve.circle is not None:
        raise InputError(
            f"the loop {curve.name!r} is a circle, which has no waves",
            "give it by points, or move, scale or tilt it",
            "variable.freedom",
        )
    if curve.points is not None:
        rows = wave_rows(np.arange(len(curve.points)) / len(curve.points), variable.wave)[number : number + 1]
        return waved(index, rows)(film, value * along)
    shifts = np.zeros((9, 3))
    shifts[number] = value * along
    return curve_waved(index, 0)(film, shifts.ravel())
