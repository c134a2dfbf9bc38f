"""Figures of a variant by their keys: numbers of its summary, clear heights, the change of the variables."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from lamella.base.arrays import Floats
from lamella.stages.results import Results
from lamella.studies.tables import HeadroomTable, VariableTable

NOT_FIGURES = ("schema", "version", "name", "warnings", "seconds", "files", "seal")
CHANGE = "change"
"""Key of the change of the variables: the root of the sum of squares of their parts of the ranges."""

NO_FIGURE = "no figure"
FIGURE_DIGITS = 12
"""Significant digits in the table: what is beyond them is rounding, and other machines have other last bits."""


EDGE_SPARE = 1e-9
"""Of a triangle's own coordinates: so far outside an edge a place still counts as on it."""


def table_figures(summary: Mapping[str, Any]) -> dict[str, Any]:
    """Numbers, flags and words of a summary by their keys, without those inside lists; the number of warnings."""
    stages = {key: value for key, value in summary.items() if key not in NOT_FIGURES}
    return dict(_leaves(stages, "")) | {"warnings": len(summary.get("warnings", ()))}


def _leaves(value: Any, key: str) -> Iterator[tuple[str, Any]]:
    if isinstance(value, Mapping):
        for name, item in value.items():
            yield from _leaves(item, f"{key}.{name}" if key else str(name))
    elif not isinstance(value, list | tuple):
        yield key, value


def figure_at(figures: Mapping[str, Any], summary: Mapping[str, Any], key: str) -> float | None:
    """The number of a figure; None where it has no finite one.

    Parameters
    ----------
    figures : mapping
        As `table_figures` gives them, and others by their keys.
    summary : mapping
        Looked into where a key leads into a list, by number or by the name or id of an entry.
    key : str

    Raises
    ------
    KeyError
        There is no such figure.
    """
    if key in figures:
        return _number(figures[key])
    place: Any = summary
    names = key.split(".")
    for depth, name in enumerate(names):
        if place is None and depth:
            return None
        if isinstance(place, Mapping) and name in place:
            place = place[name]
        elif isinstance(place, list | tuple):
            place = _entry(place, name)
        else:
            raise KeyError(key)
    if isinstance(place, Mapping | list | tuple | str):
        raise KeyError(key)
    return _number(place)


def _entry(entries: Sequence[Any], name: str) -> Any:
    """An entry of a list by its number or name; None where there is none: another variant may have it."""
    if name.isdigit():
        return entries[int(name)] if int(name) < len(entries) else None
    named = [one for one in entries if isinstance(one, Mapping) and name in (one.get("name"), one.get("id"))]
    return named[0] if named else None


def _number(value: Any) -> float | None:
    if value is None or isinstance(value, str):
        return None
    return float(value) if math.isfinite(value) else None


def rounded_figure(value: Any) -> Any:
    """A figure with so many digits as mean something."""
    return float(f"{value:.{FIGURE_DIGITS}g}") if isinstance(value, float) and math.isfinite(value) else value


def change_of(variables: Sequence[VariableTable], chosen: Sequence[Any], start: Sequence[Any]) -> float:
    """How far numbers with ranges are from where they begin, in parts of their ranges.

    Parameters
    ----------
    variables : sequence of VariableTable
    chosen, start : sequence
        Values of the variant, and those it begins with.
    """
    total = 0.0
    for variable, value, first in zip(variables, chosen, start, strict=True):
        if variable.range is not None:
            total += ((float(value) - float(first)) / (variable.range[1] - variable.range[0])) ** 2
        else:
            total += float(value != first)
    return math.sqrt(total)


def headroom(results: Results, place: HeadroomTable) -> float | None:
    """Clear height under the surface at a place, m; None where no surface is above it.

    Of the faces of the surface's mesh above the place the lowest one counts.

    Parameters
    ----------
    results : Results
    place : HeadroomTable
        In the drawing's coordinates.
    """
    origin = np.array(results.origin)
    x, y = np.array(place.at) - origin[:2]
    faces = results.mesh.faces
    corners = results.mesh.points[np.vstack([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]])]
    heights = _heights_at(corners, float(x), float(y))
    return float(heights.min() + origin[2] - place.ground) if len(heights) else None


def _heights_at(corners: Floats, x: float, y: float) -> Floats:
    """Heights of triangles (n, 3, 3) above a place in plan, by barycentric coordinates."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    first, second = b - a, c - a
    area = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        dx, dy = x - a[:, 0], y - a[:, 1]
        u = (dx * second[:, 1] - dy * second[:, 0]) / area
        v = (dy * first[:, 0] - dx * first[:, 1]) / area
        # an edge belongs to both of its triangles, whatever rounding says
        inside = (u >= -EDGE_SPARE) & (v >= -EDGE_SPARE) & (u + v <= 1 + EDGE_SPARE)
    u, v = u[inside], v[inside]
    return np.asarray(a[inside, 2] + u * first[inside, 2] + v * second[inside, 2])
