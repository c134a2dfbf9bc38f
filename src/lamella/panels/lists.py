"""panels.csv: a row for each plate."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.drawing_origin import NOWHERE, Origin
from lamella.files.write.table import Column, write_table
from lamella.panels.panels import COLD_BENT, LAID, MADE, Panels

MM = 1000.0


class PanelRow(NamedTuple):
    """What is told of a plate."""

    panels: Panels
    number: int
    at: slice
    sides: Floats
    place: Floats
    area: float

    @property
    def owner(self) -> int:
        """The planned panel."""
        return int(self.panels.owners[self.number])


def _joined(values: Floats, digits: int) -> str:
    """Numbers with ";" between, nothing where there is none."""
    # adding zero turns -0.0 into 0.0
    return ";".join("" if np.isnan(x) else f"{round(x, digits) + 0.0:.{digits}f}" for x in values.tolist())


def _number(value: float, digits: int) -> str:
    return _joined(np.array([value]), digits) if np.isfinite(value) else ""


COLUMNS: tuple[Column[PanelRow], ...] = (
    Column(
        "id",
        "of the plate: P a panel, P7.1 a triangle of one, S a run of several",
        lambda row: row.panels.ids[row.number],
    ),
    Column(
        "kind",
        "plates of one kind are cut alike; the drawing has each once",
        lambda row: f"T{row.panels.kinds[row.number] + 1}",
    ),
    Column("made", "flat, single-curved, cold-bent", lambda row: MADE[row.panels.made[row.number]]),
    Column("lies", "inside, rim, umbilic", lambda row: LAID[row.panels.laid[row.owner]]),
    Column(
        "nodes",
        "of the net at the corners, counter-clockwise, with `;` between",
        lambda row: ";".join(map(str, row.panels.plates.nodes[row.at].tolist())),
    ),
    Column("x_m", "of the middle of its corners", lambda row: _number(row.place[0], 4)),
    Column("y_m", "", lambda row: _number(row.place[1], 4)),
    Column("z_m", "", lambda row: _number(row.place[2], 4)),
    Column("sides_mm", "of the flat plate, from each corner to the next", lambda row: _joined(MM * row.sides, 2)),
    Column("angles_deg", "between the sides at each corner", lambda row: _joined(row.panels.angles[row.at], 3)),
    Column(
        "kinks_deg",
        "to the neighbour across each side, positive on a ridge; empty at a rim",
        lambda row: _joined(row.panels.kinks[row.at], 3),
    ),
    Column("area_m2", "of the flat plate", lambda row: f"{row.area:.6g}"),
    Column(
        "out_of_plane_mm",
        "of the panel, before it is divided",
        lambda row: _number(MM * float(row.panels.planes.out_of_plane[row.owner]), 3),
    ),
    Column(
        "warp_mm",
        "of plates bent cold: the fourth corner off the plane of the others",
        lambda row: (
            _number(MM * float(row.panels.planes.warps[row.owner]), 3)
            if row.panels.made[row.number] == COLD_BENT
            else ""
        ),
    ),
    Column(
        "radius_m",
        "least bending radius of single-curved plates",
        lambda row: _number(float(row.panels.radii[row.number]), 4),
    ),
)


def panel_rows(panels: Panels, origin: Origin = NOWHERE) -> list[list[object]]:
    """A row a plate, a value for each of `COLUMNS`."""
    plates = panels.plates
    sides = np.linalg.norm(panels.outlines[plates.following()] - panels.outlines, axis=1)
    sizes = plates.sizes
    middle = np.stack(
        [np.bincount(plates.owner, panels.points[plates.nodes, k], len(plates)) / sizes for k in range(3)], axis=1
    )
    at = [slice(a, b) for a, b in zip(plates.offsets[:-1].tolist(), plates.offsets[1:].tolist(), strict=True)]
    rows = (
        PanelRow(panels, k, one, sides[one], middle[k] + np.array(origin), float(panels.areas[k]))
        for k, one in enumerate(at)
    )
    return [[column.value(row) for column in COLUMNS] for row in rows]


def write_panels(path: Path, panels: Panels, *, name: str, version: str, origin: Origin = NOWHERE) -> None:
    """Write the list.

    Parameters
    ----------
    path : Path
    panels : Panels
    name, version : str
        Of the project and of the program.
    origin : (3,)
        Point of the drawing that coordinates are measured from, m.

    Raises
    ------
    OSError
        Where the file cannot be written whole.
    """
    header = [column.name for column in COLUMNS]
    write_table(path, header, panel_rows(panels, origin), name=name, version=version)
