"""One self-contained HTML file that shows a run in any browser, offline."""

from __future__ import annotations

import base64
import hashlib
import html
import re
from dataclasses import dataclass
from pathlib import Path

from lamella.base.message import Message
from lamella.base.wording import one_line
from lamella.view.bundle import asset, bundled
from lamella.view.scene.encode import encode_scene
from lamella.view.scene.scene import Scene

CORNER_LIMIT = 24
"""Corners of the boundary in a report's table."""

CORNER_COLUMNS = ("Place, m", "Angle, °", "Node angle off, °", "Utilisation")


@dataclass(frozen=True)
class ReportData:
    """What a report shows.

    Attributes
    ----------
    name : str
        The project's name.
    version : str
        The program's version.
    subtitle : tuple of str
        Kind of surface, section and material of the lamellas.
    figures : tuple of (section, label, value, unit)
        Key figures, already formatted; sections appear in the order of their first figure.
    corners : tuple of (place, angle, node angle, utilisation)
        Corners of the boundary, already formatted, in the order of the summary; none: no table.
    warnings : tuple of str
        Shown above everything else; a `Message` leads to the places of its key in the scene.
    scene : Scene
        What the 3D view and the plots show.
    """

    name: str
    version: str
    subtitle: tuple[str, ...]
    figures: tuple[tuple[str, str, str, str], ...]
    corners: tuple[tuple[str, str, str, str], ...]
    warnings: tuple[str, ...]
    scene: Scene


def write_report(path: Path, data: ReportData) -> None:
    """Write the report to `path`.

    Parameters
    ----------
    path : Path
        The file, replaced if it exists.
    data : ReportData
        What to show.
    """
    path.write_bytes(report_html(data).encode())


def report_html(data: ReportData) -> str:
    """Return the report as the text of one HTML file.

    Parameters
    ----------
    data : ReportData
        What to show.

    Returns
    -------
    str
        HTML that asks for nothing outside itself; the same for the same data.
    """
    three, script = asset("three.min.js"), bundled("report.js")
    return _filled(
        asset("report.html"),
        {
            "policy": _policy(three, script),
            "name": html.escape(one_line(data.name)),
            "version": html.escape(data.version),
            "subtitle": html.escape(one_line(" · ".join(part for part in data.subtitle if part))),
            "warnings": _warnings_html(data.warnings),
            "figures": _figures_html(data.figures) + _corners_html(data.corners),
            "notes": "".join(f'<p class="note">{html.escape(note)}</p>' for note in data.scene.remarks),
            "css": asset("viewer.css") + asset("report.css"),
            "scene": base64.b64encode(encode_scene(data.scene)).decode(),
            "three": three,
            "script": script,
        },
    )


def _filled(template: str, values: dict[str, str]) -> str:
    # One pass, so that a project named "{{css}}" stays just a name.
    return re.sub(r"\{\{(\w+)\}\}", lambda match: values[match[1]], template)


def _policy(*scripts: str) -> str:
    """Content security policy: these scripts by their hashes, no other, and no request to anywhere."""
    hashes = " ".join(
        f"'sha256-{base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()}'" for script in scripts
    )
    return (
        f"default-src 'none'; script-src {hashes}; style-src 'unsafe-inline'; img-src data:; "
        "base-uri 'none'; form-action 'none'"
    )


def _warnings_html(warnings: tuple[str, ...]) -> str:
    if not warnings:
        return ""
    title = "Warning" if len(warnings) == 1 else f"{len(warnings)} warnings"
    items = "".join(_warning_item(warning) for warning in warnings)
    return f'<section class="warnings" aria-label="Warnings"><h2>{title}</h2><ul>{items}</ul></section>'


def _warning_item(warning: str) -> str:
    """A warning, and the key by which its places are found."""
    key = f' data-warning="{html.escape(warning.key)}"' if isinstance(warning, Message) else ""
    return f"<li{key}>{html.escape(one_line(warning))}</li>"


def _figures_html(figures: tuple[tuple[str, str, str, str], ...]) -> str:
    sections: dict[str, list[str]] = {}
    for section, label, value, unit in figures:
        suffix = f" <span>{html.escape(unit)}</span>" if unit else ""
        # "3.4e-15" would break at its sign, yet a long text has to break somewhere.
        kind = "short" if len(value) + len(unit) < 24 else "long"
        sections.setdefault(section, []).append(
            f'<tr><th scope="row">{html.escape(label)}</th><td class="{kind}">{html.escape(value)}{suffix}</td></tr>'
        )
    return "\n".join(
        f"<table><caption>{html.escape(section)}</caption><tbody>{''.join(rows)}</tbody></table>"
        for section, rows in sections.items()
    )


def _corners_html(corners: tuple[tuple[str, str, str, str], ...]) -> str:
    """A table with a row a corner, and how many more the summary has."""
    if not corners:
        return ""
    head = "".join(f'<th scope="col">{html.escape(column)}</th>' for column in CORNER_COLUMNS)
    rows = "".join(
        f'<tr><th scope="row">{html.escape(corner[0])}</th>'
        + "".join(f'<td class="short">{html.escape(value)}</td>' for value in corner[1:])
        + "</tr>"
        for corner in corners[:CORNER_LIMIT]
    )
    left = len(corners) - CORNER_LIMIT
    if left > 0:
        rows += f'<tr><th colspan="{len(CORNER_COLUMNS)}">{left:,} more: summary.json, network.corners</th></tr>'
    caption = "<caption>Corners of the boundary</caption>"
    body = f"<thead><tr>{head}</tr></thead><tbody>{rows}</tbody>"
    return f'\n<table class="columns">{caption}{body}</table>'
