"""erection/path.csv: where every node is in every state, for who measures on site."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from lamella.base.arrays import Floats
from lamella.erection.erection import Erection
from lamella.files.whole import write_whole
from lamella.files.write.text import csv_comment

HEADER = "share,node,x_m,y_m,z_m,joint_angle_deg"
# decimals of a metre and of a degree
PLACE_DECIMALS, DEGREES = 5, 2


def write_path(path: Path, erection: Erection, origin: Floats, *, name: str, version: str) -> None:
    """Write path.csv: a row a node and state; share 0 is flat, 1 designed; node numbers are those of nodes.csv.

    The first row, after ``#``, names version and project; the second the columns and their units. Joints are measured
    from A to B; nodes without one have none.

    Raises
    ------
    OSError
        Where the file cannot be written whole.
    """
    model = erection.model
    lines = [f"# lamella {csv_comment(version)} · project {csv_comment(name)}", HEADER]
    for state in erection.states:
        angles = np.full(model.nodes, np.nan)
        angles[model.joint_nodes] = state.angles
        points = (state.poses.points[: model.nodes] + np.asarray(origin, float)).tolist()
        for node, ((x, y, z), angle) in enumerate(zip(points, angles.tolist(), strict=True)):
            told = "" if np.isnan(angle) else f"{angle:.{DEGREES}f}"
            # minus zero is no place
            place = ",".join(f"{round(c, PLACE_DECIMALS) + 0.0:.{PLACE_DECIMALS}f}" for c in (x, y, z))
            lines.append(f"{state.share:.4f},{node},{place},{told}")
    write_whole(path, ("\n".join(lines) + "\n").encode())
