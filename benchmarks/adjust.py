"""Adjusting uneven sketches until their nets close: CPU seconds of one thread each, and which do.

Fixed sets of random sketches: every control point of an elliptic rim with two arches or three changed smoothly by up to
0.3 m, with one ring or three in it; rings alone that may change ("few"); rings so near to where the umbilics are that
these are next to a rim ("near"). With the name of a set, and numbers of its sketches, only these:

    python benchmarks/adjust.py one 3 7

A row a sketch then; one a set otherwise. Of each: whether the net closes, or why it was refused; CPU seconds; steps;
how far the rim is from the drawn one, over what it may be (more than 1 breaks the limit); the longest time without a
report.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from bench import Limit, Row, Table, show
from scipy.spatial import cKDTree

from lamella import InputError, parse_project, read_project
from lamella.base.progress import Report
from lamella.project.tables import FormFoundTable
from lamella.stages.surface.adjusted_table import adjust_table
from lamella.stages.surface.boundary_of_tables import boundary_loops

EXAMPLE = Path(__file__).parents[1] / "examples" / "17_gridshell.toml"
# CPU seconds: the median of the sketches of a set, and each of them
LIMITS = {"example": (8.0, 8.0), "one": (4.0, 30.0), "three": (30.0, 30.0), "few": (4.0, 30.0), "near": (8.0, 30.0)}
COUNTS = {"example": 1, "one": 30, "three": 5, "few": 8, "near": 8}
FINE = 20_000


def rim_points(rng: np.random.Generator, halves: tuple[float, float], arch: float) -> np.ndarray:
    """Points (n, 3), m, of an ellipse with two arches, its heights and plan changed smoothly by up to 0.3 m."""
    count = int(rng.integers(18, 37))
    t = 2 * np.pi * np.arange(count) / count
    points = np.column_stack([halves[0] * np.cos(t), halves[1] * np.sin(t), arch - arch * np.cos(2 * t)])
    change = sum(
        np.outer(np.cos(k * t), rng.normal(size=3)) + np.outer(np.sin(k * t), rng.normal(size=3)) for k in range(4)
    )
    return np.asarray(points + 0.3 * change / np.linalg.norm(change, axis=1).max())


def sketch(kind: str, seed: int) -> dict[str, Any]:
    """Tables of a project, by the name of its set."""
    rng = np.random.default_rng([13, sorted(COUNTS).index(kind), seed])
    halves = (float(rng.uniform(5, 7)), float(rng.uniform(3.8, 5)))
    arch = float(rng.uniform(1.8, 3.0))
    adjust = {
        "move": float(rng.uniform(0.1, 0.4)),
        "scale": float(rng.uniform(0.03, 0.12)),
        "tilt": float(rng.uniform(3, 8)),
    }
    rim: dict[str, Any] = {"name": "rim", "points": rim_points(rng, halves, arch).tolist()}
    if kind != "few":
        rim["adjust"] = {"points": float(rng.uniform(0.15, 0.45))}
    if kind == "three":
        places = [(3.0, 0.0), (-1.5, 2.0), (-1.5, -2.0)]
        radii = rng.uniform(0.6, 0.8, 3).tolist()
    else:
        places = [(float(rng.uniform(-0.4, 0.4)), float(rng.uniform(-0.3, 0.3)))]
        # the umbilics of the symmetric one are at about half of the shorter axis
        radii = [float(rng.uniform(1.0, 1.5) if kind != "near" else rng.uniform(0.42, 0.5) * halves[1])]
    rings = [
        {
            "name": f"oculus {k}" if k else "oculus",
            "circle": {
                "center": [x, y, float(rng.uniform(0.7, 0.9)) * arch],
                "radius": radius,
                "normal": [float(rng.uniform(-0.05, 0.05)), float(rng.uniform(-0.05, 0.05)), 1.0],
            },
            "adjust": adjust,
        }
        for k, ((x, y), radius) in enumerate(zip(places, radii, strict=True))
    ]
    cells = 2 * int(rng.integers(8, 20))
    return {
        "surface": {"kind": "form-found", "boundary": [rim, *rings]},
        "network": {"cells": cells, "closing": "adjust"},
    }


def farthest(old: FormFoundTable, new: FormFoundTable) -> float:
    """How far points of the rim are from the drawn one, at most, over what its `adjust` allows."""
    allowed = old.boundary[0].adjust
    if allowed is None or not allowed.points:
        return 0.0
    t = np.arange(FINE) / FINE
    before, after = (boundary_loops(table, EXAMPLE.parent)[0].at(t) for table in (old, new))
    return float(cKDTree(before).query(after[::10])[0].max()) / (allowed.points + allowed.move)


class Listener:
    """The longest time between two reports that a user sees, CPU seconds."""

    def __init__(self) -> None:
        self.last, self.longest = time.process_time(), 0.0

    def __call__(self, report: Report) -> None:
        now = time.process_time()
        self.longest, self.last = max(self.longest, now - self.last), now


def measured(kind: str, number: int) -> dict[str, Any]:
    """A row of one sketch."""
    project = read_project(EXAMPLE) if kind == "example" else parse_project(sketch(kind, number))
    table = project.surface
    assert isinstance(table, FormFoundTable)
    listener = Listener()
    begin = time.process_time()
    row: dict[str, Any] = {"set": kind, "sketch": number}
    found: dict[str, Any]
    try:
        adjusted = adjust_table(
            table, EXAMPLE.parent, cells=project.network.cells, spacing=project.network.spacing, progress=listener
        )
    except InputError as error:
        row |= {"CPU s": time.process_time() - begin, "silent, s": listener.longest}
        found = {"closes": "no", "why not": error.message.replace("|", "/")}
    else:
        row |= {"CPU s": time.process_time() - begin, "silent, s": listener.longest}
        figures = adjusted.figures
        found = {
            "closes": "yes",
            "missed before, cells": figures["missed_before"],
            "after": figures["missed_after"],
            "steps": figures["steps"],
            "rim / its limit": farthest(table, adjusted.table),
        }
    return row | found


def set_table(kind: str, numbers: Iterable[int]) -> Table:
    """Some sketches of a set, one by one."""
    rows = []
    for number in numbers:
        rows.append(measured(kind, number))
        print(rows[-1], file=sys.stderr, flush=True)
    return Table(f"Sketches of the set {kind!r}", "CPU seconds of one thread.", tuple(rows))


def tables() -> Iterator[Table]:
    """A row a set."""
    rows: list[Row] = []
    limits = []
    for kind, count in COUNTS.items():
        sketches = set_table(kind, range(count)).rows
        seconds = [float(row["CPU s"]) for row in sketches]  # type: ignore[arg-type]
        closed = [row for row in sketches if row["closes"] == "yes"]
        middle, most = float(np.median(seconds)), max(seconds)
        rims = [float(row["rim / its limit"]) for row in closed]  # type: ignore[arg-type]
        rows.append(
            {
                "set": kind,
                "sketches": len(sketches),
                "close": len(closed),
                "median, CPU s": middle,
                "most, CPU s": most,
                "silent, s": max(float(row["silent, s"]) for row in sketches),  # type: ignore[arg-type]
                "rim / its limit": max(rims, default=None),
            }
        )
        limits += [
            Limit(f"{kind}: median, CPU s", middle, LIMITS[kind][0]),
            Limit(f"{kind}: most, CPU s", most, LIMITS[kind][1]),
        ]
    yield Table(
        "Boundaries adjusted until their nets close",
        "Example 17, and random uneven sketches: rims with two arches or three and one ring in them, three rings, "
        "rings alone that may change (few), rings next to the umbilics (near). How many close, what that takes, the "
        "longest time without a word, and how far rims are from the drawn ones over what they may be.",
        tuple(rows),
        tuple(limits),
    )


if __name__ == "__main__":
    kinds = sys.argv[1:2]
    if kinds:
        show([set_table(kinds[0], [int(word) for word in sys.argv[2:]] or range(COUNTS[kinds[0]]))])
    else:
        show(tables())
