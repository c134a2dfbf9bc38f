"""Searching for the best variant: sequential quadratic programming, or a genetic algorithm."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.studies.sampling import at_shares
from lamella.studies.table import Row
from lamella.studies.tables import OptimiseTable, StudyTable

Evaluate = Callable[[Sequence[tuple[Any, ...]]], list[Row]]
"""Rows of variants with these values, computed side by side."""

# of the range of what was seen: how much worse a variant counts that there is not
WORSE = 1.0
SCALE_LEAST = 1e-12


class _Enough(Exception):
    """As many variants as may be have been computed."""


def search(study: StudyTable, table: OptimiseTable, start: Sequence[Any], evaluate: Evaluate) -> str:
    """Compute variants in search of the best; returns how it ended, in words.

    Parameters
    ----------
    study : StudyTable
    table : OptimiseTable
    start : sequence
        Values of the project.
    evaluate : callable
    """
    values = any(variable.values is not None or variable.whole for variable in study.variable)
    method = table.method or ("evolution" if values or len(study.objective) > 1 else "gradient")
    if method == "evolution":
        return _evolution(study, table, evaluate)
    return _Gradient(study, table, start, evaluate).run()


class _Gradient:
    """SLSQP (D. Kraft, DFVLR-FB 88-28, 1988; `scipy.optimize.minimize`) in shares of the ranges.

    Differences are central, of two variants a variable, all computed side by side; one-sided beside a limit of a range
    or where there is no variant on one side. A place without a variant counts as worse than all that were seen, so
    that the line search draws back from it.
    """

    def __init__(self, study: StudyTable, table: OptimiseTable, start: Sequence[Any], evaluate: Evaluate) -> None:
        self._study, self._table, self._evaluate = study, table, evaluate
        self._first = np.array([self._share(k, value) for k, value in enumerate(start)])
        self._seen: dict[tuple[Any, ...], Row] = {}
        self._scale = np.ones(1 + sum(2 - (c.at_most is None) - (c.at_least is None) for c in study.constraint))

    def _share(self, number: int, value: Any) -> float:
        low, high = self._study.variable[number].range or (0.0, 1.0)
        if self._table.start is not None:
            value = self._table.start[number]
        return float(np.clip((float(value) - low) / (high - low), 0.0, 1.0))

    def run(self) -> str:
        """Search, and how it ended."""
        from scipy.optimize import minimize

        first = self._rows([self._first])[0]
        if not np.isfinite(self._values(first)).all():
            raise InputError(
                f"the search has nowhere to begin: {first.kept.reason}",
                "write start = [...] in [optimise], with values that have a design; or let the stage of that figure "
                "run (until)",
                "optimise.start",
            )
        self._scale = np.maximum(np.abs(self._values(first)), SCALE_LEAST)
        limits = len(self._scale) - 1
        bounded = [{"type": "ineq", "fun": lambda x: -self._at(x)[1:], "jac": lambda x: -self._slopes(x)[1:]}]
        try:
            found = minimize(
                lambda x: float(self._at(x)[0]),
                self._first,
                jac=lambda x: self._slopes(x)[0],
                method="SLSQP",
                bounds=[(0.0, 1.0)] * len(self._first),
                constraints=bounded if limits else (),
                options={"ftol": self._table.tolerance, "maxiter": self._table.evaluations},
            )
        except _Enough:
            return (
                f"not converged: ended at {self._table.evaluations:,} variants, as [optimise] evaluations says; the "
                "best so far may be next to the start"
            )
        return f"{found.message.lower()}: {len(self._seen):,} variants"

    def _rows(self, places: Sequence[Floats]) -> list[Row]:
        """Rows at shares of the ranges; each variant is computed once."""
        chosen = [at_shares(self._study.variable, place) for place in places]
        new = list(dict.fromkeys(one for one in chosen if one not in self._seen))
        if new and len(self._seen) + len(new) > self._table.evaluations:
            raise _Enough
        self._seen.update(zip(new, self._evaluate(new), strict=True))
        return [self._seen[one] for one in chosen]

    def _values(self, row: Row) -> Floats:
        """The objective and by how much each limit is passed."""
        return np.array([*row.goals, *row.excess])

    def _at(self, place: Floats) -> Floats:
        """The same, scaled; worse than any before where there is no such variant."""
        values = self._values(self._rows([place])[0]) / self._scale
        if np.isfinite(values).all():
            return values
        seen = np.array([self._values(row) for row in self._seen.values()]) / self._scale
        seen = seen[np.isfinite(seen).all(1)]
        return np.asarray(seen.max(0) + WORSE * np.maximum(np.ptp(seen, axis=0), 1.0))

    def _slopes(self, place: Floats) -> Floats:
        """Derivatives by the shares, (1 + limits, p)."""
        step, count = self._table.step, len(place)
        ahead = np.clip(place + step * np.eye(count), 0.0, 1.0)
        behind = np.clip(place - step * np.eye(count), 0.0, 1.0)
        rows = self._rows([place, *ahead, *behind])
        values = np.array([self._values(row) for row in rows]) / self._scale
        here, before, after = values[0], values[count + 1 :], values[1 : count + 1]
        high, low = np.diagonal(ahead) - place, place - np.diagonal(behind)
        after_is, before_is = (np.asarray(np.isfinite(side).all(1)) for side in (after, before))
        after, high = np.where(after_is[:, None], after, here), np.where(after_is, high, 0.0)
        before, low = np.where(before_is[:, None], before, here), np.where(before_is, low, 0.0)
        width = high + low
        slopes = np.where(width > 0, (after - before).T / np.where(width > 0, width, 1.0), 0.0)
        # SLSQP of scipy 1.17 takes the numbers of a matrix in the order of its memory
        return np.ascontiguousarray(slopes)


def _evolution(study: StudyTable, table: OptimiseTable, evaluate: Evaluate) -> str:
    """NSGA-II (Deb, Pratap, Agarwal, Meyarivan, IEEE Trans. Evol. Comput. 6 (2002) 182) of optuna.

    With its authors' crossover and mutation. A generation is computed side by side and told in the order of its
    variants whichever is ready first, so that the search is the same on any number of workers.
    """
    try:
        import optuna
    except ImportError:
        raise InputError(
            "a genetic algorithm needs optuna, and it is not installed", 'install it: pip install "lamella[study]"'
        ) from None
    optuna.logging.set_verbosity(optuna.logging.ERROR)
    population = min(table.population, table.evaluations)
    with warnings.catch_warnings():
        # their interfaces may change with a version of optuna
        warnings.simplefilter("ignore", optuna.exceptions.ExperimentalWarning)
        crossover, mutation = optuna.samplers.nsgaii.SBXCrossover(), optuna.samplers.nsgaii.PolynomialMutation()
        sampler = optuna.samplers.NSGAIISampler(
            population_size=population, seed=table.seed, crossover=crossover, mutation=mutation
        )
    searched = optuna.create_study(directions=["minimize"] * len(study.objective), sampler=sampler)
    spread = {
        variable.column: (
            optuna.distributions.CategoricalDistribution(range(len(variable.values)))
            if variable.values is not None
            else optuna.distributions.FloatDistribution(0.0, 1.0)
        )
        for variable in study.variable
    }
    seen: dict[tuple[Any, ...], Row] = {}
    asked = 0
    while asked < table.evaluations:
        trials = [searched.ask(spread) for _ in range(min(population, table.evaluations - asked))]
        asked += len(trials)
        chosen = [_chosen(study, trial.params) for trial in trials]
        new = list(dict.fromkeys(one for one in chosen if one not in seen))
        seen.update(zip(new, evaluate(new), strict=True))
        for trial, one in zip(trials, chosen, strict=True):
            row = seen[one]
            if not np.isfinite([*row.goals, *row.excess]).all():
                searched.tell(trial, state=optuna.trial.TrialState.FAIL)
                continue
            for number, excess in enumerate(row.excess):
                trial.set_constraint(str(number), excess)
            searched.tell(trial, list(row.goals))
    return f"{len(seen):,} variants in generations of {population}"


def _chosen(study: StudyTable, params: dict[str, Any]) -> tuple[Any, ...]:
    """Values of a trial."""
    return tuple(
        variable.values[params[variable.column]]
        if variable.values is not None
        else at_shares((variable,), np.array([params[variable.column]]))[0]
        for variable in study.variable
    )
