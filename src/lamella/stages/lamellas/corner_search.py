"""Which radius of a boundary's corners brings the strips of a net below their strength.

How stress falls with the radius depends on where lamellas come to lie beside the fillets: the net of each is laid.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.progress import Progress, Report, silent
from lamella.base.wording import rounded
from lamella.network.elements.element_network import ElementNetwork
from lamella.network.streamlines.streamline_network import TracedNetwork
from lamella.project.tables import FormFoundTable, Project
from lamella.stages.network.net_of_table import net_of_plan, net_plan
from lamella.stages.section_of_table import section_of
from lamella.strip.lamellas import make_lamellas
from lamella.surface.element.surface import ElementSurface
from lamella.surface.surface import Surface

COARSE = 2e-2
"""Tolerance of the surfaces that are tried, where that of the project is finer: the one of `lamella.stages.check`."""

MOST_TRIED = 4
"""Radii, each twice the one before."""

ENOUGH = 0.9
"""Utilisation on a coarse surface below which a finer one is tried."""


SurfaceOf = Callable[[Project], Surface[Any]]


def corner_help(
    made: ElementNetwork | TracedNetwork,
    utilisation: Floats,
    project: Project,
    surface_of: SurfaceOf,
    progress: Progress,
) -> Callable[[Floats], str]:
    """What helps at a point (3,) next to a corner of the boundary, in words, for strips with a utilisation (k,)."""
    searched = partial(radius_that_does, project, surface_of, progress=progress)
    return partial(made.at_corner, utilisation=utilisation, searched=searched)


def radius_that_does(
    project: Project, surface_of: SurfaceOf, loop: int, radii: tuple[float, float], progress: Progress = silent
) -> str:
    """A radius of a boundary loop's corners that brings the utilisation to 1 and below; empty: none was found.

    Parameters
    ----------
    project : Project
        Of a surface found between curves.
    surface_of : callable
        The surface that a project describes.
    loop : int
        Number of the loop.
    radii : (float, float)
        The first `corner_radius` to try, and the largest one the loop has room for, m.
    progress : callable
        Is told of each radius.
    """
    table = project.surface
    assert isinstance(table, FormFoundTable)
    name = table.boundary[loop].name
    coarse = max(table.tolerance, COARSE)
    tried: list[tuple[float, float]] = []
    for doubling in range(MOST_TRIED):
        radius = rounded(min(radii[0] * 2**doubling, radii[1]), up=False, digits=2)
        if tried and radius <= tried[-1][1]:
            break
        progress(Report.detail(f"corner_radius = {radius:g} m tried for {name!r}"))
        try:
            used = _utilisation(_with_radius(project, loop, radius, coarse), surface_of)
            # what is said is what a run finds: lamellas lie elsewhere on a finer surface, and peaks are narrow
            if used <= ENOUGH and coarse > table.tolerance:
                progress(Report.detail(f"the surface with corner_radius = {radius:g} m as fine as asked for"))
                used = _utilisation(_with_radius(project, loop, radius, table.tolerance), surface_of)
        except InputError:
            continue
        tried.append((used, radius))
        if used <= 1:
            return f"corner_radius = {radius:g} m in the table of {name!r} brings it to {rounded(used, up=True):g}"
    return ""


def _with_radius(project: Project, loop: int, radius: float, tolerance: float) -> Project:
    table = project.surface
    assert isinstance(table, FormFoundTable)
    loops = list(table.boundary)
    loops[loop] = loops[loop].model_copy(update={"corner_radius": radius})
    surface = table.model_copy(update={"boundary": tuple(loops), "tolerance": tolerance})
    # where the boundary is adjusted, it is so after it was rounded
    closing = "open" if project.network.closing == "adjust" else project.network.closing
    network = project.network.model_copy(update={"closing": closing})
    return project.model_copy(update={"surface": surface, "network": network})


def _utilisation(project: Project, surface_of: SurfaceOf) -> float:
    """The largest one of the project's strips."""
    surface = surface_of(project)
    assert isinstance(surface, ElementSurface)
    network = net_of_plan(net_plan(surface, project, None, silent), project).network
    lamellas = make_lamellas(network, section_of(project), project.material(), surface=surface)
    return float(np.max(lamellas.utilisation))
