"""Least squares of parameters whose moves are limited in length.

The least of |A x - b|^2 with |M_k x| <= 1 for vectors M_k x of a few components each: how far a point of a boundary
moves is such a vector, linear in the parameters. The least is found from within by an interior point method (S. Boyd,
L. Vandenberghe, Convex Optimization (2004), section 11.7; the step's aim by S. Mehrotra, SIAM J. Optim. 2 (1992)
575): two or three dozen small linear systems, however many limits are reached.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.linalg import LinAlgError, cho_factor, cho_solve

from lamella.base.arrays import Floats

# of a limit, or in the unit of x: a solution of the least squares alone beyond it by less is taken
LIMIT_EXCESS = 1e-6
# of the objective: what is left to be gained at the end; steps at most; share of the way to the nearest limit
GAP_LEFT, INTERIOR_STEPS_MAX, TO_LIMIT = 1e-12, 80, 0.99
# of the largest slack: where one is less, no place keeps all planes
NO_PLACE = 1e-60
# of the diagonal, where a system has no root
REGULAR = 1e-14


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
        Normals and bounds: normals x <= bounds. Where no x within the limits keeps them all, one that breaks some.
    """
    normals, bounds = planes or (np.zeros((0, system.shape[1])), np.zeros(0))
    # of one length, as rounding is
    length = np.maximum(np.linalg.norm(normals, axis=1), 1e-300)
    within = _Within(*np.linalg.qr(system), right, limits, normals / length[:, None], bounds / length)
    x = within.free
    if (within.excess(x) > LIMIT_EXCESS).any():
        x = within.least()
    return np.asarray(x / max(1.0, float(np.linalg.norm(limits @ x, axis=1).max(initial=0.0))))


@dataclass(frozen=True)
class _Within:
    """The problem with its matrix as Q R."""

    axes: Floats
    triangle: Floats
    right: Floats
    limits: Floats
    normals: Floats
    bounds: Floats

    @property
    def free(self) -> Floats:
        """The solution without limits, (p,)."""
        return np.asarray(np.linalg.solve(self.triangle, self.axes.T @ self.right))

    def excess(self, x: Floats) -> Floats:
        """How far x is beyond each limit and plane, (n + m,)."""
        far = np.linalg.norm(self.limits @ x, axis=1)
        return np.concatenate([far - 1, self.normals @ x - self.bounds])

    def least(self) -> Floats:
        """The solution, by steps that bring it, its slacks s and multipliers y together: s y -> 0."""
        wanted = self.axes.T @ self.right
        size = max(float(wanted @ wanted), 1e-300)
        x = np.zeros(len(wanted))
        s = np.maximum(np.append(np.full(len(self.limits), 0.5), self.bounds), 0.1)
        y = size / len(s) / s
        for _ in range(INTERIOR_STEPS_MAX):
            here = _Place.of(self, wanted, x, s, y)
            gap = float(s @ y)
            if s.min() < NO_PLACE * s.max():
                break
            if gap <= GAP_LEFT * size and np.abs(here.off).max() < LIMIT_EXCESS:
                break
            _, ds, dy = here.step(np.zeros(len(s)))
            ahead = float((s + _share(s, ds) * ds) @ (y + _share(y, dy) * dy))
            dx, ds, dy = here.step((ahead / gap) ** 3 * gap / len(s) - ds * dy)
            share = TO_LIMIT * min(_share(s, ds), _share(y, dy))
            x, s, y = x + share * dx, s + share * ds, y + share * dy
        return np.asarray(x)


class _Place(NamedTuple):
    """The linear system of the steps from one place."""

    s: Floats
    y: Floats
    # of the constraints (|M x|^2 - 1) / 2 + s = 0 and normals x - bounds + s = 0
    slopes: Floats
    off: Floats
    pull: Floats
    factor: tuple[Floats, bool]

    @classmethod
    def of(cls, within: _Within, wanted: Floats, x: Floats, s: Floats, y: Floats) -> _Place:
        limits, triangle = within.limits, within.triangle
        n, components, p = limits.shape
        moves = limits @ x
        slopes = np.vstack([np.einsum("kc,kcp->kp", moves, limits), within.normals])
        off = np.append(((moves**2).sum(1) - 1) / 2, within.normals @ x - within.bounds) + s
        pull = triangle.T @ (triangle @ x - wanted) + slopes.T @ y
        flat = limits.reshape(-1, p)
        matrix = triangle.T @ triangle + flat.T @ (np.repeat(y[:n], components)[:, None] * flat)
        return cls(s, y, slopes, off, pull, _rooted(matrix + slopes.T @ ((y / s)[:, None] * slopes)))

    def step(self, aim: Floats) -> tuple[Floats, Floats, Floats]:
        """Changes of x, s and y with which s y becomes `aim`, to first order."""
        push = (aim + self.y * self.off) / self.s - self.y
        dx = cho_solve(self.factor, -self.pull - self.slopes.T @ push)
        ds = -self.off - self.slopes @ dx
        return dx, ds, (aim - self.y * ds) / self.s - self.y


def _share(values: Floats, change: Floats) -> float:
    """The share of a change, up to 1, after which the first of some positive values is 0."""
    falling = change < 0
    return float(min(1.0, (-values[falling] / change[falling]).min(initial=np.inf)))


def _rooted(matrix: Floats) -> tuple[Floats, bool]:
    """Cholesky's factor of a positive matrix that rounding may have left without one."""
    more = 0.0
    while True:
        try:
            factor, lower = cho_factor(matrix + more * np.diag(np.diagonal(matrix)))
            return np.asarray(factor), bool(lower)
        except LinAlgError:
            more = max(10 * more, REGULAR)
