"""erection/forces.csv: what a driver on site pulls or pushes with, in every state."""

from __future__ import annotations

from pathlib import Path

from lamella.erection.erection import Erection
from lamella.files.whole import write_whole
from lamella.files.write.text import csv_comment

HEADER = "share,travel_m,energy_j,driver_n,node,force_n"
# decimals of forces and energies, and of places
FORCE_DECIMALS, PLACE_DECIMALS = 3, 5


def write_forces(path: Path, erection: Erection, *, name: str, version: str) -> None:
    """Write forces.csv: a row a state and cable or moved node.

    Of a cable the node is its first end and the force its tension; of others the force is along the node's way, below
    0 where the net has to be held back. The driver's force is conjugate to its travel.

    Raises
    ------
    OSError
        Where the file cannot be written whole.
    """
    way = erection.way
    assert way is not None
    lines = [f"# lamella {csv_comment(version)} · project {csv_comment(name)}", HEADER]
    for state, forces in zip(erection.states, way.forces.tolist(), strict=True):
        travel = f"{state.share * way.travel:.{PLACE_DECIMALS}f}"
        energy, driver = (f"{_told(x):.{FORCE_DECIMALS}f}" for x in (state.energy, state.driver))
        for node, force in zip(way.nodes.tolist(), forces, strict=True):
            told = f"{_told(force):.{FORCE_DECIMALS}f}"
            lines.append(f"{state.share:.4f},{travel},{energy},{driver},{node},{told}")
    write_whole(path, ("\n".join(lines) + "\n").encode())


def _told(value: float) -> float:
    """Rounded; minus zero is no force."""
    return round(value, FORCE_DECIMALS) + 0.0
