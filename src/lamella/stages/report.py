"""What the report shows of a run."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from lamella import __version__
from lamella.stages import all_stages
from lamella.stages.figure import Row, report_rows
from lamella.stages.results import Results
from lamella.stages.scene import scene_of
from lamella.view.report import ReportData


def report_data(results: Results) -> ReportData:
    """What the report shows of a run."""
    return ReportData(
        name=results.project.name,
        version=__version__,
        subtitle=_subtitle(results),
        figures=tuple(_figures(results.summary)),
        corners=tuple(_corners(results.summary)),
        warnings=tuple(results.summary["warnings"]),
        scene=scene_of(results),
    )


def _subtitle(results: Results) -> tuple[str, ...]:
    """Kind of surface, section and material of the lamellas."""
    if results.lamellas is None:
        return (results.surface.kind,)
    section = results.lamellas.section
    text = f"lamellas {section.height * 1e3:.6g} × {section.thickness * 1e3:.6g} mm"
    if section.layers > 1:
        text += f", {section.layers} layers {section.offset * 1e3:.6g} mm apart"
    return results.surface.kind, text, results.project.lamella.material


def _figures(summary: dict[str, Any]) -> Iterator[Row]:
    """Key figures of the summary as (section, label, value, unit)."""
    for stage in all_stages.STAGES:
        if summary.get(stage.name):
            yield from report_rows(stage.figures, stage.report, stage.name, summary)


def _corners(summary: dict[str, Any]) -> list[tuple[str, str, str, str]]:
    """Place, angle between the sides, worst node angle and utilisation next to each corner of the boundary."""
    rows = (summary["network"] or {}).get("corners", [])
    stress = (summary["lamellas"] or {}).get("utilisation_at_corners", [None] * len(rows))

    decimals = int(np.clip(1 - np.floor(np.log10(max(summary["surface"]["size"]))), 0, 3))

    def told(value: float | None, form: str) -> str:
        # nothing of the net is there
        return "–" if value is None else format(value, form)

    return [
        (
            ", ".join(f"{x:.{decimals}f}" for x in row["point"]),
            f"{row['angle_deg']:.1f}",
            told(row["node_angle_deviation_max_deg"], ".2g"),
            told(use, ".2f"),
        )
        for row, use in zip(rows, stress, strict=True)
    ]
