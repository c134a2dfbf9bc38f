"""Figures of nets and segments in the crane."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from lamella.stages.figure import ABSENT, FLAG, INTEGER, NUMBER, TEXT, Figure, list_of, nullable, record

if TYPE_CHECKING:
    from lamella.stages.erection.output import ErectionOutput

Rows = Iterator[tuple[str, str, str]]


def _lifting(out: ErectionOutput) -> Any:
    if not any(one.lifts for one in out.segments):
        return ABSENT
    return [
        {
            "id": one.id,
            "points": case.points,
            "bracing": case.bracing,
            "nodes": case.lifted.nodes.tolist(),
            "weight": case.lifted.weight,
            "deflection": case.lifted.deflection,
            "von_mises_max": case.lifted.von_mises,
            "sling_max": None if case.lifted.poses is None else float(case.lifted.slings.max()),
            "holds": case.holds,
        }
        for one in out.segments
        for case in one.lifts
    ]


def _lifting_rows(value: list[dict[str, Any]], summary: dict[str, Any]) -> Rows:
    """By number of points, of all segments together: those that hold with each bracing."""
    for points in sorted({one["points"] for one in value}):
        for bracing in dict.fromkeys(one["bracing"] for one in value):
            those = [one for one in value if one["points"] == points and one["bracing"] == bracing]
            name = f"Lifted at {points} points, bracing: {bracing.replace('_', ' ')}"
            bends = [one["deflection"] for one in those if one["deflection"] is not None]
            if len(those) == 1 and bends:
                yield f"{name}, bends by", f"{bends[0]:.3f}", "m"
            else:
                yield name, f"{sum(one['holds'] for one in those)} of {len(those)}", "hold their shape"


LIFTING: Figure[ErectionOutput] = Figure(
    "lifting",
    "",
    "where `erection.lifting` is given, the net or each segment (`id`, empty for the whole net) lifted at `points` "
    '`nodes` under its own weight with the `bracing` "none", "cables", "edge_beams" or "both": `weight` (N), '
    "`deflection` from the designed shape after the best rigid motion (m), `von_mises_max` of a strip (Pa), largest "
    "force of a sling (`sling_max`, N), each null where no equilibrium was found, and whether it `holds`: bends by "
    "no more than `lifting.limit` of its extent",
    _lifting,
    list_of(
        record(
            id=TEXT,
            points=INTEGER,
            bracing=TEXT,
            nodes=list_of(INTEGER),
            weight=NUMBER,
            deflection=nullable(NUMBER),
            von_mises_max=nullable(NUMBER),
            sling_max=nullable(NUMBER),
            holds=FLAG,
        )
    ),
    always=False,
    rows=_lifting_rows,
)
