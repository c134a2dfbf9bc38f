"""Changes of a project's text: the value is there afterwards, and nothing else has changed."""

from __future__ import annotations

import copy
import tomllib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lamella.project.text_edits import with_item, with_table, with_values, without_item, without_key, without_table
from lamella.project.text_places import text_places

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.toml"))
ODD = """\
# a comment = [1, 2]
title = 'a "quoted" # text'   # behind it
"strange key" = {a = 1, b.c = [1, 2,], "d e" = "}"}
long = \"\"\"
[not.a.table]
x = 1 \"\"\"\"
when = 1979-05-27 07:32:00
[surface]
kind = "form-found" # film
boundary.x = 3
[[list]]
points = [ # here
  [ 0.0, 1.0,2.0 ],  # first ]
  [3,4,5]
]
[list.slide]
point = [1, 2, 3]
[[list]]
points = [[0, 0, 0], [1, 1, 1]]
[[list.part]]
arc = {start = [0, 0, 0]}
[[list.part]]
arc = {start = [1, 0, 0]}
"""


def at(values: Any, path: tuple[Any, ...]) -> Any:
    for key in path:
        values = values[key]
    return values


def comments(text: str) -> list[str]:
    return [line.partition("#")[2] for line in text.splitlines() if "#" in line]


@pytest.mark.parametrize("text", [ODD, ODD.replace("\n", "\r\n"), *(path.read_text("utf-8") for path in EXAMPLES)])
def test_places_are_those_of_the_values(text: str) -> None:
    whole = tomllib.loads(text)
    places = text_places(text)
    assert len(places.values) > 3
    for path, span in places.values.items():
        read = tomllib.loads(f"k = {text[span.start : span.end]}".replace("\r\n", "\n"))["k"]
        assert read == at(whole, path), path


@pytest.mark.parametrize("text", [ODD, EXAMPLES[12].read_text("utf-8")])
@given(st.data())
@settings(max_examples=25, deadline=None)
def test_a_number_is_changed_where_it_stands(text: str, data: st.DataObject) -> None:
    places = text_places(text)
    whole = tomllib.loads(text)
    numbers = [path for path in places.values if type(at(whole, path)) in (int, float)]
    path = data.draw(st.sampled_from(numbers))
    value = data.draw(st.floats(-1e3, 1e3, allow_nan=False))
    changed = with_values(text, {path: value})
    wanted = copy.deepcopy(whole)
    at(wanted, path[:-1])[path[-1]] = value
    assert tomllib.loads(changed) == wanted
    span = places.values[path]
    same = at(whole, path) == value
    assert same or changed == text[: span.start] + repr(value) + text[span.end :]


def test_what_has_its_value_is_not_touched() -> None:
    text = "x = [6.0, 1e1, 3]   # m\n"
    assert with_values(text, {("x",): [6, 10.0, 3.0]}) == text
    assert with_values(text, {("x",): [6, 10.0, 3.5]}) == "x = [6.0, 1e1, 3.5]   # m\n"


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (("network", "cells"), 30),
        (("surface", "mean_curvature"), -0.1),
        (("surface", "boundary", "y"), 2),
        (("strange key", "f"), [1, 2]),
        (("strange key", "b", "e"), 1),
        (("list", 0, "place", "shift"), [0.0, 0.0, 1.0]),
        (("list", 1, "part", 0, "arc", "end"), [1, 1, 1]),
        (("new",), 'with "quotes" and \\ and \x7f'),
    ],
)
@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_a_key_that_is_not_there_is_given(path: tuple[Any, ...], value: Any, newline: str) -> None:
    text = ODD.replace("\n", newline)
    changed = with_values(text, {path: value})
    assert at(tomllib.loads(changed), path) == value
    # all the rest is as it was
    before, after = tomllib.loads(text), tomllib.loads(changed)
    assert comments(changed)[: len(comments(text))] == comments(text)
    assert {k: v for k, v in after.items() if k != path[0]} == {k: v for k, v in before.items() if k != path[0]}
    assert changed.count("\n") == changed.count(newline)


def test_a_key_of_an_empty_text() -> None:
    assert with_values("", {("a",): 1}) == "a = 1\n\n"
    assert tomllib.loads(with_values("# nothing", {("a", "b"): 1})) == {"a": {"b": 1}}


@pytest.mark.parametrize("index", range(4))
@pytest.mark.parametrize(
    "text",
    [
        "x = [[0, 0], [1, 1], [2, 2]] # c\n",
        "x = [[0, 0], [1, 1], [2, 2],]\n",
        "x = [\n  [0, 0], # a\n  [1, 1],\n  [2, 2] # b, ]\n]\n",
        "x = [[0, 0],\n     [1, 1], [2, 2]\n]\n",
    ],
)
def test_items_are_put_in_and_taken_out(text: str, index: int) -> None:
    items = tomllib.loads(text)["x"]
    more = with_item(text, ("x",), index, [9, 9])
    assert tomllib.loads(more)["x"] == [*items[:index], [9, 9], *items[index:]]
    assert comments(more) == comments(text)
    assert tomllib.loads(without_item(more, ("x",), index))["x"] == items
    if index < 3:
        assert tomllib.loads(without_item(text, ("x",), index))["x"] == [*items[:index], *items[index + 1 :]]


def test_an_item_has_the_layout_of_its_neighbours() -> None:
    text = "x = [\n  [0, 0], # a\n  [1, 1],\n]\n"
    more = with_item(text, ("x",), 1, [9, 9])
    assert more == "x = [\n  [0, 0], # a\n  [9, 9],\n  [1, 1],\n]\n"
    assert without_item(more, ("x",), 1) == text


def test_tables_come_and_go() -> None:
    text = EXAMPLES[12].read_text("utf-8")
    hole = {"name": "second", "circle": {"center": [1.0, 0.0, 2.0], "radius": 0.5}}
    more = with_table(text, "surface.boundary", hole)
    before, after = tomllib.loads(text), tomllib.loads(more)
    assert after["surface"]["boundary"] == [*before["surface"]["boundary"], hole]
    assert after["network"] == before["network"]
    assert without_table(more, "surface.boundary", 2) == text
    less = tomllib.loads(without_table(text, "surface.boundary", 0))
    assert less["surface"]["boundary"] == before["surface"]["boundary"][1:]
    assert tomllib.loads(without_table(ODD, "list", 0))["list"] == tomllib.loads(ODD)["list"][1:]


def test_keys_go() -> None:
    assert without_key("a = 1 # one\nb = 2\n", ("a",)) == "b = 2\n"
    assert tomllib.loads(without_key("t = {a = 1, b = 2}\n", ("t", "a"))) == {"t": {"b": 2}}
    assert without_key("a = 1\n", ("b",)) == "a = 1\n"
