"""Combinations of EN 1990 against lists that others have published."""

import re

import pytest

from lamella.base.errors import InputError
from lamella.structure.actions.combinations import (
    PSI,
    Action,
    PartialFactors,
    serviceability_combinations,
    ultimate_combinations,
)

G, Q, S, W, T = (
    Action("G", "permanent"),
    Action("Q", "B"),
    Action("S", "snow"),
    Action("W", "wind"),
    Action("Temp", "temperature"),
)

# "Loads combinations at SLS and ULS according to Eurocode 1", www.tarekdata.com, for dead, office, wind, thermal loads
PUBLISHED_ULS = """
1.35 G + 1.5 Q + 0.9 W + 0.9 Temp; 1.35 G + 1.5 Q + 0.9 W; 1.35 G + 1.5 Q + 0.9 Temp; 1.35 G + 1.5 Q;
1 G + 1.5 Q + 0.9 W + 0.9 Temp; 1 G + 1.5 Q + 0.9 W; 1 G + 1.5 Q + 0.9 Temp; 1 G + 1.5 Q;
1.35 G + 1.05 Q + 1.5 W + 0.9 Temp; 1.35 G + 1.05 Q + 1.5 W; 1.35 G + 1.5 W + 0.9 Temp; 1.35 G + 1.5 W;
1 G + 1.05 Q + 1.5 W + 0.9 Temp; 1 G + 1.05 Q + 1.5 W; 1 G + 1.5 W + 0.9 Temp; 1 G + 1.5 W;
1.35 G + 1.05 Q + 0.9 W + 1.5 Temp; 1.35 G + 1.05 Q + 1.5 Temp; 1.35 G + 0.9 W + 1.5 Temp; 1.35 G + 1.5 Temp;
1 G + 1.05 Q + 0.9 W + 1.5 Temp; 1 G + 1.05 Q + 1.5 Temp; 1 G + 0.9 W + 1.5 Temp; 1 G + 1.5 Temp
"""
PUBLISHED_SLS = """
1 G + 1 Q + 0.6 W + 0.6 Temp; 1 G + 1 Q + 0.6 W; 1 G + 1 Q + 0.6 Temp; 1 G + 1 Q;
1 G + 0.7 Q + 1 W + 0.6 Temp; 1 G + 0.7 Q + 1 W; 1 G + 1 W + 0.6 Temp; 1 G + 1 W;
1 G + 0.7 Q + 0.6 W + 1 Temp; 1 G + 0.7 Q + 1 Temp; 1 G + 0.6 W + 1 Temp; 1 G + 1 Temp
"""


def listed(text):
    return {re.sub(r"\s+", " ", one).strip() for one in text.split(";")}


def formulas(combinations):
    return {one.formula for one in combinations}


def test_ultimate_combinations_are_the_published_ones():
    # and those of permanent actions alone, which the list leaves out
    assert formulas(ultimate_combinations([G, Q, W, T])) == listed(PUBLISHED_ULS) | {"1.35 G", "1 G"}


def test_characteristic_combinations_are_the_published_ones():
    assert formulas(serviceability_combinations([G, Q, W, T], "characteristic")) == listed(PUBLISHED_SLS) | {"1 G"}


def test_examples_of_steel_buildings_in_europe():
    # Steel Buildings in Europe, Multi-Storey, Part 3: Actions (2008), 3.2.3, 3.3.2 and 3.3.3
    found = formulas(ultimate_combinations([G, S, W]))
    assert {"1.35 G + 1.5 S + 0.9 W", "1.35 G + 0.75 S + 1.5 W"} <= found
    assert {"1 G + 1 S + 0.6 W"} <= formulas(serviceability_combinations([G, S, W], "characteristic"))
    assert {"1 G + 1 S + 0.7 Q"} <= formulas(serviceability_combinations([G, S, Q], "characteristic"))
    assert formulas(serviceability_combinations([G, S, W], "frequent")) == {"1 G + 0.2 S", "1 G + 0.2 W", "1 G"}
    assert {"1 G + 0.2 S + 0.3 Q"} <= formulas(serviceability_combinations([G, S, Q], "frequent"))


def test_6_10a_and_b():
    # EN 1990, table A1.2(B): 1.35 G + 1.5 psi0 Q, and 0.85 x 1.35 G + 1.5 Q
    by_rule = {}
    for one in ultimate_combinations([G, S, W], expression="6.10a/b"):
        by_rule.setdefault(one.rule, set()).add(one.formula)
    assert "1.35 G + 0.75 S + 0.9 W" in by_rule["6.10a"]
    assert {"1.1475 G + 1.5 S + 0.9 W", "1.1475 G + 0.75 S + 1.5 W", "1 G + 1.5 W"} <= by_rule["6.10b"]
    assert "1.35 G" in by_rule["6.10a"]
    assert not any(formula.startswith("1.35 G") for formula in by_rule["6.10b"])
    # none of 6.10a and b is above 6.10
    assert not by_rule["6.10b"] & {"1.35 G + 1.5 S + 0.9 W"}


def test_imposed_loads_of_roofs_never_accompany():
    roof = Action("man", "H")
    found = formulas(ultimate_combinations([G, roof, S]))
    assert "1.35 G + 1.5 man + 0.75 S" in found
    assert not any("man" in one and "1.5 man" not in one for one in found)


def test_loads_of_one_group_never_act_together():
    left, right = Action("left", "wind"), Action("right", "wind")
    drifted = Action("drifted", "snow", group="white")
    even = Action("even", "snow", group="white")
    for one in ultimate_combinations([G, left, right, drifted, even]):
        assert not {"left", "right"} <= set(one.factors)
        assert not {"drifted", "even"} <= set(one.factors)


def test_permanent_loads_of_one_source_have_one_factor_and_other_sources_their_own():
    cladding, earth = Action("cladding", "permanent"), Action("earth", "permanent", group="earth")
    found = {tuple(one.factors.items()) for one in ultimate_combinations([G, cladding, earth])}
    assert found == {(("G", g), ("cladding", g), ("earth", e)) for g in (1.35, 1.0) for e in (1.35, 1.0)}


def test_settlements_are_there_or_not():
    moved = Action("moved", "settlement")
    assert formulas(ultimate_combinations([G, moved], PartialFactors(settlement=1.2))) == {
        "1.35 G + 1.2 moved",
        "1 G + 1.2 moved",
        "1.35 G",
        "1 G",
    }


def test_own_psi_and_factors_of_a_national_annex():
    # UK: gamma_G 1.35, xi 0.925; wind psi0 0.5
    wind = Action("W", "wind", psi=(0.5, 0.2, 0.0))
    found = formulas(ultimate_combinations([G, Q, wind], PartialFactors(reduction=0.925), "6.10a/b"))
    assert "1.24875 G + 1.5 Q + 0.75 W" in found


def test_names_are_unique_and_every_combination_is_there_once():
    found = ultimate_combinations([G, Q, S, W, T], expression="6.10a/b")
    assert len({one.name for one in found}) == len(found) == len(formulas(found))


def test_too_many_to_look_at_are_refused():
    many = [Action(f"q{k}", "B") for k in range(20)]
    with pytest.raises(InputError) as caught:
        ultimate_combinations([G, *many])
    assert "1,048,576" in caught.value.message
    assert "group" in caught.value.remedy


def test_an_unknown_category_is_refused():
    with pytest.raises(InputError) as caught:
        Action("x", "snows")
    assert caught.value.where == "category"
    assert all(name in caught.value.remedy for name in PSI)
