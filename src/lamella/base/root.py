"""A root between two points where a function has different signs.

scipy's `brentq` finds the same ones to the last bit, but importing `scipy.optimize` takes as long as a small run.
"""

from __future__ import annotations

from collections.abc import Callable
from math import copysign

MOST_STEPS = 100
"""Twice as many as bisection alone takes from the root's own size down to its last bit."""

RELATIVE = 4 * 2.0**-52
"""Share of the root that counts as rounding: four units in the last place."""


def root_between(
    f: Callable[[float], float], low: float, high: float, *, tolerance: float, relative: float = RELATIVE
) -> float:
    """Root of a continuous function by Brent's method: inverse quadratic interpolation, bisection where it is slow.

    Parameters
    ----------
    f : callable
    low, high : float
        Where f has different signs, or is zero.
    tolerance : float
        Of the root.
    relative : float
        Share of the root that is added to it.

    Raises
    ------
    ValueError
        f has one sign at both ends.
    ArithmeticError
        It is too flat at its root, or not continuous.

    References
    ----------
    R. P. Brent, Algorithms for Minimization Without Derivatives, Prentice-Hall 1973, chapter 4
    """
    # x: best so far, with the smaller |f|; before: the last one; other: across the root from x
    before, x = low, high
    f_before, f_x = f(before), f(x)
    if f_before == 0:
        return before
    if f_x != 0 and (f_before < 0) == (f_x < 0):
        raise ValueError(f"f({low:g}) = {f_before:g} and f({high:g}) = {f_x:g} have one sign")
    other, f_other, step, last_step = before, f_before, x - before, x - before
    for _ in range(MOST_STEPS):
        if f_before != 0 and f_x != 0 and (f_before < 0) != (f_x < 0):
            other, f_other, step, last_step = before, f_before, x - before, x - before
        if abs(f_other) < abs(f_x):
            before, x, other = x, other, x
            f_before, f_x, f_other = f_x, f_other, f_x
        least, half = (tolerance + relative * abs(x)) / 2, (other - x) / 2
        if f_x == 0 or abs(half) < least:
            return x
        step, last_step = _step((before, f_before), (x, f_x), (other, f_other), step, last_step, half, least)
        before, f_before = x, f_x
        x += step if abs(step) > least else copysign(least, half)
        f_x = f(x)
    raise ArithmeticError(f"no root to {tolerance:g} in {MOST_STEPS} steps between {low:g} and {high:g}")


def _step(
    before: tuple[float, float],
    now: tuple[float, float],
    other: tuple[float, float],
    step: float,
    last_step: float,
    half: float,
    least: float,
) -> tuple[float, float]:
    """The next step and the one it has to be shorter than half of: by interpolation, or half of the interval."""
    (x_before, f_before), (x, f), (x_other, f_other) = before, now, other
    if abs(last_step) <= least or abs(f) >= abs(f_before):
        return half, half
    if x_before == x_other:
        tried = -f * (x - x_before) / (f - f_before)
    else:
        slope, slope_other = (f_before - f) / (x_before - x), (f_other - f) / (x_other - x)
        tried = -f * (f_other * slope_other - f_before * slope) / (slope_other * slope * (f_other - f_before))
    return (tried, step) if 2 * abs(tried) < min(abs(last_step), 3 * abs(half) - least) else (half, half)
