"""How well an unknown is determined, from the curvature of the problem with all others worked out."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from lamella.base.sparse import Backend, SingularError
from lamella.projection.constraint import Constraint
from lamella.projection.normal_equations import NormalEquations
from lamella.projection.unknowns import Block, Layout

# the constraints hold this much more exactly than the points are known
EXACTNESS = 1e3


def uncertainty(
    blocks: Sequence[Block],
    constraints: Sequence[Constraint],
    unknown: str,
    points: str,
    doubt: float,
    *,
    backend: Backend | None = None,
) -> float:
    """Standard deviation of a single unknown when points are known to +-doubt and constraints hold.

    Of all small changes that leave the constraints met, those that move the points least decide: the inverse of
    J^T J + P / EXACTNESS^2 at the unknown, times doubt^2 / EXACTNESS^2, P the points' squared changes over their
    scale. An unknown the net can follow at no cost has a large one, whatever the residual says.

    Parameters
    ----------
    blocks : sequence of Block
        Unknowns where the constraints hold.
    constraints : sequence of Constraint
        Those that hold.
    unknown : str
        Block with one number.
    points : str
        Block whose values were given.
    doubt : float
        Of each coordinate, over the scale of the points' block.

    Returns
    -------
    float
        In the unit of the unknown; infinite where nothing determines it.
    """
    layout, vector = Layout.of(blocks)
    values = layout.values(vector)
    current = [constraint.refreshed(values) for constraint in constraints]
    equations = NormalEquations.of(layout, current, backend)
    entries, _ = equations.assemble(current, equations.linearise(current, vector), [c.weight for c in current])
    share = np.full(layout.size, 1e-8)
    first, count = layout.starts[points], int(np.prod(layout.shapes[points]))
    share[first : first + count] = 1.0
    entries[equations.pattern.columns[:-1]] += share / (EXACTNESS * layout.scale) ** 2
    right = np.zeros(layout.size)
    right[layout.starts[unknown]] = 1.0
    try:
        factor = equations.pattern.factor(entries)
    except SingularError:
        return np.inf
    inverse = float(right @ factor.solve(right))
    return doubt / EXACTNESS * float(np.sqrt(inverse)) if inverse > 0 and not factor.negative else np.inf
