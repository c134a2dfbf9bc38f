"""Load factor to failure: a load case grows in proportion, past limit points, until the structure gives way."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from lamella.base.errors import InputError
from lamella.base.progress import Progress, Report, silent
from lamella.base.result import Result
from lamella.structure.analysis.load_curve import LoadCurve, Use, shift_between
from lamella.structure.buckling import critical_point, linear_buckling
from lamella.structure.controls import LoadControl
from lamella.structure.equilibrium import Equilibrium
from lamella.structure.newton import StepError, step
from lamella.structure.static import arc_length_path, load_path
from lamella.structure.tangent import Tangent

FIRST_SHARE = 0.1
"""Of the load factor that linear buckling expects: the first step."""

MOST_LENGTHENED = 4.0
"""Times the first one."""

MOST_STATES = 200
AFTER_LIMIT = 6
"""States past a limit point."""

MOVED_FAR = 0.5
"""Of a structure's size: what moves farther is no longer the structure that was designed."""

CRITICAL_TOLERANCE = 1e-5
YIELD_ROUNDS = 12
YIELD_TOLERANCE = 1e-6


@dataclass(frozen=True, repr=False, eq=False)
class Failure(Result):
    """What a structure does as its load grows; factors are multiples of the load, None where there is none.

    Attributes
    ----------
    name : str
        Of the case.
    linear_factor : float or None
        Of linear buckling about the state without the load.
    yield_factor : float or None
        Where the utilisation reaches 1.
    branch_factor : float or None
        Where the path branches first: the structure leaves it for a shape of its own.
    limit_factor : float or None
        Where the load is largest: it snaps there.
    curve : LoadCurve
    reason : str
        Why the path was followed no farther.
    """

    name: str
    linear_factor: float | None
    yield_factor: float | None
    branch_factor: float | None
    limit_factor: float | None
    curve: LoadCurve
    reason: str

    def _line(self) -> str:
        return f"{self.name!r}, stable up to {self.stable_factor:.4g}, elastic up to {self.elastic_factor:.4g}"

    @property
    def reached(self) -> float:
        """The largest load factor that was followed."""
        return float(self.curve.factors.max())

    @property
    def stable_factor(self) -> float:
        """Where it first branches or snaps; what was reached where it does neither."""
        found = [one for one in (self.branch_factor, self.limit_factor) if one is not None]
        return min(found, default=self.reached)

    @property
    def elastic_factor(self) -> float:
        """Where it first yields, branches or snaps; what was reached where it does none of it."""
        return self.stable_factor if self.yield_factor is None else min(self.stable_factor, self.yield_factor)


def load_to_failure(
    name: str, start: Equilibrium, use: Use, *, most: float = 20.0, progress: Progress = silent
) -> Failure:
    """Follow a load case until it has its largest load factor, and a little farther.

    Parameters
    ----------
    name : str
        Of the case.
    start : Equilibrium
        Without the load, at the load factor 0, with the case's loads.
    use : callable
    most : float
        Load factor up to which it is followed.
    progress : callable

    Raises
    ------
    InputError
        `most` is not above 0.
    """
    if not (np.isfinite(most) and most > 0):
        raise InputError(f"factor_max = {most!r}", "it has to be above 0", "factor_max")
    if start.negative:
        curve = LoadCurve.of([start], use)
        return Failure(name, None, None, None, None, curve, "the structure is unstable without the load")
    linear = _linear_factor(start)
    states, reason, limited = _followed(name, start, most, linear, progress)
    curve = LoadCurve.of(states, use)
    branch, limit = _critical(states, limited)
    return Failure(name, linear, _yielding(states, curve, use, limited), branch, limit, curve, reason)


def _linear_factor(start: Equilibrium) -> float | None:
    with suppress(InputError):
        factors = linear_buckling(start, 1).factors
        return float(factors[0]) if len(factors) else None
    return None


def _followed(
    name: str, start: Equilibrium, most: float, linear: float | None, progress: Progress
) -> tuple[list[Equilibrium], str, int | None]:
    """States of the path, why it ends, and the first state past the limit point."""
    states, limited, size = [start], None, start.structure.size
    try:
        for here in _path(start, most, linear):
            progress(Report.step(f"load case {name}, load factor {here.factor:.3g}", min(here.factor / most, 1.0)))
            if limited is None and _falls(states[-1], here):
                limited = len(states)
            states.append(_light(here))
            if limited is not None and len(states) >= limited + AFTER_LIMIT:
                return states, "the load is past its largest value", limited
            if np.abs(shift_between(start, here)).max() > MOVED_FAR * size:
                return states, f"it has moved by more than {MOVED_FAR:g} of its size", limited
            if here.factor >= most:
                return states, "the largest load factor asked for is reached", limited
            if len(states) > MOST_STATES:
                return states, f"{MOST_STATES} states are computed", limited
    except InputError as error:
        return states, error.message, limited
    return states, "the largest load factor asked for is reached", limited


def _light(state: Equilibrium) -> Equilibrium:
    """The same without what has been computed of it."""
    return replace(state)


def _path(start: Equilibrium, most: float, linear: float | None) -> Iterator[Equilibrium]:
    """By arc length; loads that change natural shapes by load factors."""
    first = FIRST_SHARE * min(most, most if linear is None else linear)
    if not start.loads.strain_free:
        yield from load_path(start, most, steps=int(1 / FIRST_SHARE))
        return
    motion = Tangent.of(start).motion()
    shifts = motion[: 6 * len(start.poses.points)].reshape(-1, 6)[:, :3]
    length = first * float(np.linalg.norm(shifts))
    if not length > 0:
        raise InputError("the load moves nothing", "", "loads")
    yield from arc_length_path(start, length, longest=MOST_LENGTHENED * length)


def _falls(before: Equilibrium, here: Equilibrium) -> bool:
    """Whether the load no longer grows along the path."""
    if here.factor <= before.factor:
        return True
    if here.negative == before.negative or not here.loads.strain_free:
        return False
    with suppress(InputError):
        onward = Tangent.of(here).motion()[: 6 * len(here.poses.points)].reshape(-1, 6)[:, :3]
        return bool((onward * shift_between(before, here)).sum() < 0)
    return False


def _critical(states: list[Equilibrium], limited: int | None) -> tuple[float | None, float | None]:
    """Load factors of the first branch and of the limit point."""
    unstable = next((k for k, state in enumerate(states) if state.negative), None)
    branch = None
    if unstable is not None and (limited is None or unstable < limited or states[unstable].negative > 1):
        branch = _between(states[unstable - 1], states[unstable])
    if limited is None:
        return branch, None
    before, after = states[limited - 1], states[limited]
    largest = _summit(states, limited)
    if branch is None and before.negative == 0:
        with suppress(InputError):
            found = float(critical_point(before, CRITICAL_TOLERANCE).factors[0])
            if max(before.factor, after.factor) <= found * (1 + CRITICAL_TOLERANCE):
                return None, found
    return branch, largest


def _summit(states: list[Equilibrium], limited: int) -> float:
    """Largest load factor of the parabola through three states around it, by the way between them."""
    if limited < 2 and len(states) < 3:
        return max(state.factor for state in states)
    middle = max(range(len(states)), key=lambda k: states[k].factor)
    middle = min(max(middle, 1), len(states) - 2)
    three = states[middle - 1 : middle + 2]
    way = np.cumsum([0.0, *(np.linalg.norm(shift_between(a, b)) for a, b in pairwise(three))])
    a, b, c = np.polyfit(way, [state.factor for state in three], 2)
    return float(c - b**2 / (4 * a)) if a < 0 else max(state.factor for state in three)


def _between(stable: Equilibrium, unstable: Equilibrium) -> float:
    """The critical load factor between two neighbouring states."""
    low, high = stable.factor, unstable.factor
    here = stable
    while high - low > CRITICAL_TOLERANCE * abs(high):
        middle = (low + high) / 2
        try:
            found = step(here, LoadControl(middle))
            # that of the step is of its last iteration, which may be as far from it as the step is long
            negative = Tangent.of(found).factor.negative
        except (StepError, InputError):
            high = middle
            continue
        if negative:
            high = middle
        else:
            here, low = found, middle
    return (low + high) / 2


def _yielding(states: list[Equilibrium], curve: LoadCurve, use: Use, limited: int | None) -> float | None:
    """The load factor at which the utilisation first is 1."""
    above = np.flatnonzero(curve.utilisation >= 1)
    if not len(above):
        return None
    k = int(above[0])
    if k == 0:
        return 0.0
    low, high = (float(curve.factors[i]) for i in (k - 1, k))
    use_low, use_high = (float(curve.utilisation[i]) for i in (k - 1, k))
    here = states[k - 1]
    for _ in range(YIELD_ROUNDS):
        factor = low + (high - low) * (1 - use_low) / (use_high - use_low)
        if limited is not None and k >= limited:
            return factor
        try:
            found = step(here, LoadControl(factor))
        except StepError:
            return factor
        used = use(found)
        if abs(used - 1) < YIELD_TOLERANCE:
            return factor
        if used < 1:
            here, low, use_low = found, factor, used
        else:
            high, use_high = factor, used
    return factor
