"""What a refusal or a warning states, whatever its words: what it is about, its numbers, and the names it gives.

A message is text for people and may be reworded; what it is about (`InputError.where`, `Message.key`), the values and
limits in it, and the keys, files and names it gives stay. Tests compare those; tests/test_messages.py reads the words.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager

import pytest

from lamella import InputError
from lamella.base.message import Message
from messages import faults

NUMBER = re.compile(r"(?<![\w.])-?\d+(?:,\d{3})*(?:\.\d+)?(?:e[+-]?\d+)?(?!\.?\d)")
# a name is no word of the sentence: it is in quotes, or is written as no word is
QUOTES = "'\"`"
VALUES = {"true", "false", "nan", "inf", "-inf"}
UNLIKE_WORDS = re.compile(r"[^\w\s]|[\d_]|[A-Z]{2}|^[A-Z]\d*$")


def numbers_in(text: str) -> list[str]:
    """Numbers of a text as they are written, without separators of thousands; not those within names."""
    return [found.replace(",", "") for found in NUMBER.findall(text)]


def is_printed(value: float, written: str) -> bool:
    """Whether a written number is a value, to the digits it is written with; one digit alone has to be exact."""
    printed = float(written)
    digits, _, power = written.lstrip("-").partition("e")
    _, _, decimals = digits.partition(".")
    if printed == value:
        return True
    if not math.isfinite(printed):
        # 2103e5727: a part of an id
        return False
    if len(digits.replace(".", "").lstrip("0")) < 2:
        return False
    return abs(printed - value) <= 0.5001 * 10.0 ** (int(power or 0) - len(decimals))


def check_stated(text: str, numbers: Iterable[float] = (), names: Iterable[str] = ()) -> None:
    """Fail unless a text states numbers, as it prints them, and names: of keys, files, curves, values in quotes."""
    written = numbers_in(text)
    for value in numbers:
        assert any(is_printed(value, one) for one in written), f"no {value!r} among {written} in: {text}"
    for name in names:
        assert re.search(rf"(?<!\w){re.escape(name.strip())}(?!\w)", text), f"no {name!r} in: {text}"
        quoted = any(f"{quote}{name}{quote}" in text for quote in QUOTES) or re.search(
            rf"\b{re.escape(name)}(?:: | = )", text
        )
        assert quoted or name in VALUES or UNLIKE_WORDS.search(name), (
            f"{name!r} is prose: state a key, number, file or quoted name"
        )


def check_refusal(
    error: InputError, where: str | None = None, numbers: Iterable[float] = (), names: Iterable[str] = ()
) -> None:
    """Fail unless an error is about `where`, states numbers and names, and reads well."""
    if where is not None:
        assert error.where == where, f"{error.where!r} instead of {where!r}: {error}"
    check_stated(str(error), numbers, names)
    assert not faults(error), (faults(error), str(error))


@contextmanager
def refused(
    where: str | None = None, numbers: Iterable[float] = (), names: Iterable[str] = ()
) -> Iterator[pytest.ExceptionInfo[InputError]]:
    """A block that has to raise an `InputError`.

    Parameters
    ----------
    where : str, optional
        File and key, or parameter, that the error is about (`InputError.where`).
    numbers : iterable of float, optional
        Numbers it states, value and limit: each has to be printed, to the digits it is printed with.
    names : iterable of str, optional
        Names it gives: keys, files, curves, values in quotes; no words of the sentence.
    """
    with pytest.raises(InputError) as caught:
        yield caught
    check_refusal(caught.value, where, numbers, names)


def keys(messages: Iterable[object]) -> list[str]:
    """Keys of messages, in their order; all have to have one."""
    assert all(isinstance(message, Message) for message in messages), messages
    return [message.key for message in messages]  # type: ignore[attr-defined]


def warned(messages: Sequence[object], key: str, numbers: Iterable[float] = (), names: Iterable[str] = ()) -> Message:
    """The one message of a key among several, which has to state numbers and names."""
    (message,) = [one for one in messages if isinstance(one, Message) and one.key == key]
    check_stated(message, numbers, names)
    return message
