"""The boundary of a project, changed so that its net closes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from lamella.base.drawing_origin import NOWHERE, measured_from, reported_from
from lamella.base.progress import Progress, Report, silent
from lamella.network.adjust.adjust import adjust_boundary
from lamella.network.adjust.strip_limit import StripLimit
from lamella.network.pattern import LAMELLAS, Pattern
from lamella.project.tables import FormFoundTable
from lamella.stages.keys import keys
from lamella.stages.surface.boundary_of_tables import adjustable_film, changed_table, with_origin
from lamella.surface.boundary.freedom import Freedom, refuse_fixed
from lamella.surface.element.surface import ElementSurface


@dataclass(frozen=True)
class AdjustedTable:
    """A table whose surface has a net that closes.

    Attributes
    ----------
    table : FormFoundTable
        With the changed boundary and H.
    surface : ElementSurface
    step : float
        Spacing l0 of the lattice, sqrt(m).
    figures : dict
        What was done, for the summary.
    """

    table: FormFoundTable
    surface: ElementSurface
    step: float
    figures: dict[str, Any]


# of the parameters that are not of the name of their key
_KEYS = {
    "film": "network.closing",
    "curves": "surface.boundary",
    "loops": "surface.boundary",
    "surface": "surface",
    "cells": "network.cells",
    "spacing": "network.spacing",
    "limit": "network.limit",
}


def adjust_table(
    table: FormFoundTable,
    folder: Path,
    *,
    cells: int | None,
    spacing: float | None,
    pattern: Pattern = LAMELLAS,
    limit: StripLimit | None = None,
    progress: Progress = silent,
) -> AdjustedTable:
    """Change the boundary of a table until the net of its surface closes.

    Parameters
    ----------
    table : FormFoundTable
    folder : Path
        Where relative paths of boundary files begin.
    cells, spacing, pattern, limit, progress
        See `lamella.network.adjust.adjust.adjust_boundary`.

    Raises
    ------
    InputError
    """
    table = with_origin(table, folder)
    with reported_from(table.origin or NOWHERE):
        if table.origin:
            progress(Report.step(measured_from(table.origin)))
        film = adjustable_film(table, folder)
        with keys("surface", **_KEYS):
            adjusted = adjust_boundary(
                film, cells=cells, spacing=spacing, pattern=pattern, limit=limit, progress=progress
            )
    return AdjustedTable(changed_table(table, adjusted.film), adjusted.surface, adjusted.step, adjusted.figures)


def refuse_held_table(table: FormFoundTable) -> None:
    """Raise an `InputError` where nothing of a boundary may change; curves of files are not read."""
    freedom = Freedom(adjustable_film(table))
    with keys("surface", **_KEYS):
        refuse_fixed(freedom)
