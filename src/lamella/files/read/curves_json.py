"""Closed curves from a JSON file, by name.

The format (docs/files.md has it too)::

    {"unit": "mm",
     "curves": {"outer": {"points": [[0, 0, 0], [4000, 0, 1000], [4000, 4000, 0], [0, 4000, 1000]],
                          "interpolation": "polyline"},
                "oculus": {"points": [[1500, 1500, 900], [2500, 1500, 900], [2000, 2500, 900]]}}}

`unit` is one of m, mm, cm, dm, ft, in; without it the project has to give `unit`. Each curve is closed, its first point
not repeated (a last point that repeats it is left out). `interpolation` is "spline" (when not given: quintic through 7
points and more, cubic through fewer) or "polyline", whose corners are kept. A project names a curve by ``id``; one
alone needs no name. Other keys are errors.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import orjson

from lamella.base.byte_order import unmarked
from lamella.base.errors import InputError
from lamella.base.number_lists import Refusal, read_points
from lamella.base.units import METRES, PROJECT_UNITS
from lamella.base.wording import cut, shown
from lamella.files.read.file_curves import CurveFile, FileCurve
from lamella.surface.boundary.pieces import lines
from lamella.surface.boundary.point_list import clean_points
from lamella.surface.boundary.splines import closed_spline

_REMEDY = 'write {"unit": "m", "curves": {"NAME": {"points": [[x, y, z], ...]}}}'


def read_json(path: Path, where: str) -> CurveFile:
    """Closed curves by name, and metres per unit (None: not given).

    Raises
    ------
    InputError
        Anything that is not as above, with the curve's name.
    """
    try:
        content = orjson.loads(unmarked(path.read_bytes()))
    except orjson.JSONDecodeError as error:
        raise InputError(f"{path} is not valid JSON: {cut(str(error), 120)}", _REMEDY, where) from None
    given = content.get("curves") if isinstance(content, dict) else None
    if not isinstance(given, dict):
        raise InputError(f'{path} has no "curves"', _REMEDY, where)
    unknown = set(content) - {"unit", "curves"}
    if unknown:
        raise InputError(f"{path}: unknown key {shown(min(unknown))}", "keys: unit, curves", where)
    unit = content.get("unit")
    if unit is not None and not (isinstance(unit, str) and unit in PROJECT_UNITS):
        raise InputError(
            f"{path}: unit {shown(unit)} is not one of {', '.join(PROJECT_UNITS)}", "write one of them", where
        )
    curves = tuple(_curve(path, name, curve, where) for name, curve in given.items())
    return CurveFile(curves, None if unit is None else METRES[unit])


def _curve(path: Path, name: str, given: Any, where: str) -> FileCurve:
    about = f"{path}: curve {cut(name, 40)!r}"
    if not isinstance(given, dict) or "points" not in given:
        raise InputError(f'{about} has no "points"', _REMEDY, where)
    unknown = set(given) - {"points", "interpolation"}
    if unknown:
        raise InputError(f"{about}: unknown key {shown(min(unknown))}", "keys: points, interpolation", where)
    interpolation = given.get("interpolation", "spline")
    if interpolation not in ("spline", "polyline"):
        raise InputError(f"{about}: interpolation {shown(interpolation)}", 'write "spline" or "polyline"', where)
    try:
        # lengths in another unit may be larger than those of a project
        points = clean_points(read_points(given["points"], most=float("inf")), closed=True)
        pieces = closed_spline(points) if interpolation == "spline" else lines(points, closed=True)
    except Refusal as error:
        raise InputError(f"{about}: {error}", error.remedy, where) from None
    except InputError as error:
        raise InputError(f"{about}: {error.message}", error.remedy, where) from None
    return FileCurve("", (name,), interpolation, pieces)
