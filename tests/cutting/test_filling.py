"""Pieces in lanes: against the optimum of small cases, the bound of length, and what first fit does."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lamella.cutting.filling import cut_and_pack, pack
from lamella.cutting.lanes import LENGTH_ROUNDING, Lane, Packing


def check(packing: Packing, strips: list[np.ndarray], lanes: list[Lane], gap: float) -> None:
    """Every strip is there from end to end, once, and no lane is longer than its kind."""
    ends = sorted((cut.strip, cut.begin, cut.end) for lane in packing.lanes for cut in lane)
    for number, bounds in enumerate(strips):
        own = [(begin, end) for strip, begin, end in ends if strip == number]
        assert own[0][0] == 0
        assert own[-1][1] == len(bounds) - 1
        assert all(one[1] == other[0] for one, other in pairwise(own))
    for lane, kind in zip(packing.lanes, packing.kinds, strict=True):
        lengths = [strips[cut.strip][cut.end] - strips[cut.strip][cut.begin] for cut in lane]
        assert sum(lengths) + gap * (len(lengths) - 1) <= lanes[kind].length + LENGTH_ROUNDING
    assert packing.cost == pytest.approx(sum(lanes[kind].cost for kind in packing.kinds))


def least_lanes(lengths: list[float], room: float, gap: float) -> int:
    """The optimum, by dynamic programming over all subsets."""
    n = len(lengths)
    total = np.zeros(1 << n)
    for k, length in enumerate(lengths):
        total[1 << k : 2 << k] = total[: 1 << k] + length + gap
    fits = total <= room + gap + LENGTH_ROUNDING
    best = np.full(1 << n, n + 1)
    best[0] = 0
    for subset in range(1, 1 << n):
        lowest, part = subset & -subset, subset
        while part:
            if part & lowest and fits[part]:
                best[subset] = min(best[subset], best[subset ^ part] + 1)
            part = (part - 1) & subset
    return int(best[-1])


def first_fit(lengths: np.ndarray, room: float, gap: float) -> int:
    """Lanes of first-fit-decreasing."""
    free: list[float] = []
    for length in sorted(lengths, reverse=True):
        at = next((k for k, left in enumerate(free) if length + gap <= left + LENGTH_ROUNDING), len(free))
        free[at:] = [free[at] if at < len(free) else room + gap, *free[at + 1 :]]
        free[at] -= length + gap
    return len(free)


@pytest.mark.parametrize("seed", range(4))
def test_small_cases_are_solved_to_the_optimum(seed: int) -> None:
    rng = np.random.default_rng(seed)
    for _ in range(6):
        lengths = rng.uniform(0.5, 4.0, rng.integers(3, 9))
        packing = pack(lengths, [Lane(6.0, 1.0)], 0.01)
        check(packing, [np.array([0, length]) for length in lengths], [Lane(6.0, 1.0)], 0.01)
        assert len(packing.lanes) == least_lanes(lengths.tolist(), 6.0, 0.01)


@given(
    st.lists(st.floats(0.01, 1.0), min_size=1, max_size=40),
    st.floats(0.0, 0.05),
    st.floats(1e-3, 1e3),
)
@settings(max_examples=40, deadline=None)
def test_never_more_than_first_fit_nor_less_than_the_length_at_any_scale(
    shares: list[float], gap: float, room: float
) -> None:
    lengths = np.array(shares) * room
    lanes = [Lane(room, 1.0)]
    packing = pack(lengths, lanes, gap * room)
    check(packing, [np.array([0, length]) for length in lengths], lanes, gap * room)
    # rounding up to a share of the lane may cost what first fit does not
    spare = len(lengths) / 16384
    assert len(packing.lanes) <= first_fit(lengths, room * (1 - spare), gap * room)
    assert len(packing.lanes) >= math.ceil(np.sum(shares) - LENGTH_ROUNDING)


def strips_of_cells(rng: np.random.Generator, count: int, low: float, high: float) -> list[np.ndarray]:
    """Strips that may be cut between cells of 0.25 to 0.55 m."""
    found = []
    for length in rng.uniform(low, high, count):
        steps = rng.uniform(0.25, 0.55, max(int(length / 0.4), 3))
        found.append(np.concatenate([[0.0], np.cumsum(steps) / steps.sum() * length]))
    return found


def test_bars_are_used_up_where_splices_are_free_to_choose() -> None:
    rng = np.random.default_rng(3)
    lanes = [Lane(6.0, 6.0)]
    for low, high in ((2.0, 14.0), (6.2, 7.0), (3.2, 3.8)):
        strips = strips_of_cells(rng, 60, low, high)
        whole = sum(float(bounds[-1]) for bounds in strips)
        packing = cut_and_pack(strips, lanes, 0.01, 0.0, 0.25)
        check(packing, strips, lanes, 0.01)
        assert whole / (6.0 * len(packing.lanes)) > 0.93


def test_cuts_cost_what_they_are_worth() -> None:
    # two bars of 6 m hold one strip of 3.5 m each, or three of them with one cut
    strips = [np.linspace(0, 3.5, 8) for _ in range(3)]
    assert len(cut_and_pack(strips, [Lane(6.0, 6.0)], 0.0, 0.0, 7.0).lanes) == 3
    cheap = cut_and_pack(strips, [Lane(6.0, 6.0)], 0.0, 0.0, 1.0)
    assert len(cheap.lanes) == 2
    assert sum(map(len, cheap.lanes)) == 4


def test_the_longest_piece_that_is_carried() -> None:
    strips = [np.linspace(0, 10.0, 21)]
    packing = cut_and_pack(strips, [Lane(12.0, 1.0)], 0.0, 4.0, 0.1)
    assert max(cut.end - cut.begin for lane in packing.lanes for cut in lane) * 0.5 <= 4.0
    assert sum(map(len, packing.lanes)) == 3
    with pytest.raises(ValueError, match="bounds"):
        cut_and_pack([np.array([0.0, 5.0])], [Lane(12.0, 1.0)], 0.0, 4.0, 0.1)


def test_of_several_bars_the_cheapest_for_what_is_on_them() -> None:
    lanes = [Lane(6.0, 6.0), Lane(3.0, 3.0), Lane(4.0, 2.5)]
    packing = pack(np.array([6.0, 3.0, 4.0]), lanes, 0.0)
    assert sorted(packing.kinds) == [0, 2, 2]
    assert packing.cost == 11.0
