"""The drawing of all plates that are cut from a sheet: each kind once, with its id, number and thickness."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from lamella.fabrication.contours import PLAIN, CutOptions, draw_contours
from lamella.fabrication.flat import outline_points
from lamella.fabrication.stroke_font import text_strokes
from lamella.files.write.dxf_text import Block, BlockWriter, DxfFile, Placed
from lamella.hardware.fold_drawing import draw_folds
from lamella.hardware.item import Hardware, Item
from lamella.hardware.rules import MM

# m: height of the text beside a plate, and what is left between plates
TEXT, SPACE = 0.008, 0.02


def write_plates(path: Path, hardware: Hardware, options: CutOptions = PLAIN, *, name: str, version: str) -> None:
    """Write the drawing: outlines and holes on layer CUT, folds on layer MARK, angles and ids on layer TEXT.

    Entities carry extended data of the application "LAMELLA": the plate's id.

    Raises
    ------
    OSError
        Where the file cannot be written whole.
    """
    file = DxfFile(name=name, version=version, further=options.layers)
    file.write(path, drawn_plates(hardware, file.owner, options))


def drawn_plates(hardware: Hardware, owner: str = "", options: CutOptions = PLAIN) -> Iterator[Placed]:
    """What the drawing holds: plates below each other, their texts to the right; `owner` of DXF entities."""
    top = 0.0
    for item in hardware:
        if not item.plate:
            continue
        prism = item.cut
        points = outline_points(prism.outline)
        low, high = points.min(axis=0), points.max(axis=0)
        yield Placed(
            _block(item, owner, float(high[0] - low[0]), options), -MM * float(low[0]), MM * (top - float(high[1]))
        )
        top -= max(float(high[1] - low[1]), TEXT) + SPACE


def _block(item: Item, owner: str, width: float, options: CutOptions) -> Block:
    """A plate's entities in its own frame, mm."""
    writer = BlockWriter(owner)
    prism = item.cut
    draw_contours(writer, prism.outline, prism.holes, options, tag=item.id)
    draw_folds(writer, item)
    left = float(outline_points(prism.outline)[:, 0].min())
    at = np.array([left + width + SPACE, -TEXT / 2])
    text = f"{item.id.upper()}  {item.quantity} PIECES  T {MM * item.thickness:g}  {item.material.upper()}"
    for stroke in text_strokes(text):
        writer.polyline("TEXT", MM * (TEXT * stroke + at), closed=False, tag=item.id)
    return writer.block()
