"""The surface that the table [surface] of a project describes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from lamella.base.errors import InputError
from lamella.base.progress import Progress, Report, silent
from lamella.project.tables import Project
from lamella.stages.warnings import order_caution
from lamella.surface.closed_forms.kinds import CLOSED_FORMS
from lamella.surface.surface import Surface


def make_surface(project: Project, folder: str | Path = Path(), progress: Progress = silent) -> Surface[Any]:
    """The surface a project describes.

    Parameters
    ----------
    project : Project
    folder : str or Path
        Where the files a project names are looked for: the folder of the project file.
    progress : callable
        Is told of the steps where a surface has to be found.

    Raises
    ------
    InputError
        No such surface.
    """
    table, folder = project.surface, Path(folder)
    if table.kind not in ("form-found", "mesh"):
        return CLOSED_FORMS[table.kind](**table.model_dump(exclude={"kind"}))
    too_low = order_caution(table.order, table.tolerance, table.most_nodes)
    if too_low:
        progress(Report.step(too_low))
    try:
        if table.kind == "form-found":
            from lamella.surface.form_finding.find import surface_of_table as find

            progress(Report.step("finding the surface between its curves"))
            return find(table, folder, progress)
        from lamella.surface.from_mesh.fit_cmc import surface_of_table as adopt

        progress(Report.step("reading the mesh"))
        return adopt(table, folder, progress)
    except InputError as error:
        if too_low and error.where == "surface.tolerance":
            raise InputError(error.message, f"write order = 3 or 4, or {error.remedy}", error.where) from None
        raise
