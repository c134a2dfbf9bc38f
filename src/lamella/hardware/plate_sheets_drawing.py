"""The drawing of all plates on their sheets."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from lamella.base.arrays import Floats
from lamella.fabrication.contours import PLAIN, CutOptions, draw_contours
from lamella.fabrication.drawing import SHEET_SPACE, sheet_block
from lamella.files.write.dxf_text import Block, BlockWriter, DxfFile, Placed
from lamella.hardware.fold_drawing import draw_folds
from lamella.hardware.item import Item
from lamella.hardware.plate_sheets import PlateSheets, sheet_rows
from lamella.hardware.rules import MM


def write_plate_sheets(
    path: Path, groups: Sequence[PlateSheets], options: CutOptions = PLAIN, *, name: str, version: str
) -> None:
    """Write the drawing: sheets from left to right, outlines and holes on layer CUT, sheets on layer SHEET.

    Entities carry extended data of the application "LAMELLA": the plate's id and the number of the piece.

    Raises
    ------
    OSError
        Where the file cannot be written whole.
    """
    file = DxfFile(name=name, version=version, further=options.layers)
    file.write(path, drawn_plate_sheets(groups, file.owner, options))


def drawn_plate_sheets(groups: Sequence[PlateSheets], owner: str, options: CutOptions = PLAIN) -> Iterator[Placed]:
    """What the drawing holds; `owner` of DXF entities."""
    left = 0.0
    blocks: dict[tuple[str, bool], Block] = {}
    for number, group, sheet in sheet_rows(groups):
        length, width = group.sizes[sheet].tolist()
        label = f"SHEET {number}  T {MM * group.thickness:g}  {group.material.upper()}"
        yield Placed(sheet_block(owner, length, width, label), MM * left, 0.0)
        for piece in np.flatnonzero(group.sheets == sheet).tolist():
            item, turned = group.items[int(group.kinds[piece])], bool(group.turned[piece])
            if (item.id, turned) not in blocks:
                blocks[item.id, turned] = _block(item, owner, turned, options)
            x, y = group.origins[piece].tolist()
            yield Placed(blocks[item.id, turned], MM * (left + x), MM * y, copy=int(group.copies[piece]))
        left += length * (1 + SHEET_SPACE)


def _block(item: Item, owner: str, turned: bool, options: CutOptions) -> Block:
    """A plate's outline, holes and folds in its own frame, or turned by 90 degrees, mm."""
    writer = BlockWriter(owner)
    holes = tuple(_turned(hole, turned) for hole in item.cut.holes)
    draw_contours(writer, _turned(item.cut.outline, turned), holes, options, tag=item.id)
    draw_folds(writer, item, turned=turned)
    return writer.block()


def _turned(outline: Floats, turned: bool) -> Floats:
    return np.column_stack([-outline[:, 1], outline[:, 0], outline[:, 2]]) if turned else outline
