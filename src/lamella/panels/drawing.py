"""panels/panels.dxf: the flat outline of each kind of plate, with what to cut of it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from lamella.base.arrays import Floats
from lamella.fabrication.stroke_font import text_strokes
from lamella.files.write.dxf_text import Block, BlockWriter, DxfFile, Placed
from lamella.panels.panels import MADE, SINGLE_CURVED, Panels

MM = 1000.0
TEXT_SHARE = 0.6
"""Length of a plate's text over its shorter extent."""

SPACE_SHARE = 0.1
"""Between plates, over the largest one."""


def write_panel_drawing(path: Path, panels: Panels, *, name: str, version: str) -> None:
    """Write the drawing: outlines on layer CUT, sides that single-curved runs are bent along on layer MARK, texts.

    Each kind is drawn once, in rows; its first plate stands for all. Entities carry extended data of the application
    "LAMELLA": the kind.

    Raises
    ------
    OSError
        Where the file cannot be written whole.
    """
    file = DxfFile(name=name, version=version)
    file.write(path, drawn_panels(panels, file.owner))


def drawn_panels(panels: Panels, owner: str = "") -> Iterator[Placed]:
    """What the drawing holds; `owner` of DXF entities."""
    at = panels.plates.offsets
    outlines = [panels.outlines[at[k] : at[k + 1]] for k in panels.first_of_kind.tolist()]
    if not outlines:
        return
    sizes = np.array([np.ptp(outline, axis=0) for outline in outlines])
    space = SPACE_SHARE * float(np.round(sizes.max(), 6))
    # rows about as long as all of them are high
    row = float(np.round(np.sqrt(((sizes[:, 0] + space) * (sizes[:, 1] + space)).sum()), 6))
    x = y = high = 0.0
    quantities = panels.quantities.tolist()
    for kind, (outline, size) in enumerate(zip(outlines, sizes.tolist(), strict=True)):
        if x > 0 and x + size[0] > row:
            x, y, high = 0.0, y - high - space, 0.0
        low = outline.min(axis=0)
        block = _block(panels, kind, quantities[kind], outline, owner)
        yield Placed(block, MM * (x - float(low[0])), MM * (y - float(low[1]) - size[1]))
        x, high = x + size[0] + space, max(high, size[1])


def _block(panels: Panels, kind: int, quantity: int, outline: Floats, owner: str) -> Block:
    """A plate's entities in its own frame, mm."""
    number = int(panels.first_of_kind[kind])
    made, tag = int(panels.made[number]), f"T{kind + 1}"
    writer = BlockWriter(owner)
    writer.polyline("CUT", MM * outline, closed=True, tag=tag)
    if made == SINGLE_CURVED and panels.ids[number].startswith("S"):
        writer.lines("MARK", MM * bending_lines(outline), tag=tag)
    text = f"{tag}  {quantity} PIECES" + ("" if not made else f"  {MADE[made].upper()}")
    strokes = text_strokes(text)
    low, high = (getattr(np.concatenate(strokes), end)(axis=0) for end in ("min", "max"))
    height = TEXT_SHARE * float(np.ptp(outline, axis=0).min()) / float(high[0] - low[0])
    middle = outline.mean(axis=0) - height * (low + high) / 2
    for stroke in strokes:
        writer.polyline("TEXT", MM * (height * stroke + middle), closed=False, tag=tag)
    return writer.block()


def bending_lines(outline: Floats) -> Floats:
    """Lines across a run's flat outline that it is bent along, (k, 2, 2), m."""
    inside = len(outline) // 2 - 1
    right = outline[2 : 1 + inside]
    left = outline[: -len(right) - 1 : -1]
    return np.stack([left, right], axis=1)
