"""Figures of a surface: key, unit, meaning and value of each, and how the report shows it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from lamella.base.wording import loop_names
from lamella.project.tables import BoundaryTable
from lamella.stages.figure import (
    ABSENT,
    FLAG,
    INTEGER,
    NUMBER,
    PAIR,
    POINT,
    TEXT,
    Figure,
    known,
    line,
    list_of,
    nullable,
    record,
)
from lamella.stages.surface.output import SurfaceOutput
from lamella.surface.closed_forms.closed_form import ClosedForm

Rows = Iterator[tuple[str, str, str]]


def _deviation(out: SurfaceOutput) -> float:
    """Largest |H - H0|: a film knows it at all its quadrature points, other surfaces are measured."""
    if "mean_curvature_deviation_max" in out.described:
        return float(out.described["mean_curvature_deviation_max"])
    surface = out.surface
    measured = surface.measured_mean_curvature(surface.check_places())
    return float(np.abs(measured - surface.mean_curvature).max())


def _loops(out: SurfaceOutput) -> Any:
    """The boundary loops of a surface of elements; those of a mesh are all held."""
    surface = out.surface
    if isinstance(surface, ClosedForm):
        return ABSENT
    # heavy, and closed forms do without
    from lamella.surface.element.rim import element_rims
    from lamella.surface.element.surface import ElementSurface

    if not isinstance(surface, ElementSurface):
        return ABSENT
    tables = getattr(out.project.surface, "boundary", ())
    rims = element_rims(surface.connectivity, surface.nodes, surface.rim_loop)
    names = [table.name for table in tables] or loop_names(len(rims))
    held = [_held(table) for table in tables] or ["held"] * len(rims)
    return [{"name": name, "length": rim.length, "held": how} for name, rim, how in zip(names, rims, held, strict=True)]


def _held(table: BoundaryTable) -> str:
    """How a loop is held, in words."""
    slides = [part.slide for part in table.part or ()] or [table.slide]
    ways = {"along a direction" if slide.direction else "on a plane" for slide in slides if slide is not None}
    if not ways:
        return "held"
    free, how = sum(slide is not None for slide in slides), " and ".join(sorted(ways))
    if free == len(slides):
        return f"slides {how}"
    return f"{free} of {len(slides)} parts {'slides' if free == 1 else 'slide'} {how}, the others are held"


def _mean_curvature_rows(value: float, summary: dict[str, Any]) -> Rows:
    varies = "mean_curvature_range" in summary["surface"]
    yield f"Mean curvature{', its mean' if varies else ''} H0", format(value, ".4g"), "1/m"


def _deviation_rows(value: float, summary: dict[str, Any]) -> Rows:
    if "mean_curvature_range" not in summary["surface"]:
        yield "|H − H0|, at check places", format(value, ".2g"), "1/m"


def _range_rows(value: list[float], summary: dict[str, Any]) -> Rows:
    yield "Mean curvature, from and to", f"{value[0]:.4g} … {value[1]:.4g}", "1/m"


def _size_rows(value: list[float], summary: dict[str, Any]) -> Rows:
    yield "Size", " × ".join(f"{x:.3g}" for x in value), "m"


def _origin_rows(value: list[float], summary: dict[str, Any]) -> Rows:
    yield "Measured from, in the drawing", ", ".join(f"{x:.10g}" for x in value), "m"


def _stability_rows(value: str, summary: dict[str, Any]) -> Rows:
    if value:
        yield "Stability", str(value), ""


def _element_rows(value: int, summary: dict[str, Any]) -> Rows:
    yield "Curved triangles", f"{value:,} of order {summary['surface']['order']}", ""


def _loop_rows(value: list[dict[str, Any]], summary: dict[str, Any]) -> Rows:
    for loop in value:
        yield loop["name"], f"{loop['length']:.4g} m, {loop['held']}", ""


FIGURES: tuple[Figure[SurfaceOutput], ...] = (
    Figure("kind", "", "as in the project", lambda out: out.surface.kind, TEXT),
    Figure(
        "mean_curvature",
        "1/m",
        'H; where it varies (`mean_curvature = "varying"`), its mean over the area',
        lambda out: out.surface.mean_curvature,
        NUMBER,
        rows=_mean_curvature_rows,
    ),
    Figure(
        "mean_curvature_deviation_max",
        "1/m",
        "largest difference from H, measured from positions at places spread over the surface; without the "
        "surroundings of the boundary's corners, where it has no bound",
        _deviation,
        NUMBER,
        rows=_deviation_rows,
    ),
    Figure("area", "m2", "of the surface", lambda out: out.surface.area(), NUMBER, rows=line("Area", "m²")),
    Figure(
        "size",
        "m",
        "bounding box of the surface, along x, y, z",
        lambda out: np.ptp(out.mesh.points, axis=0).tolist(),
        POINT,
        rows=_size_rows,
    ),
    Figure(
        "k1_max",
        "1/m",
        "largest principal curvature",
        lambda out: float(out.mesh.k1.max()),
        NUMBER,
        rows=line("Largest k1", "1/m"),
    ),
    Figure(
        "k2_min",
        "1/m",
        "smallest principal curvature",
        lambda out: float(out.mesh.k2.min()),
        NUMBER,
        rows=line("Smallest k2", "1/m"),
    ),
    Figure(
        "stability",
        "",
        "`stable`, `unstable` or `fold`; null where it is not determined, as of closed forms",
        lambda out: out.described.get("stability"),
        nullable({"enum": ["stable", "unstable", "fold"]}),
        rows=_stability_rows,
    ),
    Figure("period", "m", "unduloid: height of a full period", known("period"), NUMBER, always=False),
    Figure("fold", "m", "nodoid: height of the fold", known("fold"), NUMBER, always=False),
    Figure(
        "jacobi_eigenvalue",
        "1/m2",
        "films: lowest eigenvalue of the Jacobi operator, below 0 unstable",
        known("jacobi_eigenvalue"),
        nullable(NUMBER),
        always=False,
        rows=line("Lowest Jacobi eigenvalue", "1/m²", form=".3g"),
    ),
    Figure("negative_eigenvalues", "", "how many are below 0", known("negative_eigenvalues"), INTEGER, always=False),
    Figure("order", "", "curved triangles: order of the polynomials", known("order"), INTEGER, always=False),
    Figure("surface_nodes", "", "curved triangles: number of nodes", known("surface_nodes"), INTEGER, always=False),
    Figure(
        "elements", "", "curved triangles: their number", known("elements"), INTEGER, always=False, rows=_element_rows
    ),
    Figure(
        "newton_steps",
        "",
        "from the harmonic start (of a mesh, from the mesh); on the whole path where one was followed",
        known("newton_steps"),
        INTEGER,
        always=False,
    ),
    Figure(
        "node_angle",
        "deg",
        "surfaces found for another angle than 90: between the lamellas",
        known("node_angle"),
        NUMBER,
        always=False,
        rows=line("Found for a node angle of", "°", form="g"),
    ),
    Figure(
        "normal_curvature",
        "1/m",
        "the same: c of A k1 + B k2 = c, which `mean_curvature_deviation` is then the difference from",
        known("normal_curvature"),
        NUMBER,
        always=False,
        rows=line("Normal curvature of its lamellas", "1/m"),
    ),
    Figure("rounds", "", "the same: rounds on the last elements", known("rounds"), INTEGER, always=False),
    Figure("continuation", "", "whether a path of films was followed", known("continuation"), FLAG, always=False),
    Figure(
        "curvature_scale",
        "1/m",
        "root mean square of sqrt((k1^2 + k2^2) / 2)",
        known("curvature_scale"),
        NUMBER,
        always=False,
    ),
    Figure(
        "mean_curvature_deviation",
        "",
        "largest difference from H over that scale; kept below `surface.tolerance`",
        known("mean_curvature_deviation"),
        NUMBER,
        always=False,
    ),
    Figure(
        "volume",
        "m3",
        "between the surface and lids over its loops as they were drawn (cones from their centroids); above 0 where "
        "the normal points out",
        known("volume"),
        NUMBER,
        always=False,
        rows=line("Volume, with lids over the loops", "m³"),
    ),
    Figure(
        "curvature_jump",
        "",
        "meshes kept as they are: root mean square of the jump of the curvature between elements, over the curvature "
        "scale; what the mesh leaves uncertain",
        known("curvature_jump"),
        NUMBER,
        always=False,
    ),
    Figure(
        "curvature_error",
        "",
        "meshes kept as they are: root mean square over the area of a bound of the curvature's error, from how far the "
        "surfaces around neighbouring vertices differ, over the curvature scale",
        known("curvature_error"),
        NUMBER,
        always=False,
    ),
    Figure("source", "", "meshes: the file and what is in it", known("source"), TEXT, always=False),
    Figure(
        "treatment",
        "",
        "meshes: what was repaired or assumed",
        known("treatment"),
        list_of(TEXT),
        always=False,
    ),
    Figure(
        "nearest_mean_curvature",
        "1/m",
        "meshes: H of the surface nearest to the vertices, before it was taken as 0 where it was",
        known("nearest_mean_curvature"),
        nullable(NUMBER),
        always=False,
    ),
    Figure(
        "fitted_mean_curvature",
        "1/m",
        "meshes: H from the curvature at the vertices (1 to 3 % low on coarse meshes)",
        known("fitted_mean_curvature"),
        nullable(NUMBER),
        always=False,
    ),
    Figure(
        "fitted_deviation",
        "",
        "meshes: how far the vertices are from that H, over the curvature scale",
        known("fitted_deviation"),
        nullable(NUMBER),
        always=False,
    ),
    Figure(
        "vertex_scatter",
        "m",
        "meshes kept as they are: standard deviation of the vertices across a smooth surface, removed where it is not "
        "0; `surface.distance_max` and `_rms` then say how far",
        known("vertex_scatter"),
        NUMBER,
        always=False,
    ),
    Figure(
        "distance_max",
        "m",
        "meshes: largest distance of the mesh's vertices from the surface",
        known("distance_max"),
        NUMBER,
        always=False,
        rows=line("Off the mesh's vertices, largest", "mm", form=".3g", scale=1e3),
    ),
    Figure(
        "distance_rms",
        "m",
        "meshes: root mean square distance of the mesh's vertices from the surface",
        known("distance_rms"),
        NUMBER,
        always=False,
        rows=line("Off the mesh's vertices, typical", "mm", form=".3g", scale=1e3),
    ),
    Figure("tolerance", "", "as in the project", known("tolerance"), NUMBER, always=False),
    Figure(
        "origin",
        "m",
        "drawings in survey coordinates: the point of the drawing that the program measures from "
        "([below](#files-that-are-read))",
        known("origin"),
        POINT,
        always=False,
        rows=_origin_rows,
    ),
    Figure(
        "mean_curvature_range",
        "1/m",
        "meshes kept as they are, other node angles than 90: smallest and largest H",
        known("mean_curvature_range"),
        PAIR,
        always=False,
        rows=_range_rows,
    ),
    Figure(
        "normal_curvature_range",
        "1/m",
        "meshes kept as they are, other node angles than 90: smallest k2 and largest k1",
        known("normal_curvature_range"),
        PAIR,
        always=False,
    ),
    Figure(
        "loops",
        "",
        "surfaces of curved triangles: list of `name`, `length` (m) and `held` (`held`, or what slides on what), the "
        "outer one first",
        _loops,
        list_of(record(name=TEXT, length=NUMBER, held=TEXT)),
        always=False,
        rows=_loop_rows,
        section="Boundary",
    ),
)

REPORT = (
    "mean_curvature",
    "mean_curvature_range",
    "mean_curvature_deviation_max",
    "area",
    "size",
    "node_angle",
    "normal_curvature",
    "k1_max",
    "k2_min",
    "volume",
    "origin",
    "stability",
    "jacobi_eigenvalue",
    "distance_max",
    "distance_rms",
    "elements",
    "loops",
)
"""Order of the report's lines."""
