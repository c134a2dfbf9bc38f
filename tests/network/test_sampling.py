"""More samples where lamellas turn sharply."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lamella.network.sampling import GRADED_SAMPLES, REFINEMENT_MAX, SAMPLE_TURN, Division, divide, more_samples


def test_pieces_that_turn_evenly() -> None:
    """Two lamellas: pieces of 0.3, 0.9 and 0 rad on the first, one of 2 rad on the second, which starts anywhere."""
    angles, count = np.array([0.3, 0.9, 0.0, 2.0]), np.array([5, 5, 3, 4])
    given = count + np.array([0, 0, 1, 1])
    heading = np.r_[
        np.arange(5) * 0.06, 0.3 + np.arange(5) * 0.18, np.full(4, 1.2), 5 + np.arange(5) * 0.5
    ]  # fmt: skip
    tangents = np.column_stack([np.cos(heading), np.sin(heading), np.zeros(len(heading))])
    wanted = more_samples(count, count, given, tangents)
    assert (wanted % count == 0).all()
    assert (angles / wanted <= SAMPLE_TURN * (1 + 1e-6)).all()
    assert (angles / wanted >= SAMPLE_TURN / 2).tolist() == [True, True, False, True]
    assert wanted[2] == 3


def test_a_kink_has_no_end() -> None:
    """Where the tangent jumps no number is enough: `REFINEMENT_MAX` times as many, however often it is asked."""
    first = count = np.array([3])
    for _ in range(4):
        tangents = np.repeat([[1.0, 0, 0], [0, 1, 0]], [2, count[0] - 1], 0)
        count = more_samples(first, count, count + 1, tangents)
    assert count.tolist() == [3 * REFINEMENT_MAX]


class _Headings(NamedTuple):
    tangents: np.ndarray


def test_samples_beside_a_sharp_turn() -> None:
    """Two curves: a piece turns within its first hundredth, the ones beside it do not turn; a stub is not divided more.

    The distance of samples grows from piece to piece by no more than it may, and not over the end of a curve.
    """
    length, owner = np.array([1.0, 0.1, 1.0, 1.0, 1e-4]), np.array([0, 0, 0, 1, 1])
    first = np.array([16, 3, 16, 16, 3])

    def headings(division: Division) -> _Headings:
        within = np.minimum(division.fraction / 0.01, 1.0)
        angle = np.select([division.piece == 1, division.piece == 2], [within, 1.0], 0.0)
        return _Headings(np.column_stack([np.cos(angle), np.sin(angle), np.zeros(len(angle))]))

    counts = divide(first, length, owner, headings)[0].counts
    assert counts[1] == 3 * REFINEMENT_MAX
    assert counts[[0, 2]].tolist() == [GRADED_SAMPLES * 16] * 2
    assert counts[3:].tolist() == first[3:].tolist()
    # a gentler turn: beside it as fine as it takes, no finer
    gentle = divide(first, length, owner, lambda division: headings_of(division, 0.3))[0].counts
    step = length / gentle
    assert gentle[1] > first[1]
    assert step[[0, 2]].max() <= GRADED_SAMPLES * step[1]
    assert step[[0, 2]].min() > GRADED_SAMPLES * step[1] / 1.2


def headings_of(division: Division, turn: float) -> _Headings:
    """A turn (rad) all along the second piece."""
    angle = np.select([division.piece == 1, division.piece == 2], [turn * division.fraction, turn], 0.0)
    return _Headings(np.column_stack([np.cos(angle), np.sin(angle), np.zeros(len(angle))]))
