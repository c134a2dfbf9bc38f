"""Lists of the segments: one row each, the joints between them, and what belongs to each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.drawing_origin import NOWHERE, Origin
from lamella.fabrication.part import Parts
from lamella.files.write.table import Column, write_table
from lamella.hardware.item import Hardware
from lamella.network.network import Network
from lamella.segments.segments import Segment, Segments


def _metres(value: float) -> str:
    # adding zero turns -0.0 into 0.0
    return f"{round(float(value), 4) + 0.0:.4f}"


COLUMNS: tuple[Column[Segment], ...] = (
    Column("id", "of the segment, by its first node", lambda one: one.id),
    Column("mass_kg", "of strips and hardware", lambda one: f"{one.mass:.6g}"),
    Column("nodes", "their number", lambda one: len(one.nodes)),
    Column("lamellas", "of which it has pieces", lambda one: len(one.lamellas)),
    Column("parts", "kinds of strips, each with all its layers that are alike", lambda one: len(one.parts)),
    Column("size_m", "greatest distance of two nodes or cut ends", lambda one: f"{one.size:.4f}"),
    Column("x_m", "of the centre of gravity", lambda one: _metres(one.centre[0])),
    Column("y_m", "", lambda one: _metres(one.centre[1])),
    Column("z_m", "", lambda one: _metres(one.centre[2])),
    Column(
        "lifting_nodes",
        "three nodes around the centre of gravity that it is lifted at, with `;` between",
        lambda one: ";".join(map(str, one.lifting.tolist())),
    ),
    Column(
        "lifting_kg",
        "what each of them carries",
        lambda one: ";".join(f"{share * one.mass:.4g}" for share in one.shares.tolist()),
    ),
)

JOINTS_HEADER = ("segment", "other_segment", "lamella", "part", "other_part", "x_m", "y_m", "z_m")
PARTS_HEADER = ("segment", "id", "kind", "quantity", "mass_kg")


def moved(segments: Segments, origin: Origin) -> Iterator[Segment]:
    """Segments with their centres in the drawing's coordinates."""
    for one in segments.segments:
        yield replace(one, centre=np.asarray(one.centre + np.array(origin)))


def segment_rows(segments: Segments, origin: Origin = NOWHERE) -> list[list[object]]:
    """A row a segment, a value for each of `COLUMNS`."""
    return [[column.value(one) for column in COLUMNS] for one in moved(segments, origin)]


def joint_rows(segments: Segments, parts: Parts, network: Network, origin: Origin = NOWHERE) -> list[list[object]]:
    """A row for each strip that goes over from one segment into another."""
    ids = [one.id for one in segments.segments]
    found: list[list[object]] = []
    for joint in segments.joints:
        point: Floats = joint.point + np.array(origin)
        names = [parts.parts[k].id for k in joint.parts]
        place = [_metres(x) for x in point.tolist()]
        found.append([*(ids[k] for k in joint.segments), str(network.ids[joint.lamella]), *names, *place])
    return found


def part_rows(segments: Segments, parts: Parts, hardware: Hardware) -> Iterator[Sequence[object]]:
    """What belongs to each segment: strips, then hardware by its kinds."""
    for k, segment in enumerate(segments.segments):
        for index in segment.parts.tolist():
            part = parts.parts[index]
            yield segment.id, part.id, "strip", part.quantity, f"{part.quantity * part.mass:.6g}"
        for item, places in zip(hardware, segments.of_place, strict=True):
            count = int((places == k).sum())
            if count:
                yield segment.id, item.id, item.kind, count, f"{count * item.mass:.6g}"


def write_segments(
    folder: Path,
    segments: Segments,
    parts: Parts,
    hardware: Hardware,
    network: Network,
    *,
    name: str,
    version: str,
    origin: Origin = NOWHERE,
) -> None:
    """Write ``segments.csv``, ``segment_joints.csv`` and ``segment_parts.csv``.

    Parameters
    ----------
    folder : Path
        An existing folder.
    segments : Segments
    parts, hardware
        Of the whole structure.
    network : Network
    name, version : str
        Of the project and of the program.
    origin : (3,)
        Point of the drawing that coordinates are measured from, m.

    Raises
    ------
    OSError
        Where a file cannot be written whole.
    """
    signed = {"name": name, "version": version}
    header = [column.name for column in COLUMNS]
    write_table(folder / "segments.csv", header, segment_rows(segments, origin), **signed)
    write_table(folder / "segment_joints.csv", JOINTS_HEADER, joint_rows(segments, parts, network, origin), **signed)
    write_table(folder / "segment_parts.csv", PARTS_HEADER, part_rows(segments, parts, hardware), **signed)
