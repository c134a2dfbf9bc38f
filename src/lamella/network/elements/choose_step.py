"""The spacing l0 of a lattice near a wanted one, and numbers of cells that are better than a given one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.limits import CELLS_MIN
from lamella.network.elements.cell_count import CellCount
from lamella.network.elements.closing_steps import CLOSES, ClosingLengths
from lamella.network.pattern import LEAST_KEPT, Pattern

# of the number of cells, and cells: how far a spacing may be moved so that the net closes with its umbilics on nodes
SPACING_REACH, LEAST_REACH, SPACING_REACH_MAX = 0.1, 0.75, 3.0
# cells: a net that misses whole numbers by more gains nothing from a moved spacing
NEARLY_CLOSED = 0.12
# what a net that does not close costs at least; 1: one that misses by more than that
OPEN_COST = 0.3
# choices that differ by less (1: all that a moved spacing may cost) are alike: then the finer one, for a rule
ALIKE = 0.02
# better numbers of cells are looked for so far away: of the number given, and cells
LOOKED, LEAST_LOOKED = 0.25, 4
# of the miss: what a number of cells has to undo to be called better where none closes the net
BETTER = 0.25


@dataclass(frozen=True)
class Better:
    """A density at which the net misses less, or nothing: `cells`, or `step` (l0, sqrt(m)) where no number does."""

    cells: int | None
    step: float
    residual: float

    @property
    def closes(self) -> bool:
        """Whether all closes, and all umbilics are nodes."""
        return self.residual <= CLOSES


def near_step(count: CellCount, closing: ClosingLengths, wanted: float, pattern: Pattern) -> float:
    """The spacing l0 (sqrt(m)) next to a wanted one that serves closing best.

    Whole numbers of cells, and spacings that make one of the lengths whole that have to be; each pays for its distance
    from the wanted one and for what it misses.

    Parameters
    ----------
    count : CellCount
    closing : ClosingLengths
    wanted : float
        sqrt(m).
    pattern : Pattern
    """
    if count.cells(wanted) < CELLS_MIN:
        # hardly a curve around the hole: cells are counted across the surface
        count = CellCount(count.across, count.across, 0j)
    cells = count.cells(wanted)
    reach = float(np.clip(SPACING_REACH * cells, LEAST_REACH, SPACING_REACH_MAX))
    tied = count.follows_period(pattern)
    multiple = pattern.multiple(count.period) if tied else 1
    least = (LEAST_KEPT if multiple > 1 else CELLS_MIN) * multiple
    low, high = int(np.ceil((cells - reach) / multiple)), int(np.floor((cells + reach) / multiple))
    numbers = {n * multiple for n in range(low, high + 1)} | {round(cells / multiple) * multiple, least}
    whole = [count.step(n, pattern) for n in numbers if n >= least]
    others: list[float] = []
    if not tied:
        # where a whole number of cells closes the net it needs no others
        kept = np.array([step for step in whole if closing.residual(step) <= CLOSES / 2])
        most = count.length / max(cells - reach, CELLS_MIN)
        for step in closing.steps(count.length / (cells + reach), most).tolist():
            if not (np.abs(count.length * (1 / step - 1 / kept)) < CLOSES).any():
                others.append(step)
    steps = np.sort([*whole, *others])
    cost = [_cost(closing, step, wanted, cells / reach) for step in steps.tolist()]
    return float(steps[np.flatnonzero(np.array(cost) <= min(cost) + ALIKE)[0]])


def _cost(closing: ClosingLengths, step: float, wanted: float, scale: float) -> float:
    residual = closing.residual(step)
    price = 0.0 if residual <= CLOSES / 2 else OPEN_COST + (1 - OPEN_COST) * min(1.0, residual / NEARLY_CLOSED) ** 2
    return float(price + (np.log(step / wanted) * scale) ** 2)


def better_density(count: CellCount, closing: ClosingLengths, step: float, pattern: Pattern) -> Better | None:
    """The nearest number of cells, or else spacing, at which the net closes; or a number that comes much nearer to it.

    Parameters
    ----------
    count, closing, pattern
        See `near_step`.
    step : float
        l0 that was taken, sqrt(m).
    """
    residual = closing.residual(step)
    if residual <= CLOSES:
        return None
    cells = round(count.cells(step))
    multiple = pattern.multiple(count.period) if count.follows_period(pattern) else 1
    least = (LEAST_KEPT if multiple > 1 else CELLS_MIN) * multiple
    reach = max(int(LOOKED * cells), LEAST_LOOKED)
    # the finer one first where two are as near
    numbers = [n for far in range(1, reach + 1) for n in (cells + far, cells - far) if n >= least and n % multiple == 0]
    found = [Better(n, there, closing.residual(there)) for n in numbers for there in [count.step(n, pattern)]]
    best = next((one for one in found if one.residual <= CLOSES / 2), None)
    if best or count.follows_period(pattern):
        return best or _nearer(found, residual)
    near = closing.steps(step * cells / (cells + reach), step * cells / max(cells - reach, CELLS_MIN))
    near = near[np.argsort(np.abs(np.log(near / step)), kind="stable")]
    exact = next((one for one in near.tolist() if closing.residual(one) <= CLOSES / 2), None)
    return Better(None, exact, closing.residual(exact)) if exact else _nearer(found, residual)


def _nearer(found: list[Better], residual: float) -> Better | None:
    """The number of cells that misses least, if that is much less than a miss."""
    best = min(found, key=lambda one: one.residual, default=None)
    return best if best and best.residual <= BETTER * residual else None
