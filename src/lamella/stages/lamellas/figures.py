"""Figures of lamellas: key, unit, meaning and value of each, and how the report shows it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

import numpy as np

from lamella.stages.figure import ABSENT, NUMBER, Figure, line, list_of, nullable, record
from lamella.stages.lamellas.developable import MEANING, SCHEMA, developable_figure
from lamella.stages.lamellas.output import LamellasOutput
from lamella.stages.lamellas.sizing_figure import SIZING
from lamella.strip.unroll import development_deviation

Rows = Iterator[tuple[str, str, str]]


def _planarity(out: LamellasOutput) -> dict[str, Any]:
    score, quads = out.lamellas.planarity, np.ones(len(out.lamellas.planarity), bool)
    # the last sample of a lamella begins no quad
    quads[out.network.sample_offsets[1:] - 1] = False
    twisted = {"median": float(np.median(score[quads])), "max": float(score[quads].max())}
    return {"twisted": twisted, "developable": out.developable.score if out.developable else None}


def _development(out: LamellasOutput) -> float:
    net = out.network
    curvature = out.lamellas.cut_curvatures if out.lamellas.section.level else net.normal_curvature
    off = development_deviation(net.sample_points, net.sample_normals, net.sample_offsets, curvature)
    return float(off.max())


def _layer_distances(out: LamellasOutput) -> list[float]:
    layers = out.lamellas.layers
    apart = np.diff(layers.distances, axis=0)[:, layers.followed]
    return [float(apart.min()), float(apart.max())] if apart.size else []


def _planarity_rows(value: dict[str, Any], summary: dict[str, Any]) -> Rows:
    yield "Planarity score, median", format(value["twisted"]["median"], ".2g"), ""
    yield "Planarity score, largest", format(value["twisted"]["max"], ".2g"), ""


def _layer_rows(value: list[float], summary: dict[str, Any]) -> Rows:
    if value:
        low, high = (f"{1e3 * x:.3g}" for x in value)
        yield "Layers apart", low if low == high else f"{low} … {high}", "mm"


def _developable_rows(value: dict[str, Any], summary: dict[str, Any]) -> Rows:
    yield "Developable strips, of the lamellas", f"{value['share']:.0%}", ""
    score = summary["lamellas"]["planarity_score"]["developable"]
    if score:
        yield "Planarity score of these, largest", format(score["max"], ".2g"), ""
    yield "Recommended strips", value["recommended"], ""


def _stress(key: str, label: str, meaning: str, values: str) -> Figure[LamellasOutput]:
    """The largest of a stress along all lamellas."""
    return Figure(
        key,
        "Pa",
        meaning,
        lambda out: float(getattr(out.lamellas, values).max()),
        NUMBER,
        rows=line(f"{label}, largest", "MPa", scale=1e-6),
    )


FIGURES: tuple[Figure[LamellasOutput], ...] = (
    Figure(
        "total_length",
        "m",
        "of all centre lines, one layer",
        lambda out: float(out.network.lengths.sum()),
        NUMBER,
        rows=line("Length, one layer", "m"),
    ),
    Figure(
        "section",
        "m",
        "height, thickness, layers, offset, marks, layer_lengths, layer_curves, and of stacked lamellas level",
        lambda out: out.lamellas.section.record,
        {"type": "object"},
    ),
    Figure(
        "material",
        "SI",
        "name, density, moduli, strengths and their source",
        lambda out: {"name": out.material_name} | asdict(out.material),
        {"type": "object", "required": ["name", "density", "youngs_modulus", "shear_modulus", "strength"]},
    ),
    Figure(
        "geodesic_curvature_max",
        "1/m",
        "largest magnitude of the geodesic curvature",
        lambda out: float(np.abs(out.network.sample_darboux.kg).max()),
        NUMBER,
        rows=line("Geodesic curvature, largest", "1/m"),
    ),
    Figure(
        "geodesic_torsion_max",
        "1/m",
        "largest magnitude of the geodesic torsion",
        lambda out: float(np.abs(out.network.sample_darboux.tg).max()),
        NUMBER,
        rows=line("Geodesic torsion, largest", "1/m"),
    ),
    Figure(
        "planarity_score",
        "",
        "`twisted`: `median` and `max` over the quads between samples; `developable`: the same where such a strip of "
        "the height exists, null where none does or `lamella.strips` does not ask for it",
        _planarity,
        record(twisted=record(median=NUMBER, max=NUMBER), developable=nullable(record(median=NUMBER, max=NUMBER))),
        rows=_planarity_rows,
    ),
    Figure(
        "development_deviation_max",
        "m",
        "written centre lines, unrolled numerically, from their straight line or circle",
        _development,
        NUMBER,
        rows=line("Off the straight or round development", "mm", form=".2g", scale=1e3),
    ),
    _stress("stress_bending_max", "Bending stress", "bending about the weak axis", "bending"),
    _stress("stress_torsion_max", "Torsion stress", "torsion", "torsion"),
    _stress(
        "stress_helix_max",
        "Helix stress",
        "tension at the edge, strip free to shorten, with plate action",
        "helix_edge",
    ),
    _stress(
        "stress_restraint_max",
        "Restraint stress",
        "tension on the centre line from marks at the arc length; 0 when relaxed",
        "restraint",
    ),
    _stress(
        "stress_layer_max",
        "Strong-axis stress of layers",
        "strong-axis bending of the layers farthest from the centre line; 0 with one layer, and with `layer_curves = "
        '"cut"` or `"lamella"`',
        "layer",
    ),
    _stress("von_mises_max", "Von Mises stress", "all of these together", "von_mises"),
    Figure(
        "utilisation_max",
        "",
        "that over the strength, without partial factors and loads",
        lambda out: float(out.lamellas.utilisation.max()),
        NUMBER,
        rows=line("Utilisation, largest", form=".2f"),
    ),
    Figure(
        "utilisation_net_section_max",
        "",
        "the same on the half height left at slots, without the helix stress ([theory.md](theory.md#stresses))",
        lambda out: float(out.lamellas.net_utilisation.max(initial=0.0)),
        NUMBER,
        rows=line("Utilisation at slots, largest", form=".2f"),
    ),
    Figure(
        "layer_distances",
        "m",
        "least and largest distance of neighbouring layers; empty with one layer",
        _layer_distances,
        list_of(NUMBER),
        rows=_layer_rows,
    ),
    Figure(
        "developable",
        "",
        MEANING,
        developable_figure,
        SCHEMA,
        always=False,
        rows=_developable_rows,
    ),
    Figure(
        "utilisation_at_corners",
        "",
        "surfaces of curved triangles: the largest utilisation next to each of `network.corners` (null: no lamella is "
        "there)",
        lambda out: out.corner_stresses.get("utilisation_at_corners", ABSENT),
        list_of(nullable(NUMBER)),
        always=False,
    ),
    Figure(
        "utilisation_away_from_corners",
        "",
        "surfaces of curved triangles: the largest utilisation away from all corners",
        lambda out: out.corner_stresses.get("utilisation_away_from_corners", ABSENT),
        NUMBER,
        always=False,
    ),
    SIZING,
)

REPORT = (
    "total_length",
    "geodesic_curvature_max",
    "geodesic_torsion_max",
    "planarity_score",
    "development_deviation_max",
    "stress_bending_max",
    "stress_torsion_max",
    "stress_helix_max",
    "stress_restraint_max",
    "stress_layer_max",
    "von_mises_max",
    "utilisation_max",
    "utilisation_net_section_max",
    "layer_distances",
    "developable",
    "sizing",
)
"""Order of the report's lines."""
