"""How a run grows with the net: CPU seconds of every stage and of the files, memory, and exponents between sizes."""

from __future__ import annotations

import itertools
import json
import resource
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from bench import Limit, Row, Table, alone, clocked, exponent, memory_gb, show

EXAMPLES = Path(__file__).parents[1] / "examples"
STAGES = ("surface", "network", "lamellas", "fabrication", "files", "report")
"""Files are all of a run, the report among them, which is measured by itself too."""
UNDULOID = {"kind": "unduloid", "neck_radius": 1.6, "bulge_radius": 2.8, "height": [-4.0, 4.0]}
# cells around the unduloid for about 1k, 10k, 100k and 400k nodes, and around the oculus for 1k, 10k and 60k
CELLS = {"unduloid": (26, 84, 269, 537), "oculus": (28, 96, 240)}
EXPONENT_MAX = 1.15
# of computation and files over the computation, at 10,000 nodes
WITH_FILES_MAX = 2.5
# CPU seconds and GB of 100,000 nodes with their files
SECONDS_MAX, GB_MAX = 60.0, 3.0


def measure(kind: str, cells: int) -> dict[str, float]:
    """Seconds of one run with all its files, its memory and the size of its folder."""
    from lamella import compute, parse_project, read_project, write
    from lamella.stages.report import report_data
    from lamella.view.report import report_html

    surface: Any = UNDULOID
    if kind == "oculus":
        surface = read_project(EXAMPLES / "13_oculus.toml").model_dump(exclude_none=True)["surface"]
    tables: dict[str, Any] = {"name": "growth", "surface": surface}
    with tempfile.TemporaryDirectory() as folder:
        # what is imported and compiled once is nothing that grows
        write(compute(parse_project(tables)), Path(folder) / "warm")
        results = compute(parse_project(tables | {"network": {"cells": cells}}))
        out = Path(folder) / "out"
        write(results, out)
        seconds = json.loads((out / "summary.json").read_text("utf-8"))["seconds"]
        size = sum(path.stat().st_size for path in out.rglob("*"))
    seconds["report"] = clocked(lambda: report_html(report_data(results)))[0]
    network = results.network
    assert network is not None
    children = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * (1 if sys.platform == "darwin" else 1024) / 1e9
    return {
        "nodes": len(network.node_points),
        "samples": len(network.sample_points),
        **{f"{stage}, s": seconds[stage] for stage in STAGES},
        "memory, GB": max(memory_gb(), children),
        "folder, MB": size / 1e6,
    }


def _computation(row: Row) -> float:
    return float(sum(float(row[f"{stage}, s"] or 0) for stage in STAGES[:-2]))


def _growth(row: Row, other: Row) -> dict[str, float]:
    """Exponent of each stage by the number of nodes; of stages below a hundredth of a second it tells nothing."""
    sizes = float(row["nodes"] or 0), float(other["nodes"] or 0)
    found = {}
    for stage in STAGES:
        one, two = float(row[f"{stage}, s"] or 0), float(other[f"{stage}, s"] or 0)
        if two > 0.01:
            found[stage] = exponent((sizes[0], max(one, 0.01)), (sizes[1], two))
    return found


def tables() -> Iterator[Table]:
    """Two for each kind of net: seconds, and exponents."""
    for kind, name in (("unduloid", "closed form"), ("oculus", "form-found")):
        rows: list[dict[str, float]] = [alone(measure, kind, cells) for cells in CELLS[kind]]
        limits = [
            Limit(f"{stage}: exponent from {rows[0]['nodes']:,} to {rows[-1]['nodes']:,} nodes", value, EXPONENT_MAX)
            for stage, value in _growth(rows[0], rows[-1]).items()
        ]
        with_files = (_computation(rows[1]) + rows[1]["files, s"]) / _computation(rows[1])
        limits.append(Limit(f"all / computation at {rows[1]['nodes']:,} nodes", with_files, WITH_FILES_MAX))
        if kind == "unduloid":
            large = f"at {rows[2]['nodes']:,} nodes, with files"
            limits += [
                Limit(f"CPU seconds {large}", _computation(rows[2]) + rows[2]["files, s"], SECONDS_MAX),
                Limit(f"memory {large}, GB", rows[2]["memory, GB"], GB_MAX),
            ]
        yield Table(
            f"Growth with the net ({name})",
            "Whole runs, each in a process of its own, with all files; the report, one of them, once more by itself. "
            "Above 20,000 nodes a cell has 8 samples instead of 16.",
            tuple(rows),
            tuple(limits),
        )
        yield Table(
            f"Exponents of growth ({name})",
            "By the number of nodes, from each size to the next.",
            tuple(
                {"from": f"{one['nodes']:,}", "to": f"{other['nodes']:,}", **_growth(one, other)}
                for one, other in itertools.pairwise(rows)
            ),
        )


if __name__ == "__main__":
    show(tables())
