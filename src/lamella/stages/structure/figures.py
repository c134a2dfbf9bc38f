"""Figures of the structure: key, unit, meaning and value of each, and how the report shows it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from lamella.stages.figure import FLAG, INTEGER, NUMBER, TEXT, Figure, line, list_of, nullable, record
from lamella.stages.structure.output import StructureOutput

if TYPE_CHECKING:
    from lamella.structure.analysis.case_result import CaseResult

Rows = Iterator[tuple[str, str, str]]

CASE = record(
    name=TEXT,
    converged=FLAG,
    stable=FLAG,
    load_factor=NUMBER,
    displacement_max=NUMBER,
    deflection_max=NUMBER,
    von_mises_max=NUMBER,
    utilisation_max=NUMBER,
    edge_beam_utilisation=NUMBER,
    residual_share=NUMBER,
    buckling_factor=nullable(NUMBER),
    cables_slack=INTEGER,
    cable_force_max=NUMBER,
)
"""Schema of the figures of one case."""


def case_figures(case: CaseResult) -> dict[str, Any]:
    """Figures of one case by key."""
    return {
        "name": case.name,
        "converged": case.converged,
        "stable": case.stable,
        "load_factor": case.load_factor,
        "displacement_max": case.displacement_max,
        "deflection_max": case.deflection_max,
        "von_mises_max": case.von_mises_max,
        "utilisation_max": case.utilisation_max,
        "edge_beam_utilisation": case.edge_utilisation_max,
        "residual_share": case.residual_share,
        "buckling_factor": float(case.buckling[0]) if len(case.buckling) else None,
        "cables_slack": case.slack,
        "cable_force_max": float(case.cable_forces.max(initial=0.0)),
    }


def _case_rows(value: list[dict[str, Any]], summary: dict[str, Any]) -> Rows:
    for case in value:
        yield f"{case['name']}: largest utilisation", f"{case['utilisation_max']:.2f}", ""
        if case["deflection_max"]:
            yield f"{case['name']}: deflection", f"{1e3 * case['deflection_max']:.3g}", "mm"
        if case["buckling_factor"] is not None:
            yield f"{case['name']}: buckling factor", f"{case['buckling_factor']:.3g}", ""


def _frequency_rows(value: list[float], summary: dict[str, Any]) -> Rows:
    if value:
        yield "Lowest natural frequency", f"{value[0]:.3g}", "Hz"


FIGURES: tuple[Figure[StructureOutput], ...] = (
    Figure(
        "elements",
        "",
        "beam elements of the model",
        lambda out: len(out.analysis.model.structure.beams),
        INTEGER,
        rows=line("Beam elements", form=","),
    ),
    Figure(
        "spring_back",
        "m",
        "how far a node moves from the designed shape when the net is let go, on its supports or, where there are "
        "none, with its middle node held",
        lambda out: out.analysis.spring_back,
        NUMBER,
        rows=line("Springs back by", "mm", form=".3g", scale=1e3),
    ),
    Figure(
        "utilisation_max",
        "",
        "the largest of all cases",
        lambda out: max(case.utilisation_max for case in out.analysis.cases),
        NUMBER,
        rows=line("Largest utilisation", form=".2f"),
    ),
    Figure(
        "cases",
        "",
        "of the residual state, each load and each combination: `name`; `converged`, whether the whole load was "
        "reached, else `load_factor` is the share that was; `stable`; `displacement_max` of a node from the designed "
        "shape and `deflection_max` from the residual state (m); `von_mises_max` (Pa, of strips with residual "
        "stress), `utilisation_max` of all members and `edge_beam_utilisation`; `residual_share` of that stress; "
        "`buckling_factor`, the first load factor of linear buckling about the loaded state or the last stable one "
        "before it, or null; `cables_slack`, `cable_force_max` (N, of both cables of a line together)",
        lambda out: [case_figures(case) for case in out.analysis.cases],
        list_of(CASE),
        rows=_case_rows,
    ),
    Figure(
        "frequencies",
        "Hz",
        "natural frequencies of the residual state, ascending",
        lambda out: out.analysis.frequencies.tolist(),
        list_of(NUMBER),
        rows=_frequency_rows,
    ),
)

REPORT = ("elements", "spring_back", "utilisation_max", "cases", "frequencies")
"""Order of the report's lines."""
