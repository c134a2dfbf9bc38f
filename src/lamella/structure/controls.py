"""What a step along an equilibrium path asks for: one equation between the motion and the load factor."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from lamella.base.arrays import Floats
from lamella.structure.beam.poses import NODE_UNKNOWNS
from lamella.structure.equilibrium import Equilibrium


class Control(Protocol):
    """How much of the load factor an iteration adds."""

    def begin(self, start: Equilibrium) -> None:
        """A step from there begins."""

    def ahead(self, iteration: int) -> float:
        """What is added to the load factor before an iteration."""

    def more(self, iteration: int, total: Floats, motion: Floats, along: Floats) -> float:
        """What the solved iteration adds.

        Parameters
        ----------
        iteration : int
            From 1.
        total : (6 n + k,)
            Motion of the step before this iteration.
        motion, along : (6 n + k,)
            Motion of this iteration at an unchanged load factor, and that of one unit of load factor.
        """


@dataclass
class LoadControl:
    """The load factor reaches `factor`."""

    factor: float
    _by: float = field(default=0.0, init=False, repr=False)

    def begin(self, start: Equilibrium) -> None:
        self._by = self.factor - start.factor

    def ahead(self, iteration: int) -> float:
        return self._by if iteration == 1 else 0.0

    def more(self, iteration: int, total: Floats, motion: Floats, along: Floats) -> float:
        return 0.0


@dataclass
class DisplacementControl:
    """A sum of unknowns grows by `by` in this step, whatever load that takes.

    Attributes
    ----------
    weights : (6 n + k,)
        Of shifts, rotations and joints' angles.
    by : float
    """

    weights: Floats
    by: float

    def begin(self, start: Equilibrium) -> None: ...

    def ahead(self, iteration: int) -> float:
        return 0.0

    def more(self, iteration: int, total: Floats, motion: Floats, along: Floats) -> float:
        rate = self.weights @ along
        return float((self.by - self.weights @ (total + motion)) / rate) if rate else np.inf


@dataclass
class ArcLengthControl:
    """The step has a length in the space of shifts, and goes on in the direction of the last one.

    The iterations go at right angles to the step so far (E. Ramm, in: Nonlinear Finite Element Analysis in Structural
    Mechanics, Springer 1981, 63): past limit points, where the load factor falls.

    Attributes
    ----------
    length : float
        Root of the sum of squares of all nodes' shifts, m.
    before : (6 n + k,)
        Motion of the last step; all 0 for the first one, which raises the load factor.
    """

    length: float
    before: Floats

    def begin(self, start: Equilibrium) -> None:
        self._shifts = np.zeros(start.poses.unknowns, bool)
        nodes = self._shifts[: NODE_UNKNOWNS * len(start.poses.points)].reshape(-1, NODE_UNKNOWNS)
        nodes[:, :3] = True

    def ahead(self, iteration: int) -> float:
        return 0.0

    def more(self, iteration: int, total: Floats, motion: Floats, along: Floats) -> float:
        shifts = self._shifts
        if iteration == 1:
            size = np.sqrt(along[shifts] @ along[shifts])
            if not size > 0:
                return np.inf
            onward = along[shifts] @ self.before[shifts]
            return float(self.length / size * (-1.0 if onward < 0 else 1.0))
        slope = total[shifts] @ along[shifts]
        return float(-(total[shifts] @ motion[shifts]) / slope) if slope else np.inf
