"""What can be said of a project before it is run, in a few seconds.

A closed form costs nothing. A surface that has to be found is found on coarse elements: whether there is one, and how
many cells and nodes its net has, does not depend on the last digits. A net of ordinary size goes through all stages of
a run on it, in memory, so that a project that is called good is one that a run computes, with the warnings of a run,
but for what `Checked.left` names.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from lamella.base.errors import InputError
from lamella.base.message import Message
from lamella.base.progress import Progress, Report, silent
from lamella.base.wording import counted
from lamella.project.tables import FormFoundTable, MeshTable, Project
from lamella.stages.clock import Clock
from lamella.stages.computation import Computation
from lamella.stages.memory import Memory
from lamella.stages.stage import Stage
from lamella.stages.surface.warnings import order_warning
from lamella.stages.wanted import wanted_stages
from lamella.surface.surface import Surface
from lamella.surface.umbilic import umbilic_reason

# tolerance of the elements on which a surface is looked for
COARSE = 2e-2
# of the mesh for pictures, on which the size is measured
COARSE_MESH = 5e-3
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
    warnings : tuple of Message
        What a run warns of, as far as it was computed.
    coarse : bool
        Whether they come from coarse elements: their figures are those of a run to a few hundredths.
    left : tuple of str
        What only a run can tell.
    """

    surface: Surface[Any]
    cells: int | None
    nodes: int | None
    warnings: tuple[Message, ...]
    coarse: bool
    left: tuple[str, ...]

    def __str__(self) -> str:
        """In words."""
        reported = "a good project" if not self.warnings else f"it runs, with {counted(len(self.warnings), 'warning')}"
        reported += f". {self.surface.kind}, H = {self.surface.mean_curvature:.6g} 1/m"
        reported += ", no net" if self.nodes is None else f", {self.cells} cells, about {self.nodes:,} nodes"
        if self.left:
            reported += f"\n  only a run can tell {'; '.join(self.left)}"
        return reported


def check_project(
    project: Project, *, folder: Path = Path(), progress: Progress = silent, memory: Memory | None = None
) -> Checked:
    """Look for everything that a run would refuse or warn of, as far as that takes seconds.

    Parameters
    ----------
    project : Project
    folder : Path
        Where the files a project names are looked for.
    progress : callable
    memory : Memory, optional
        Of earlier checks and runs: what it holds is not computed again.

    Raises
    ------
    InputError
        What a run would refuse.
    """
    stages, messages = wanted_stages(project, None)
    left: list[str] = []
    coarse = _coarse(project, left)
    memory = Memory() if memory is None else memory
    begun = None
    try:
        begun = _begun(project, coarse, stages, folder, progress, memory)
    except InputError as error:
        if coarse is project or error.where != "surface.tolerance":
            raise
    if begun and coarse is not project and umbilic_reason(begun.upstream().surface.check_points(), COARSE):
        # the elements' own errors would decide
        progress(Report.step("nearly a sphere or a plane: found anew as finely as the run does"))
        begun = None
    if begun is None:
        # in the project's own numbers
        coarse = project
        left.clear()
        begun = _begun(project, coarse, stages, folder, progress, memory)
    estimates = [begun.estimate(stage, progress) for stage in stages[1:]]
    sizes = {key: value for estimate in estimates for key, value in estimate.figures.items()}
    left += [unknown for estimate in estimates for unknown in estimate.unknown]
    nodes = sizes.get("nodes")
    if nodes is not None and nodes > MOST_TRACED:
        left.append(f"whether all lamellas can be traced, and their strips (checked up to {MOST_TRACED:,} nodes)")
    elif nodes is not None and _adjusts(project):
        left.append("whether the boundary can be adjusted so that the net closes, and what its strips are")
    else:
        begun.warnings[:0] = messages
        for stage in stages[1:]:
            long = stage.takes_long(begun.upstream()) if begun.outputs.keys() >= set(stage.needs) else ""
            if long:
                left.append(long)
            else:
                begun.run_all([stage])
        if "network" in begun.outputs:
            nodes = len(begun.outputs["network"].network.node_points)
    warnings = tuple(begun.results().summary["warnings"])
    return Checked(begun.upstream().surface, sizes.get("cells"), nodes, warnings, coarse is not project, tuple(left))


def _adjusts(project: Project) -> bool:
    """Whether a run changes the boundary, which takes longer than a check may."""
    return project.network.closing == "adjust" and project.surface.kind == "form-found"


def _begun(
    project: Project, coarse: Project, stages: Sequence[Stage[Any]], folder: Path, progress: Progress, memory: Memory
) -> Computation:
    """A computation of the stages whose surface is there; what can be refused without a net has been."""
    files = coarse.files.model_copy(update={"mesh_tolerance": max(COARSE_MESH, coarse.files.mesh_tolerance)})
    light = coarse.model_copy(update={"files": files})
    # a computation of the surface alone leaves the boundary as it is
    wanted = stages[:1] if _adjusts(project) else stages
    begun = Computation(light, wanted, folder, memory, Clock(silent), finer=_finer(project, coarse), checked=stages)
    begun.run(stages[0], progress)
    return begun


def _finer(project: Project, coarse: Project) -> float:
    """By how much smaller the tolerance of a run is than that of its check."""
    one, other = project.surface, coarse.surface
    if not isinstance(one, FormFoundTable | MeshTable) or not isinstance(other, FormFoundTable | MeshTable):
        return 1.0
    return other.tolerance / one.tolerance


def _coarse(project: Project, left: list[str]) -> Project:
    """The project on coarse elements, where its surface has elements; what that leaves open is added to `left`."""
    table = project.surface
    if not isinstance(table, FormFoundTable | MeshTable) or table.tolerance >= COARSE:
        return project
    open_ = f"whether {table.most_nodes:,} nodes keep tolerance = {table.tolerance:g} (checked: {COARSE:g})"
    too_low = order_warning(table.order, table.tolerance, table.most_nodes)
    left.append(f"{open_}: {too_low}" if too_low else open_)
    return project.model_copy(update={"surface": table.model_copy(update={"tolerance": COARSE})})
