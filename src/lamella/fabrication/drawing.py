"""The drawings a laser takes: both families' parts, and all pieces on their sheets."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from lamella.base.arrays import Floats
from lamella.fabrication.contours import PLAIN, CutOptions, draw_contours
from lamella.fabrication.engraving import engrave
from lamella.fabrication.part import Part, Parts
from lamella.fabrication.sheet import Nesting
from lamella.fabrication.stroke_font import text_strokes
from lamella.files.write.dxf_text import Block, BlockWriter, DxfFile, Placed

MM = 1e3
# between sheets in the drawing, as a share of their length
SHEET_SPACE = 0.05
# width over length of a sheet that the next one is drawn below
NARROW = 0.04


def write_drawings(
    folder: Path, parts: Parts, nesting: Nesting, options: CutOptions = PLAIN, *, name: str, version: str
) -> tuple[Path, ...]:
    """Write ``A.dxf``, ``B.dxf`` (each part once, in rows) and ``sheets.dxf`` (every piece in its place).

    Layer CUT holds closed outlines with slots as notches, MARK node centre lines (LINE) and orientation
    triangles (closed LWPOLYLINE), TEXT ids as strokes, SHEET outlines and numbers of the sheets, which are
    not to be cut. Entities of a part carry extended data of the application "LAMELLA": the part's id and
    the number of the copy.

    Parameters
    ----------
    folder : Path
        An existing folder.
    parts : Parts
    nesting : Nesting
        Of those parts.
    options : CutOptions
        How contours are cut.
    name, version : str
        Of the project and of the program, for the header.

    Returns
    -------
    tuple of Path
        The files written.

    Raises
    ------
    OSError
        Where a file cannot be written whole.
    """
    file = DxfFile(name=name, version=version, further=options.layers)
    paths = []
    for sheet, placed in drawn_sheets(parts, nesting, file.owner, options).items():
        paths.append(folder / f"{sheet}.dxf")
        file.write(paths[-1], placed)
    return tuple(paths)


def drawn_sheets(
    parts: Parts, nesting: Nesting, owner: str = "", options: CutOptions = PLAIN
) -> dict[str, Iterator[Placed]]:
    """What the drawings hold, by their names: "A", "B" (each part once, in rows), "sheets" (every piece in its place).

    Parameters
    ----------
    parts : Parts
    nesting : Nesting
        Of those parts.
    owner : str
        Of DXF entities.
    options : CutOptions
    """
    blocks = [_part_block(part, owner, options) for part in parts.parts]
    rows = {
        family: _rows([(p, b) for p, b in zip(parts.parts, blocks, strict=True) if p.family == family], nesting.gap)
        for family in "AB"
    }
    return rows | {"sheets": _sheets(nesting, blocks, owner)}


def _part_block(part: Part, owner: str, options: CutOptions) -> Block:
    """A part's entities in its own frame, mm."""
    engraving = engrave(part)
    writer = BlockWriter(owner)
    draw_contours(writer, part.outline, part.hole_outlines(), options, tag=part.id)
    writer.lines("MARK", MM * engraving.nodes, tag=part.id)
    writer.polyline("MARK", MM * engraving.arrow, closed=True, tag=part.id)
    for stroke in engraving.strokes:
        writer.polyline("TEXT", MM * stroke, closed=False, tag=part.id)
    return writer.block()


def _rows(rows: list[tuple[Part, Block]], gap: float) -> Iterator[Placed]:
    """Parts below each other, aligned at the left."""
    top = 0.0
    for part, block in rows:
        left, low, _, high = part.bounds
        yield Placed(block, -MM * left, MM * (top - high))
        top -= high - low + gap


def _sheets(nesting: Nesting, blocks: list[Block], owner: str) -> Iterator[Placed]:
    """Sheets from left to right and the pieces on them."""
    corners = _corners(nesting)
    for number, ((length, width), (left, low)) in enumerate(zip(nesting.sizes.tolist(), corners.tolist(), strict=True)):
        kind = nesting.stocks[number].kind.upper() if nesting.stocks else "SHEET"
        yield Placed(sheet_block(owner, length, width, f"{kind} {number + 1}"), MM * left, MM * low)
    x = MM * (corners[nesting.sheets, 0] + nesting.x)
    y = MM * (corners[nesting.sheets, 1] + nesting.y)
    for index, copy, x_mm, y_mm, turned in zip(
        nesting.parts.tolist(),
        nesting.copies.tolist(),
        x.tolist(),
        y.tolist(),
        (nesting.rotations == 180.0).tolist(),
        strict=True,
    ):
        yield Placed(blocks[index], x_mm, y_mm, turned, copy)


def _corners(nesting: Nesting) -> Floats:
    """Lower left corners of the sheets in the drawing, (s, 2), m: side by side; bars below each other."""
    lengths, widths = nesting.sizes.T
    narrow = (widths < NARROW * lengths) & bool(nesting.stocks)
    beside = np.where(narrow, 0.0, lengths * (1 + SHEET_SPACE))
    below = np.where(narrow, -2 * widths, 0.0)
    return np.column_stack([np.where(narrow, 0.0, np.cumsum(beside) - beside), np.cumsum(below)])


def sheet_block(owner: str, length: float, width: float, label: str) -> Block:
    """Outline of a sheet (m) and what is written above it, on layer SHEET."""
    writer = BlockWriter(owner)
    corners = np.array([(0.0, 0.0), (length, 0.0), (length, width), (0.0, width)])
    writer.polyline("SHEET", MM * corners, closed=True, tag="")
    # a bar is narrow
    size = (0.05 if width > NARROW * length else 0.3) * width
    for stroke in text_strokes(label):
        writer.polyline("SHEET", MM * (size * stroke + (0.0, width + 0.5 * size)), closed=False, tag="")
    return writer.block()
