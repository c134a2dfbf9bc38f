"""erection/flat.dxf: the net as it is put together on the floor."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from lamella.base.arrays import Floats
from lamella.erection.erection import Erection
from lamella.fabrication.stroke_font import text_strokes
from lamella.files.write.dxf_text import Block, BlockWriter, DxfFile, Placed
from lamella.structure.beam.helices import points_between

MM = 1e3
# pieces an element that its curve is drawn with
DRAWN_PIECES = 4
# m: letters of lamellas' ids, of joints' angles, and what is left around them
ID_TEXT, ANGLE_TEXT, TEXT_SPACE = 0.06, 0.025, 0.02
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
    model, plane = erection.model, erection.flat.plane
    lines, network, section = model.lines, model.lamellas.network, model.lamellas.section
    points, frames = model.structure.beams.attachment.ends(erection.states[0].poses)
    along, turned = points_between(points, frames, np.arange(DRAWN_PIECES + 1) / DRAWN_PIECES)
    centre, left = plane.project(along), (turned[..., 1] @ plane.axes[:2].T)
    for number, lamella in enumerate(network.ids):
        own = np.flatnonzero(lines.lamella == number)
        line, side = _joined(centre[own]), _joined(left[own])
        for layer, offset in enumerate(section.layer_offsets.tolist()):
            yield Placed(
                _layer(line + offset * side, side, section.thickness, lamella, owner), 0.0, 0.0, copy=layer + 1
            )
        yield from _ids(line, lamella, owner)
    yield Placed(_angles(erection, owner), 0.0, 0.0)
    low = plane.project(erection.states[0].poses.points).min(0)
    for row, text in enumerate((STACKED if section.level else SLOTTED, ANGLES)):
        at = low - (0.0, (2 * row + 3) * ID_TEXT)
        yield Placed(_text(text, at, ID_TEXT / 2, "", owner), 0.0, 0.0)


def _joined(pieces: Floats) -> Floats:
    """Points (e, p + 1, 2) of elements one behind the other as one line."""
    return np.concatenate((pieces[:, :-1].reshape(-1, 2), pieces[-1:, -1]))


def _layer(line: Floats, side: Floats, thickness: float, lamella: str, owner: str) -> Block:
    across = 0.5 * thickness * side
    writer = BlockWriter(owner)
    writer.polyline("MARK", MM * np.concatenate((line + across, (line - across)[::-1])), closed=True, tag=lamella)
    return writer.block()


def _ids(line: Floats, lamella: str, owner: str) -> Iterator[Placed]:
    """Beyond both ends of a lamella."""
    width = ID_TEXT * len(lamella)
    for end, before in ((line[0], line[1]), (line[-1], line[-2])):
        away = (end - before) / np.linalg.norm(end - before)
        middle = end + away * (TEXT_SPACE + width / 2)
        yield Placed(_text(lamella, middle - (width / 2, ID_TEXT / 2), ID_TEXT, lamella, owner), 0.0, 0.0)


def _angles(erection: Erection, owner: str) -> Block:
    """At every joint."""
    model, state = erection.model, erection.states[0]
    writer = BlockWriter(owner)
    places = erection.flat.plane.project(state.poses.points[model.joint_nodes]) + TEXT_SPACE
    for place, angle in zip(places, state.angles.tolist(), strict=True):
        for stroke in text_strokes(f"{angle:.1f}"):
            writer.polyline("TEXT", MM * (ANGLE_TEXT * stroke + place), closed=False, tag="")
    return writer.block()


def _text(text: str, at: Floats, size: float, tag: str, owner: str) -> Block:
    writer = BlockWriter(owner)
    for stroke in text_strokes(text):
        writer.polyline("TEXT", MM * (size * stroke + at), closed=False, tag=tag)
    return writer.block()
