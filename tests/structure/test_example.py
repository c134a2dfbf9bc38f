"""The example of the room's docstring runs."""

import doctest

import lamella.structure


def test_example():
    assert doctest.testmod(lamella.structure, optionflags=doctest.NORMALIZE_WHITESPACE) == (0, 23)
