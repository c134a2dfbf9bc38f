"""Samplers: every combination, one variant in each row of a hypercube, balanced sequences."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from lamella.studies.sampling import sampled
from lamella.studies.tables import parse_study

AREA = {"key": "surface.neck_radius", "range": [1.0, 3.0]}
CELLS = {"key": "network.cells", "range": [10, 14], "whole": True}
STEEL = {"key": "lamella.material", "values": ["1.4301", "S355"]}


def _sampled(variables: list[dict[str, Any]], **sampler: Any) -> list[tuple[Any, ...]]:
    return sampled(parse_study({"project": "p.toml", "variable": variables, "sampler": sampler}))


def test_a_grid_is_every_combination() -> None:
    grid = _sampled([AREA, STEEL, CELLS], count=3)
    assert len(grid) == len(set(grid)) == 3 * 2 * 3
    assert {one[0] for one in grid} == {1.0, 2.0, 3.0}
    assert {one[2] for one in grid} == {10, 12, 14}
    assert all(isinstance(one[2], int) for one in grid)
    assert _sampled([AREA], count=1) == [(2.0,)]
    # fewer whole numbers than values: each once
    assert [one[0] for one in _sampled([CELLS], count=50)] == [10, 11, 12, 13, 14]


def test_a_latin_hypercube_has_one_variant_in_every_row_of_every_variable() -> None:
    """McKay, Beckman, Conover 1979: of n variants each n-th part of each range holds one."""
    n = 40
    samples = _sampled([AREA, AREA | {"key": "lamella.height", "range": [0.05, 0.25]}], kind="latin-hypercube", count=n)
    shares = (np.array(samples) - [1.0, 0.05]) / [2.0, 0.2]
    for column in shares.T:
        assert sorted(np.floor(column * n).astype(int).tolist()) == list(range(n))


def test_a_sobol_sequence_is_balanced() -> None:
    """I. M. Sobol 1967: of 2^m points each part of 2^-m of the square, cut by powers of two, holds one."""
    samples = _sampled([AREA, AREA | {"key": "lamella.height"}], kind="sobol", count=64)
    shares = (np.array(samples) - 1.0) / 2.0
    for across in (1, 2, 4, 8, 16, 32, 64):
        cells = np.floor(shares * [across, 64 / across]).astype(int)
        assert len({tuple(cell) for cell in cells.tolist()}) == 64


@pytest.mark.parametrize("kind", ["latin-hypercube", "sobol"])
def test_the_seed_decides(kind: str) -> None:
    one, again, other = (_sampled([AREA, STEEL, CELLS], kind=kind, count=20, seed=seed) for seed in (7, 7, 8))
    assert one == again != other
    assert {values[1] for values in one} == {"1.4301", "S355"}
    assert {values[2] for values in one} == {10, 11, 12, 13, 14}
