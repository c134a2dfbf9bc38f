"""What can be said of a project before it is run, in a few seconds.

A closed form costs nothing. A surface that has to be found is found on coarse elements: whether there is one, and how
many cells and nodes its net has, does not depend on the last digits. A net of ordinary size is traced on it, so that a
project that is called good is one that a run computes, but for what `Checked.left` names.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from lamella.cautions import order_caution
from lamella.errors import InputError
from lamella.network.lines import is_traced
from lamella.pipeline import plan
from lamella.progress import Progress, silent
from lamella.project import FormFoundTable, MeshTable, Project
from lamella.surface.surface import Surface
from lamella.surface.umbilic import umbilic_reason

# tolerance of the elements on which a surface is looked for
COARSE = 2e-2
# nets of more nodes are not traced for a check: it would take longer than finding the surface
MOST_TRACED = 5_000


@dataclass(frozen=True)
class Checked:
    """What is known of a project that is not refused.

    Attributes
    ----------
    surface : Surface
        A closed form, or the surface on coarse elements.
    cells, nodes : int or None
        Of the net, about; None: it has none.
    no_net : str
        Why it has none.
    left : tuple of str
        What only a run can tell.
    """

    surface: Surface[Any]
    cells: int | None
    nodes: int | None
    no_net: str
    left: tuple[str, ...]

    def __str__(self) -> str:
        """In words."""
        told = f"{self.surface.kind}, H = {self.surface.mean_curvature:.6g} 1/m"
        if self.nodes is not None:
            told += f", {self.cells} cells, about {self.nodes:,} nodes"
        if self.no_net:
            told += f"; the run ends with the surface: it is {self.no_net}, and has no net of lamellas"
        if self.left:
            told += f"\n  only a run can tell {'; '.join(self.left)}"
        return told


def check_project(project: Project, *, folder: Path = Path(), progress: Progress = silent) -> Checked:
    """Look for everything that a run would refuse, as far as that takes seconds.

    Parameters
    ----------
    project : Project
    folder : Path
        Where the files a project names are looked for.
    progress : callable

    Raises
    ------
    InputError
        What a run would refuse.
    """
    left: list[str] = []
    coarse = _coarse(project, left)
    try:
        surface, density = plan(coarse, folder=folder, progress=progress)
    except InputError as error:
        if coarse is project or error.where != "surface.tolerance":
            raise
        # in the project's own numbers
        left.clear()
        surface, density = plan(project, folder=folder, progress=progress)
    if density:
        return Checked(surface, density.cells, density.estimated_nodes, "", ())
    if coarse is not project and umbilic_reason(surface.check_points(), COARSE):
        # the elements' own errors would decide
        progress("  nearly a sphere or a plane: found anew as finely as asked for")
        left.clear()
        surface, _ = plan(project, folder=folder, progress=progress)
    flat = umbilic_reason(surface.check_points())
    if flat:
        return Checked(surface, None, None, flat, tuple(left))
    from lamella.weaving import lay, lay_traced, trace, weave

    progress("  laying the net")
    if is_traced(surface, project.network.pattern):
        lines = lay_traced(surface, project)
        cells, nodes = lines.cells, lines.estimated_nodes
        if nodes <= MOST_TRACED:
            trace(surface, project, progress)
    else:
        laid = lay(surface, project, None, progress)
        cells, nodes = laid.lattice.cells, laid.lattice.estimated_nodes
        if project.network.closing == "adjust":
            left.append("whether the boundary can be adjusted so that the net closes")
        elif nodes <= MOST_TRACED:
            weave(laid, project)
    if nodes > MOST_TRACED:
        left.append(f"whether all lamellas can be traced (checked in nets of up to {MOST_TRACED:,} nodes)")
    return Checked(surface, cells, nodes, "", tuple(left))


def _coarse(project: Project, left: list[str]) -> Project:
    """The project on coarse elements, where its surface has elements; what that leaves open is added to `left`."""
    table = project.surface
    if not isinstance(table, FormFoundTable | MeshTable) or table.tolerance >= COARSE:
        return project
    open_ = f"whether {table.most_nodes:,} nodes keep tolerance = {table.tolerance:g} (checked: {COARSE:g})"
    too_low = order_caution(table.order, table.tolerance, table.most_nodes)
    left.append(f"{open_}: {too_low}" if too_low else open_)
    return project.model_copy(update={"surface": table.model_copy(update={"tolerance": COARSE})})
