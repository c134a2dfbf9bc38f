"""Displacement control of a node, past a limit point, against the closed form."""

import numpy as np
import pytest

from lamella import InputError
from lamella.structure.analysis.driven import driven
from lamella.structure.loads import make_loads
from lamella.structure.static import at_rest
from structure.analysis.test_failure import SECTION, bar_load, unused
from structure.test_paths import toggle


def test_apex_driven_through():
    """The load of the toggle at every height, of which more than half have no load control (R. von Mises 1923)."""
    start = toggle(1, SECTION, "x y rx rz", "x y z rx rz")
    found = driven("push", start, 1, np.array([0, 0, -3.0]), 0.6, unused, steps=12)
    curve = found.curve
    assert curve.watched[-1] == pytest.approx(0.6, abs=1e-12)
    assert np.abs(curve.factors - bar_load(0.3 - curve.watched)).max() < 1e-8
    assert (curve.factors[-1] < 0.02 * curve.factors.max(), found.reason) == (True, "")
    assert np.allclose(curve.shifts, curve.watched)
    assert curve.negative.max() == 1


def test_refusals():
    start = toggle(1, SECTION, "x y rx rz", "x y z rx rz")
    with pytest.raises(InputError) as refused:
        driven("push", start, 1, np.array([1.0, 0, 0]), 0.1, unused)
    assert refused.value.where == "near"
    warm = at_rest(start.structure, make_loads(start.structure, swelling=1e-4))
    with pytest.raises(InputError) as refused:
        driven("warm", warm, 1, np.array([0, 0, 1.0]), 0.1, unused)
    assert refused.value.where == "loads"
