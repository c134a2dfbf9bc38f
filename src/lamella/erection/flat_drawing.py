"""erection/flat.dxf: the net as it is put together on the floor."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from lamella.base.arrays import Floats
from lamella.erection.erection import Erection
from lamella.erection.flat_plan import FlatPlan
from lamella.fabrication.stroke_font import text_strokes
from lamella.files.write.dxf_text import Block, BlockWriter, DxfFile, Placed

MM = 1e3
# m: letters of lamellas' ids, of joints' angles, and what is left around them
ID_TEXT, ANGLE_TEXT, TEXT_SPACE = 0.06, 0.025, 0.02
# ids that stand one behind the other
MOST_IDS_AT_AN_END = 40
SLOTTED = "LAY THE A LAMELLAS UPRIGHT WITH THEIR SLOTS UP. PUT THE B LAMELLAS ON FROM ABOVE WITH THEIR SLOTS DOWN."
STACKED = "LAY THE A LAMELLAS UPRIGHT. STACK THE B LAMELLAS ON THEM AND BOLT THEM LOOSELY."
ANGLES = "NUMBERS BESIDE JOINTS ARE THEIR ANGLES IN DEGREES FROM A TO B COUNTER-CLOCKWISE."


def write_flat(path: Path, erection: Erection, *, name: str, version: str) -> None:
    """Write the assembly drawing of the flat state, in mm, in its plane of least squares, seen from the +n side.

    Layer MARK holds every layer of every lamella with its thickness (closed polylines), TEXT the lamellas' ids at
    both ends, the joints' angles and the order of threading. Nothing of it is cut. Entities of a lamella carry
    extended data of the application "LAMELLA": its id and the number of the layer.

    Raises
    ------
    OSError
        Where the file cannot be written whole.
    """
    file = DxfFile(name=name, version=version)
    file.write(path, _placed(erection, file.owner))


def _placed(erection: Erection, owner: str) -> Iterator[Placed]:
    plan = FlatPlan.of(erection)
    section = erection.model.lamellas.section
    ids = erection.model.lamellas.network.ids
    for lamella, line, side in zip(ids, plan.lines, plan.sides, strict=True):
        for layer, offset in enumerate(section.layer_offsets.tolist()):
            yield Placed(
                _layer(line + offset * side, side, section.thickness, lamella, owner), 0.0, 0.0, copy=layer + 1
            )
    yield from _ids(plan, ids, owner)
    yield Placed(_angles(plan, erection, owner), 0.0, 0.0)
    low = np.concatenate(plan.lines).min(0)
    for row, text in enumerate((STACKED if section.level else SLOTTED, ANGLES)):
        at = low - (0.0, (2 * row + 5) * ID_TEXT)
        yield Placed(_text(text, at, ID_TEXT / 2, "", owner), 0.0, 0.0)


def _layer(line: Floats, side: Floats, thickness: float, lamella: str, owner: str) -> Block:
    across = 0.5 * thickness * side
    writer = BlockWriter(owner)
    writer.polyline("MARK", MM * np.concatenate((line + across, (line - across)[::-1])), closed=True, tag=lamella)
    return writer.block()


def _ids(plan: FlatPlan, ids: Sequence[str], owner: str) -> Iterator[Placed]:
    """Beyond both ends of a lamella; where another one ends there, farther out."""
    taken = np.empty((0, 4))
    for lamella, line in zip(ids, plan.lines, strict=True):
        half = np.array([ID_TEXT * len(lamella), ID_TEXT]) / 2
        for end, before in ((line[0], line[1]), (line[-1], line[-2])):
            away = (end - before) / np.linalg.norm(end - before)
            for farther in range(MOST_IDS_AT_AN_END):
                middle = end + away * (TEXT_SPACE + half[0] + farther * 1.5 * ID_TEXT)
                box = np.concatenate((middle - half, middle + half))
                if not _covers(taken, box):
                    break
            taken = np.concatenate((taken, box[None]))
            yield Placed(_text(lamella, box[:2], ID_TEXT, lamella, owner), 0.0, 0.0)


def _covers(taken: Floats, box: Floats) -> bool:
    """Whether a box (left, low, right, high) covers another one."""
    return bool(((taken[:, :2] < box[2:]) & (box[:2] < taken[:, 2:])).all(1).any())


def _angles(plan: FlatPlan, erection: Erection, owner: str) -> Block:
    """At every joint."""
    writer = BlockWriter(owner)
    for place, angle in zip(plan.joints + TEXT_SPACE, erection.states[0].angles.tolist(), strict=True):
        for stroke in text_strokes(f"{angle:.1f}"):
            writer.polyline("TEXT", MM * (ANGLE_TEXT * stroke + place), closed=False, tag="")
    return writer.block()


def _text(text: str, at: Floats, size: float, tag: str, owner: str) -> Block:
    writer = BlockWriter(owner)
    for stroke in text_strokes(text):
        writer.polyline("TEXT", MM * (size * stroke + at), closed=False, tag=tag)
    return writer.block()
