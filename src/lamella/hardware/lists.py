"""Tables of the hardware: its kinds, and the place of every piece."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from lamella.base.drawing_origin import NOWHERE, Origin
from lamella.files.whole import write_whole
from lamella.files.write.table import Column, write_table
from lamella.files.write.text import csv_comment, require_finite, rows
from lamella.hardware.item import Hardware, Item
from lamella.hardware.rules import MM

COLUMNS: tuple[Column[Item], ...] = (
    Column("id", "of the kind of part", lambda item: item.id),
    Column("kind", "washer, key, bolt, nut, screw, block, ...", lambda item: item.kind),
    Column("description", "size and standard", lambda item: item.description),
    Column("material", "name", lambda item: item.material),
    Column("quantity", "pieces", lambda item: item.quantity),
    Column("mass_kg", "of one piece", lambda item: f"{item.mass:.6g}"),
    Column("total_mass_kg", "of all pieces", lambda item: f"{item.quantity * item.mass:.6g}"),
    Column("thickness_mm", "of plates; else empty", lambda item: f"{MM * item.thickness:.4f}" if item.plate else ""),
    Column(
        "length_mm", "of bolts and screws; else empty", lambda item: f"{MM * item.length:.4f}" if item.length else ""
    ),
    Column("drawing", "file it is drawn in; else empty", lambda item: "plates.dxf" if item.plate else ""),
)

PLACES_HEADER = "id,place,x_m,y_m,z_m,ax,ay,az,bx,by,bz"


def write_hardware(path: Path, hardware: Hardware, *, name: str, version: str) -> None:
    """Write the list of kinds, a row each; OSError if it cannot be written whole."""
    rows = ([column.value(item) for column in COLUMNS] for item in hardware)
    write_table(path, [column.name for column in COLUMNS], rows, name=name, version=version)


def write_places(path: Path, hardware: Hardware, *, name: str, version: str, origin: Origin = NOWHERE) -> None:
    """Write a row for every piece: its kind, where it is, the origin of its axes (m), and its x and y axis.

    Parameters
    ----------
    path : Path
    hardware : Hardware
    name, version : str
        Of the project and of the program.
    origin : (3,)
        Point of the drawing that coordinates are measured from, m.

    Raises
    ------
    OSError
        Where the file cannot be written whole.
    """
    lines = [f"# lamella {csv_comment(version)} · project {csv_comment(name)}", PLACES_HEADER]
    for item in hardware:
        places = item.places
        require_finite(places.origins, places.axes)
        numbers = np.column_stack([places.origins + np.array(origin), places.axes[:, 0], places.axes[:, 1]])
        table = rows(numbers, between=b",").decode().splitlines()
        lines += [f'{item.id},"{label}",{row}' for label, row in zip(places.labels, table, strict=True)]
    write_whole(path, ("\n".join(lines) + "\n").encode())
