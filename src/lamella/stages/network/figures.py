"""Figures of a network: key, unit, meaning and value of each, and how the report shows it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import asdict
from typing import Any

import numpy as np

from lamella.network.network import BOUNDARY, SINGULAR, Network
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
from lamella.stages.network.output import NetworkOutput
from lamella.strip.planarity import planarity_score
from lamella.strip.principal_strips import principal_strips

Rows = Iterator[tuple[str, str, str]]
ORDER_AND_RAYS = {"point": POINT, "order": INTEGER, "rays": INTEGER}


def _angle(key: str) -> Callable[[NetworkOutput], float]:
    """A figure of the angles at regular nodes: of nets of elements also by the points that are written."""
    return lambda out: out.described[key] if key in out.described else out.angles[key]


def _singular_nodes(out: NetworkOutput) -> list[dict[str, Any]]:
    """Of nets of elements the umbilics that are nodes, at the places of the umbilics."""
    if "umbilics" in out.described:
        return [
            {key: umbilic[key] for key in ORDER_AND_RAYS} for umbilic in out.described["umbilics"] if umbilic["node"]
        ]
    network = out.network
    a, b = network.node_degrees()
    rays = a + b
    return [
        {"point": network.node_points[i].tolist(), "order": int(rays[i]) // 2 - 2, "rays": int(rays[i])}
        for i in np.flatnonzero(network.node_kinds == SINGULAR).tolist()
    ]


def _is_principal(network: Network) -> bool:
    return network.pattern.kind == "principal"


def _principal_strips(out: NetworkOutput) -> Any:
    return asdict(principal_strips(out.network)) if _is_principal(out.network) else ABSENT


def _principal_rows(value: dict[str, Any], summary: dict[str, Any]) -> Rows:
    yield "Strips on these lines: different outlines", f"{value['different']:,}", ""
    yield "Curvature of their outlines", f"{value['edgewise_min']:.3g} … {value['edgewise_max']:.3g}", "1/m"
    yield "Bent by, largest", format(value["bend_max"], ".3g"), "1/m"


def _curvature_deviation(out: NetworkOutput) -> float | None:
    """Largest |kn - c| along all lamellas: of nets of elements also by the points that are written."""
    network = out.network
    if _is_principal(network):
        return None
    if "normal_curvature_deviation_max" in out.described:
        return float(out.described["normal_curvature_deviation_max"])
    return float(np.abs(network.sample_darboux.kn - network.normal_curvature).max())


def _closed(out: NetworkOutput) -> bool:
    """Whether all periods are whole; where a cut surface has joints, these decide."""
    if "closed" in out.described:
        return bool(out.described["closed"])
    return all(abs(c - round(c)) <= 1e-3 for p in out.network.periods for c in (p.a_cells, p.b_cells))


def _principal_curvatures(out: NetworkOutput) -> Any:
    network = out.network
    if not _is_principal(network):
        return ABSENT
    kn, family = network.sample_darboux.kn, np.repeat(network.families, np.diff(network.sample_offsets))
    return {f: [float(kn[family == f].min()), float(kn[family == f].max())] for f in "AB" if (family == f).any()}


def _panel_nodes(network: Network) -> np.ndarray[Any, np.dtype[np.int64]]:
    """Nodes of the faces with four corners, (f, 4)."""
    start = network.face_offsets[:-1][np.diff(network.face_offsets) == 4]
    return np.asarray(network.face_nodes[start[:, None] + np.arange(4)])


def panel_planarity(network: Network) -> dict[str, float | None]:
    """Planarity score of the faces with four corners: inside, and with a corner on the rim."""
    panels = _panel_nodes(network)
    score = planarity_score(*network.node_points[panels].transpose(1, 0, 2))
    rim = (network.node_kinds[panels] == BOUNDARY).any(1)
    inner = score[~rim]
    return {
        "median": float(np.median(inner)) if len(inner) else None,
        "max": float(inner.max()) if len(inner) else None,
        "rim_max": float(score[rim].max()) if rim.any() else None,
    }


def _right_angled(summary: dict[str, Any]) -> bool:
    """Whether lamellas cross at right angles by their kind."""
    return summary["network"]["normal_curvature"] in (None, summary["surface"]["mean_curvature"])


def _off_square_rows(value: float, summary: dict[str, Any]) -> Rows:
    if _right_angled(summary):
        yield "Node angle off 90°, largest", format(value, ".2g"), "°"
    elif "node_angle" in summary["surface"]:
        wanted = summary["surface"]["node_angle"]
        yield f"Node angle off {wanted:g}°, largest", format(value, ".2g"), "°"


def _angle_rows(label: str) -> Callable[[float, dict[str, Any]], Rows]:
    def rows(value: float, summary: dict[str, Any]) -> Rows:
        if not _right_angled(summary):
            yield f"Node angle, {label}", format(value, ".4g"), "°"

    return rows


def _curvature_rows(value: float, summary: dict[str, Any]) -> Rows:
    if not _right_angled(summary):
        yield "Normal curvature of all lamellas", format(value, ".4g"), "1/m"


def _curvature_deviation_rows(value: float, summary: dict[str, Any]) -> Rows:
    of = "H" if _right_angled(summary) else "it"
    yield f"Normal curvature off {of}, largest", format(value, ".2g"), "1/m"


def _planarity_rows(value: dict[str, float | None], summary: dict[str, Any]) -> Rows:
    for key, label in (("median", "inside, median"), ("max", "inside, worst"), ("rim_max", "at the rim, worst")):
        score = value[key]
        if score is not None:
            yield f"Panel planarity {label}", format(score, ".2g"), ""


def _unreal_rows(value: float, summary: dict[str, Any]) -> Rows:
    if value:
        yield "Surface without such directions", format(value * 100, ".3g"), "%"


def _adjusted_rows(value: dict[str, Any], summary: dict[str, Any]) -> Rows:
    yield "Boundary adjusted by, at most", format(value["moved_max"] * 1e3, ".3g"), "mm"


def _singular_rows(value: list[Any], summary: dict[str, Any]) -> Rows:
    yield "Singular nodes", format(len(value), "d"), ""


BY_POINTS = (
    "; on surfaces of curved triangles and of lines from seeds by the tangents on the surface or by the points of the "
    "written centre lines, whichever is more"
)

FIGURES: tuple[Figure[NetworkOutput], ...] = (
    Figure(
        "nodes", "", "number of nodes", lambda out: len(out.network.node_points), INTEGER, rows=line("Nodes", form=",")
    ),
    Figure(
        "lamellas",
        "",
        "number of lamellas",
        lambda out: len(out.network.ids),
        INTEGER,
        rows=line("Lamellas", form=","),
    ),
    Figure(
        "lamellas_left_out",
        "",
        "shorter than `network.minimum_length`",
        lambda out: out.network.left_out,
        INTEGER,
    ),
    Figure("faces", "", "number of faces", lambda out: len(out.network.face_offsets) - 1, INTEGER),
    Figure(
        "kind",
        "",
        "`lamellas` or `principal`",
        lambda out: out.network.pattern.kind,
        {"enum": ["lamellas", "principal"]},
    ),
    Figure(
        "every",
        "",
        "`[p, q]`: one in p curves of family A is kept, one in q of family B",
        lambda out: list(out.network.pattern.every),
        list_of(INTEGER),
    ),
    Figure("requested", "", "density as requested, before curves are left out", lambda out: out.requested, TEXT),
    Figure(
        "cells",
        "",
        "number of cells, before curves are left out",
        lambda out: out.network.cells,
        INTEGER,
        rows=line("Cells around or across", form="d"),
    ),
    Figure(
        "step",
        "sqrt(m)",
        "l0 of [theory.md](theory.md); of lines from seeds the distance of these along the first guide, m",
        lambda out: out.network.step,
        NUMBER,
    ),
    Figure(
        "singular_nodes",
        "",
        "list of `point` (m), `order`, `rays`",
        _singular_nodes,
        list_of(record(**ORDER_AND_RAYS)),
        rows=_singular_rows,
    ),
    Figure(
        "node_angle_min_deg",
        "deg",
        "smallest angle between the families, at regular nodes" + BY_POINTS,
        _angle("node_angle_min_deg"),
        NUMBER,
        rows=_angle_rows("smallest"),
    ),
    Figure(
        "node_angle_max_deg",
        "deg",
        "largest angle between the families, at regular nodes" + BY_POINTS,
        _angle("node_angle_max_deg"),
        NUMBER,
        rows=_angle_rows("largest"),
    ),
    Figure(
        "node_angle_deviation_max_deg",
        "deg",
        "largest difference from 90 degrees, or from `network.angle`, at regular nodes" + BY_POINTS,
        _angle("node_angle_deviation_max_deg"),
        NUMBER,
        rows=_off_square_rows,
    ),
    Figure(
        "node_angle_deviation_mean_deg",
        "deg",
        "mean difference from 90 degrees, or from `network.angle`, at regular nodes" + BY_POINTS,
        _angle("node_angle_deviation_mean_deg"),
        NUMBER,
    ),
    Figure(
        "principal_strips",
        "",
        "principal nets: what strips on its lines would be: `different` outlines, `bend_max` and `twist_max` (kg and "
        "tg, 1/m; not twisted), `edgewise_min` and `edgewise_max` (kn, the curvature of their outlines, 1/m)",
        _principal_strips,
        record(different=INTEGER, bend_max=NUMBER, twist_max=NUMBER, edgewise_min=NUMBER, edgewise_max=NUMBER),
        always=False,
        rows=_principal_rows,
    ),
    Figure(
        "normal_curvature",
        "1/m",
        "of all lamellas: H, or what the project gives; null in a principal net",
        lambda out: None if _is_principal(out.network) else out.network.normal_curvature,
        nullable(NUMBER),
        rows=_curvature_rows,
    ),
    Figure(
        "normal_curvature_deviation_max",
        "1/m",
        "largest difference from that, along all lamellas: by the surface's second derivatives, on surfaces of "
        "curved triangles and of lines from seeds (there unsmoothed) also by the points of the written centre lines,"
        " which have small kinks where they go over from one element to the next; the larger of both. By points: "
        "second derivative of the polynomial of degree four that fits seven neighbouring samples best. Null in a "
        "principal net",
        _curvature_deviation,
        nullable(NUMBER),
        rows=_curvature_deviation_rows,
    ),
    Figure(
        "cell_edge_min",
        "m",
        "smallest arc length from node to node, pieces at the rim and next to corners included: all of them are built",
        lambda out: float(out.network.cell_edges.min()),
        NUMBER,
        rows=line("Cell edge, smallest", "m"),
    ),
    Figure(
        "cell_edge_median",
        "m",
        "median arc length from node to node",
        lambda out: float(np.median(out.network.cell_edges)),
        NUMBER,
        rows=line("Cell edge, median", "m"),
    ),
    Figure(
        "cell_edge_max",
        "m",
        "largest arc length from node to node",
        lambda out: float(out.network.cell_edges.max()),
        NUMBER,
        rows=line("Cell edge, largest", "m"),
    ),
    Figure(
        "periods",
        "",
        "list of `around`, `a_cells`, `b_cells`: lamellas (those that are kept) crossed on a loop around a hole, after "
        'rounding if `closing = "round"`',
        lambda out: [p._asdict() for p in out.network.periods],
        list_of(record(around=TEXT, a_cells=NUMBER, b_cells=NUMBER)),
    ),
    Figure(
        "closed",
        "",
        "whether the net meets itself: all periods and joints are whole within 0.001, by themselves or by rounding; "
        "always for lines from seeds, which have no lattice",
        _closed,
        FLAG,
    ),
    Figure(
        "principal_curvatures",
        "1/m",
        'principal nets: smallest and largest normal curvature of each family, `{"A": [..], "B": [..]}`',
        _principal_curvatures,
        record(("A", "B"), A=PAIR, B=PAIR),
        always=False,
    ),
    Figure(
        "geodesic_torsion_max",
        "1/m",
        "principal nets: magnitude; 0 along exact principal lines",
        lambda out: float(np.abs(out.network.sample_darboux.tg).max()) if _is_principal(out.network) else ABSENT,
        NUMBER,
        always=False,
    ),
    Figure(
        "panels",
        "",
        "principal nets: faces with four corners",
        lambda out: len(_panel_nodes(out.network)) if _is_principal(out.network) else ABSENT,
        INTEGER,
        always=False,
        rows=line("Panels with four corners", form=","),
    ),
    Figure(
        "panel_planarity",
        "",
        "principal nets: distance of the panels' diagonals over the diagonals' mean length: `median` and `max` of "
        "those inside, `rim_max` of those with a corner on the rim",
        lambda out: panel_planarity(out.network) if _is_principal(out.network) else ABSENT,
        record(median=nullable(NUMBER), max=nullable(NUMBER), rim_max=nullable(NUMBER)),
        always=False,
        rows=_planarity_rows,
    ),
    Figure(
        "umbilics",
        "",
        "surfaces of curved triangles: list of `point` (m), `order`, `rays` and `node` (whether the net has a node "
        "there, or lamellas pass around). Those on the rim are not listed, no lamella ends in them: nearer to it "
        "than 0.002 of the surface's size, or than their place is sure by the surface's own error estimate, or "
        "within 0.015 of a sharp corner. On straight beams they lie exactly, wherever the twist changes its sign",
        known("umbilics"),
        list_of(record(**ORDER_AND_RAYS, node=FLAG)),
        always=False,
    ),
    Figure(
        "isothermic_residual",
        "",
        "surfaces of curved triangles: root mean square of dw - sqrt(D) dz over that of sqrt(D) dz "
        "([theory.md](theory.md)); next to 0 where the mean curvature is constant and the principal directions are "
        "resolved",
        known("isothermic_residual"),
        NUMBER,
        always=False,
    ),
    Figure(
        "joints",
        "",
        "surfaces of curved triangles: list of `between` (what a piece of the cut joins: boundary loops, singular "
        "nodes, seams), `off_cells` (how far the net is from meeting itself there, 0 to 0.5; up to 1 where umbilics "
        "were put on nodes) and `closed` (whether it does, by itself or by rounding)",
        known("joints"),
        list_of(record(between=TEXT, off_cells=NUMBER, closed=FLAG)),
        always=False,
    ),
    Figure(
        "corners",
        "",
        "surfaces of curved triangles: for each corner of the boundary that turns by more than 20 degrees `point` (m), "
        "`angle_deg` (between its sides, on the surface), `curvature_exponent` (the curvature goes like this power of "
        "the distance: below 0 it has no bound), `radius` (m, of what counts as next to it), `unresolved_radius` (m, "
        "within which the elements do not follow the curvature), and the worst of the net within `radius`: "
        "`normal_curvature_deviation_max`, `geodesic_torsion_max` (1/m), `node_angle_deviation_max_deg`, "
        "`cell_edge_min` (m); null where it has nothing there. `network.node_angle_*` and "
        "`network.normal_curvature_deviation_max` leave out what is within `unresolved_radius`; these rows do not",
        known("corners"),
        list_of({"type": "object", "required": ["point", "angle_deg", "radius"]}),
        always=False,
    ),
    Figure(
        "node_angle_mean_deg",
        "deg",
        "lines from seeds: mean angle between the families, at regular nodes",
        known("node_angle_mean_deg"),
        NUMBER,
        always=False,
        rows=_angle_rows("mean"),
    ),
    Figure(
        "normal_curvature_deviation_p95",
        "1/m",
        "lines from seeds: the difference from the normal curvature at 95 % of the samples; null in a principal net",
        known("normal_curvature_deviation_p95"),
        nullable(NUMBER),
        always=False,
    ),
    Figure(
        "guides", "", "lines from seeds: guides that seeds were counted along", known("guides"), INTEGER, always=False
    ),
    Figure(
        "inner_ends",
        "",
        "lines from seeds: ends of lamellas inside the surface, where directions stop being real",
        known("inner_ends"),
        INTEGER,
        always=False,
    ),
    Figure(
        "unreal_area_share",
        "",
        "lines from seeds: share of the area without a direction of that normal curvature",
        known("unreal_area_share"),
        NUMBER,
        always=False,
        rows=_unreal_rows,
    ),
    Figure(
        "flat_area_share",
        "",
        "lines from seeds: share of the area where there are two directions, at less than 20 degrees",
        known("flat_area_share"),
        NUMBER,
        always=False,
    ),
    Figure(
        "adjustment",
        "",
        '`closing = "adjust"`: `missed_before`, `missed_after` (cells), `moved_max` and `moved` by loop (m: largest '
        "distance of the changed curve from the drawn one), `mean_curvature_change` (1/m), `steps`",
        lambda out: out.adjustment or ABSENT,
        record(
            missed_before=NUMBER,
            missed_after=NUMBER,
            moved_max=NUMBER,
            moved={"type": "object", "additionalProperties": NUMBER},
            mean_curvature_change=NUMBER,
            steps=INTEGER,
        ),
        always=False,
        rows=_adjusted_rows,
    ),
)

REPORT = (
    "lamellas",
    "nodes",
    "singular_nodes",
    "cells",
    "cell_edge_min",
    "cell_edge_median",
    "cell_edge_max",
    "principal_strips",
    "adjustment",
    "unreal_area_share",
    "node_angle_deviation_max_deg",
    "node_angle_min_deg",
    "node_angle_max_deg",
    "node_angle_mean_deg",
    "normal_curvature",
    "normal_curvature_deviation_max",
    "panels",
    "panel_planarity",
)
"""Order of the report's lines."""
