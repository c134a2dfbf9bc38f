"""erection/lifting.csv: the net, or its segments, in the crane."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from lamella.erection.lift_cases import LiftCase
from lamella.files.whole import write_whole
from lamella.files.write.text import csv_comment

HEADER = "segment,points,bracing,nodes,weight_n,holds,deflection_m,von_mises_mpa,slings_n"


def write_lifting(path: Path, lifts: Iterable[tuple[str, Sequence[LiftCase]]], *, name: str, version: str) -> None:
    """Write lifting.csv: a row a segment, number of points and bracing.

    Nodes and forces of their slings have `;` between; what does not hold at all has no deflection.

    Parameters
    ----------
    path : Path
    lifts : iterable of (str, sequence of LiftCase)
        Id of the segment, empty for the whole net, and its cases.
    name, version : str
        Of the project and of the program.

    Raises
    ------
    OSError
        Where the file cannot be written whole.
    """
    lines = [f"# lamella {csv_comment(version)} · project {csv_comment(name)}", HEADER]
    for segment, cases in lifts:
        for case in cases:
            one = case.lifted
            nodes = ";".join(map(str, one.nodes.tolist()))
            bends = "" if one.deflection is None else f"{one.deflection:.4f}"
            stress = "" if one.von_mises is None else f"{one.von_mises / 1e6:.1f}"
            slings = "" if one.poses is None else ";".join(f"{tension:.1f}" for tension in one.slings.tolist())
            head = f"{segment},{case.points},{case.bracing},{nodes},{one.weight:.1f},{int(case.holds)}"
            lines.append(f"{head},{bends},{stress},{slings}")
    write_whole(path, ("\n".join(lines) + "\n").encode())
