"""More samples where lamellas turn sharply."""

from __future__ import annotations

import numpy as np

from lamella.network.sampling import REFINEMENT_MAX, SAMPLE_TURN, more_samples


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
