"""Is a film stable: the lowest eigenvalue of its Jacobi operator.

The second variation of area + 2 H volume along a normal shift phi is the integral of |grad phi|^2 - |A|^2 phi^2 with
|A|^2 = k1^2 + k2^2 = 4 H^2 - 2 K: the Jacobi operator is -Laplace - |A|^2, with phi = 0 on held boundaries.

Near a fold, or where two families cross, another film of the same H is beside. Along the lowest mode phi, of eigenvalue
lambda, area + 2 H volume is E(a) = lambda m a^2 / 2 + c a^3 / 6 + ... with m the integral of phi^2 and c the third
variation; its other stationary point is a = -2 lambda m / c (Lyapunov and Schmidt's reduction to first order).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse.linalg import ArpackError, LinearOperator, eigsh

from lamella.base.arrays import Floats
from lamella.base.sparse import Factor, SingularError
from lamella.surface.form_finding.film import Film
from lamella.surface.form_finding.variation import Variation

# of 1 / area: below it the lowest eigenvalue is nought for all purposes, the film is at the fold
FOLD = 0.05
# of 1 / area: above it no other film is near enough for its distance to be estimated
NEAR_FOLD = 2.0
# step of the third variation's difference quotient, over the film's size
STABILITY_STEP = 1e-3
# shifts tried below the spectrum, each four times the one before
SHIFTS = 40


@dataclass(frozen=True)
class Stability:
    """How a film answers to disturbances.

    Attributes
    ----------
    verdict : str
        "stable", "unstable" or, where abs(lowest) times the film's area is below 0.05, "fold". That product has no
        dimension and is 18.2 for a flat disc, (pi / L)^2 - 1 / R^2 times 2 pi R L for a cylinder: 0.2 at a length L of
        0.995 pi R. Close to a fold lowest falls with the distance from it along the family, so that within a thousandth
        of the critical length a cylinder is at the fold.
    lowest : float
        Lowest eigenvalue of the Jacobi operator, 1/m^2.
    negative : int
        Negative eigenvalues.
    mode : (n,)
        Normal shift of the nodes in the lowest mode, of largest value 1.
    beside : float
        Largest distance of another film of the same H in the same loops, an estimate, m; infinite where none is near.
    """

    verdict: str
    lowest: float
    negative: int
    mode: Floats
    beside: float = np.inf


def stability_of(film: Film, mean_curvature: float) -> Stability:
    """Stability of a film in equilibrium at a given mean curvature (1/m)."""
    directions = film.directions()
    pattern = film.pattern
    variation = Variation(film.connectivity, directions)
    first = variation.first(film.nodes)
    stiffness = pattern.assemble(variation.second(film.nodes, first, mean_curvature))
    entries = pattern.assemble(variation.mass(first))
    mass = pattern.matrix(entries)
    # from below the spectrum the lowest eigenvalue is the nearest one, however far below nought it lies
    factor: Factor | None = None
    negative: int | None = None
    shift = 0.0
    for below in (0.0, 1e-6, *4.0 ** np.arange(SHIFTS)):
        shift = -below / film.size**2
        try:
            factor = pattern.factor(stiffness - shift * entries)
        except SingularError:
            continue
        negative = factor.negative if negative is None else negative
        if not factor.negative:
            break
    assert factor is not None
    assert negative is not None
    matrix = pattern.matrix(stiffness)
    inverse = LinearOperator(matrix.shape, matvec=factor.solve, dtype=float)
    start = np.ones(pattern.size)
    try:
        values, vectors = eigsh(matrix, 1, mass, sigma=shift, OPinv=inverse, v0=start, tol=1e-9)
    except ArpackError:
        values, vectors = eigsh(matrix, 1, mass, sigma=shift, OPinv=inverse, tol=1e-6, ncv=44)
    lowest = float(values[0])
    mode = np.zeros(film.connectivity.node_count)
    mode[film.unknowns >= 0] = vectors[:, 0]
    verdict = "stable" if lowest > 0 else "unstable"
    if abs(lowest) * first.area < FOLD:
        verdict = "fold"
    mode /= mode[np.abs(mode).argmax()]
    beside = np.inf
    if abs(lowest) * first.area < NEAR_FOLD:
        bend = _third_variation(film, variation, mean_curvature, mode)
        heavy = mode[film.unknowns >= 0]
        beside = float(abs(2 * lowest * (heavy @ (mass @ heavy))) / max(abs(bend), 1e-300))
    return Stability(verdict, lowest, negative, mode, beside)


def _third_variation(film: Film, variation: Variation, mean_curvature: float, mode: Floats) -> float:
    """Third variation of area + 2 H volume along a mode."""
    step = STABILITY_STEP * film.size
    free = film.unknowns >= 0

    def second(shift: float) -> float:
        nodes = film.nodes + shift * mode[:, None] * variation.directions
        blocks = variation.second(nodes, variation.first(nodes), mean_curvature)
        return float(mode[free] @ (film.pattern.matrix(film.pattern.assemble(blocks)) @ mode[free]))

    return (second(step) - second(-step)) / (2 * step)
