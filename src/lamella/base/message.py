"""Sentences for the user that programs and tests recognise by a key."""

from __future__ import annotations


class Message(str):
    """A warning or remark: text, with a key that stays when the text is reworded.

    It is a `str` in every other way: it compares, prints and goes into JSON as its text.

    Parameters
    ----------
    key : str
        What it is about, in one word of letters and underscores, for example "cells_large".
    text : str
        The sentence, with its numbers and what to do about it.
    """

    __slots__ = ("key",)

    key: str

    def __new__(cls, key: str, text: str) -> Message:
        message = super().__new__(cls, text)
        message.key = key
        return message

    def __getnewargs__(self) -> tuple[str, str]:  # type: ignore[override]
        return self.key, str(self)

    def of(self, name: str) -> Message:
        """The same message about one of several things, named in front of it."""
        return Message(self.key, f"{name}: {self}")
