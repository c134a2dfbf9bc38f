"""Least squares of parameters whose moves are limited in length.

The least of |A x - b|^2 with |M_k x| <= 1 for vectors M_k x of a few components each: how far a point of a boundary
moves is such a vector, linear in the parameters. Each is bounded by its tangent planes, u . M_k x <= 1 for unit vectors
u, where the last solution lies beyond (Kelley, J. SIAM 8 (1960) 703); with planes alone it is a problem of least
distance, solved by non-negative least squares (Lawson and Hanson, Solving Least Squares Problems, 1974, chapter 23).
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import solve_triangular
from scipy.optimize import nnls

from lamella.surface.points import Floats

# of a limit: solutions beyond it by less are brought back by a common factor
BEYOND = 1e-6
# rounds of planes; each takes away most of what was beyond
MOST_ROUNDS = 60


def least_squares_within(system: Floats, right: Floats, limits: Floats) -> Floats:
    """The solution (p,) of least |system x - right|^2 with |limits[k] x| <= 1 for all k.

    Parameters
    ----------
    system : (m, p)
        Of rank p.
    right : (m,)
    limits : (n, c, p)
    """
    axes, triangle = np.linalg.qr(system)
    q_right = axes.T @ right
    planes = np.zeros((0, system.shape[1]))
    x = np.asarray(solve_triangular(triangle, q_right))
    for _ in range(MOST_ROUNDS):
        moves = limits @ x
        far = np.linalg.norm(moves, axis=1)
        over = far > 1 + BEYOND
        if not over.any():
            break
        unit = moves[over] / far[over, None]
        planes = np.vstack([planes, np.einsum("kc,kcp->kp", unit, limits[over])])
        x = _behind_planes(triangle, q_right, planes)
    return np.asarray(x / max(1.0, float(np.linalg.norm(limits @ x, axis=1).max(initial=0.0))))


def _behind_planes(triangle: Floats, right: Floats, planes: Floats) -> Floats:
    """The least |triangle x - right| with planes (n, p) x <= 1."""
    # y = triangle x - right is the shortest vector with normals y >= heights
    normals = -solve_triangular(triangle, planes.T, trans="T").T
    heights = -1 - normals @ right
    count = len(right)
    dual = np.vstack([normals.T, heights])
    goal = np.append(np.zeros(count), 1.0)
    weights, _ = nnls(dual, goal, maxiter=50 * dual.shape[1])
    rest = goal - dual @ weights
    # the dual of a possible problem: rest[count] is above 0
    y = (dual[:count] @ weights) / rest[count]
    return np.asarray(solve_triangular(triangle, right + y))
