"""The Pareto front against its definition."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from lamella.studies.pareto import pareto_front


@given(
    arrays(float, st.tuples(st.integers(0, 30), st.integers(1, 3)), elements=st.integers(-3, 3).map(float)), st.data()
)
def test_nobody_is_better(costs: np.ndarray, data: st.DataObject) -> None:
    if len(costs) and data.draw(st.booleans()):
        costs[data.draw(st.integers(0, len(costs) - 1)), 0] = np.nan
    front = pareto_front(costs)
    for k, row in enumerate(costs):
        with np.errstate(invalid="ignore"):
            beaten = ((costs <= row).all(1) & (costs < row).any(1)).any()
        assert front[k] == (not beaten and not np.isnan(row).any())
