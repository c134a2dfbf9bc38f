"""Words of the drawings in a language: a text file a language in the folder terms/."""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass, field
from functools import cache
from importlib.resources import files

ENGLISH = "en"


@dataclass(frozen=True)
class Terms:
    """Words by their keys.

    Attributes
    ----------
    words : dict
        As in terms/en.toml: texts, with {name} where something is filled in, and the decimal sign.
    phrases : dict
        Of the descriptions of hardware, which are English; from the file's table [descriptions].
    """

    words: dict[str, str]
    phrases: dict[str, str] = field(default_factory=dict)

    def __call__(self, key: str, **values: object) -> str:
        """A word, filled in."""
        return self.words[key].format(**values) if values else self.words[key]

    def number(self, value: float, decimals: int) -> str:
        """A number with at most so many decimals."""
        text = f"{value:.{decimals}f}"
        if decimals:
            text = text.rstrip("0").rstrip(".")
        return (text if text != "-0" else "0").replace(".", self.words["decimal"])

    def description(self, text: str) -> str:
        """A description of hardware, phrase by phrase, the longest ones first; its numbers with this decimal sign."""
        for phrase in sorted(self.phrases, key=lambda one: (-len(one), one)):
            text = re.sub(rf"\b{re.escape(phrase)}\b", self.phrases[phrase], text)
        return re.sub(r"(?<=\d)\.(?=\d)", self.words["decimal"], text)

    def mm(self, metres: float) -> str:
        """A length in mm, to a tenth."""
        return self.number(1e3 * metres, 1)


@cache
def languages() -> tuple[str, ...]:
    """What there are: names of the files in terms/."""
    found = (entry.name for entry in files("lamella.drawings").joinpath("terms").iterdir())
    return tuple(sorted(name.removesuffix(".toml") for name in found if name.endswith(".toml")))


@cache
def terms(language: str) -> Terms:
    """The words of one of the `languages`; what its file has not is said in English."""
    folder = files("lamella.drawings").joinpath("terms")
    words: dict[str, str] = {}
    phrases: dict[str, str] = {}
    for name in (ENGLISH, language):
        read = tomllib.loads(folder.joinpath(f"{name}.toml").read_text(encoding="utf-8"))
        phrases |= read.pop("descriptions", {})
        words |= read
    return Terms(words, phrases)
