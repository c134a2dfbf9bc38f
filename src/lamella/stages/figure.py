"""A figure of a run: declared once with key, unit, label, meaning and the function that gives its value.

summary.json, its JSON schema, the report's table and the page docs/files.md are made from these records.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

Of = TypeVar("Of")
Row = tuple[str, str, str, str]
"""Of the report: section, label, value, unit."""


class _Absent:
    """What a figure is where it does not exist: its key is left out."""

    def __repr__(self) -> str:
        return "ABSENT"


ABSENT = _Absent()

NUMBER: dict[str, Any] = {"type": "number"}
INTEGER: dict[str, Any] = {"type": "integer"}
TEXT: dict[str, Any] = {"type": "string"}
FLAG: dict[str, Any] = {"type": "boolean"}
POINT: dict[str, Any] = {"type": "array", "items": NUMBER, "minItems": 3, "maxItems": 3}
PAIR: dict[str, Any] = {"type": "array", "items": NUMBER, "minItems": 2, "maxItems": 2}


def list_of(item: dict[str, Any]) -> dict[str, Any]:
    """JSON schema of a list."""
    return {"type": "array", "items": item}


def record(optional: Sequence[str] = (), /, **properties: dict[str, Any]) -> dict[str, Any]:
    """JSON schema of an object with these keys and no others."""
    required = [key for key in properties if key not in optional]
    return {"type": "object", "properties": properties, "required": required, "additionalProperties": False}


def nullable(schema: dict[str, Any]) -> dict[str, Any]:
    """JSON schema of the same or null."""
    return {"anyOf": [schema, {"type": "null"}]}


@dataclass(frozen=True)
class Figure(Generic[Of]):
    """One figure of a stage.

    Attributes
    ----------
    key : str
        In summary.json, below the stage's name.
    unit : str
        Of the values there; empty: none, or said in the meaning.
    meaning : str
        One sentence for the documentation, Markdown.
    value : callable
        From what a stage has computed to the value, of JSON's types; `ABSENT` where there is none.
    schema : dict
        JSON schema of the value.
    always : bool
        Whether the key is there for every project.
    rows : callable or None
        Lines of the report's table as (label, value, unit), from the value and all figures of the run by stage.
    section : str
        Heading of these lines where it is not that of the stage.
    """

    key: str
    unit: str
    meaning: str
    value: Callable[[Of], Any]
    schema: dict[str, Any]
    always: bool = True
    rows: Callable[[Any, dict[str, Any]], Iterator[tuple[str, str, str]]] | None = None
    section: str = ""


def line(
    label: str, unit: str = "", *, form: str = ".4g", scale: float = 1.0
) -> Callable[[Any, dict[str, Any]], Iterator[tuple[str, str, str]]]:
    """One line of the report with a number.

    Parameters
    ----------
    label, unit : str
        As shown.
    form : str
        Of `format`.
    scale : float
        Shown numbers over those of the summary.
    """

    def rows(value: Any, summary: dict[str, Any]) -> Iterator[tuple[str, str, str]]:
        yield label, format(value * scale if scale != 1 else value, form), unit

    return rows


def evaluate(figures: Sequence[Figure[Of]], of: Of) -> dict[str, Any]:
    """The values of figures by key, in their order."""
    values = ((figure.key, figure.value(of)) for figure in figures)
    return {key: value for key, value in values if value is not ABSENT}


def require_declared(figures: Sequence[Figure[Any]], values: dict[str, Any]) -> None:
    """Require that a figure stands for each value: one that is not declared would be lost.

    Raises
    ------
    KeyError
    """
    unknown = set(values) - {figure.key for figure in figures}
    if unknown:
        raise KeyError(f"no figure is declared for {', '.join(sorted(unknown))}")


def report_rows(
    figures: Sequence[Figure[Any]], report: tuple[str, Sequence[str]], stage: str, summary: dict[str, Any]
) -> Iterator[Row]:
    """Lines of the report for a stage; figures that are absent or null have none.

    Parameters
    ----------
    figures : sequence of Figure
    report : (str, sequence of str)
        Heading, and keys in the order of the lines.
    stage : str
    summary : dict
        Figures by stage.
    """
    by_key, (heading, order) = {figure.key: figure for figure in figures}, report
    for figure in (by_key[key] for key in order):
        value = summary[stage].get(figure.key)
        if figure.rows and value is not None:
            for row in figure.rows(value, summary):
                yield figure.section or heading, *row


def known(key: str) -> Callable[[Any], Any]:
    """What an output describes of itself under a key of the summary, where it does."""
    return lambda out: out.described.get(key, ABSENT)


def figures_schema(figures: Sequence[Figure[Any]]) -> dict[str, Any]:
    """JSON schema of a stage's figures."""
    properties = {
        figure.key: figure.schema
        | {"description": f"{figure.meaning} [{figure.unit}]" if figure.unit else figure.meaning}
        for figure in figures
    }
    return {
        "type": "object",
        "properties": properties,
        "required": [figure.key for figure in figures if figure.always],
        "additionalProperties": False,
    }
