"""An example's run says the same on every processor: its counts and words, and its figures within 1e-4."""

from __future__ import annotations

import orjson
import pytest

from conftest import run_of_example
from examples.kernels import KERNELS, differences, same_text, summary_under

# examples that take about a second; `python tests/examples/kernels.py` compares all of them
NAMES = ["06_scherk", "10_saddle"]


@pytest.mark.parametrize("name", NAMES)
def test_examples_say_the_same_under_other_kernels(name: str) -> None:
    """Figures of the summary within their own accuracy, counts and warnings alike, under older kernels."""
    own = orjson.loads(orjson.dumps(run_of_example(name).summary, option=orjson.OPT_SERIALIZE_NUMPY))
    found = {kernel: list(differences(own, summary_under(kernel, name), own)) for kernel in KERNELS}
    assert not any(found.values()), found


def test_differences_are_seen() -> None:
    one = {"surface": {"size": [3.0, 4.0, 0.0], "elements": 3, "area": 2.0, "mean_curvature_deviation": 1e-3}}
    one |= {"warnings": ["2 of 3"]}
    for key, value, seen in (
        ("elements", 4, True),
        ("area", 2.0001, False),
        ("area", 2.001, True),
        ("mean_curvature_deviation", 1.05e-3, False),
        ("mean_curvature_deviation", 1.2e-3, True),
    ):
        other = {"surface": one["surface"] | {key: value}, "warnings": ["2 of 3"]}
        assert bool(list(differences(one, other, one))) == seen, key
    assert list(differences(one, one | {"warnings": ["2 of 4"]}, one))


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ("| tg | 0.158 1/m |", "| tg | 0.159 1/m |", True),
        ("| tg | 0.158 1/m |", "| tg | 0.161 1/m |", False),
        ("1,104 nodes", "1,105 nodes", False),
        ("at (-0.54, 2.1) m", "at (0.54, 2.1) m", False),
        ("1.2e-04", "1.3e-04", True),
        ("487 kg", "486.9 kg", True),
        ("a 1.0", "b 1.0", False),
    ],
)
def test_texts_are_compared_within_their_last_digits(one: str, other: str, same: bool) -> None:
    assert same_text(one, other) == same
