"""Figures of the parts: key, unit, meaning and value of each, and how the report shows it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from lamella.stages.fabrication.output import FabricationOutput
from lamella.stages.figure import INTEGER, NUMBER, Figure, line

Rows = Iterator[tuple[str, str, str]]


def _bow_rows(value: float, summary: dict[str, Any]) -> Rows:
    if value:
        yield "Cut outlines bowed by, at most", format(value * 1e3, ".2g"), "mm"


def _sheet_use(out: FabricationOutput) -> float:
    area = sum(part.quantity * part.area for part in out.parts.parts)
    return area / float(np.prod(out.nesting.sizes, axis=1).sum())


FIGURES: tuple[Figure[FabricationOutput], ...] = (
    Figure("mass", "kg", "of all pieces, slots taken off", lambda out: out.parts.mass, NUMBER, rows=line("Mass", "kg")),
    Figure(
        "surface_weight",
        "kg/m2",
        "mass over area of the surface",
        lambda out: out.parts.mass / out.surface_area,
        NUMBER,
        rows=line("Mass per area of surface", "kg/m²"),
    ),
    Figure(
        "parts",
        "",
        "pieces to cut (all layers)",
        lambda out: out.parts.pieces,
        INTEGER,
        rows=line("Parts", form=","),
    ),
    Figure("sheets", "", "sheets", lambda out: out.nesting.sheet_count, INTEGER, rows=line("Sheets", form="d")),
    Figure(
        "bow_max",
        "m",
        "how far a centre line cut to its own curvature leaves its straight line or arc; 0 where none is",
        lambda out: max((part.bow for part in out.parts.parts), default=0.0),
        NUMBER,
        rows=_bow_rows,
    ),
    Figure("sheet_use", "", "area of the parts over area of the sheets", _sheet_use, NUMBER),
)

REPORT = ("parts", "sheets", "bow_max", "mass", "surface_weight")
"""Order of the report's lines."""
