"""What a second computation costs in the same process, with what the first one left in a `lamella.Memory`."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from statistics import median
from typing import Any

from bench import Limit, Row, Table, clocked, show

from lamella import Memory, compute, parse_project, read_project

EXAMPLES = Path(__file__).parents[1] / "examples"
NAMES = ("08_two_rings", "10_saddle", "13_oculus", "14_three_columns", "16_hall")
# key, value and the largest share of the first computation that it may cost
CHANGES: tuple[tuple[str, Any, float], ...] = (
    ("lamella.height", 0.07, 0.15),
    ("network.cells", 30, 0.5),
    ("fabrication.sheet", (6.0, 2.0), 0.15),
)


def tables() -> Iterator[Table]:
    """A row an example."""
    rows: list[Row] = []
    shares: dict[str, list[float]] = {key: [] for key, _, _ in CHANGES}
    for example in NAMES:
        project = read_project(EXAMPLES / f"{example}.toml")
        memory = Memory()
        first, _ = clocked(lambda: compute(project, folder=EXAMPLES, memory=memory))  # noqa: B023 (called at once)
        row: dict[str, Any] = {"example": example, "first, s": first}
        for key, value, _ in CHANGES:
            written = project.model_dump(exclude_none=True)
            table, _, name = key.partition(".")
            written[table] = written.get(table, {}) | {name: value}
            if key == "network.cells":
                written[table].pop("spacing", None)
            changed = parse_project(written)
            again, _ = clocked(lambda: compute(changed, folder=EXAMPLES, memory=memory))  # noqa: B023
            row[f"other `{key}` / first"] = again / first
            shares[key].append(again / first)
        rows.append(row)
    yield Table(
        "A second computation",
        "Examples computed with a `lamella.Memory`, then again with one value changed: surface and net that do not "
        "hang on it are kept.",
        tuple(rows),
        tuple(
            Limit(f"other `{key}` / first, median of the examples", median(shares[key]), at_most)
            for key, _, at_most in CHANGES
        ),
    )


if __name__ == "__main__":
    show(tables())
