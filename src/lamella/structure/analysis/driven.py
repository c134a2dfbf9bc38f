"""A node driven by a load case as far as is asked for: displacement control."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.result import Result
from lamella.structure.analysis.load_curve import LoadCurve, Use
from lamella.structure.beam.poses import NODE_UNKNOWNS
from lamella.structure.equilibrium import Equilibrium
from lamella.structure.static import displacement_path


@dataclass(frozen=True, repr=False, eq=False)
class Driven(Result):
    """What multiple of a case moves a node so far.

    Attributes
    ----------
    name : str
        Of the case.
    node : int
    curve : LoadCurve
        `watched` is the shift of the node in the direction.
    reason : str
        Why it was not moved as far as was asked for; empty: it was.
    """

    name: str
    node: int
    curve: LoadCurve
    reason: str

    def _line(self) -> str:
        return f"{self.name!r}, node {self.node} by {1e3 * self.curve.watched[-1]:.4g} mm: {self.curve._line()}"


def driven(
    name: str, start: Equilibrium, node: int, direction: Floats, by: float, use: Use, *, steps: int = 20
) -> Driven:
    """Move a node in a direction, whatever multiple of the loads that takes, past limit points too.

    Parameters
    ----------
    name : str
    start : Equilibrium
        Without the load, at the load factor 0, with the case's loads.
    node : int
    direction : (3,)
        Of any length.
    by : float
        m.
    use : callable
    steps : int
        To begin with.

    Raises
    ------
    InputError
        The node is held in all that the direction has; loads that change natural lengths.
    """
    if not start.loads.strain_free:
        raise InputError(
            "the case changes lengths of parts, as temperature does: a displacement cannot drive it",
            "choose a case of forces",
            "loads",
        )
    way = np.asarray(direction, float) / np.linalg.norm(direction)
    weights = np.zeros(start.poses.unknowns)
    weights[NODE_UNKNOWNS * node : NODE_UNKNOWNS * node + 3] = way
    if not weights[start.structure.free].any():
        raise InputError(f"node {node} is held in this direction", "choose another place or direction", "near")
    states, reason = [start], ""
    path = displacement_path(start, weights, by, steps=steps)
    while True:
        try:
            states.append(next(path))
        except StopIteration:
            break
        except InputError as error:
            reason = error.message
            break
    return Driven(name, node, LoadCurve.of(states, use, weights), reason)
