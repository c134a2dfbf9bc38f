"""sizing.csv: how thick, high and far apart the strips of each lamella may be."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from lamella.files.write.table import Column, write_table
from lamella.network.network import Network
from lamella.strip.lamellas import Lamellas
from lamella.strip.sizing import Sizing

Row = tuple[str, float, float, float, float, list[float]]


def _mm(value: float) -> str:
    return f"{1e3 * value:.5g}" if np.isfinite(value) else ""


COLUMNS: tuple[Column[Row], ...] = (
    Column("lamella", "its id", lambda row: row[0]),
    Column("utilisation", "largest, of the strips as they are, without safety", lambda row: f"{row[1]:.6g}"),
    Column(
        "thickness_max_mm",
        "largest that stays elastic with the safety, the other measures as they are; empty: 16 times the present one "
        "does, or it has no part in the stresses; 0: not even a sixty-fourth does",
        lambda row: _mm(row[2]),
    ),
    Column("height_max_mm", "the same", lambda row: _mm(row[3])),
    Column("offset_max_mm", "the same", lambda row: _mm(row[4])),
    Column("x_m", "where its utilisation is largest", lambda row: f"{row[5][0]:.4f}"),
    Column("y_m", "", lambda row: f"{row[5][1]:.4f}"),
    Column("z_m", "", lambda row: f"{row[5][2]:.4f}"),
)


def write_sizing(path: Path, sizing: Sizing, network: Network, lamellas: Lamellas, *, name: str, version: str) -> None:
    """Write a row a lamella.

    Parameters
    ----------
    path : Path
    sizing : Sizing
    network : Network
        In the drawing's coordinates.
    lamellas : Lamellas
    name, version : str
        Of the project and of the program.

    Raises
    ------
    OSError
        Where the file cannot be written whole.
    """
    rows = []
    for k, first in enumerate(network.sample_offsets[:-1].tolist()):
        along = lamellas.utilisation[first : int(network.sample_offsets[k + 1])]
        worst = int(np.argmax(np.round(along, 9)))
        measures = [float(one[k]) for one in (sizing.thickness, sizing.height, sizing.offset)]
        place = (np.round(network.sample_points[first + worst], 4) + 0.0).tolist()
        row: Row = (str(network.ids[k]), float(along.max()), measures[0], measures[1], measures[2], place)
        rows.append([column.value(row) for column in COLUMNS])
    write_table(path, [column.name for column in COLUMNS], rows, name=name, version=version)
