"""A curve by its arc length: Gauss-Legendre quadrature on adaptive cells, inverted by Newton's method."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.surface.boundary.pieces import Pieces

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)
_NODES, _WEIGHTS = (1 + _NODES) / 2, _WEIGHTS / 2

# of the whole length: agreement asked of a cell's quadrature with that of its halves; rounding is 1e-15
_AGREEMENT = 2e-14
# halvings of a piece; a curve that needs more stands still somewhere, which the caller refuses
_MOST_HALVINGS = 24
# cells that do not agree yet, beside four a piece
_MOST_CELLS = 50_000
# of the whole length: nearer than this to the end of a piece is on it, else a corner's own t, rounded, could lie
# on the wrong side of the corner
_SNAP = 6e-15


class Course:
    """A curve of rational pieces, by its arc length.

    Parameters
    ----------
    pieces : Pieces
        Joined end to end.

    Attributes
    ----------
    pieces : Pieces
        About `origin`: far from it differences would lose digits.
    origin : (3,)
        m.
    cell_piece : (c,)
        Piece of each cell; cells are in order along the curve.
    cell_start, cell_stop : (c,)
        The cell's range of s.
    cell_arc : (c + 1,)
        Arc length at the start of each cell, m, and the whole length.
    """

    def __init__(self, pieces: Pieces) -> None:
        hull = pieces.hull
        self.origin = np.asarray((hull.min(axis=0) + hull.max(axis=0)) / 2)
        # the evaluation works with degree 2 and above
        self.pieces = pieces.transformed(1.0, -self.origin).raised(2)
        self.cell_piece, self.cell_start, self.cell_stop, lengths = self._cells()
        self.cell_arc = np.concatenate([[0.0], np.cumsum(lengths)])

    @property
    def length(self) -> float:
        """m."""
        return float(self.cell_arc[-1])

    @cached_property
    def joints(self) -> Floats:
        """Arc length where each piece begins, m, (m,)."""
        first = np.searchsorted(self.cell_piece, np.arange(self.pieces.count))
        return np.asarray(self.cell_arc[first])

    def _speed(self, piece: Integers, s: Floats) -> Floats:
        return self.pieces.speed(piece, s[:, None])[:, 0]

    def _integral(self, piece: Integers, start: Floats, stop: Floats) -> Floats:
        """Arc length of each piece between two parameters, m."""
        width = stop - start
        s = start[:, None] + width[:, None] * _NODES
        return np.asarray(width * (self.pieces.speed(piece, s) @ _WEIGHTS))

    def _reached(self, piece: Integers, start: Floats, stop: Floats) -> tuple[Floats, Floats]:
        """Arc length of each piece between two parameters, m, and the speed at the second one, m."""
        width = stop - start
        s = np.concatenate([start[:, None] + width[:, None] * _NODES, stop[:, None]], axis=1)
        speed = self.pieces.speed(piece, s)
        return np.asarray(width * (speed[:, :-1] @ _WEIGHTS)), speed[:, -1]

    def _cells(self) -> tuple[Integers, Floats, Floats, Floats]:
        """Halve pieces until the quadrature of every cell is exact to rounding."""
        m = self.pieces.count
        piece, start, stop = np.arange(m), np.zeros(m), np.ones(m)
        whole = self._integral(piece, start, stop)
        done: list[tuple[Integers, Floats, Floats, Floats]] = []
        total = float(whole.sum())
        for halving in range(_MOST_HALVINGS + 1):
            middle = (start + stop) / 2
            left, right = self._integral(piece, start, middle), self._integral(piece, middle, stop)
            good = np.abs(left + right - whole) <= _AGREEMENT * total
            # numbers of extreme sizes never agree; halving them further would only fill the memory
            if halving == _MOST_HALVINGS or np.count_nonzero(~good) > _MOST_CELLS + 4 * m:
                good[:] = True
            done.append((piece[good], start[good], stop[good], (left + right)[good]))
            bad = ~good
            if not bad.any():
                break
            piece = np.repeat(piece[bad], 2)
            start = np.stack([start[bad], middle[bad]], axis=1).ravel()
            stop = np.stack([middle[bad], stop[bad]], axis=1).ravel()
            whole = np.stack([left[bad], right[bad]], axis=1).ravel()
        piece, start, stop, length = (np.concatenate([cells[k] for cells in done]) for k in range(4))
        order = np.lexsort((start, piece))
        return piece[order], start[order], stop[order], length[order]

    def arc_at(self, piece: Integers, s: Floats) -> Floats:
        """Arc length at places given by piece and parameter, each (n,), m."""
        cell = np.searchsorted(self.cell_piece + self.cell_start, piece + s, side="right") - 1
        # s = 1 belongs to the piece it ends, not to the next one
        cell = np.clip(cell, 0, np.searchsorted(self.cell_piece, piece, side="right") - 1)
        return np.asarray(self.cell_arc[cell] + self._integral(piece, self.cell_start[cell], s))

    def locate(self, arc: Floats) -> tuple[Integers, Floats]:
        """Piece and parameter at arc lengths.

        Parameters
        ----------
        arc : (n,)
            In 0..length, m; where two pieces meet, the later one is meant (at the end the first).

        Returns
        -------
        piece, s : (n,)
        """
        snap = _SNAP * self.length
        cell = np.searchsorted(self.cell_arc, arc + snap, side="right") - 1
        at_end = cell >= len(self.cell_piece)
        cell = np.where(at_end, 0, cell)
        wanted = np.where(at_end, 0.0, np.maximum(arc - self.cell_arc[cell], 0.0))
        piece, low, high = self.cell_piece[cell], self.cell_start[cell], self.cell_stop[cell]
        size = self.cell_arc[cell + 1] - self.cell_arc[cell]
        start, width = low.copy(), high - low
        s = start + width * _first_guess(self._end_speeds[cell] * width[:, None] / size[:, None], wanted / size)
        active = np.arange(len(s))
        for _ in range(60):
            p, x = piece[active], s[active]
            length, speed = self._reached(p, start[active], x)
            residual = length - wanted[active]
            low[active] = np.where(residual < 0, x, low[active])
            high[active] = np.where(residual > 0, x, high[active])
            with np.errstate(divide="ignore", invalid="ignore"):
                new = x - residual / speed
            inside = (new >= low[active]) & (new <= high[active])
            new = np.where(inside, new, (low[active] + high[active]) / 2)
            s[active] = np.where(residual == 0, x, new)
            # Newton squares its error: the step after this one would be below rounding
            active = active[np.abs(residual) > 1e-9 * np.minimum(size[active], wanted[active] + 1e-6 * size[active])]
            if not len(active):
                break
        return piece, s

    @cached_property
    def _end_speeds(self) -> Floats:
        """Speed |dX/ds| at both ends of each cell, m, (c, 2)."""
        ends = (self.cell_start, self.cell_stop)
        return np.stack([self._speed(self.cell_piece, s) for s in ends], axis=1)


def _first_guess(speeds: Floats, share: Floats) -> Floats:
    """Cubic with the inverse's slopes at both ends of the cell, for a share (n,) of its arc length."""
    with np.errstate(divide="ignore"):
        slope0, slope1 = 1 / speeds[:, 0], 1 / speeds[:, 1]
    x = share
    guess = x * x * (3 - 2 * x) + slope0 * x * (1 - x) ** 2 - slope1 * x * x * (1 - x)
    # slopes above 3 may make the cubic turn back
    tame = np.maximum(slope0, slope1) <= 3
    return np.asarray(np.where(tame, np.clip(guess, 0.0, 1.0), x))
