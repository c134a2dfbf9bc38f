"""A load case: all that acts at once, in the order of a network's nodes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.result import Result

GRAVITY = 9.81
"""m/s^2; with it EN 1991-1-1 annex A turns densities into weights."""


@dataclass(frozen=True, eq=False, repr=False)
class LoadCase(Result):
    """Loads and imposed motions at the load factor 1; global axes.

    Attributes
    ----------
    name : str
    node_forces : (n, 3)
        N.
    node_moments : (n, 3)
        N m.
    self_weight : (3,)
        What the weight of all masses is multiplied by, in multiples of `GRAVITY`: (0, 0, -1) is the weight itself.
    temperature : float
        Change of all parts' temperature, K.
    settlements : (n, 6)
        Shifts (m) and rotation vectors (rad) of supports; 0 where nothing is fixed.
    """

    name: str
    node_forces: Floats
    node_moments: Floats
    self_weight: Floats
    temperature: float
    settlements: Floats

    def _line(self) -> str:
        x, y, z = self.total.tolist()
        return f"{self.name}: {x:.4g}, {y:.4g}, {z:.4g} N and {np.linalg.norm(self.self_weight):.4g} times the weight"

    @property
    def total(self) -> Floats:
        """Sum of the forces at the nodes, N, (3,): without self-weight."""
        return np.asarray(self.node_forces.sum(0))


def no_load(name: str, count: int) -> LoadCase:
    """Nothing acts on so many nodes."""
    return LoadCase(name, np.zeros((count, 3)), np.zeros((count, 3)), np.zeros(3), 0.0, np.zeros((count, 6)))


def combined(name: str, cases: Sequence[LoadCase], factors: Mapping[str, float]) -> LoadCase:
    """Several cases at once, each times its factor.

    Parameters
    ----------
    name : str
    cases : sequence of LoadCase
        Of the same nodes.
    factors : mapping
        By the cases' names; one that is not named takes no part.

    Raises
    ------
    InputError
        A factor of a case that is not there.
    """
    known = {case.name: case for case in cases}
    for other in factors:
        if other not in known:
            raise InputError(f"there is no load {other!r}", f"loads are {', '.join(known)}", "factors")
    chosen = [(known[one], factor) for one, factor in factors.items()]
    start = no_load(name, len(cases[0].node_forces))

    def total(key: str) -> Floats:
        return np.asarray(getattr(start, key) + sum(factor * getattr(case, key) for case, factor in chosen))

    return LoadCase(
        name,
        total("node_forces"),
        total("node_moments"),
        total("self_weight"),
        float(total("temperature")),
        total("settlements"),
    )
