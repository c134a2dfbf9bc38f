"""Load cases of a net and their combination."""

import numpy as np
import pytest

from lamella.base.errors import InputError
from lamella.structure.actions.load_case import combined, no_load
from lamella.structure.actions.node_supports import DIRECTIONS, NodeSupports, no_supports


def _case(name, draw):
    case = no_load(name, 4)
    parts = {"node_forces": (4, 3), "node_moments": (4, 3), "self_weight": (3,), "settlements": (4, 6)}
    for key, shape in parts.items():
        object.__setattr__(case, key, draw.normal(size=shape))
    object.__setattr__(case, "temperature", float(draw.normal()))
    return case


def test_a_combination_is_linear_in_every_part():
    draw = np.random.default_rng(1)
    cases = [_case("dead", draw), _case("snow", draw), _case("wind", draw)]
    both = combined("uls", cases, {"dead": 1.35, "wind": -1.5})
    for key in ("node_forces", "node_moments", "self_weight", "temperature", "settlements"):
        expected = 1.35 * np.asarray(getattr(cases[0], key)) - 1.5 * np.asarray(getattr(cases[2], key))
        assert np.allclose(getattr(both, key), expected, rtol=0, atol=1e-15)


def test_a_factor_of_no_load_is_refused():
    with pytest.raises(InputError) as caught:
        combined("uls", [no_load("snow", 2)], {"sno": 1.5})
    assert caught.value.where == "factors"
    assert "snow" in caught.value.remedy


@pytest.mark.parametrize("stiffness", [-1.0, np.inf, np.nan])
def test_stiffness_that_is_none_is_refused(stiffness):
    none = no_supports(3)
    springs = none.springs.copy()
    springs[2, 5] = stiffness
    with pytest.raises(InputError) as caught:
        NodeSupports(none.fixed, springs)
    assert caught.value.where == "spring"
    assert "node 2" in caught.value.message
    assert DIRECTIONS[5] in caught.value.message


def test_supported_nodes_are_fixed_ones_and_those_on_springs():
    none = no_supports(3)
    fixed, springs = none.fixed.copy(), none.springs.copy()
    fixed[0, 1], springs[2, 3] = True, 10.0
    assert NodeSupports(fixed, springs).supported.tolist() == [True, False, True]
