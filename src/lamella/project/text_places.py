"""Where the values of a project stand in its text, so that they can be changed in place.

The text is TOML that `tomllib` has read already; only places are looked for here. A path names a value by its keys,
and by numbers in lists: ("surface", "boundary", 1, "circle", "radius").
"""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass, field
from typing import NamedTuple

Path = tuple[str | int, ...]

_BLANK = re.compile(r"(?:[ \t\r\n]|#[^\n]*)*")
_SPACE = re.compile(r"[ \t]*")
_BARE = re.compile(r"[A-Za-z0-9_-]+")
_TEXT = re.compile(
    r'"""(?:\\.|[^\\])*?"""(?:"{0,2})|' + r"'''.*?'''(?:'{0,2})|" + r'"(?:\\.|[^"\\\n])*"|' + r"'[^'\n]*'",
    re.DOTALL,
)
_SCALAR = re.compile(r"\d{4}-\d\d-\d\d \d\d:[^\s,\]}#]+|[^\s,\]}#]+")


class Span(NamedTuple):
    """From the first character to behind the last one."""

    start: int
    end: int


class Statement(NamedTuple):
    """A key with its value.

    Attributes
    ----------
    span : Span
    table : tuple
        Path of the table it is written in.
    """

    span: Span
    table: Path


@dataclass(frozen=True)
class TextPlaces:
    """Places in a project's text.

    Attributes
    ----------
    values : dict
        Span of each value by its path: also of items of lists, and of what is inside tables in braces.
    statements : dict
        Keys with their values, by path, as they are written below headers.
    headers : dict
        Span of each table's header by the table's path; that of the whole text, (), is empty.
    inline : frozenset
        Paths of tables in braces.
    """

    values: dict[Path, Span] = field(default_factory=dict)
    statements: dict[Path, Statement] = field(default_factory=dict)
    headers: dict[Path, Span] = field(default_factory=dict)
    inline: set[Path] = field(default_factory=set)

    def items(self, path: Path) -> list[Span]:
        """Spans of the items of a list."""
        found: list[Span] = []
        while (*path, len(found)) in self.values:
            found.append(self.values[(*path, len(found))])
        return found

    def section_end(self, path: Path) -> int:
        """Where the last statement of a table ends, or its header: of the tables inside it too."""
        ends = [span.end for at, span in self.headers.items() if at[: len(path)] == path]
        ends += [one.span.end for one in self.statements.values() if one.table[: len(path)] == path]
        return max(ends)

    def table_end(self, path: Path) -> int:
        """The same without the tables inside it."""
        ends = [one.span.end for one in self.statements.values() if one.table == path]
        return max([self.headers[path].end, *ends])


def text_places(text: str) -> TextPlaces:
    """Places of all values in a text that is TOML.

    Parameters
    ----------
    text : str
        As it is, with its line ends.
    """
    return _Scanner(text).scan()


class _Scanner:
    """Goes through a text once."""

    def __init__(self, text: str) -> None:
        self.text, self.at, self.found = text, 0, TextPlaces()
        self.found.headers[()] = Span(0, 0)

    def scan(self) -> TextPlaces:
        table: Path = ()
        counts: dict[Path, int] = {}
        self._skip(_BLANK)
        while self.at < len(self.text):
            if self.text[self.at] == "[":
                table = self._header(counts)
            else:
                self._statement(table)
            self._skip(_BLANK)
        return self.found

    def _skip(self, what: re.Pattern[str]) -> None:
        passed = what.match(self.text, self.at)
        self.at = passed.end() if passed else self.at

    def _header(self, counts: dict[Path, int]) -> Path:
        start = self.at
        is_list = self.text.startswith("[[", start)
        self.at += 2 if is_list else 1
        keys = self._keys()
        self.at = self.text.index("]", self.at) + (2 if is_list else 1)
        if is_list:
            parent = self._counted(keys[:-1], counts)
            whole = (*parent, keys[-1])
            counts[whole] = counts.get(whole, -1) + 1
            table: Path = (*whole, counts[whole])
        else:
            table = self._counted(keys, counts)
        self.found.headers[table] = Span(start, self.at)
        return table

    @staticmethod
    def _counted(keys: Path, counts: dict[Path, int]) -> Path:
        """Keys of a header with the number of the last table of each list that they lead through."""
        path: Path = ()
        for key in keys:
            path = (*path, key)
            path = (*path, counts[path]) if path in counts else path
        return path

    def _keys(self) -> Path:
        """A key, or several with dots between them."""
        keys: list[str | int] = []
        while True:
            self._skip(_SPACE)
            quoted = _TEXT.match(self.text, self.at)
            bare = _BARE.match(self.text, self.at)
            passed = quoted or bare
            if passed is None:
                raise ValueError(f"no key at character {self.at}")
            keys.append(tomllib.loads(f"k = {passed[0]}")["k"] if quoted else passed[0])
            self.at = passed.end()
            self._skip(_SPACE)
            if not self.text.startswith(".", self.at):
                return tuple(keys)
            self.at += 1

    def _statement(self, table: Path) -> None:
        start = self.at
        path = (*table, *self._assigned(table))
        self.found.statements[path] = Statement(Span(start, self.at), table)

    def _assigned(self, table: Path) -> Path:
        keys = self._keys()
        # behind the "="
        self.at += 1
        self._skip(_SPACE)
        self._value((*table, *keys))
        return keys

    def _value(self, path: Path) -> None:
        start = self.at
        if self.text[start] == "[":
            self._list(path)
        elif self.text[start] == "{":
            self._braces(path)
        else:
            passed = _TEXT.match(self.text, start) or _SCALAR.match(self.text, start)
            if passed is None:
                raise ValueError(f"no value at character {start}")
            self.at = passed.end()
        self.found.values[path] = Span(start, self.at)

    def _list(self, path: Path) -> None:
        self.at += 1
        for number in range(len(self.text)):
            self._skip(_BLANK)
            if self.text[self.at] == "]":
                break
            self._value((*path, number))
            self._skip(_BLANK)
            if self.text[self.at] == ",":
                self.at += 1
        self.at += 1

    def _braces(self, path: Path) -> None:
        self.found.inline.add(path)
        self.at += 1
        self._skip(_BLANK)
        while self.text[self.at] != "}":
            self._assigned(path)
            self._skip(_BLANK)
            if self.text[self.at] == ",":
                self.at += 1
                self._skip(_BLANK)
        self.at += 1
