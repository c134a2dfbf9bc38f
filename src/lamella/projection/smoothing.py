"""A low-pass filter for nets: noise goes, shape stays. One linear system before a problem that needs a fair start."""

from __future__ import annotations

import numpy as np

from lamella.base.sparse import Backend, SymmetricPattern
from lamella.projection.constraints.fairness import fairness
from lamella.projection.quad_mesh import QuadMesh

# third differences against staying: waves of L edges are damped where SMOOTHING_FAIRNESS (2 pi / L)^3 > 1, about 9
# edges; shorter ones are noise, longer ones shape
SMOOTHING_FAIRNESS = 3.0


def smoothed(mesh: QuadMesh, *, fair: float = SMOOTHING_FAIRNESS, backend: Backend | None = None) -> QuadMesh:
    r"""The net with the least sum of third differences and of moves.

    .. math:: \sum_i |v_i - v_i^0|^2 + f^2 \sum_s |-v_{s_0} + 3 v_{s_1} - 3 v_{s_2} + v_{s_3}|^2 \to \min

    Differences along polylines and along the boundary; a singular vertex is drawn to the mean of its neighbours.

    Parameters
    ----------
    mesh : QuadMesh
    fair : float
        f; 0 leaves the net as it is.
    backend : optional
        See `lamella.base.sparse.default_backend`.
    """
    one, other, values = [np.zeros(0, np.int64)], [np.zeros(0, np.int64)], [np.zeros(0)]
    for part in fairness(mesh, 3, weight=fair):
        a, b = np.tril_indices(len(part.coefficients))
        one.append(part.stencils[:, a].ravel())
        other.append(part.stencils[:, b].ravel())
        values.append(np.tile(part.weight**2 * part.coefficients[a] * part.coefficients[b], len(part.stencils)))
    pattern = SymmetricPattern.from_pairs(
        np.concatenate(one), np.concatenate(other), len(mesh.vertices), backend=backend
    )
    entries = pattern.assemble(np.concatenate(values))
    entries[pattern.columns[:-1]] += 1.0
    return mesh.at(pattern.factor(entries).solve(mesh.vertices))
