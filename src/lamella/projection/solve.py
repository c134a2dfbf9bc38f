"""Gauss-Newton's method with Levenberg and Marquardt's damping and an exact line search, on sparse constraints.

Each iteration solves (sum w^2 J^T J + lambda D^-2) d = -sum w^2 J^T f, D the scales of the unknowns. What the
constraints leave open is thereby settled by the least change. Where constraints ask for too much and residuals stay,
Newton's second-order term joins in while the matrix remains positive definite, so the least remainder is reached in a
few steps too. The pattern and its symbolic factorisation are worked out once.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.sparse import Backend, Factor, SingularError
from lamella.projection.constraint import Constraint
from lamella.projection.line_search import best_length
from lamella.projection.normal_equations import NormalEquations
from lamella.projection.report import Iteration, Solution, Verdict
from lamella.projection.unknowns import Block, Layout

DAMPING, LEAST_DAMPING, MOST_DAMPING = 1e-6, 1e-10, 1e6
# line search lengths that tell a good linearisation from a bad one, and what follows for the damping
GOOD, POOR, DAMPING_LOWER, RAISE = 0.6, 0.3, 0.1, 10.0
# a faded weight below this share of its first is dropped
FAINT = 1e-4
# a step that leaves more than this share of the sum of squares asks for second derivatives
SLOW_DECREASE = 0.3
# stagnation: over so many iterations the sum of squares falls by less than this and steps do not shrink to this share
IDLE, DECREASE, SHRINK = 4, 1e-3, 0.5


def solve(
    blocks: Sequence[Block],
    constraints: Sequence[Constraint],
    *,
    iterations: int = 50,
    tolerance: float = 1e-10,
    step_tolerance: float = 1e-9,
    damping: float = DAMPING,
    on_iteration: Callable[[Iteration], None] | None = None,
    backend: Backend | None = None,
) -> Solution:
    """Move unknowns until constraints hold.

    Parameters
    ----------
    blocks : sequence of Block
        Unknowns with their start.
    constraints : sequence of Constraint
        At least one hard.
    iterations : int
        Most steps.
    tolerance : float
        The root mean square residual below which a constraint is met, in edges or radians.
    step_tolerance : float
        Steps end below this, over the scale of the unknown.
    damping : float
        lambda at the start.
    on_iteration : optional
        Called with each record as soon as it is known.
    backend : optional
        See `lamella.base.sparse.default_backend`.

    Returns
    -------
    Solution

    Raises
    ------
    InputError
        Blocks or constraints that make no problem.
    """
    begin = time.process_time()
    _check(constraints, iterations, tolerance)
    layout, vector = Layout.of(blocks)
    origin = np.concatenate([np.ravel(b.values if b.origin is None else b.origin) for b in blocks])
    current = [constraint.refreshed(layout.values(vector)) for constraint in constraints]
    equations = NormalEquations.of(layout, current, backend)
    ending = _Ending(constraints, tolerance, step_tolerance)
    records: list[Iteration] = []
    for number in range(iterations + 1):
        weights = [_weight(constraint, number) for constraint in constraints]
        linearised = equations.linearise(current, vector)
        residuals = [at.residual for at in linearised]
        state = Iteration(
            number,
            {c.name: _rms(f) for c, f in zip(constraints, residuals, strict=True)},
            {c.name: float(np.abs(f).max(initial=0.0)) for c, f in zip(constraints, residuals, strict=True)},
            {name: _rms(moved) for name, moved in layout.values((vector - origin) / layout.scale).items()},
            sum(w**2 * float(np.vdot(f, f)) for w, f in zip(weights, residuals, strict=True)),
            0.0,
            0.0,
            damping,
            0.0,
        )
        if records:
            damping = _next_damping(records[-1], state.objective)
        verdict = ending.verdict(state, records, weights)
        if verdict is None and number < iterations:
            values, right = equations.assemble(current, linearised, weights)
            if records and ending.slow(state, records[-1], weights):
                values += equations.second_order(current, linearised, weights, vector)
            factor, damping = _factor(equations, values, damping)
            if factor is None:
                verdict = "broken off"
            else:
                direction = -factor.solve(right)
                del factor, values  # before the next ones take their memory
                ends = equations.residuals(current, vector + direction)
                length = best_length(residuals, equations.change(linearised, direction), ends, weights)
                vector = vector + length * direction
                step = float(np.abs(length * direction / layout.scale).max())
                state = replace(state, step=step, length=length, damping=damping)
        records.append(replace(state, seconds=time.process_time() - begin))
        if on_iteration:
            on_iteration(records[-1])
        if verdict is not None:
            break
        current = [constraint.refreshed(layout.values(vector)) for constraint in current]
    return Solution(
        {name: values.copy() for name, values in layout.values(vector).items()},
        tuple(records),
        verdict or "iterations used up",
        ending.unmet(records[-1]),
    )


class _Ending:
    """The stopping tests: residual, step, stagnation."""

    def __init__(self, constraints: Sequence[Constraint], tolerance: float, step_tolerance: float) -> None:
        self._hard = [c.name for c in constraints if c.hard]
        self._fading = [c.fade != 1 for c in constraints]
        self._lasting = any(not c.hard and c.fade == 1 for c in constraints)
        self._tolerance, self._step_tolerance = tolerance, step_tolerance

    def unmet(self, state: Iteration) -> tuple[str, ...]:
        """Hard constraints that do not hold, the worst first."""
        missing = [name for name in self._hard if not state.residual[name] <= self._tolerance]
        return tuple(sorted(missing, key=lambda name: -state.residual[name]))

    def _steady(self, weights: Sequence[float]) -> bool:
        """Whether nothing fades any more."""
        return not any(weight and fading for weight, fading in zip(weights, self._fading, strict=True))

    def slow(self, state: Iteration, before: Iteration, weights: Sequence[float]) -> bool:
        """Whether residuals stay that are too large for Gauss and Newton: their second order counts then."""
        return self._steady(weights) and state.objective > SLOW_DECREASE * before.objective

    def verdict(self, state: Iteration, before: Sequence[Iteration], weights: Sequence[float]) -> Verdict | None:
        """How it ends here; None: it goes on."""
        if not np.isfinite(state.objective):
            return "broken off"
        still = bool(before) and before[-1].step <= self._step_tolerance
        # a lasting wish (a driver, closeness) has its least only where the steps end
        if not self.unmet(state) and (still or not self._lasting):
            return "solved"
        if not self._steady(weights):
            return None
        if still and state.objective > before[-1].objective * (1 - DECREASE):
            return "settled"
        if len(before) > IDLE:
            earlier, last = before[-1 - IDLE], before[-1]
            idle = state.objective > earlier.objective * (1 - DECREASE)
            # near a least sum that is not nought steps shrink slowly while the sum hardly changes
            if idle and last.step > SHRINK * earlier.step:
                return "stagnated"
        return None


def _weight(constraint: Constraint, number: int) -> float:
    """Weight at an iteration."""
    share = constraint.fade**number
    return constraint.weight * share if share >= FAINT else 0.0


def _factor(equations: NormalEquations, values: Floats, damping: float) -> tuple[Factor | None, float]:
    """A factor that is positive definite, and the damping it took, which stays in the values."""
    diagonal = equations.pattern.columns[:-1]
    undamped = values[diagonal]
    while damping <= MOST_DAMPING:
        values[diagonal] = undamped + damping / equations.layout.scale**2
        factor = _definite(equations, values)
        if factor is not None:
            return factor, damping
        damping = damping * RAISE
    return None, damping


def _definite(equations: NormalEquations, values: Floats) -> Factor | None:
    """A factor of the matrix, if it is positive definite."""
    try:
        factor = equations.pattern.factor(values)
    except SingularError:
        return None
    return None if factor.negative else factor


def _next_damping(before: Iteration, objective: float) -> float:
    """More after a step that was cut short; after one that went as far as foreseen less, as residuals have become less.

    Damping in proportion to the residual keeps the order two of Gauss and Newton where J^T J is singular or nearly so
    (Fan and Yuan 2005): soft modes of a large net would otherwise come in by a constant share a step.
    """
    if before.length < POOR:
        return min(before.damping * RAISE, MOST_DAMPING)
    if before.length <= GOOD:
        return before.damping
    share = np.sqrt(objective / before.objective) if before.objective > 0 else DAMPING_LOWER
    return max(before.damping * min(DAMPING_LOWER, float(share)), LEAST_DAMPING)


def _rms(numbers: Floats) -> float:
    return float(np.sqrt(np.mean(numbers**2))) if numbers.size else 0.0


def _check(constraints: Sequence[Constraint], iterations: int, tolerance: float) -> None:
    """Refuse what makes no problem."""
    names = [constraint.name for constraint in constraints]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise InputError(f"several constraints are called {twice[0]!r}", "give each constraint a name of its own")
    if not any(constraint.hard for constraint in constraints):
        raise InputError("no constraint is hard", "mark those that have to hold with hard=True")
    for constraint in constraints:
        if not (0 <= constraint.weight < np.inf and 0 <= constraint.fade <= 1):
            raise InputError(
                f"constraint {constraint.name!r} has weight {constraint.weight!r} and fade {constraint.fade!r}",
                "weights are at least 0, fades from 0 to 1",
            )
        if constraint.hard and constraint.fade != 1:
            raise InputError(
                f"constraint {constraint.name!r} is hard and fades", "what has to hold cannot fade: set hard=False"
            )
    if iterations < 0 or not tolerance > 0:
        raise InputError(f"iterations = {iterations!r}, tolerance = {tolerance!r}", "at least 0, and a number above 0")
