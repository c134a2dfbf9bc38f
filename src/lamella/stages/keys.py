"""From the parameters of functions to the keys of a project file.

Geometry knows no project file: an `InputError` raised there names the parameter of the function that was called, as a
path where only a part of it is wrong (`neck_radius`, `loops[1]`, `section.height`). The stage that makes the call says
which key each parameter was read from.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TypeVar

from lamella.base.errors import InputError
from lamella.base.message import Message

Text = TypeVar("Text", str, Message)


@contextmanager
def keys(table: str, **read_from: str) -> Iterator[None]:
    """Errors that name parameters become errors that name keys; as a decorator too.

    Parameters
    ----------
    table : str
        A parameter `x` was read from the key `table.x`; an error without a parameter is about the table.
    **read_from : str
        Parameters that were read from another key, given in full: ``loops="surface.boundary"``.
    """
    try:
        yield
    except InputError as error:
        raise InputError(error.message, error.remedy, key_of(error.where, table, **read_from)) from None


def key_of(parameter: str, table: str, **read_from: str) -> str:
    """The key that a parameter, or a part of it ("loops[1].name"), was read from; see `keys`."""
    name, rest = re.fullmatch(r"(\w*)(.*)", parameter, re.DOTALL).groups()  # type: ignore[union-attr]
    return (read_from.get(name) or (f"{table}.{name}" if name else table)) + rest


def with_keys(text: Text, *names: str) -> Text:
    """A warning made by geometry, with the keys ("surface.tolerance") of the parameters ("tolerance") it names.

    The first mention of each is written as the key.
    """
    written: str = text
    for key in names:
        written = re.sub(rf"(?<![\w.-]){re.escape(key.rpartition('.')[2])}(?!\w)", key, written, count=1)
    return Message(text.key, written) if isinstance(text, Message) else written
