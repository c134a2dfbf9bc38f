"""The way of a structure under growing load: a row a state."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.result import Result
from lamella.structure.equilibrium import Equilibrium

Use = Callable[[Equilibrium], float]
"""Largest utilisation of an equilibrium."""


@dataclass(frozen=True, repr=False, eq=False)
class LoadCurve(Result):
    """States of a path, the one it begins with first.

    Attributes
    ----------
    factors : (p,)
        Load factors.
    shifts : (p,)
        Largest shift of a node from where the path begins, m.
    watched : (p,)
        The weighted sum of unknowns that is looked at, from where the path begins, m: of a path that a displacement
        drives that displacement, else `shifts`.
    utilisation : (p,)
    negative : (p,) int
        Negative eigenvalues of the stiffness: 0 where the state is stable.
    """

    factors: Floats
    shifts: Floats
    watched: Floats
    utilisation: Floats
    negative: Integers

    def _line(self) -> str:
        return f"{len(self.factors)} states, load factor up to {self.factors.max():.4g}"

    @classmethod
    def of(cls, states: Iterable[Equilibrium], use: Use, weights: Floats | None = None) -> LoadCurve:
        """Of a path's states.

        Parameters
        ----------
        states : iterable of Equilibrium
            Of one structure, at least one.
        use : callable
        weights : (6 n + k,), optional
            Of shifts, for `watched`.
        """
        rows: list[tuple[float, float, float, float, int]] = []
        first: Equilibrium | None = None
        for here in states:
            first = here if first is None else first
            by = shift_between(first, here)
            far = float(np.linalg.norm(by, axis=1).max())
            watched = far
            if weights is not None:
                watched = float(weights[: 6 * len(by)].reshape(-1, 6)[:, :3].ravel() @ by.ravel())
            rows.append((here.factor, far, watched, use(here), here.negative))
        factors, shifts, watch, used, negative = (np.array(column) for column in zip(*rows, strict=True))
        return cls(factors, shifts, watch, used, negative)


def shift_between(one: Equilibrium, other: Equilibrium) -> Floats:
    """Shifts of the nodes from one state to another, m, (n, 3)."""
    return np.asarray(other.poses.points - one.poses.points)
