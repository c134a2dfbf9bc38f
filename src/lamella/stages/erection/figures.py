"""Figures of the erection: key, unit, meaning and value of each, and how the report shows it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from lamella.base.wording import counted
from lamella.stages.erection.lifting_figures import LIFTING
from lamella.stages.erection.way_figures import WAY
from lamella.stages.figure import ABSENT, FLAG, INTEGER, NUMBER, PAIR, TEXT, Figure, line, list_of, nullable, record

if TYPE_CHECKING:
    from lamella.erection.erection import Erection
    from lamella.stages.erection.output import ErectionOutput

Rows = Iterator[tuple[str, str, str]]


def _flat_of(made: Erection) -> dict[str, Any]:
    flat, angles = made.flat, made.states[0].angles
    return {
        "height": flat.height,
        "radius": None if flat.planar else flat.radius,
        "off": flat.off,
        "lies": flat.lies,
        "size": list(flat.size),
        "joint_angle_min_deg": float(angles.min()),
        "joint_angle_max_deg": float(angles.max()),
        "overlaps": len(flat.overlaps),
    }


def _flat(out: ErectionOutput) -> dict[str, Any]:
    every = [_flat_of(made) for made in out.made]
    worst = max(every, key=lambda one: one["off"])
    return {
        "height": max(one["height"] for one in every),
        "radius": worst["radius"],
        "off": worst["off"],
        "lies": all(one["lies"] for one in every),
        "size": max((one["size"] for one in every), key=lambda size: size[0] * size[1]),
        "joint_angle_min_deg": min(one["joint_angle_min_deg"] for one in every),
        "joint_angle_max_deg": max(one["joint_angle_max_deg"] for one in every),
        "overlaps": sum(one["overlaps"] for one in every),
    }


def _segments(out: ErectionOutput) -> Any:
    if not out.divided:
        return ABSENT
    return [
        {"id": one.id, "mass": one.mass, "fault": one.fault or None} | ({} if one.made is None else _told(one.made))
        for one in out.segments
    ]


def _told(made: Erection) -> dict[str, Any]:
    return {"flat": _flat_of(made)} | {key: of(made) for key, of in OF_SEGMENT.items()}


def _segment_rows(value: list[dict[str, Any]], summary: dict[str, Any]) -> Rows:
    yield "Segments laid flat", f"{sum('flat' in one and one['flat']['lies'] for one in value)} of {len(value)}", ""


BRACES = ("cables", "edge_beams", "both")

FLAT = record(
    height=NUMBER,
    radius=nullable(NUMBER),
    off=NUMBER,
    lies=FLAG,
    size=PAIR,
    joint_angle_min_deg=NUMBER,
    joint_angle_max_deg=NUMBER,
    overlaps=INTEGER,
)


def _flat_rows(value: dict[str, Any], summary: dict[str, Any]) -> Rows:
    length, width = value["size"]
    yield "Flat state", f"{length:.2f} x {width:.2f}", "m"
    if value["radius"] is not None:
        yield "Lies on a sphere of radius", f"{value['radius']:.4g}", "m"
    yield "Joint angles, flat", f"{value['joint_angle_min_deg']:.1f} to {value['joint_angle_max_deg']:.1f}", "°"
    if value["overlaps"]:
        yield "Overlaps, flat", counted(value["overlaps"], "pair"), "of lamellas"


def _braced_rows(value: dict[str, Any], summary: dict[str, Any]) -> Rows:
    names = {"cables": "cables", "edge_beams": "edge beams", "both": "cables and edge beams"}
    for key, back in value.items():
        if back is not None:
            yield f"Springs back, with {names[key]}, by", f"{back:.3f}", "m"


def _gap(made: Erection) -> float | None:
    return min((state.stiffness_gap for state in made.states if state.stiffness_gap is not None), default=None)


def _leaves_plane(made: Erection) -> float | None:
    """By the square of the height over the plane, which grows steadily where the net begins to leave it."""
    if not made.flat.planar:
        return None
    size = made.model.structure.size
    heights = np.array([state.height for state in made.states])
    shares = np.array([state.share for state in made.states])
    up = np.flatnonzero(heights > 1e-6 * size)
    if not len(up) or up[0] == 0:
        return None
    first = int(up[0])
    if first + 1 < len(shares):
        one, two = heights[first] ** 2, heights[first + 1] ** 2
        reached = shares[first] - one * (shares[first + 1] - shares[first]) / (two - one)
        return float(np.clip(reached, shares[first - 1], shares[first]))
    return float(shares[first - 1])


def _on_the_way(name: str) -> Callable[[Erection], float]:
    return lambda made: max(getattr(state, name) for state in made.states)


def _worst(of: Callable[[Erection], float | None], choose: Callable[[Iterator[float]], float] = max) -> Any:
    """Of the whole net or all segments; null where none has it."""

    def value(out: ErectionOutput) -> float | None:
        found = [one for one in map(of, out.made) if one is not None]
        return choose(iter(found)) if found else None

    return value


def _joint_moment(made: Erection) -> float | None:
    if made.driver is None:
        return None
    return max(abs(state.driver) for state in made.states) * float(np.abs(made.driver.weights).max())


def _driver_rows(value: float, summary: dict[str, Any]) -> Rows:
    way = summary.get("way")
    yield "Driver, at most", f"{value:.4g}", "N" if way and way["force_max"] is not None else "N m"


OF_SEGMENT: dict[str, Callable[[Erection], Any]] = {
    "energy_designed": lambda made: made.locked.energy,
    "driver_max": _on_the_way("driver"),
    "strong_axis_stress_max": _on_the_way("strong_axis"),
    "von_mises_max": _on_the_way("von_mises"),
    "slot_width_needed": lambda made: made.slot_width_needed,
    "spring_back": lambda made: made.spring_back,
    "spring_back_cables": lambda made: made.braced.get("cables"),
}
"""What is told of each segment."""


FIGURES: tuple[Figure[ErectionOutput], ...] = (
    Figure(
        "flat",
        "",
        "the flat state: `height` over its plane of least squares (m), `radius` of its sphere (m; null where strips "
        "are straight), `off`, how far nodes are off that plane or sphere (m), `lies`, whether that is no more than "
        "strips give, `size` of the floor it takes (m), smallest and largest joint angle from A to B "
        "(`joint_angle_min_deg`, `joint_angle_max_deg`), `overlaps`, pairs of lamellas that cross without a joint",
        _flat,
        FLAT,
        rows=_flat_rows,
    ),
    Figure("states", "", "states of the way", lambda out: len(out.made[0].states), INTEGER),
    Figure(
        "energy_flat",
        "J",
        "elastic energy of all layers, flat",
        _worst(lambda made: made.states[0].energy, sum),
        NUMBER,
        rows=line("Elastic energy, flat", "J"),
    ),
    Figure(
        "energy_designed",
        "J",
        "the same, joints locked in the designed shape",
        _worst(lambda made: made.locked.energy, sum),
        NUMBER,
        rows=line("Elastic energy, designed", "J"),
    ),
    Figure(
        "driver_max",
        "N m",
        "largest moment of the driver: each joint is turned by as much as its weight says, the sum of their squares 1; "
        "of a driver on site its largest force, N",
        _worst(_on_the_way("driver")),
        NUMBER,
        rows=_driver_rows,
    ),
    Figure(
        "joint_moment_max",
        "N m",
        "largest moment that a joint is driven by; null where a driver on site drives the net",
        _worst(_joint_moment),
        nullable(NUMBER),
        rows=line("Moment on a joint, at most", "N m"),
    ),
    Figure(
        "strong_axis_stress_max",
        "Pa",
        "largest bending stress about the strong axis on the way",
        _worst(_on_the_way("strong_axis")),
        NUMBER,
        rows=line("Strong-axis stress on the way", "MPa", scale=1e-6),
    ),
    Figure(
        "von_mises_max",
        "Pa",
        "largest equivalent stress on the way",
        _worst(_on_the_way("von_mises")),
        NUMBER,
        rows=line("Equivalent stress on the way", "MPa", scale=1e-6),
    ),
    Figure(
        "leaves_plane",
        "",
        "share of the way at which the net leaves its plane; null where it never lies in one",
        _worst(_leaves_plane, min),
        nullable(NUMBER),
    ),
    Figure(
        "stiffness_gap_min",
        "",
        "smallest 1 - k1/k2 of the stable states, k the stiffness of the easiest and the "
        "second easiest motion with free joints: near 0 the net opens in a second way; null where no state is stable "
        "without the driver",
        _worst(_gap, min),
        nullable(NUMBER),
        rows=line("Stiffness gap, at least", form=".2f"),
    ),
    Figure(
        "slot_width_needed",
        "m",
        "width of slots in which the joints turn as far as they do; null where lamellas are stacked",
        _worst(lambda made: made.slot_width_needed),
        nullable(NUMBER),
        rows=line("Slots needed on the way", "mm", scale=1e3, form=".2f"),
    ),
    Figure(
        "spring_back",
        "m",
        "how far a node is from where it was designed where joints are locked and nothing else "
        "holds the net, after the best rigid motion",
        _worst(lambda made: made.spring_back),
        NUMBER,
        rows=line("Springs back by", "m", form=".3f"),
    ),
    Figure(
        "spring_back_braced",
        "m",
        "the same with what the project braces the net by: `cables` on its diagonals, `edge_beams`, `both`; null where "
        "no equilibrium was found",
        lambda out: {} if out.divided else out.made[0].braced,
        record(
            ("cables", "edge_beams", "both"),
            cables=nullable(NUMBER),
            edge_beams=nullable(NUMBER),
            both=nullable(NUMBER),
        ),
        rows=_braced_rows,
    ),
    Figure(
        "segments",
        "",
        "where `[segments]` is given: `id`, `mass` (kg, with hardware), `fault`, why it could not be laid flat, or "
        "null; else `flat` and some of the figures of each. All other figures are then of the worst segment, energies "
        "of all",
        _segments,
        list_of(
            record(
                ("flat", *OF_SEGMENT),
                id=TEXT,
                mass=NUMBER,
                fault=nullable(TEXT),
                flat=FLAT,
                **dict.fromkeys(OF_SEGMENT, nullable(NUMBER)),
            )
        ),
        always=False,
        rows=_segment_rows,
    ),
    LIFTING,
    Figure(
        "each_joint",
        "",
        "whether each joint is turned to its own angle on the way, as one moment shared by all would "
        "not lead the net to its designed shape",
        lambda out: any(made.each_joint for made in out.made),
        FLAG,
    ),
    WAY,
    Figure(
        "hold",
        "N m",
        "moment on each joint that keeps the net from folding up in the flat state; 0 where it lies by itself",
        _worst(lambda made: made.hold),
        NUMBER,
    ),
)

REPORT = (
    "segments",
    "flat",
    "energy_flat",
    "energy_designed",
    "driver_max",
    "joint_moment_max",
    "strong_axis_stress_max",
    "von_mises_max",
    "stiffness_gap_min",
    "slot_width_needed",
    "spring_back",
    "spring_back_braced",
    "way",
    "lifting",
)
"""Order of the report's lines."""
