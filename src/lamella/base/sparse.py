"""Sparse symmetric systems: the pattern is analysed once, the numbers are factored many times.

Two back ends do the same: `rslab` (supernodal L D L^T) and scipy's SuperLU, which is always there. Both give the
inertia, the number of negative eigenvalues, which tells a stable film from an unstable one (Sylvester's law).
"""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import Any, Literal, Protocol, cast

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from lamella.base.arrays import Floats, Integers

AnyIntegers = NDArray[np.int32] | Integers
Backend = Literal["rslab", "splu"]

# minimum degree orders small systems faster, nested dissection larger ones better
DISSECTION_FROM = 30_000


def default_backend() -> Backend:
    """Back end in use: LAMELLA_SOLVER where it is set, else `rslab` where it can be imported, else "splu"."""
    wanted = os.environ.get("LAMELLA_SOLVER", "")
    if wanted in ("rslab", "splu"):
        return cast(Backend, wanted)
    try:
        import rslab  # noqa: F401
    except ImportError:
        return "splu"
    return "rslab"


def packed(blocks: Floats) -> Floats:
    """Lower triangles of symmetric blocks (e, k, k), row by row, (e, k (k + 1) / 2)."""
    k = blocks.shape[1]
    i, j = np.tril_indices(k)
    return np.asarray(blocks.reshape(len(blocks), -1).take(k * i + j, 1))


def counted(numbers: AnyIntegers, count: int) -> AnyIntegers:
    """Order that sorts whole numbers from 0 to count - 1, equal ones as they come: each is counted to its place."""
    n = len(numbers)
    # rows of one entry each, in columns of these numbers: their transpose has what is asked for
    starts = np.arange(n + 1, dtype=numbers.dtype)
    return cast(AnyIntegers, sp.csr_matrix((np.zeros(n, np.int8), numbers, starts), (n, count)).tocsc().indices)


class SingularError(ArithmeticError):
    """The matrix has no inverse to working precision."""


class Factor(Protocol):
    """A factored symmetric matrix."""

    negative: int
    """Number of negative eigenvalues."""

    def solve(self, right: Floats) -> Floats:
        """Solution for one (n,) or several (n, k) right-hand sides."""


class _RslabFactor:
    def __init__(self, factor: Any) -> None:
        self._factor = factor
        _, self.negative, zero = (int(x) for x in factor.inertia)
        if zero:
            raise SingularError(f"{zero} eigenvalues vanish")

    def solve(self, right: Floats) -> Floats:
        if right.ndim == 1:
            return np.asarray(self._factor.solve(np.ascontiguousarray(right)))
        return np.asarray(self._factor.solve_many(np.ascontiguousarray(right)))


class _SuperLuFactor:
    def __init__(self, matrix: sp.csc_matrix) -> None:
        from scipy.sparse.linalg import splu

        try:
            self._factor = splu(
                matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
            )
        except RuntimeError as error:
            raise SingularError(str(error)) from None
        if not np.array_equal(self._factor.perm_r, self._factor.perm_c):
            raise SingularError("rows were exchanged on the way: a pivot vanishes")
        # rows are in the columns' order, so U's diagonal is that of D in L D L^T
        self.negative = int((self._factor.U.diagonal() < 0).sum())

    def solve(self, right: Floats) -> Floats:
        return np.asarray(self._factor.solve(right))


@dataclass(frozen=True)
class SymmetricPattern:
    """Where the entries of a symmetric matrix assembled from element blocks are, the same for all its values.

    Attributes
    ----------
    size : int
        Number of unknowns, border included.
    columns, rows : (size + 1,), (nnz,)
        Lower triangle in compressed columns, rows ascending.
    border : int
        Number of last unknowns that are coupled with all others (a multiplier of a volume, a step length).
    backend : "rslab" or "splu"
    """

    size: int
    columns: AnyIntegers
    rows: AnyIntegers
    border: int
    backend: Backend
    _target: AnyIntegers = field(repr=False)  # entry of each kept block value
    _kept: Integers | None = field(repr=False)  # flat index of each kept block value, ascending; None: all are
    _border_target: Integers = field(repr=False)  # (border, size) entries of the border's rows
    _symbolic: dict[str, Any] = field(default_factory=dict, repr=False)

    def __getstate__(self) -> dict[str, Any]:
        # the solver's analysis is its own memory, and made again by the next factorisation
        return vars(self) | {"_symbolic": {}}

    @classmethod
    def from_elements(
        cls, unknowns: Integers, count: int, *, border: int = 0, backend: Backend | None = None
    ) -> SymmetricPattern:
        """Pattern of element blocks.

        Parameters
        ----------
        unknowns : (e, k) int
            Unknown of each local one; -1: held, its rows and columns are left out.
        count : int
            Number of unknowns without the border.
        border : int
            Unknowns after those, coupled with all.
        backend : optional
            Default: `default_backend`.
        """
        first, second = np.tril_indices(unknowns.shape[1])
        small = unknowns.astype(np.int32) if count < np.iinfo(np.int32).max else unknowns
        one, other = small.take(first, 1).ravel(), small.take(second, 1).ravel()
        return cls.from_pairs(one, other, count, border=border, backend=backend)

    @classmethod
    def from_pairs(
        cls, one: AnyIntegers, other: AnyIntegers, count: int, *, border: int = 0, backend: Backend | None = None
    ) -> SymmetricPattern:
        """Pattern of single entries, each given once for (i, j) and (j, i), as often as values are added to it.

        Parameters
        ----------
        one, other : (p,) int
            The two unknowns of each; -1: held, left out. `assemble` takes the values in this order.
        count, border, backend
            As `from_elements`.
        """
        size = count + border
        free = (one >= 0) & (other >= 0)
        kept = None if free.all() else np.flatnonzero(free)
        if kept is not None:
            one, other = one.take(kept), other.take(kept)
        pairs = len(one)
        below = np.arange(count, size)[:, None] >= np.arange(size)
        border_high, border_low = np.nonzero(below)
        # the whole diagonal is there, whatever the entries; what fits into 32 bits is sorted faster
        small = np.int32 if size + pairs + len(border_low) < np.iinfo(np.int32).max else np.int64
        columns, rows = np.empty((2, size + pairs + len(border_low)), small)
        columns[:size] = rows[:size] = np.arange(size)
        np.minimum(one, other, out=columns[size : size + pairs], casting="same_kind")
        np.maximum(one, other, out=rows[size : size + pairs], casting="same_kind")
        columns[size + pairs :], rows[size + pairs :] = border_low, border_high + count
        order = counted(rows, size)
        order = order[counted(columns[order], size)]
        columns, rows = columns[order], rows[order]
        new = np.ones(len(order), bool)
        new[1:] = (columns[1:] != columns[:-1]) | (rows[1:] != rows[:-1])
        # kept for good: 32 bits, as LAPACK's and SuperLU's indices
        entry = np.empty(len(order), np.int32)
        entry[order] = np.cumsum(new, dtype=small) - 1
        del order
        border_target = np.full((border, size), -1)
        border_target[below] = entry[size + pairs :]
        return cls(
            size,
            np.searchsorted(columns[new], np.arange(size + 1)).astype(np.int32),
            rows[new].astype(np.int32),
            border,
            backend or default_backend(),
            entry[size : size + pairs].copy(),
            kept,
            border_target,
        )

    def assemble(self, blocks: Floats, border: Floats | None = None, *, first: int = 0) -> Floats:
        """Entries of the lower triangle, (nnz,).

        Parameters
        ----------
        blocks : (e, k (k + 1) / 2) or (p,)
            Lower triangles of the element blocks, see `packed`; or the values of the pairs.
        border : (border, size), optional
            Rows of the border.
        first : int
            The values are those of the pairs from this one on; pairs without a value add nothing.
        """
        given = blocks.ravel()
        part = slice(first, first + given.size)
        if self._kept is not None:
            part = slice(*np.searchsorted(self._kept, (first, first + given.size)))
            given = given[self._kept[part] - first]
        values = np.bincount(self._target[part], given, len(self.rows)).astype(np.float64, copy=False)
        if border is not None:
            inside = self._border_target >= 0
            values[self._border_target[inside]] += border[inside]
        return np.asarray(values)

    def matrix(self, values: Floats) -> sp.csc_matrix:
        """The full symmetric matrix."""
        lower = sp.csc_matrix((values, self.rows, self.columns), (self.size, self.size))
        return (lower + sp.tril(lower, -1).T).tocsc()

    def factor(self, values: Floats) -> Factor:
        """Factor the matrix of these entries.

        Raises
        ------
        SingularError
        """
        if not np.isfinite(values).all():
            raise SingularError("entries that are no numbers")
        if self.backend == "splu":
            return _SuperLuFactor(self.matrix(values))
        return self._factor_rslab(values)

    def _factor_rslab(self, values: Floats) -> Factor:
        import rslab

        symbolic = self._symbolic.get("rslab")
        if symbolic is None:
            lower = sp.csc_matrix((values, self.rows, self.columns), (self.size, self.size))
            ordering = "metis" if self.size >= DISSECTION_FROM else "amd"
            # one pool for all, of RAYON_NUM_THREADS: a pool for each factorisation keeps tens of megabytes
            symbolic = rslab.analyze(lower, path="ldlt", ordering=ordering, threads="ambient")
            self._symbolic["rslab"] = symbolic
        try:
            return _RslabFactor(symbolic.factor(values))
        except (RuntimeError, ValueError, ArithmeticError) as error:
            raise SingularError(str(error)) from None
