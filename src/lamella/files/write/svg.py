"""Drawings as SVG files in true size: the same lines and arcs as in DXF, a group for each layer.

Units are millimetres: width and height are told in mm, and one unit of the view box is one of them. y points down in
SVG, so that drawings are turned over; nothing is mirrored to look at.
"""

from __future__ import annotations

from collections.abc import Iterable
from html import escape
from pathlib import Path

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.wording import one_line
from lamella.files.whole import write_whole
from lamella.files.write.dxf_text import LAYERS, Drawn, Placed

COLOURS = {"CUT": "#ff0000", "MARK": "#0000ff", "TEXT": "#00a000", "SHEET": "#808080"}
"""Of the layers, like those of the DXF files."""
FURTHER = "#c000c0"
"""Of layers beside them."""
STROKE = 0.1
"""mm: width of lines to look at; a laser follows their middles."""
SVG_MARGIN = 5.0
"""mm: around the drawing."""
SVG_DECIMALS = 6
"""Of a millimetre."""


def write_svg(path: Path, placed: Iterable[Placed], *, name: str, version: str, further: Iterable[str] = ()) -> None:
    """Write a drawing.

    Parameters
    ----------
    path : Path
    placed : iterable of Placed
        What it holds; every path has the attributes `data-part` and `data-copy`, as the extended data of DXF entities.
    name, version : str
        Of the project and of the program.
    further : iterable of str
        Layers beside those of `COLOURS`.

    Raises
    ------
    OSError
        Where the file cannot be written whole.
    """
    items = [item for item in placed if item.block.entities]
    ends = [item.ends for item in items] or [(np.zeros(2), np.zeros(2))]
    low = np.min([end[0] for end in ends], axis=0) - SVG_MARGIN
    high = np.max([end[1] for end in ends], axis=0) + SVG_MARGIN
    left, top = float(low[0]), float(high[1])
    width, height = (_text(value) for value in (high - low).tolist())
    groups: dict[str, list[str]] = {layer: [] for layer in (*LAYERS, *further)}
    for item in items:
        points = np.round(item.points - (left, top), SVG_DECIMALS) * (1.0, -1.0) + 0.0
        for one in item.block.drawn:
            data = _path(points[one.first : one.end], one)
            owner = f' data-part="{escape(one.tag)}" data-copy="{item.copy}"' if one.tag else ""
            groups[one.layer].append(f'<path{owner} d="{data}"/>')
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}mm" height="{height}mm" '
        f'viewBox="0 0 {width} {height}">',
        f"<title>{escape(one_line(name))}</title>",
        f"<desc>lamella {escape(one_line(version))}</desc>",
    ]
    for layer, paths in groups.items():
        if paths:
            lines.append(f'<g id="{layer}" fill="none" stroke="{COLOURS.get(layer, FURTHER)}" stroke-width="{STROKE}">')
            lines += [*paths, "</g>"]
    write_whole(path, ("\n".join([*lines, "</svg>"]) + "\n").encode())


def _path(points: Floats, one: Drawn) -> str:
    """A polyline's path; y points down."""
    rows = points.tolist()
    data = [f"M{_text(rows[0][0])} {_text(rows[0][1])}"]
    following = rows[1:] + (rows[:1] if one.closed else [])
    bulges = [0.0] * len(rows) if one.bulges is None else one.bulges.tolist()
    for k, (x, y) in enumerate(following):
        bulge = bulges[k]
        if bulge == 0.0:
            if k < len(rows) - 1:
                data.append(f"L{_text(x)} {_text(y)}")
            continue
        chord = float(np.hypot(x - rows[k][0], y - rows[k][1]))
        radius = chord * (1 + bulge**2) / (4 * abs(bulge))
        # counter-clockwise to look at, which SVG calls the negative direction
        flags = f"{int(abs(bulge) > 1)} {int(bulge < 0)}"
        data.append(f"A{_text(radius)} {_text(radius)} 0 {flags} {_text(x)} {_text(y)}")
    return "".join(data) + ("Z" if one.closed else "")


def _text(value: float) -> str:
    return f"{value:.{SVG_DECIMALS}f}".rstrip("0").rstrip(".")
