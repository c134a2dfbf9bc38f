"""Figures of the panels: key, unit, meaning and value of each, and how the report shows it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from lamella.stages.figure import INTEGER, NUMBER, Figure, line, nullable

if TYPE_CHECKING:
    from lamella.panels.panels import Panels

Rows = Iterator[tuple[str, str, str]]


def _of(key: str) -> Any:
    """A figure that panels describe of themselves."""
    return lambda panels: panels.describe()[key]


def _over_rows(value: int, summary: dict[str, Any]) -> Rows:
    yield "Panels beyond the limit", f"{value} of {summary['panels']['planned']}", ""


FIGURES: tuple[Figure[Panels], ...] = (
    Figure("count", "", "plates that are cut", _of("count"), INTEGER, rows=line("Plates", form=",")),
    Figure(
        "different",
        "",
        "kinds of plates; those of one kind differ by 0.1 mm at most",
        _of("different"),
        INTEGER,
        rows=line("Kinds of plates", form=","),
    ),
    Figure("planned", "", "panels before any is divided or joined with others", _of("planned"), INTEGER),
    Figure(
        "out_of_plane_max_mm",
        "mm",
        "largest distance of the highest from the lowest corner of a panel, before it is divided",
        _of("out_of_plane_max_mm"),
        NUMBER,
        rows=line("Out of plane, most", "mm", form=".3g"),
    ),
    Figure(
        "out_of_plane_median_mm",
        "mm",
        "the same, half of all panels have less",
        _of("out_of_plane_median_mm"),
        NUMBER,
        rows=line("Out of plane, half have less", "mm", form=".3g"),
    ),
    Figure("over_limit", "", "panels beyond `panels.limit_mm`", _of("over_limit"), INTEGER, rows=_over_rows),
    Figure(
        "warp_mean_mm",
        "mm",
        'of whole cells, with `on = "cells"`: distance of a corner from the plane of the three others; else null',
        _of("warp_mean_mm"),
        nullable(NUMBER),
        rows=line("Warp of cells, mean", "mm"),
    ),
    Figure("warp_min_mm", "mm", "the least of these", _of("warp_min_mm"), nullable(NUMBER)),
    Figure("warp_max_mm", "mm", "the largest of these", _of("warp_max_mm"), nullable(NUMBER)),
    Figure(
        "kink_max_deg",
        "deg",
        "largest angle between the planes of neighbours",
        _of("kink_max_deg"),
        NUMBER,
        rows=line("Kink between neighbours, most", "°", form=".3g"),
    ),
    Figure("area", "m2", "of all flat plates", _of("area"), NUMBER, rows=line("Area of plates", "m²")),
    Figure("left_out", "", "small plates at rims that the gap leaves nothing of", _of("left_out"), INTEGER),
)

REPORT = (
    "count",
    "different",
    "area",
    "out_of_plane_max_mm",
    "out_of_plane_median_mm",
    "over_limit",
    "warp_mean_mm",
    "kink_max_deg",
)
