"""What a run says about files for other programs that do not carry all of the model."""

from __future__ import annotations

from collections.abc import Iterator

from lamella.base.progress import Report
from lamella.project.structure_tables import StructureTable
from lamella.project.tables import Project


def export_remarks(project: Project) -> Iterator[Report]:
    """One line a file that leaves something out, as docs/structure-exports.md has it."""
    table = project.structure or StructureTable()
    if "saf" in table.exports:
        yield Report.detail("structure/saf.xlsx is without the twist of strips and the helix effect: SAF has neither")
    if "opensees" in table.exports:
        warm = [load.name for load in project.load or () if load.kind == "temperature"]
        if warm:
            yield Report.detail(f"structure/opensees.py is without load {', '.join(warm)}: a change of temperature")
        if table.construction:
            yield Report.detail(
                "structure/opensees.py lets everything go at once, whatever structure.construction says"
            )
