"""The one test that reads messages: the words of every place that refuses something, and the rules they follow.

Other tests compare what a message is about, its numbers and names (`refusals`), and pass it to the same rules.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

import lamella
from lamella import InputError
from messages import MOST, faults, line_faults

PACKAGE = Path(lamella.__file__).parent
# what makes an error for the user
CALLS = {"InputError", "mesh_error"}


def refusals() -> Iterator[tuple[str, ast.Call]]:
    """Every call that makes an error for the user, with its place."""
    for path in sorted(PACKAGE.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in CALLS:
                yield f"{path.relative_to(PACKAGE)}:{node.lineno}", node


def literals(node: ast.expr) -> str:
    """The text of an expression as far as it is written, with # for what is put in."""
    if isinstance(node, ast.Constant):
        return node.value if isinstance(node.value, str) else "#"
    if isinstance(node, ast.JoinedStr):
        return "".join(map(literals, node.values))
    if isinstance(node, ast.BinOp):
        return literals(node.left) + literals(node.right)
    return "#"


def test_every_refusal_reads_well() -> None:
    """Its own words, wherever it is raised: short, plain, without what Python prints of itself."""
    seen, wrong = 0, []
    for place, call in refusals():
        seen += 1
        texts = [literals(argument) for argument in call.args[:2]]
        texts += [literals(word.value) for word in call.keywords if word.arg in ("message", "remedy")]
        wrong += [f"{place}: {fault}" for text in texts for fault in line_faults(text.strip())]
    assert seen > 200
    assert not wrong


@pytest.mark.parametrize(
    ("message", "remedy", "fault"),
    [
        ("height = 3 m is out of range", "", "remedy"),
        ("the points are array([1., 2.])", "give finite numbers", "array("),
        ("height = np.float64(3.0) m", "give a number", "np.float64("),
        ("the value is [ 0.  1. inf]", "give finite numbers", "[ 0. "),
        ("the value is None", "give a number", "None"),
        ("x" * (MOST + 1), "shorten it", str(MOST)),
        ("two  spaces", "write one", "spaces"),
    ],
)
def test_the_rules_find_what_reads_badly(message: str, remedy: str, fault: str) -> None:
    assert any(fault in found for found in faults(InputError(message, remedy)))


def test_a_good_refusal_has_no_faults() -> None:
    assert not faults(InputError("height = 9 m is out of range: at most 5 m", "lower height", "lamella.height"))
