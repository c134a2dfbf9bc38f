"""What the solver tells: one record an iteration, and a verdict at the end."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

from lamella.base.arrays import Floats

Verdict = Literal["solved", "settled", "stagnated", "iterations used up", "broken off", "collapsed", "left the surface"]
"""How it ended.

solved
    All hard constraints are met to the tolerance.
settled
    The steps have ended and some hard constraint is not met: together they ask for too much, and the remainder is
    the least one.
stagnated
    The sum of squares no longer falls, though steps go on.
iterations used up
    None of these yet.
broken off
    The equations cannot be solved, or values grow beyond all numbers.
collapsed
    Edges have lost their length: a point meets most constraints. There is no such net nearby.
left the surface
    Vertices have gone over its border, where only its tangent planes go on.
"""


@dataclass(frozen=True)
class Iteration:
    """The state before a step, and the step.

    Attributes
    ----------
    number : int
        0: the start.
    residual, largest : name to float
        Root mean square and largest absolute residual of each constraint, without its weight: edges or radians.
    drift : name to float
        Root mean square over a block's components of the change since the start or `Block.origin`, over its scale.
    objective : float
        Weighted sum of squares.
    step : float
        Largest change of an unknown that follows, over its scale; 0 after the last.
    length : float
        Share of the Gauss-Newton step the line search took.
    damping : float
        Levenberg and Marquardt's lambda.
    seconds : float
        CPU time since the solver was called.
    """

    number: int
    residual: dict[str, float]
    largest: dict[str, float]
    drift: dict[str, float]
    objective: float
    step: float
    length: float
    damping: float
    seconds: float = field(compare=False)

    def __str__(self) -> str:
        parts = ", ".join(f"{name} {value:.1e}" for name, value in self.residual.items())
        return f"{self.number:3d}  {parts}; step {self.step:.1e} x {self.length:.2f}, damping {self.damping:.0e}"


@dataclass(frozen=True)
class Solution:
    """Where the solver ended.

    Attributes
    ----------
    values : name to (n, d)
        Unknowns by block.
    iterations : tuple of Iteration
        From the start to the end; the last one is the state of `values`.
    verdict : Verdict
    unmet : tuple of str
        Hard constraints whose root mean square is above the tolerance, largest first.
    """

    values: dict[str, Floats] = field(repr=False)
    iterations: tuple[Iteration, ...] = field(repr=False)
    verdict: Verdict
    unmet: tuple[str, ...]

    @property
    def last(self) -> Iteration:
        """The state of `values`."""
        return self.iterations[-1]

    @property
    def solved(self) -> bool:
        """Whether all hard constraints are met."""
        return self.verdict == "solved"

    def __str__(self) -> str:
        lines = [f"{self.verdict} after {self.last.number} iterations, {self.last.seconds:.2f} s"]
        for name, value in self.last.residual.items():
            mark = "  not met" if name in self.unmet else ""
            lines.append(f"  {name}: rms {value:.2e}, largest {self.last.largest[name]:.2e}{mark}")
        return "\n".join(lines)
