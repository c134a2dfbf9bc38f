"""Figures of the parts: key, unit, meaning and value of each, and how the report shows it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from lamella.fabrication.schedule import congruent_parts
from lamella.stages.fabrication.output import FabricationOutput
from lamella.stages.fabrication.stock_figures import STOCK_FIGURES, sheet_use
from lamella.stages.figure import ABSENT, INTEGER, NUMBER, TEXT, Figure, line, list_of, nullable, record

Rows = Iterator[tuple[str, str, str]]


def _bow_rows(value: float, summary: dict[str, Any]) -> Rows:
    if value:
        yield "Cut outlines bowed by, at most", format(value * 1e3, ".2g"), "mm"


HUB = ("hub plate", "hub fin", "packer", "hub post")
"""Kinds of part that a hub is made of; it has two plates."""


OF_KIND = record(("length",), count=INTEGER, different=INTEGER, mass=NUMBER, length=NUMBER)
"""Schema of the figures of one kind of hardware."""


def _hardware(out: FabricationOutput) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for item in out.hardware:
        one = found.setdefault("hub" if item.kind in HUB else item.kind, {"count": 0, "different": 0, "mass": 0.0})
        one["mass"] += item.quantity * item.mass
        if item.kind in ("cable", "edge_beam"):
            one["length"] = one.get("length", 0.0) + item.quantity * item.length
        if item.kind not in HUB[1:]:
            one["count"] += item.quantity // 2 if item.kind in HUB else item.quantity
            one["different"] += 1
    return found


def _hardware_rows(value: dict[str, Any], summary: dict[str, Any]) -> Rows:
    for kind, of_kind in value.items():
        several = f", {of_kind['different']} kinds" if of_kind["different"] > 1 else ""
        yield f"{kind.capitalize()}{several}", f"{of_kind['count']:,}", f"pieces, {of_kind['mass']:.3g} kg"


def _segments(out: FabricationOutput) -> Any:
    if not out.segments.segments:
        return ABSENT
    return [
        {"id": one.id, "mass": one.mass, "lamellas": len(one.lamellas), "nodes": len(one.nodes)}
        for one in out.segments.segments
    ]


def _segment_rows(value: list[dict[str, Any]], summary: dict[str, Any]) -> Rows:
    masses = [one["mass"] for one in value]
    yield "Segments", f"{len(masses)}", f"of {min(masses):.4g} to {max(masses):.4g} kg"


FIGURES: tuple[Figure[FabricationOutput], ...] = (
    Figure(
        "mass",
        "kg",
        "of all strips, slots and holes taken off, and of the hardware",
        lambda out: out.parts.mass + out.hardware.mass,
        NUMBER,
        rows=line("Mass", "kg"),
    ),
    Figure(
        "surface_weight",
        "kg/m2",
        "mass over area of the surface",
        lambda out: (out.parts.mass + out.hardware.mass) / out.surface_area,
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
    Figure(
        "slot_width",
        "m",
        "of the slots where lamellas cross at a right angle, where `[erection]` is given and no width: what the joints "
        "need on the way from flat to designed, at least 2 x thickness",
        lambda out: out.slot_width if out.by_erection else ABSENT,
        NUMBER,
        always=False,
        rows=line("Slots", "mm", scale=1e3),
    ),
    Figure(
        "parts_different",
        "",
        "kinds of lamella layers: parts that are not congruent within 0.01 mm",
        lambda out: len(set(congruent_parts(out.parts))),
        INTEGER,
        rows=line("Different lamella layers", form=","),
    ),
    Figure(
        "hardware",
        "",
        "by kind, where `[joint]` is given: `count` (of pieces; of whole hubs), `different` (kinds of them), `mass` "
        "(kg, of all), of cables and edge beams `length` (m, of all)",
        _hardware,
        {"type": "object", "additionalProperties": OF_KIND},
        rows=_hardware_rows,
    ),
    Figure(
        "sheet_use",
        "",
        "area of the parts over area of the sheets and coils they are cut from; null where all are cut from bars",
        sheet_use,
        nullable(NUMBER),
    ),
    *STOCK_FIGURES,
    Figure(
        "segments",
        "",
        "where `[segments]` is given: `id`, `mass` (kg, with hardware), and the numbers of `lamellas` it has pieces of "
        "and of `nodes`",
        _segments,
        list_of(record(id=TEXT, mass=NUMBER, lamellas=INTEGER, nodes=INTEGER)),
        always=False,
        rows=_segment_rows,
    ),
)

REPORT = (
    "parts",
    "parts_different",
    "sheets",
    "bow_max",
    "slot_width",
    "mass",
    "surface_weight",
    "hardware",
    "stock",
    "cut_length",
    "segments",
)
"""Order of the report's lines."""
