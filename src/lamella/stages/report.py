"""What the report shows of a run."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from lamella import __version__
from lamella.files.write.drawn_layer import DrawnLayer
from lamella.stages import all_stages
from lamella.stages.figure import Row, report_rows
from lamella.stages.results import Results
from lamella.surface.element.surface import ElementSurface
from lamella.surface.mesh import SurfaceMesh
from lamella.view.report import ReportData

COARSE_MESH_POINTS = 7_500
"""Vertices below which the report's mesh of a surface of curved elements is made anew, with `REPORT_SAG`."""

REPORT_SAG = 2.5e-4
"""A quarter of what the files' mesh has, over the diagonal of the bounding box: four times the vertices."""


def report_data(results: Results) -> ReportData:
    """What the report shows of a run."""
    return ReportData(
        name=results.project.name,
        version=__version__,
        kind=results.surface.kind,
        figures=tuple(_figures(results.summary)),
        corners=tuple(_corners(results.summary)),
        warnings=tuple(results.summary["warnings"]),
        surface=_report_mesh(results),
        mean_curvature=results.surface.mean_curvature,
        network=results.network,
        lamellas=results.lamellas,
        material=results.project.lamella.material,
        built=tuple(_built(results)),
    )


def _built(results: Results) -> Iterator[DrawnLayer]:
    """What the 3D view shows of what is built."""
    project, out, lamellas = results.project, results.outputs.get("fabrication"), results.lamellas
    if out is not None and lamellas is not None and (project.joint is not None or project.files.solids):
        from lamella.stages.fabrication.scene import report_layers

        yield from report_layers(out, lamellas, project.lamella.material)


def _report_mesh(results: Results) -> SurfaceMesh:
    """The mesh of the report: finer than the files' where that is coarse, so that curved rims look curved."""
    if isinstance(results.surface, ElementSurface) and len(results.mesh.points) < COARSE_MESH_POINTS:
        return results.surface.mesh(REPORT_SAG)
    return results.mesh


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
