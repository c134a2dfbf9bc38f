"""The curves of a net that the table [network] of a project describes, and what is refused of them beforehand."""

from __future__ import annotations

from lamella.network.pattern import Pattern
from lamella.network.streamlines.applicability import refuse_lattice_options
from lamella.project.tables import FormFoundTable, MeshTable, NetworkTable, Project
from lamella.stages.keys import keys


def pattern_of(table: NetworkTable) -> Pattern:
    """Which curves of the isothermic lattice the net has."""
    p, q = (table.every, table.every) if isinstance(table.every, int) else table.every
    return Pattern(table.kind, (p, q), table.normal_curvature, table.angle)


@keys("network")
def refuse_lines(project: Project) -> None:
    """Refuse what lines from seeds cannot have, where it is known before the surface is found that they are such.

    Raises
    ------
    InputError
    """
    if _surely_traced(project):
        refuse_lattice_options(pattern_of(project.network), project.network.closing)


def _surely_traced(project: Project) -> bool:
    """Whether the net follows from no lattice whatever surface is found (`applicability.is_traced`)."""
    table, wanted = project.surface, project.network.normal_curvature
    if isinstance(table, MeshTable) and table.mean_curvature == "varying":
        return True
    if wanted is None:
        return False
    if isinstance(table, MeshTable):
        # a mesh that is fitted may turn out to be a minimal surface, but no other H is met to the last digit
        return wanted != (0.0 if table.mean_curvature == "fit" else table.mean_curvature)
    if project.network.angle != 90:
        return True
    if isinstance(table, FormFoundTable):
        return table.volume is not None or wanted != (table.mean_curvature or 0.0)
    return False
