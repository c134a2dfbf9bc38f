"""Examples in docstrings: every public name has one, and all of them run."""

from __future__ import annotations

import doctest
import inspect

import pytest

import lamella

NAMES = [name for name in lamella.__all__ if not name.startswith("_")]


def examples(name: str) -> list[doctest.DocTest]:
    value = getattr(lamella, name)
    finder = doctest.DocTestFinder(exclude_empty=True)
    # of a class also those of its own methods
    return [test for test in finder.find(value, name, module=inspect.getmodule(value)) if test.examples]


@pytest.mark.parametrize("name", NAMES)
def test_examples_of(name: str) -> None:
    found = examples(name)
    assert found, f"{name} has no example"
    for test in found:
        runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE)
        runner.run(test)
        assert not runner.failures
