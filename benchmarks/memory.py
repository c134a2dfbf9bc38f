"""What a second computation costs in the same process: seconds over those of the first one.

CPU time of one thread; the ratios are those within one run.
"""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

from lamella import Memory, compute, parse_project, read_project

EXAMPLES = Path(__file__).parents[1] / "examples"
# key, value and the largest share of the first computation that it may cost
CHANGES: tuple[tuple[str, Any, float], ...] = (
    ("lamella.height", 0.07, 0.15),
    ("network.cells", 26, 0.5),
    ("fabrication.sheet", (6.0, 2.0), 0.15),
)


def main() -> None:
    """Print a table."""
    print(f"{'example':18s} {'first, s':>9s} " + " ".join(f"{key:>18s}" for key, _, _ in CHANGES))
    for example in ("08_two_rings", "10_saddle", "13_oculus", "14_three_columns", "16_hall"):
        project = read_project(EXAMPLES / f"{example}.toml")
        memory, seconds = Memory(), []
        changed = [project]
        for key, value, _ in CHANGES:
            tables = project.model_dump(exclude_none=True)
            table, _, name = key.partition(".")
            tables[table] = tables.get(table, {}) | {name: value}
            if key == "network.cells":
                tables[table].pop("spacing", None)
            changed.append(parse_project(tables))
        for one in changed:
            start = time.process_time()
            compute(one, folder=EXAMPLES, memory=memory)
            seconds.append(time.process_time() - start)
        ratios = " ".join(f"{one / seconds[0]:18.3f}" for one in seconds[1:])
        print(f"{example:18s} {seconds[0]:9.2f} {ratios}")
    print(f"{'limits':28s} " + " ".join(f"{limit:18.3f}" for _, _, limit in CHANGES))


if __name__ == "__main__":
    main()
