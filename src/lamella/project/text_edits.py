"""Changes of a project's text that keep its comments and its layout: a number is changed where it stands."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Mapping, Sequence
from typing import Any

from lamella.project.text_places import Path, Span, TextPlaces, text_places

_BARE = re.compile(r"[A-Za-z0-9_-]+")
_REST_OF_LINE = re.compile(r"[ \t]*,?[ \t]*(?:#[^\n]*)?(?:\r?\n|$)")
_LINE_END = re.compile(r"[^\n]*?(?=\r?\n|$)")


def written(value: Any) -> str:
    """A value as TOML on one line: numbers, texts, lists, tables in braces."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int | float):
        return repr(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Mapping):
        inside = ", ".join(f"{_key(name)} = {written(one)}" for name, one in value.items())
        return f"{{{inside}}}"
    return f"[{', '.join(map(written, value))}]"


def with_values(text: str, values: Mapping[Path, Any]) -> str:
    """The text with some values changed, or given where they were not.

    Lists of as many numbers are changed number by number, and what has its value already is not touched.

    Parameters
    ----------
    text : str
        TOML.
    values : mapping
        By path; numbers, texts, lists or tables.
    """
    places = text_places(text)
    changes: list[tuple[Span, str]] = []
    missing: dict[Path, Any] = {}
    for path, value in values.items():
        if path in places.values:
            changes += _changes(text, places, path, value)
        else:
            missing[path] = value
    for span, new in sorted(changes, reverse=True):
        text = text[: span.start] + new + text[span.end :]
    for path, value in missing.items():
        text = _with_key(text, path, value)
    return text


def with_item(text: str, path: Path, index: int, value: Any) -> str:
    """The text with an item put into a list, laid out like its neighbours.

    Parameters
    ----------
    text : str
    path : tuple
        Of the list.
    index : int
        What the item's is to be.
    value : any
    """
    places = text_places(text)
    items, new = places.items(path), written(value)
    if not items:
        start = places.values[path].start + 1
        return text[:start] + new + text[start:]
    if index == 0:
        start = items[0].start
        alone = _indent(text, start)
        between = " " if alone is None else _newline(text) + alone
        return f"{text[:start]}{new},{between}{text[start:]}"
    before = items[min(index, len(items)) - 1]
    comma = re.compile(r"[ \t]*,").match(text, before.end)
    indent = _indent(text, before.start)
    if indent is None:
        at = comma.end() if comma else before.end
        is_last = index >= len(items)
        if comma:
            return f"{text[:at]} {new}{'' if is_last else ','}{text[at:]}"
        return f"{text[:at]}, {new}{text[at:]}"
    head = text[: before.end] + ("" if comma else ",") + text[before.end :]
    line = _LINE_END.match(head, before.end + 1)
    end = line.end() if line else len(head)
    if not _REST_OF_LINE.match(head, before.end):
        # what follows is on the same line
        end = before.end + 1 if not comma else comma.end()
        return f"{head[:end]} {new},{head[end:]}"
    return f"{head[:end]}{_newline(text)}{indent}{new},{head[end:]}"


def without_item(text: str, path: Path, index: int) -> str:
    """The text without an item of a list; a line that holds nothing else goes too."""
    items = text_places(text).items(path)
    item = items[index]
    indent, rest = _indent(text, item.start), _REST_OF_LINE.match(text, item.end)
    if indent is not None and rest and rest[0].endswith("\n"):
        return text[: item.start - len(indent)] + text[rest.end() :]
    if index + 1 < len(items):
        return text[: item.start] + text[items[index + 1].start :]
    start = items[index - 1].end if index else item.start
    return text[:start] + text[item.end :]


def without_key(text: str, path: Path) -> str:
    """The text without a key and its value, with its line where that holds nothing else; as it is where it has none."""
    places = text_places(text)
    if path in places.statements:
        span = places.statements[path].span
        indent, rest = _indent(text, span.start), re.compile(r"[ \t]*(?:#[^\n]*)?\r?\n").match(text, span.end)
        start = span.start - len(indent or "")
        return text[:start] + text[rest.end() if rest else span.end :]
    if path[:-1] in places.inline and path in places.values:
        whole = tomllib.loads(text)
        table: Any = whole
        for key in path[:-1]:
            table = table[key]
        left = {name: value for name, value in table.items() if name != path[-1]}
        span = places.values[path[:-1]]
        return text[: span.start] + written(left) + text[span.end :]
    return text


def with_table(text: str, name: str, values: Mapping[str, Any]) -> str:
    """The text with one more table of a list of tables, behind those that are there.

    Parameters
    ----------
    text : str
    name : str
        Of the list: "surface.boundary".
    values : mapping
        Keys and values of the table.
    """
    newline, path = _newline(text), tuple(name.split("."))
    lines = [f"[[{name}]]", *(f"{_key(key)} = {written(value)}" for key, value in values.items())]
    places = text_places(text)
    of_list = [table for table in places.headers if table[: len(path)] == path and len(table) > len(path)]
    if not of_list:
        head = text if not text or text.endswith("\n") else text + newline
        return head + newline + newline.join(lines) + newline
    last = max(table[: len(path) + 1] for table in of_list)
    end = _line_end(text, places.section_end(last))
    return text[:end] + newline + newline + newline.join(lines) + text[end:]


def without_table(text: str, name: str, index: int) -> str:
    """The text without one table of a list of tables, and those inside it."""
    places = text_places(text)
    path: Path = (*name.split("."), index)
    start = places.headers[path].start
    end = _line_end(text, places.section_end(path))
    after = re.compile(r"(?:[ \t]*\r?\n){0,2}").match(text, end)
    return text[:start] + text[after.end() if after else end :]


def _changes(text: str, places: TextPlaces, path: Path, value: Any) -> list[tuple[Span, str]]:
    """Spans that are to be written anew for a value."""
    span = places.values[path]
    items = places.items(path)
    if isinstance(value, Sequence) and not isinstance(value, str) and len(items) == len(value) and items:
        parts = [_changes(text, places, (*path, k), one) for k, one in enumerate(value)]
        return [change for part in parts for change in part]
    old = tomllib.loads(f"k = {text[span.start : span.end]}")["k"]
    same = old == value and isinstance(old, bool) == isinstance(value, bool)
    return [] if same else [(span, written(value))]


def _with_key(text: str, path: Path, value: Any) -> str:
    """The text with a key that is not there yet."""
    places, newline = text_places(text), _newline(text)
    for depth in range(len(path) - 1, -1, -1):
        table, rest = path[:depth], path[depth:]
        nested = value
        for name in reversed(rest[1:]):
            nested = {name: nested}
        if table in places.inline:
            if any(at[: depth + 1] == path[: depth + 1] for at in places.values):
                # written by keys with dots
                return _in_braces(text, places, table, f"{'.'.join(map(_key, rest))} = {written(value)}")
            return _in_braces(text, places, table, f"{_key(rest[0])} = {written(nested)}")
        beside = [one for at, one in places.statements.items() if table and at[:depth] == table and one.table != table]
        if table not in places.headers and beside:
            # the table is written by keys with dots
            own, end = beside[-1].table, _line_end(text, beside[-1].span.end)
            line = f"{'.'.join(map(_key, path[len(own) :]))} = {written(value)}"
            return text[:end] + newline + line + text[end:]
        if table in places.headers and table:
            end = _line_end(text, places.table_end(table))
            return f"{text[:end]}{newline}{_key(rest[0])} = {written(nested)}{text[end:]}"
    if len(path) == 1:
        end = places.table_end(())
        line = f"{_key(path[0])} = {written(value)}"
        if end:
            end = _line_end(text, end)
            return f"{text[:end]}{newline}{line}{text[end:]}"
        first = min((span.start for at, span in places.headers.items() if at), default=len(text))
        return f"{text[:first]}{line}{newline}{newline}{text[first:]}"
    header = ".".join(map(_key, path[:-1]))
    head = text if not text or text.endswith("\n") else text + newline
    return f"{head}{newline}[{header}]{newline}{_key(path[-1])} = {written(value)}{newline}"


def _in_braces(text: str, places: TextPlaces, table: Path, line: str) -> str:
    span = places.values[table]
    inside = text[span.start + 1 : span.end - 1].rstrip()
    end = span.start + 1 + len(inside)
    return f"{text[:end]}{', ' if inside else ''}{line}{text[end:]}"


def _key(name: str | int) -> str:
    plain = str(name)
    return plain if _BARE.fullmatch(plain) else written(plain)


def _newline(text: str) -> str:
    return "\r\n" if "\r\n" in text else "\n"


def _line_end(text: str, at: int) -> int:
    """Where the line ends that a place is on."""
    passed = _LINE_END.match(text, at)
    return passed.end() if passed else len(text)


def _indent(text: str, start: int) -> str | None:
    """What stands in front of a place on its line where that is blank, else None."""
    line = text[text.rfind("\n", 0, start) + 1 : start]
    return line if not line.strip() else None
