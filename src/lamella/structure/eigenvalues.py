"""Lowest eigenvalues of a structure's stiffness, with its factorisation."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from scipy.linalg import eigh
from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.sparse import Factor

# up to so many unknowns all eigenvalues are computed at once
DENSE_UNKNOWNS = 60
# of the ratio that one unknown alone has: less is rounding
LEAST_INVERSE = 1e-9
# of the start of the iteration, which is the same on every run
START_SEED = 7


def least_ratios(stiffness: sp.csc_matrix, factor: Factor, other: sp.csc_matrix, count: int) -> tuple[Floats, Floats]:
    """The smallest positive r with stiffness x = r other x, and x.

    Parameters
    ----------
    stiffness : (n, n)
        Positive definite.
    factor : Factor
        Its factorisation.
    other : (n, n)
        Symmetric.
    count : int
        Most of them.

    Returns
    -------
    ratios, vectors : (c,), (n, c)
        Ascending; fewer than `count` where there are not more.
    """
    size = stiffness.shape[0]
    # the largest ratio of any one unknown is a bound from below of that of all motions together
    bound = float(np.abs(other.diagonal() / stiffness.diagonal()).max())
    if size <= max(DENSE_UNKNOWNS, 2 * count + 1):
        inverse, vectors = eigh(other.toarray(), stiffness.toarray())
    else:
        solve = LinearOperator((size, size), matvec=factor.solve, dtype=np.float64)
        start = np.random.default_rng(START_SEED).standard_normal(size)
        try:
            inverse, vectors = eigsh(other, k=count, M=stiffness, Minv=solve, which="LA", v0=start)
        except ArpackNoConvergence as failure:
            # where no further ratio is positive the iteration ends at a cluster of rounding
            inverse, vectors = failure.eigenvalues, failure.eigenvectors
    order = np.argsort(-inverse, kind="stable")[:count]
    order = order[inverse[order] > LEAST_INVERSE * bound]
    return 1 / inverse[order], vectors[:, order]


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
