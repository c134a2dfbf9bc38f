"""Searches on functions whose best value is known: no surface is computed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest

from lamella.base.errors import InputError
from lamella.studies.folder import Kept
from lamella.studies.optimise import search
from lamella.studies.table import Row
from lamella.studies.tables import parse_study
from lamella.studies.variant import DONE, REFUSED

Functions = Callable[..., tuple[tuple[float, ...], tuple[float, ...]]]


def _search(
    functions: Functions, ranges: dict[str, list[float]], objectives: int = 1, limits: int = 0, **optimise: Any
) -> tuple[list[Row], str]:
    """Rows of a search; `functions` returns goals and excesses, or raises where there is no variant."""
    study = parse_study(
        {
            "project": "p.toml",
            "variable": [{"key": key, "range": ends} for key, ends in ranges.items()],
            "objective": [{"figure": f"f{k}"} for k in range(objectives)],
            "constraint": [{"figure": f"g{k}", "at_most": 0.0} for k in range(limits)],
            "optimise": optimise,
        }
    )
    rows: list[Row] = []

    def evaluate(chosen: Sequence[tuple[Any, ...]]) -> list[Row]:
        new = []
        for one in chosen:
            try:
                goals, excess = functions(*one)
                kept = Kept(DONE, "", "", {}, {}, b"")
            except ZeroDivisionError:
                goals, excess = (np.nan,) * objectives, (np.nan,) * limits
                kept = Kept(REFUSED, "none", "", None, {}, b"")
            new.append(Row(str(len(rows) + len(new)), one, kept, {}, goals, excess, (0.0,) * limits))
        rows.extend(new)
        return new

    assert study.optimise is not None
    middle = [sum(ends) / 2 for ends in ranges.values()]
    return rows, search(study, study.optimise, middle, evaluate)


def _best(rows: list[Row]) -> Row:
    return min((row for row in rows if all(e <= 1e-7 for e in row.excess)), key=lambda row: row.goals[0])


def test_gradient_finds_a_constrained_minimum() -> None:
    """x^2 + 2 y^2 with x + y >= 3: the multiplier's equations give (2, 1)."""
    rows, ended = _search(
        lambda x, y: ((x * x + 2 * y * y,), (3 - x - y,)), {"a": [0.0, 5.0], "b": [0.0, 4.0]}, limits=1, tolerance=1e-12
    )
    assert np.allclose(_best(rows).chosen, (2.0, 1.0), atol=1e-5)
    assert "success" in ended


def test_gradient_stays_in_its_ranges_and_computes_nothing_twice() -> None:
    rows, _ = _search(lambda x: ((-x,), ()), {"a": [1.0, 2.0]})
    assert max(row.chosen[0] for row in rows) == _best(rows).chosen[0] == 2.0
    assert len({row.chosen for row in rows}) == len(rows)


def test_gradient_draws_back_from_where_there_is_no_variant() -> None:
    """(x - 1)^2 with no variant below 0.9, from 2.5: the first step leads there."""

    def functions(x: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        if x < 0.9:
            raise ZeroDivisionError
        return ((x - 1) ** 2,), ()

    rows, _ = _search(functions, {"a": [0.0, 5.0]})
    assert _best(rows).chosen[0] == pytest.approx(1.0, abs=1e-4)


def test_as_many_variants_as_allowed() -> None:
    rows, ended = _search(
        lambda x, y: ((100 * (y - x * x) ** 2 + (1 - x) ** 2,), ()),
        {"a": [-2.0, 2.5], "b": [-2.0, 3.0]},
        evaluations=9,
    )
    assert len(rows) <= 9
    assert "9" in ended


def test_a_search_that_begins_nowhere() -> None:
    with pytest.raises(InputError) as refusal:
        _search(lambda x: ((1 / 0,), ()), {"a": [0.0, 1.0]})
    assert refusal.value.where == "optimise.start"


def test_evolution_finds_the_front_of_two_distances() -> None:
    """Of the squared distances from (0, 0) and (2, 0) the front is the segment between; with x >= 0.5 what is left."""
    options: dict[str, Any] = {"method": "evolution", "evaluations": 900, "population": 30, "seed": 3}

    def found() -> list[Row]:
        return _search(
            lambda x, y: ((x * x + y * y, (x - 2) ** 2 + y * y), (0.5 - x,)),
            {"a": [-10.0, 10.0], "b": [-10.0, 10.0]},
            objectives=2,
            limits=1,
            **options,
        )[0]

    rows = found()
    late = np.array([row.chosen for row in rows[-60:]])
    near = (late[:, 0] > 0.4) & (late[:, 0] < 2.1) & (abs(late[:, 1]) < 0.5)
    # of draws without a search 1 in 240 lies there
    assert near.mean() > 0.4
    assert [row.chosen for row in rows] == [row.chosen for row in found()]
