"""Figures of a net that a driver on site, or its use as a mechanism, moves."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from lamella.stages.figure import ABSENT, FLAG, INTEGER, NUMBER, TEXT, Figure, nullable, record

if TYPE_CHECKING:
    from lamella.stages.erection.output import ErectionOutput

Rows = Iterator[tuple[str, str, str]]


def _way(out: ErectionOutput) -> Any:
    if out.divided or out.made[0].way is None:
        return ABSENT
    made, way = out.made[0], out.made[0].way
    last, stop = made.states[-1], way.stop
    told = {
        "kind": way.kind,
        "start": way.start,
        "gravity": way.gravity,
        "travel": way.travel,
        "force_max": float(np.abs(way.forces).max()) if way.forces.size else None,
        "reached": last.share if stop is None else stop.share,
        "limit_points": len(way.snaps),
        "stop": None if stop is None else {"share": stop.share, "state": stop.state, "node": stop.node},
        "off_design": way.off_design,
        "joint_angle_min_deg": float(last.angles.min()),
        "joint_angle_max_deg": float(last.angles.max()),
    }
    if made.motion is not None:
        told["motion"] = {"node": made.motion.node, "least": made.motion.least, "most": made.motion.most}
    return told


def _way_rows(value: dict[str, Any], summary: dict[str, Any]) -> Rows:
    if "motion" in value:
        yield "Moves as a mechanism", f"{value['motion']['least']:.1f} to {value['motion']['most']:.1f}", "°"
    else:
        yield "Driven on site by", value["kind"], f"from the {value['start']} net"
        yield "Off its designed shape at the end", f"{value['off_design']:.3f}", "m"


WAY: Figure[ErectionOutput] = Figure(
    "way",
    "",
    "of a driver on site or a mechanism: `kind` of the driver, `start` and whether the net weighs (`gravity`), "
    "`travel` of the driver (m; of joints rad), largest force of a cable or a moved node (`force_max`, N), "
    "`reached` share of the way, `limit_points` that the net snapped at, the `stop` where no equilibrium was found "
    "beyond (share, state, node; or null), `off_design`, how far the last state is off the designed shape (m), "
    "`joint_angle_min_deg`, `joint_angle_max_deg` in it, and of a mechanism its `motion` (the joint's node, its "
    "angle in the first and the last state, deg)",
    _way,
    record(
        ("motion",),
        kind=TEXT,
        start=TEXT,
        gravity=FLAG,
        travel=NUMBER,
        force_max=nullable(NUMBER),
        reached=NUMBER,
        limit_points=INTEGER,
        stop=nullable(record(share=NUMBER, state=INTEGER, node=INTEGER)),
        off_design=NUMBER,
        joint_angle_min_deg=NUMBER,
        joint_angle_max_deg=NUMBER,
        motion=record(node=INTEGER, least=NUMBER, most=NUMBER),
    ),
    always=False,
    rows=_way_rows,
)
