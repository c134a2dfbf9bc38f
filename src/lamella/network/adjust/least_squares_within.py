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

from lamella.base.arrays import Booleans, Floats

# of a limit, or in the unit of x: solutions beyond it by less are brought back by a common factor
LIMIT_EXCESS = 1e-6
# rounds of planes; each takes away most of what was beyond
PLANE_ROUNDS_MAX = 60


def least_squares_within(
    system: Floats, right: Floats, limits: Floats, planes: tuple[Floats, Floats] | None = None
) -> Floats:
    """The solution (p,) of least |system x - right|^2 with |limits[k] x| <= 1 for all k, behind planes.

    Parameters
    ----------
    system : (m, p)
        Of rank p.
    right : (m,)
    limits : (n, c, p)
    planes : (m, p) and (m,), optional
        Normals and bounds: normals x <= bounds, which some x within the limits keeps.
    """
    axes, triangle = np.linalg.qr(system)
    q_right = axes.T @ right
    given, given_bounds = planes or (np.zeros((0, system.shape[1])), np.zeros(0))
    # of one length, as rounding is
    length = np.maximum(np.linalg.norm(given, axis=1), 1e-300)
    given, given_bounds = given / length[:, None], given_bounds / length
    normals, bounds = given, given_bounds
    x = np.asarray(solve_triangular(triangle, q_right))
    for _ in range(PLANE_ROUNDS_MAX):
        moves = limits @ x
        far = np.linalg.norm(moves, axis=1)
        over = far > 1 + LIMIT_EXCESS
        if not over.any() and (given @ x <= given_bounds + LIMIT_EXCESS).all():
            break
        unit = moves[over] / far[over, None]
        normals = np.vstack([normals, np.einsum("kc,kcp->kp", unit, limits[over])])
        bounds = np.append(bounds, np.ones(len(unit)))
        x, held = _behind_planes(triangle, q_right, normals, bounds)
        # the least rises from round to round: planes that hold nothing now are not needed for it
        held[: len(given)] = True
        normals, bounds = normals[held], bounds[held]
    return np.asarray(x / max(1.0, float(np.linalg.norm(limits @ x, axis=1).max(initial=0.0))))


def _behind_planes(triangle: Floats, right: Floats, planes: Floats, bounds: Floats) -> tuple[Floats, Booleans]:
    """The least |triangle x - right| with planes (n, p) x <= bounds (n,), and which of these hold it, (n,)."""
    # y = triangle x - right is the shortest vector with normals y >= heights
    normals = -solve_triangular(triangle, planes.T, trans="T").T
    heights = -bounds - normals @ right
    count = len(right)
    dual = np.vstack([normals.T, heights])
    goal = np.append(np.zeros(count), 1.0)
    weights, _ = nnls(dual, goal, maxiter=50 * dual.shape[1])
    rest = goal - dual @ weights
    # the dual of a possible problem: rest[count] is above 0
    y = (dual[:count] @ weights) / rest[count]
    return np.asarray(solve_triangular(triangle, right + y)), weights > 0
