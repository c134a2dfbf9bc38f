"""Where the boundary of a project can be adjusted so that its net closes."""

from __future__ import annotations

from lamella.base.errors import InputError
from lamella.project.tables import FormFoundTable, Project


def refuse_adjusting(project: Project) -> None:
    """Say where `closing = "adjust"` cannot work, before anything is looked for.

    Raises
    ------
    InputError
    """
    if project.network.closing != "adjust":
        return
    if project.surface.kind == "mesh":
        raise InputError(
            'closing = "adjust" changes boundary curves, and a mesh has none',
            'write closing = "open" or "round", or find the surface from curves (kind = "form-found")',
            "network.closing",
        )
    if isinstance(project.surface, FormFoundTable):
        from lamella.stages.surface.adjusted_table import refuse_held_table

        refuse_held_table(project.surface)
