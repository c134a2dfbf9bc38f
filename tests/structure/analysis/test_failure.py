"""Load factor to failure: limit points, branches and yield against closed forms."""

import numpy as np
import pytest

from lamella import InputError
from lamella.structure.analysis.failure import load_to_failure
from lamella.structure.loads import make_loads
from lamella.structure.static import at_rest
from structure.strips import orders, rod, strip
from structure.test_paths import toggle

SECTION = rod(axial=1e3, about_u=1e6)


def unused(state):
    return 0.0


def bar_load(z):
    """Of the leg of a toggle of height z, R. von Mises 1923."""
    return 1e3 * z * (1 / np.hypot(1, z) - 1 / np.hypot(1, 0.3))


@pytest.mark.parametrize("scale", [1.0, 1e-3, 1e3])
def test_limit_point(scale):
    """Where l^3 = l0, whatever the load is measured in; the path goes on past it."""
    start = toggle(1, SECTION, "x y rx rz", "x y z rx rz")
    loads = make_loads(start.structure, forces={1: (0, 0, -scale, 0, 0, 0)})
    found = load_to_failure("push", at_rest(start.structure, loads), unused, most=100 / scale)
    height = np.sqrt(np.hypot(1, 0.3) ** (2 / 3) - 1)
    assert found.limit_factor * scale == pytest.approx(bar_load(height), rel=1e-5)
    assert (found.branch_factor, found.yield_factor) == (None, None)
    assert found.stable_factor == found.limit_factor
    assert found.curve.factors[-1] < found.limit_factor
    # linear buckling of the unloaded toggle: load and force in the bar in proportion, N z / l = P
    assert found.linear_factor > found.limit_factor


def test_yield_before_the_limit():
    """The load of the height at which the bar has the force that the utilisation 1 stands for."""
    start = toggle(1, SECTION, "x y rx rz", "x y z rx rz")
    natural = np.hypot(1, 0.3)

    def use(state):
        return abs(np.hypot(1, state.poses.points[1, 2]) / natural - 1) / 0.005

    found = load_to_failure("push", start, use, most=100)
    assert found.yield_factor == pytest.approx(bar_load(np.sqrt((0.995 * natural) ** 2 - 1)), rel=1e-5)
    assert found.elastic_factor == found.yield_factor < found.stable_factor


def test_first_branch():
    """L. Euler 1744: a column under its end, pinned; linear buckling gives the same, and elements fourth order."""
    exact = np.pi**2 * 5.6 / 2.0**2
    errors, linear = [], []
    for elements in (2, 4, 8):
        column = strip(elements, 2.0, rod(axial=1e7), {0: "x y z rx", -1: "y z"})
        loads = make_loads(column, forces={elements: (-1.0, 0, 0, 0, 0, 0)})
        found = load_to_failure("column", at_rest(column, loads), unused, most=3 * exact)
        errors.append(found.branch_factor / exact - 1)
        linear.append(found.linear_factor / found.branch_factor - 1)
    # shortening of the column, N / E A, and the tolerance of the search are what both differ by
    assert np.abs(linear).max() < 2e-5
    assert np.allclose(orders(errors), 4.0, atol=0.3)
    assert found.limit_factor is None
    assert found.reason == "the largest load factor asked for is reached"


def test_stiffening_has_no_failure():
    """A rope of rods pulled sideways gets stiffer: followed to the largest factor, which is said."""
    rope = strip(2, 2.0, rod(axial=1e4, about_n=1e-2), {0: "x y z rx", -1: "x y z"})
    loads = make_loads(rope, forces={1: (0, 1.0, 0, 0, 0, 0)})
    found = load_to_failure("pull", at_rest(rope, loads), unused, most=5)
    assert found.reached >= 5
    assert found.stable_factor == found.reached
    # E A (l - 1) 2 w / l = P for the middle's shift w, but for what little bending carries
    w = found.curve.shifts[-1]
    length = np.hypot(1, w)
    assert 1e4 * (length - 1) * 2 * w / length == pytest.approx(found.curve.factors[-1], rel=2e-2)


def test_refusals():
    start = toggle(1, SECTION, "x y rx rz", "x y z rx rz")
    for most in (0.0, -1.0, np.inf):
        with pytest.raises(InputError) as refused:
            load_to_failure("push", start, unused, most=most)
        assert refused.value.where == "factor_max"
