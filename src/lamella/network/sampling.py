"""How densely the curves of a net are sampled: evenly along each piece between two stops, and more where it turns.

Past an umbilic that is no node a lamella turns within a fraction of a cell.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol, TypeVar

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.ragged import ragged_ranges
from lamella.base.vectors import crosses, dots, lengths

# samples a cell (docs/files.md): of nets of up to so many nodes, and of larger ones
SAMPLES_PER_CELL, SAMPLES_PER_CELL_LARGE, LARGE_NET_NODES = 16, 8, 20_000
# parts: a piece is divided into a whole number of them where it is no longer than that by more than this; whole cells
# are, but for the errors of where a line meets the rim
WHOLE_PARTS = 1e-3
# samples a piece at least, where curvatures are read from neighbouring samples: the last ones next to the rim
SAMPLES_PER_PIECE_MIN = 3
# radians between the tangents of following samples, and how many times more samples a piece may get for it: at a kink,
# as in a corner of the boundary, no number is enough
SAMPLE_TURN, REFINEMENT_MAX = 0.06, 32
# times the samples' distance in such a piece that it is beside it, and times more samples that a piece may get for it:
# polynomials through samples of both, from which written lines are measured, are off where it changes by more
GRADED_SAMPLES = 4


class HasTangents(Protocol):
    """What is known at the samples, their unit tangents (k, 3) among it."""

    @property
    def tangents(self) -> Floats:
        """Unit tangents, piece after piece, (k, 3)."""


Samples = TypeVar("Samples", bound=HasTangents)


@dataclass(frozen=True)
class Division:
    """How samples divide pieces of curves; a piece's samples are its start and those within it.

    Attributes
    ----------
    counts : (s,) int
        Parts of each piece.
    last : (s,) bool
        Pieces after which their curve ends: they have a sample at their end too.
    """

    counts: Integers
    last: Booleans

    @cached_property
    def given(self) -> Integers:
        """Samples of each piece, (s,)."""
        return self.counts + self.last

    @cached_property
    def starts(self) -> Integers:
        """First sample of each piece, (s,)."""
        return np.cumsum(self.given) - self.given

    @cached_property
    def piece(self) -> Integers:
        """Piece of each sample, (k,)."""
        return np.repeat(np.arange(len(self.counts)), self.given)

    @cached_property
    def fraction(self) -> Floats:
        """Where in its piece each sample lies, from 0 to 1, (k,)."""
        return np.asarray(ragged_ranges(self.given) / self.counts[self.piece])


def parts_of(share: Floats, nodes: int, least: int = SAMPLES_PER_PIECE_MIN) -> Integers:
    """Parts into which pieces are divided where nothing turns, (s,), in a net of so many nodes.

    Parameters
    ----------
    share : (s,)
        Length of each piece over that of a whole cell.
    nodes : int
    least : int
        Parts of a piece, however short.
    """
    per_cell = SAMPLES_PER_CELL if nodes <= LARGE_NET_NODES else SAMPLES_PER_CELL_LARGE
    return np.maximum(np.ceil(share * per_cell - WHOLE_PARTS), least).astype(np.int64)


def divide(
    first: Integers, length: Floats, owner: Integers, sample: Callable[[Division], Samples]
) -> tuple[Division, Samples]:
    """Samples along pieces of curves, so many that tangents of following ones differ by no more than `SAMPLE_TURN`.

    Beside pieces that are given many for it, the next ones are given more, see `GRADED_SAMPLES`.

    Parameters
    ----------
    first : (s,) int
        Parts of each piece where nothing turns, see `parts_of`.
    length : (s,)
        Of each piece, m.
    owner : (s,) int
        Curve of each piece; a curve's pieces follow each other.
    sample : callable
        Evaluates the samples of a division.
    """
    last = np.r_[owner[1:] != owner[:-1], True]
    division = Division(first, last)
    while True:
        samples = sample(division)
        finer = more_samples(first, division.counts, division.given, samples.tangents)
        finer = _graded(finer, first, length, last)
        if (finer == division.counts).all():
            return division, samples
        division = Division(finer, last)


def more_samples(first: Integers, count: Integers, given: Integers, tangents: Floats) -> Integers:
    """Numbers of parts of pieces with which the tangent turns by no more than `SAMPLE_TURN` from sample to sample.

    Parameters
    ----------
    first : (s,) int
        Parts into which samples divide each piece where nothing turns.
    count : (s,) int
        Parts into which these samples divide them.
    given : (s,) int
        Samples each piece has in `tangents`: its start and what follows, and its end if no piece follows on it.
    tangents : (k, 3)
        Unit tangents, piece after piece. A lamella's pieces follow each other.

    Returns
    -------
    (s,) int
        At least `count`, and at most `REFINEMENT_MAX` times `first`.
    """
    if not len(tangents):
        return count
    before, after = tangents[:-1], tangents[1:]
    turn = np.r_[np.arctan2(lengths(crosses(before, after)), dots(before, after)), 0.0]
    end = np.cumsum(given)
    # from the last sample of a lamella to the first one of the next nothing turns
    turn[end[given > count] - 1] = 0.0
    largest = np.maximum.reduceat(turn, end - given)
    times = np.maximum(np.ceil(largest / SAMPLE_TURN - 1e-6), 1).astype(np.int64)
    return np.asarray(np.minimum(count * times, np.maximum(REFINEMENT_MAX * first, count)))


def _graded(count: Integers, first: Integers, length: Floats, last: Booleans) -> Integers:
    """Numbers of parts, (s,), at least `count`, also beside pieces that got more than `first` for their turns."""
    if count.size < 2:
        return count
    refined = np.where(count > first, count / np.maximum(length, np.finfo(float).tiny), 0.0)
    beside = np.zeros(len(count))
    joined = ~last[:-1]
    beside[:-1] = np.where(joined, refined[1:], 0.0)
    beside[1:] = np.maximum(beside[1:], np.where(joined, refined[:-1], 0.0))
    wanted = np.minimum(np.ceil(length * beside / GRADED_SAMPLES - 1e-6), GRADED_SAMPLES * first)
    return np.maximum(count, wanted.astype(np.int64))
