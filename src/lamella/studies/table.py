"""The table of a study: a row a variant, a column a variable or figure."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from lamella.base.arrays import Booleans, Floats
from lamella.base.errors import InputError
from lamella.studies.figures import CHANGE, change_of, figure_at, rounded_figure, table_figures
from lamella.studies.folder import Kept
from lamella.studies.pareto import pareto_front
from lamella.studies.tables import StudyTable
from lamella.studies.variant import DONE

FIRST, LAST = ("id",), ("status", "feasible", "best", "reason")
"""Columns before the variables, and between them and the figures."""


LIMIT_SPARE = 1e-6
"""Of a limit: by so much a figure may pass it and still count as keeping it."""


@dataclass(frozen=True)
class Row:
    """A variant.

    Attributes
    ----------
    name : str
        Of its folder.
    chosen : tuple
        A value for each variable.
    kept : Kept
    figures : dict
        By key: those of the summary, "headroom.NAME" and "change".
    goals : tuple of float
        Of each objective, small is good; NaN where there is none.
    excess : tuple of float
        By which each limit is passed, in its own unit; negative where it is kept, NaN where the figure has no value.
    spare : tuple of float
        By which it may be passed for rounding.
    """

    name: str
    chosen: tuple[Any, ...]
    kept: Kept
    figures: Mapping[str, Any]
    goals: tuple[float, ...]
    excess: tuple[float, ...]
    spare: tuple[float, ...]

    @property
    def feasible(self) -> bool:
        """Whether it was computed and keeps all limits."""
        passed = zip(self.excess, self.spare, strict=True)
        return self.kept.status == DONE and all(excess <= spare for excess, spare in passed)


def row_of(study: StudyTable, name: str, chosen: tuple[Any, ...], kept: Kept, start: Sequence[Any]) -> Row:
    """The row of a variant.

    Parameters
    ----------
    study : StudyTable
    name : str
    chosen : tuple
    kept : Kept
    start : sequence
        Values that "change" is measured from.

    Raises
    ------
    InputError
        An objective or a constraint names no figure.
    """
    summary = kept.summary or {}
    figures: dict[str, Any] = {CHANGE: change_of(study.variable, chosen, start)}
    if kept.status == DONE:
        figures |= {f"headroom.{place}": height for place, height in kept.headrooms.items()}
        figures |= table_figures(summary)
    goals, excess, spare = [], [], []
    missing: list[str] = []
    for number, objective in enumerate(study.objective):
        value = _figure(figures, summary, objective.figure, kept, name, f"objective[{number}].figure")
        goals.append(-value if objective.goal == "max" else value)
        missing += [objective.figure] if np.isnan(value) else []
    for number, limit in enumerate(study.constraint):
        value = _figure(figures, summary, limit.figure, kept, name, f"constraint[{number}].figure")
        missing += [limit.figure] if np.isnan(value) else []
        for sign, bound in ((1, limit.at_most), (-1, limit.at_least)):
            if bound is not None:
                excess.append(sign * (value - bound))
                spare.append(LIMIT_SPARE * abs(bound))
    if kept.status == DONE and missing:
        kept = replace(kept, reason=f"without a value: {', '.join(dict.fromkeys(missing))}")
    return Row(name, chosen, kept, figures, tuple(goals), tuple(excess), tuple(spare))


def _figure(
    figures: Mapping[str, Any], summary: Mapping[str, Any], key: str, kept: Kept, name: str, where: str
) -> float:
    if kept.status != DONE:
        return float("nan")
    try:
        value = figure_at(figures, summary, key)
    except KeyError:
        near = _nearest(key, figures)
        raise InputError(
            f"{key} is no figure of the summary{f', did you mean {near}?' if near else ''}",
            f"choose a key of variants/{name}/summary.json (docs/files.md); a stage has figures where it runs "
            "([structure], until)",
            where,
        ) from None
    return float("nan") if value is None else value


def _nearest(key: str, figures: Mapping[str, Any]) -> str:
    from difflib import get_close_matches

    near = get_close_matches(key, list(figures), 1, 0.5)
    return near[0] if near else ""


@dataclass(frozen=True)
class Table:
    """All rows of a study.

    Attributes
    ----------
    study : StudyTable
    rows : tuple of Row
    """

    study: StudyTable
    rows: tuple[Row, ...]

    @property
    def goals(self) -> Floats:
        """Objectives, small is good, (n, m)."""
        return np.array([row.goals for row in self.rows]).reshape(len(self.rows), len(self.study.objective))

    @property
    def best(self) -> Booleans:
        """Variants that keep all limits and that no other such one is better than, (n,); none without an objective."""
        if not self.study.objective or not self.rows:
            return np.zeros(len(self.rows), bool)
        feasible = np.array([row.feasible for row in self.rows])
        return pareto_front(np.where(feasible[:, None], self.goals, np.nan))

    @property
    def columns(self) -> dict[str, list[Any]]:
        """Values by column; None where a variant has none."""
        names: dict[str, None] = {}
        for row in self.rows:
            names.update(dict.fromkeys(row.figures))
        columns: dict[str, list[Any]] = {"id": [row.name for row in self.rows]}
        for number, variable in enumerate(self.study.variable):
            columns[variable.column] = [row.chosen[number] for row in self.rows]
        columns["status"] = [row.kept.status for row in self.rows]
        columns["feasible"] = [row.feasible for row in self.rows]
        columns["best"] = self.best.tolist()
        columns["reason"] = [row.kept.reason for row in self.rows]
        for name in names:
            # a variable may have the name of a figure
            columns.setdefault(name, [rounded_figure(row.figures.get(name)) for row in self.rows])
        return columns

    def csv(self) -> bytes:
        """As comma-separated text."""
        columns = self.columns
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(columns)
        for values in zip(*columns.values(), strict=True):
            writer.writerow([_cell(value) for value in values])
        return text.getvalue().encode()


def _cell(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    return repr(value) if isinstance(value, float) else " ".join(str(value).split())
