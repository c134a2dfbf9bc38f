"""Parts and sheets as curves of a drawing, in metres, for pictures."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lamella.fabrication.engraving import engrave
from lamella.fabrication.flat import outline_points
from lamella.fabrication.part import Part, Parts
from lamella.fabrication.sheet import Nesting
from lamella.view.drawing_picture import Curve


def part_curves(part: Part, x: float = 0.0, y: float = 0.0, *, turned: bool = False, marks: bool = True) -> list[Curve]:
    """Outline, node centre lines, start mark and id of a part whose own origin is at x, y, m."""
    drawn = [("CUT", outline_points(part.outline))]
    if marks:
        engraving = engrave(part)
        drawn += [("MARK", line) for line in engraving.nodes]
        drawn += [("MARK", np.vstack([engraving.arrow, engraving.arrow[:1]]))]
        drawn += [("TEXT", stroke) for stroke in engraving.strokes]
    sign = -1.0 if turned else 1.0
    return [Curve(layer, layer == "CUT", sign * points + (x, y), part.id) for layer, points in drawn]


def rows(parts: Parts, gap: float = 0.01) -> Iterator[tuple[Part, float, float]]:
    """Each part once, one below the other and aligned at the left: where its origin lies, m."""
    top = 0.0
    for part in parts.parts:
        left, low, _, high = part.bounds
        yield part, -left, top - high
        top -= high - low + gap


def sheet_curves(parts: Parts, nesting: Nesting, sheet: int, *, marks: bool = True) -> list[Curve]:
    """A sheet's outline and the pieces on it, m from its lower left corner."""
    length, width = nesting.sizes[sheet].tolist()
    corners = np.array([(0.0, 0.0), (length, 0.0), (length, width), (0.0, width), (0.0, 0.0)])
    curves = [Curve("SHEET", True, corners, "")]
    for piece in np.flatnonzero(nesting.sheets == sheet).tolist():
        part = parts.parts[int(nesting.parts[piece])]
        at = float(nesting.x[piece]), float(nesting.y[piece])
        curves += part_curves(part, *at, turned=bool(nesting.rotations[piece]), marks=marks)
    return curves
