"""developable.csv: rulings of developable strips along every lamella, in space and on the flat strip."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from lamella.files.whole import write_whole
from lamella.files.write.text import csv_comment
from lamella.network.network import Network
from lamella.strip.developable_strips import DevelopableStrips, flat_ends, rulings
from lamella.strip.lamellas import Lamellas

HEADER = (
    "lamella,arclength_m,buildable_height_m,slope,bending_MPa,planarity_score,"
    "low_x_m,low_y_m,low_z_m,high_x_m,high_y_m,high_z_m,flat_low_x_mm,flat_low_y_mm,flat_high_x_mm,flat_high_y_mm"
)


def write_developable(
    path: Path, network: Network, lamellas: Lamellas, strips: DevelopableStrips, *, name: str, version: str
) -> None:
    """Write a row for every sample: its ruling, or empty cells where there is none.

    Parameters
    ----------
    path : Path
    network : Network
        That of the lamellas, in the drawing's coordinates.
    lamellas : Lamellas
    strips : DevelopableStrips
        Along these.
    name, version : str
        Of the project and of the program.

    Raises
    ------
    OSError
        Where the file cannot be written whole.
    """
    reach = lamellas.section.height / 2 * rulings(network, strips.slopes)
    low, high = network.sample_points - reach, network.sample_points + reach
    flat = 1e3 * flat_ends(lamellas, strips.slopes)
    numbers = np.column_stack([strips.slopes, 1e-6 * strips.bending, strips.planarity, low, high, flat[0], flat[1]])
    owner = np.repeat(np.arange(len(network.ids)), np.diff(network.sample_offsets)).tolist()
    lines = [f"# lamella {csv_comment(version)} · project {csv_comment(name)}", HEADER]
    for k, s, limit, exists, row in zip(
        owner,
        network.sample_arclengths.tolist(),
        strips.heights.tolist(),
        strips.exists.tolist(),
        numbers.tolist(),
        strict=True,
    ):
        cells = [f"{value:.9g}" if np.isfinite(value) else "" for value in row] if exists else [""] * len(row)
        lines.append(",".join([network.ids[k], f"{s:.9g}", f"{limit:.6g}" if np.isfinite(limit) else "", *cells]))
    write_whole(path, ("\n".join(lines) + "\n").encode())
