"""Figures of the structure: key, unit, meaning and value of each, and how the report shows it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from lamella.stages.figure import ABSENT, FLAG, INTEGER, NUMBER, TEXT, Figure, line, list_of, nullable, record
from lamella.stages.structure.output import StructureOutput

if TYPE_CHECKING:
    from lamella.structure.analysis.case_result import CaseResult
    from lamella.structure.analysis.compared_case import ComparedCase

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


STAGE = record(name=TEXT, displacement_max=NUMBER, utilisation_max=NUMBER, prop_force_max=NUMBER)
"""Schema of a stage of construction."""

FAILURE = record(
    case=TEXT,
    linear_buckling=nullable(NUMBER),
    first_yield=nullable(NUMBER),
    first_branch=nullable(NUMBER),
    limit_point=nullable(NUMBER),
    followed_to=NUMBER,
    ended_by=TEXT,
)
"""Schema of a load factor to failure."""

COMPARED = record(
    variant=TEXT,
    case=TEXT,
    deflection_max=nullable(NUMBER),
    utilisation_max=nullable(NUMBER),
    buckling_factor=nullable(NUMBER),
    axial_share=nullable(NUMBER),
    remark=TEXT,
)
"""Schema of a case of a variant."""


def _stages(out: StructureOutput) -> Any:
    from lamella.structure.export.further_rows import prop_force_max

    if not out.analysis.stages:
        return ABSENT
    return [
        {
            "name": stage.name,
            "displacement_max": stage.displacement_max,
            "utilisation_max": stage.utilisation_max,
            "prop_force_max": prop_force_max(stage),
        }
        for stage in out.analysis.stages
    ]


def _failures(out: StructureOutput) -> Any:
    return [
        {
            "case": one.name,
            "linear_buckling": one.linear_factor,
            "first_yield": one.yield_factor,
            "first_branch": one.branch_factor,
            "limit_point": one.limit_factor,
            "followed_to": one.reached,
            "ended_by": one.reason,
        }
        for one in out.failures
    ] or ABSENT


def _compared(cases: tuple[ComparedCase, ...]) -> Any:
    return [
        {
            "variant": one.variant,
            "case": one.case,
            "deflection_max": one.deflection_max,
            "utilisation_max": one.utilisation_max,
            "buckling_factor": one.buckling_factor,
            "axial_share": None if one.shares is None else one.shares.axial,
            "remark": one.reason,
        }
        for one in cases
    ] or ABSENT


def _stage_rows(value: list[dict[str, Any]], summary: dict[str, Any]) -> Rows:
    for stage in value:
        yield f"{stage['name']}: shift", f"{1e3 * stage['displacement_max']:.3g}", "mm"
        yield f"{stage['name']}: utilisation", f"{stage['utilisation_max']:.2f}", ""


def _failure_rows(value: list[dict[str, Any]], summary: dict[str, Any]) -> Rows:
    for case in value:
        for label, key in (
            ("linear buckling", "linear_buckling"),
            ("first yield", "first_yield"),
            ("first branch", "first_branch"),
            ("limit point", "limit_point"),
        ):
            if case[key] is not None:
                yield f"{case['case']}: {label} at", f"{case[key]:.3g}", "times"
        yield f"{case['case']}: followed to", f"{case['followed_to']:.3g}", "times"


def _compared_rows(value: list[dict[str, Any]], summary: dict[str, Any]) -> Rows:
    for one in value:
        label = f"{one['variant']}, {one['case']}"
        if one["deflection_max"] is None:
            yield label, one["remark"], ""
            continue
        told = f"{1e3 * one['deflection_max']:.3g} mm, utilisation {one['utilisation_max']:.2f}"
        if one["buckling_factor"] is not None:
            told += f", buckling at {one['buckling_factor']:.3g}"
        yield label, told, ""


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
    Figure(
        "construction",
        "",
        "where the order of construction is given: at the end of every stage, `displacement_max` from the designed "
        "shape (m), `utilisation_max` and `prop_force_max` (N)",
        _stages,
        list_of(STAGE),
        always=False,
        rows=_stage_rows,
        section="Construction",
    ),
    Figure(
        "failure",
        "",
        "where `[structure.failure]` is given, multiples of each case: `linear_buckling` about the state without "
        "loads, and on the non-linear path `first_yield`, `first_branch`, `limit_point`, null where there is none up "
        "to `followed_to`",
        _failures,
        list_of(FAILURE),
        always=False,
        rows=_failure_rows,
        section="Load factor to failure",
    ),
    Figure(
        "sensitivity",
        "",
        "where `[structure.sensitivity]` is given: each case of each variant, the designed one first; `axial_share` of "
        "the energy that the load adds is carried as a shell does",
        lambda out: _compared(out.sensitivity),
        list_of(COMPARED),
        always=False,
        rows=_compared_rows,
        section="Sensitivity",
    ),
    Figure(
        "variants",
        "",
        "where `[[structure.variant]]` is given: the same of these",
        lambda out: _compared(out.variants),
        list_of(COMPARED),
        always=False,
        rows=_compared_rows,
        section="Variants",
    ),
)

REPORT = (
    *("elements", "spring_back", "utilisation_max", "cases", "frequencies"),
    *("construction", "failure", "sensitivity", "variants"),
)
"""Order of the report's lines."""
