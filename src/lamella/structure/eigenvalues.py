"""Lowest eigenvalues of a structure's stiffness, with its factorisation.

Strips buckle and swing between nodes in very many ways alike: hundreds of eigenvalues lie within a few per cent.
Lanczos' method tells such ones apart only when it is started beside them, so the spectrum is shifted to just below the
lowest one, which the inertia of the shifted matrix finds: it counts the eigenvalues below (Sylvester's law).
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.linalg import eigh, eigh_tridiagonal
from scipy.sparse.linalg import LinearOperator, eigsh

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.sparse import Factor, SingularError, SymmetricPattern

# up to so many unknowns all eigenvalues are computed at once
DENSE_UNKNOWNS = 60
# over the largest by size, of the inverse of ratios: less is rounding
LEAST_INVERSE = 1e-9
# of the start of the iteration, which is the same on every run
START_SEED = 7
# Lanczos steps that tell where about the lowest eigenvalue is
ROUGH_STEPS = 30
# over what is known to be above the lowest eigenvalue: the first shift tried; each further one is as much lower again
SHIFT_SHARE = 0.92
MOST_SHIFTS = 200
# of eigenvalues
EIGENVALUE_TOLERANCE = 1e-10
# vectors that Lanczos' method keeps beside those that are asked for
KEPT_VECTORS = 40


def least_ratios(
    pattern: SymmetricPattern, stiffness: Floats, factor: Factor, other: Floats, count: int
) -> tuple[Floats, Floats]:
    """The smallest positive r with stiffness x = r other x, and x.

    Parameters
    ----------
    pattern : SymmetricPattern
    stiffness : (nnz,)
        Entries of a positive definite matrix.
    factor : Factor
        Its factorisation.
    other : (nnz,)
        Entries of a symmetric matrix.
    count : int
        Most of them.

    Returns
    -------
    ratios, vectors : (c,), (n, c)
        Ascending; fewer than `count` where there are not more.
    """
    size, left, right = pattern.size, pattern.matrix(stiffness), pattern.matrix(other)
    if size <= max(DENSE_UNKNOWNS, 2 * count + 1):
        inverse, vectors = eigh(right.toarray(), left.toarray())
        order = np.argsort(-inverse, kind="stable")[:count]
        order = order[inverse[order] > LEAST_INVERSE * np.abs(inverse).max()]
        return 1 / inverse[order], vectors[:, order]
    start = np.random.default_rng(START_SEED).standard_normal(size)
    rough = _rough_inverses(left, factor, right, start)
    least = LEAST_INVERSE * float(np.abs(rough).max())
    if rough[-1] <= least:
        return np.zeros(0), np.zeros((size, 0))
    shift, shifted = _below(pattern, stiffness, other, 1 / float(rough[-1]))
    kept = min(size - 1, 2 * count + KEPT_VECTORS)
    ratios, vectors = eigsh(
        left,
        k=count,
        M=right,
        sigma=shift,
        mode="buckling",
        OPinv=LinearOperator((size, size), matvec=shifted.solve, dtype=np.float64),
        which="LA",
        ncv=kept,
        tol=EIGENVALUE_TOLERANCE,
        v0=start,
    )
    order = np.argsort(ratios, kind="stable")
    order = order[(ratios[order] > 0) & (ratios[order] < 1 / least)]
    return ratios[order], vectors[:, order]


def _rough_inverses(left: sp.csc_matrix, factor: Factor, right: sp.csc_matrix, start: Floats) -> Floats:
    """Ascending; the last one is below the largest eigenvalue of left^-1 right and near it: Lanczos' method in the norm
    of left."""
    diagonal: list[float] = []
    beside: list[float] = []
    before, vector = np.zeros_like(start), factor.solve(left @ start)
    norm = np.sqrt(vector @ (left @ vector))
    for _ in range(ROUGH_STEPS):
        vector /= norm
        image = right @ vector
        diagonal.append(float(vector @ image))
        onward = factor.solve(image) - diagonal[-1] * vector - (beside[-1] if beside else 0.0) * before
        before, vector = vector, onward
        norm = float(np.sqrt(max(vector @ (left @ vector), 0.0)))
        if norm <= np.finfo(float).eps * max(map(abs, diagonal)):
            break
        beside.append(norm)
    beside = beside[: len(diagonal) - 1]
    return np.asarray(eigh_tridiagonal(np.array(diagonal), np.array(beside), eigvals_only=True))


def _below(pattern: SymmetricPattern, stiffness: Floats, other: Floats, above: float) -> tuple[float, Factor]:
    """A shift below the lowest eigenvalue, which is at most `above`, with the factorisation of the shifted matrix."""
    shift = above
    for _ in range(MOST_SHIFTS):
        shift *= SHIFT_SHARE
        try:
            shifted = pattern.factor(stiffness - shift * other)
        except SingularError:
            continue
        if shifted.negative == 0:
            return shift, shifted
    return 0.0, pattern.factor(stiffness)


def require_stable(negative: int, load_factor: float) -> None:
    """Refuse a state whose stiffness is not positive definite.

    Raises
    ------
    InputError
    """
    if negative:
        raise InputError(
            f"the equilibrium at the load factor {load_factor:.6g} is unstable in {negative} ways",
            "start from a stable one, at a smaller load factor",
            "equilibrium",
        )
