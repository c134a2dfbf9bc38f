"""Which load cases an analysis is asked for, by the names of loads and combinations."""

from __future__ import annotations

from lamella.base.errors import InputError
from lamella.base.wording import shown
from lamella.project.structure_tables import StructureTable
from lamella.project.tables import Project
from lamella.stages.actions_of_tables import combinations_of


def asked_cases(project: Project, names: tuple[str, ...] | None, where: str) -> tuple[str, ...]:
    """The cases of these names; all combinations where none is given and there are any, else all loads.

    Raises
    ------
    InputError
        A name that no load or combination has; no loads at all.
    """
    loads = tuple(load.name for load in project.load or ())
    combinations = tuple(one.name for one in combinations_of(project))
    if not loads:
        raise InputError("there are no loads to do this with", "add tables [[load]]", where)
    if names is None:
        return combinations or loads
    for name in names:
        if name not in loads + combinations:
            known = ", ".join(shown(one) for one in loads + combinations)
            raise InputError(f"there is no load or combination {shown(name)}", f"there are {known}", where)
    return names


def check_asked_cases(project: Project) -> None:
    """Refuse analyses of cases that are not there, and stages of construction without what they put on."""
    table = project.structure or StructureTable()
    for key, part in (("failure", table.failure), ("sensitivity", table.sensitivity)):
        if part is not None:
            asked_cases(project, part.cases, f"structure.{key}.cases")
    if table.displacement is not None:
        asked_cases(project, (table.displacement.case,), "structure.displacement.case")
    if table.variant:
        asked_cases(project, None, "structure.variant")
    if table.construction is not None:
        on = "cables on" in table.construction
        if on and project.cables is None:
            raise InputError(
                'the stage "cables on" and no cables', "add [cables], or leave the stage out", "structure.construction"
            )
        if project.cables is not None and not on:
            raise InputError(
                "there are cables, and the construction says not when they come",
                'add the stage "cables on"',
                "structure.construction",
            )
