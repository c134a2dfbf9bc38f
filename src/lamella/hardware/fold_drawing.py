"""Folds of a plate in its cutting drawing: the line on layer MARK, sense and angle on layer TEXT beside it."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats
from lamella.fabrication.stroke_font import text_strokes
from lamella.files.write.dxf_text import BlockWriter
from lamella.hardware.item import Item
from lamella.hardware.rules import MM

FOLD_TEXT = 0.004
"""m: height of the text; less where the plate is narrow."""
FOLD_TEXT_SHARE = 0.8
"""Of the fold's length that the text takes at most."""


def draw_folds(writer: BlockWriter, item: Item, *, turned: bool = False) -> None:
    """Draw all folds of a plate.

    Parameters
    ----------
    writer : BlockWriter
    item : Item
    turned : bool
        Whether the plate is turned by 90 degrees, counter-clockwise.
    """
    for fold in item.folds:
        writer.polyline("MARK", MM * _turned(fold.line, turned), closed=False, tag=item.id)
        begin, end = fold.line
        length = float(np.linalg.norm(end - begin))
        up = (end - begin) / length
        strokes = text_strokes(fold.text)
        wide = max(float(stroke[:, 0].max()) for stroke in strokes)
        size = min(FOLD_TEXT, FOLD_TEXT_SHARE * length / wide)
        # along the line, on its right: beyond the fold, where no hole is
        right = np.array([up[1], -up[0]])
        base = begin + (length - size * wide) / 2 * up + (fold.radius + 2 * size) * right
        for stroke in strokes:
            points = base + size * (stroke[:, :1] * up - stroke[:, 1:] * right)
            writer.polyline("TEXT", MM * _turned(points, turned), closed=False, tag=item.id)


def _turned(points: Floats, turned: bool) -> Floats:
    return np.column_stack([-points[:, 1], points[:, 0]]) if turned else points
