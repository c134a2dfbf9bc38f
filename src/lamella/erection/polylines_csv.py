"""erection/polylines.csv: the way of every node as a polyline of few points, for programs that impose it.

All nodes have their points at the same states, so that they move together: prescribed displacements that are linear in
between keep to the way within a tolerance that is told.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.ties import grid_of, rounded
from lamella.erection.erection import Erection
from lamella.files.whole import write_whole
from lamella.files.write.text import csv_comment

HEADER = "node,point,share,x_m,y_m,z_m"
# of the net's extent: polylines that are nearer to the way are good enough; and most points of one
OFF_WAY, MOST_CORNERS = 2e-3, 12
# decimals of a metre
POLYLINE_DECIMALS = 5


def few_states(shares: Floats, points: Floats, tolerance: float, most: int = MOST_CORNERS) -> tuple[Integers, float]:
    """States between which all nodes go nearly straight, and how far one is off at most, m.

    The state at which a node is farthest off is added until none is farther than the tolerance (U. Ramer, Computer
    Graphics and Image Processing 1 (1972) 244, of all nodes together and at the same share of the way).

    Parameters
    ----------
    shares : (s,)
        Ascending.
    points : (s, n, 3)
        m.
    tolerance : float
        m.
    most : int
        States that are chosen at most.
    """
    chosen = [0, len(shares) - 1]
    grid = grid_of(float(np.ptp(points, axis=(0, 1)).max(initial=1e-9)))
    while True:
        at = np.searchsorted(shares[chosen], shares, side="right").clip(1, len(chosen) - 1)
        first, last = np.array(chosen)[at - 1], np.array(chosen)[at]
        part = ((shares - shares[first]) / (shares[last] - shares[first]))[:, None, None]
        off = np.linalg.norm(points - (1 - part) * points[first] - part * points[last], axis=2).max(1)
        worst = int(rounded(off, grid).argmax())
        if off[worst] <= tolerance or len(chosen) >= most or worst in chosen:
            return np.array(chosen), float(off.max())
        chosen = sorted([*chosen, worst])


def write_polylines(path: Path, erection: Erection, origin: Floats, *, name: str, version: str) -> None:
    """Write polylines.csv: a row a node and point; node numbers are those of nodes.csv.

    The first row, after ``#``, names version, project and how far the polylines are off the way.

    Raises
    ------
    OSError
        Where the file cannot be written whole.
    """
    model = erection.model
    shares = np.array([state.share for state in erection.states])
    points = np.stack([state.poses.points[: model.nodes] for state in erection.states]) + np.asarray(origin, float)
    chosen, off = few_states(shares, points, OFF_WAY * model.structure.size)
    about = f"# lamella {csv_comment(version)} · project {csv_comment(name)} · within {1e3 * off:.1f} mm of the way"
    lines = [about, HEADER]
    few = points[chosen].transpose(1, 0, 2).tolist()
    for node, line in enumerate(few):
        for number, (share, place) in enumerate(zip(shares[chosen].tolist(), line, strict=True)):
            # minus zero is no place
            told = ",".join(f"{round(c, POLYLINE_DECIMALS) + 0.0:.{POLYLINE_DECIMALS}f}" for c in place)
            lines.append(f"{node},{number},{share:.4f},{told}")
    write_whole(path, ("\n".join(lines) + "\n").encode())
