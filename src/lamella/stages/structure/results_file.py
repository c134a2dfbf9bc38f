"""structure/results.json: what every case does to every node of the net."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import orjson

from lamella.base.wording import one_line
from lamella.files.whole import write_whole
from lamella.structure.analysis.analyse import Analysis
from lamella.structure.analysis.case_result import CaseResult

SCHEMA = "lamella/structure/1"


def write_results(path: Path, analysis: Analysis, *, name: str, version: str) -> None:
    """Write the results of all cases, in the order of network.json's nodes."""
    content = {
        "schema": SCHEMA,
        "version": version,
        "units": "m, N, Pa, Hz",
        "name": one_line(name),
        "cases": [_case(case) for case in analysis.cases],
        "buckling": [{"case": case.name, "factors": case.buckling.tolist()} for case in analysis.cases[1:]],
        "frequencies": analysis.frequencies.tolist(),
    }
    write_whole(path, orjson.dumps(content, option=orjson.OPT_INDENT_2) + b"\n")


def _case(case: CaseResult) -> dict[str, Any]:
    return {
        "name": case.name,
        "converged": case.converged,
        "stable": case.stable,
        "load_factor": case.load_factor,
        "load_total": case.load_total.tolist(),
        "reaction_total": case.reaction_total.tolist(),
        "displacement_max": case.displacement_max,
        "deflection_max": case.deflection_max,
        "von_mises_max": case.von_mises_max,
        "utilisation_max": case.utilisation_max,
        "residual_share": case.residual_share,
        "nodes": case.displacements.tolist(),
    }
