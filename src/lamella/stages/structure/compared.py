"""Variants of a structure beside the designed one: a row for each of them and each case."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from lamella.base.errors import InputError
from lamella.base.progress import Progress, Report, silent
from lamella.stages.actions_of_tables import Actions
from lamella.stages.stage import Upstream
from lamella.stages.structure.model_of_tables import model_of
from lamella.stages.structure.variant import Variant
from lamella.structure.analysis.analyse import analyse
from lamella.structure.analysis.case_result import CaseResult
from lamella.structure.analysis.compared_case import ComparedCase

DESIGNED = "as designed"


def compared(
    up: Upstream,
    actions: Actions,
    designed: Iterable[CaseResult],
    variants: Iterable[Variant],
    cases: tuple[str, ...],
    progress: Progress,
) -> Iterator[ComparedCase]:
    """The designed structure's cases of these names, then those of each variant."""
    for case in designed:
        if case.name in cases:
            yield ComparedCase.of(DESIGNED, case)
    kept = list(variants)
    for k, variant in enumerate(kept):
        progress(Report.step(f"variant: {variant.name}", k / len(kept)))
        try:
            found = _analysed(up, actions, variant, cases)
        except InputError as error:
            yield from (ComparedCase(variant.name, name, error.message) for name in cases)
        else:
            yield from (ComparedCase.of(variant.name, case) for case in found)


def _analysed(up: Upstream, actions: Actions, variant: Variant, cases: tuple[str, ...]) -> list[CaseResult]:
    modelled = model_of(*variant.applied(up, actions))
    analysis = analyse(
        modelled.model,
        [case for case in modelled.cases if case.name in cases],
        node_masses=modelled.node_masses,
        cables_later=modelled.cables_later,
        construction=modelled.construction,
        buckling=1,
        frequencies=0,
        progress=silent,
    )
    return list(analysis.cases[1:])
