"""The variants of a study: values of its variables on a grid, in a Latin hypercube or in a Sobol sequence."""

from __future__ import annotations

import itertools
import math
import warnings
from typing import Any

import numpy as np

from lamella.base.arrays import Floats
from lamella.studies.tables import StudyTable, VariableTable

SAMPLE_DIGITS = 12
"""Of the values of ranges: enough for any length, and the same text whatever rounding a sampler's own sums have."""


def sampled(study: StudyTable) -> list[tuple[Any, ...]]:
    """The values of each variant, in the order of their numbers.

    Latin hypercubes (McKay, Beckman, Conover, Technometrics 21 (1979) 239) and scrambled Sobol sequences are those of
    `scipy.stats.qmc`.

    Parameters
    ----------
    study : StudyTable
    """
    sampler, variables = study.sampler, study.variable
    if sampler.kind == "grid":
        return list(itertools.product(*(_on_grid(variable, sampler.count) for variable in variables)))
    # heavy, and grids do without
    from scipy.stats import qmc

    engine: Any = qmc.LatinHypercube if sampler.kind == "latin-hypercube" else qmc.Sobol
    with warnings.catch_warnings():
        # a Sobol sequence of another length than a power of 2 is balanced less well, which `count` says
        warnings.simplefilter("ignore", UserWarning)
        shares = engine(len(variables), seed=np.random.default_rng(sampler.seed)).random(sampler.count)
    return [at_shares(variables, row) for row in shares]


def at_shares(variables: tuple[VariableTable, ...], shares: Floats) -> tuple[Any, ...]:
    """Values at shares (p,) of the ranges, 0 to 1; of lists of values the one whose part of that length it is."""
    return tuple(_at(variable, float(share)) for variable, share in zip(variables, shares, strict=True))


def _at(variable: VariableTable, share: float) -> Any:
    if variable.values is not None:
        return variable.values[min(int(share * len(variable.values)), len(variable.values) - 1)]
    assert variable.range is not None
    low, high = variable.range
    if variable.whole:
        first, last = math.ceil(low), math.floor(high)
        return min(first + int(share * (last - first + 1)), last)
    return float(f"{low + (high - low) * share:.{SAMPLE_DIGITS}g}")


def _on_grid(variable: VariableTable, count: int) -> tuple[Any, ...]:
    if variable.values is not None:
        return variable.values
    if count == 1:
        return (_at(variable, 0.5),)
    if variable.whole and variable.range is not None:
        spread = np.rint(np.linspace(math.ceil(variable.range[0]), math.floor(variable.range[1]), count))
        return tuple(dict.fromkeys(spread.astype(int).tolist()))
    return tuple(_at(variable, k / (count - 1)) for k in range(count))
