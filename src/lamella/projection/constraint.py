"""What a constraint says of itself; everything else is the solver's.

A constraint is written once for m items at a time. It names its arguments (`slots`), and gives the residual and its
derivatives by each argument, both as whole arrays. Residuals are lengths over the mean edge, angles in radians or
unit-vector components: a residual of 1e-3 is a thousandth of an edge wherever it stands, so weights compare. They are
at most quadratic in the unknowns; Gauss-Newton's method does well on those (Tang et al. 2014; paper section 2.2), and
the solver's line search is exact because of it.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar, Self

from lamella.base.arrays import Floats
from lamella.projection.unknowns import Slot, Values


@dataclass(frozen=True, kw_only=True)
class Constraint(ABC):
    """m items of p equations each.

    Attributes
    ----------
    name : str
        Under which reports list it.
    weight : float
        Factor of the residual in the sum of squares: 0.1 counts a tenth of an edge as much as a hundredth with 1.
    fade : float
        Factor of the weight from an iteration to the next; below 1e-4 of its first weight a constraint is dropped.
    hard : bool
        Whether it has to be met to the solver's tolerance before the verdict is "solved". Hard and soft constraints
        are terms of one sum of squares: soft ones that fade choose among the ways to meet the hard ones and leave no
        trace, since at the end the hard ones are alone. A soft one of weight w that stays (fade 1) keeps the hard
        ones from holding by the order of w^2; they count as met only if that is within the tolerance.
    """

    name: str
    weight: float = 1.0
    fade: float = 1.0
    hard: bool = True

    linear: ClassVar[bool] = False
    """Whether the derivatives are the same everywhere: then they are worked out once."""

    @abstractmethod
    def slots(self) -> tuple[Slot, ...]:
        """Arguments of `residual`, m items each."""

    @abstractmethod
    def residual(self, *arguments: Floats) -> Floats:
        """Residuals (m, p) of arguments (m, d) each."""

    @abstractmethod
    def jacobian(self, *arguments: Floats) -> tuple[Floats, ...]:
        """Derivatives by each argument, (m, p, d) each."""

    def refreshed(self, values: Values) -> Self:
        """The constraint with foot points and the like of new values; they are constants between two iterations."""
        return self
