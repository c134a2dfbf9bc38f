"""What the tables below [structure] ask for besides the load cases."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from lamella.base.drawing_origin import drawing_origin
from lamella.base.errors import InputError
from lamella.base.progress import Progress, Report
from lamella.project.structure_tables import StructureTable
from lamella.stages.actions_of_tables import Actions
from lamella.stages.keys import keys
from lamella.stages.stage import Upstream
from lamella.stages.structure.asked_cases import asked_cases
from lamella.stages.structure.compared import compared
from lamella.stages.structure.output import StructureOutput
from lamella.stages.structure.variant import sensitivity_variants, variant_of
from lamella.structure.actions.places import refuse_far
from lamella.structure.analysis.analyse import Analysis
from lamella.structure.analysis.case_result import CaseResult
from lamella.structure.analysis.compared_case import ComparedCase
from lamella.structure.analysis.driven import Driven, driven
from lamella.structure.analysis.failure import Failure, load_to_failure
from lamella.structure.equilibrium import Equilibrium


def further_analyses(up: Upstream, actions: Actions, analysis: Analysis, progress: Progress) -> StructureOutput:
    """All that is asked for, beside the analysis of the cases."""
    return StructureOutput(
        analysis,
        _failures(up, analysis, progress),
        _driven(up, analysis, progress),
        _sensitivity(up, actions, analysis, progress),
        _variants(up, actions, analysis, progress),
    )


def _table(up: Upstream) -> StructureTable:
    return up.project.structure or StructureTable()


def _start(analysis: Analysis, name: str) -> Equilibrium:
    """The state without loads, with the loads of a case to come."""
    case = next(case for case in analysis.cases[1:] if case.name == name)
    return replace(case.rest, loads=case.equilibrium.loads)


def _use(analysis: Analysis) -> Callable[[Equilibrium], float]:
    rest = analysis.cases[0]
    return lambda state: CaseResult("", analysis.model, state, rest.equilibrium, "", np.zeros(0)).utilisation_max


def _failures(up: Upstream, analysis: Analysis, progress: Progress) -> tuple[Failure, ...]:
    table = _table(up).failure
    if table is None:
        return ()
    use = _use(analysis)
    return tuple(
        load_to_failure(name, _start(analysis, name), use, most=table.factor_max, progress=progress)
        for name in asked_cases(up.project, table.cases, "structure.failure.cases")
    )


def _driven(up: Upstream, analysis: Analysis, progress: Progress) -> Driven | None:
    table = _table(up).displacement
    if table is None:
        return None
    network, origin = up.outputs["network"].network, drawing_origin(up.surface)
    away = np.linalg.norm(network.node_points + origin - np.array(table.near), axis=1)
    # of nodes alike the first, whatever the last bits
    node = int(np.round(away / max(float(away.max()), np.finfo(float).tiny), 9).argmin())
    with keys("structure.displacement"):
        refuse_far(network.node_points, table.near, float(away[node]))
    progress(Report.step(f"node {node} driven by load case {table.case}"))
    start, way = _start(analysis, table.case), np.array(table.direction)
    with keys("structure.displacement", loads="structure.displacement.case"):
        return driven(table.case, start, node, way, table.by, _use(analysis), steps=table.steps)


def _sensitivity(up: Upstream, actions: Actions, analysis: Analysis, progress: Progress) -> tuple[ComparedCase, ...]:
    table = _table(up).sensitivity
    if table is None:
        return ()
    cases = asked_cases(up.project, table.cases, "structure.sensitivity.cases")
    thickness = up.project.lamella.thickness
    if table.thickness >= thickness:
        raise InputError(
            f"strips of {thickness:g} m cannot be thinner by {table.thickness:g} m",
            "give less than their thickness",
            "structure.sensitivity.thickness",
        )
    variants = sensitivity_variants(table, thickness)
    return tuple(compared(up, actions, analysis.cases, variants, cases, progress))


def _variants(up: Upstream, actions: Actions, analysis: Analysis, progress: Progress) -> tuple[ComparedCase, ...]:
    tables = _table(up).variant
    if not tables:
        return ()
    cases = asked_cases(up.project, None, "structure.variant")
    return tuple(compared(up, actions, analysis.cases, map(variant_of, tables), cases, progress))
