"""study.html: the variants of a study on a page that opens from the disk, without a network."""

from __future__ import annotations

from html import escape
from importlib.resources import files
from typing import Any

import orjson

from lamella import __version__
from lamella.base.wording import one_line
from lamella.studies.table import Table
from lamella.studies.variant import DONE

SHOWN = (
    "surface.area",
    "network.nodes",
    "network.closed",
    "lamellas.total_length",
    "lamellas.utilisation_max",
    "fabrication.mass",
    "fabrication.parts_different",
    "warnings",
)
"""Columns listed beside a variant, besides variables, objectives and constraints."""

REFUSED_SHOWN_MAX, PAGE_DIGITS = 500, 7


def page(table: Table, title: str) -> bytes:
    """The page of a study.

    Variants' nets are scripts in their folders, which the page loads as they are looked at.

    Parameters
    ----------
    table : Table
    title : str
    """
    columns = table.columns
    done = [k for k, row in enumerate(table.rows) if row.kept.status == DONE]
    goals = [objective.figure for objective in table.study.objective]
    limits = [limit.figure for limit in table.study.constraint]
    shown = {
        name: [_shown(values[k]) for k in done]
        for name, values in columns.items()
        if name not in ("id", "status", "reason", "best") and any(values[k] is not None for k in done)
    }
    variables = [variable.column for variable in table.study.variable]
    data: dict[str, Any] = {
        "names": [columns["id"][k] for k in done],
        "columns": shown,
        "variables": [name for name in variables if name in shown],
        "goals": [name for name in dict.fromkeys([*goals, *limits]) if name in shown],
        "shown": [name for name in SHOWN if name in shown],
        "best": [name for name, best in zip(columns["id"], columns["best"], strict=True) if best],
        "refused": [
            (row.name, ", ".join(_short(value) for value in row.chosen), one_line(row.kept.reason))
            for row in table.rows
            if row.kept.status != DONE
        ][:REFUSED_SHOWN_MAX],
    }
    assets = files("lamella.studies") / "assets"
    filled = (assets / "study.html").read_text("utf-8")
    footer = f"lamella {__version__}; figures are those of summary.json (docs/files.md), the table is table.csv"
    for key, content in {
        "css": (assets / "study.css").read_text("utf-8"),
        "js": (assets / "study.js").read_text("utf-8"),
        "footer": escape(footer),
        "title": escape(one_line(title)),
        # last: words of the project may look like a place to fill; "</" would end the script
        "data": orjson.dumps(data).decode().replace("<", "\\u003c"),
    }.items():
        filled = filled.replace(f"{{{{{key}}}}}", content)
    return filled.encode()


def _shown(value: Any) -> Any:
    """Fewer digits than the table has: a page is looked at."""
    return float(f"{value:.{PAGE_DIGITS}g}") if isinstance(value, float) else value


def _short(value: Any) -> str:
    return f"{value:.5g}" if isinstance(value, float) else str(value)
