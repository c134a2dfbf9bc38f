"""The surface that the table [surface] of a project describes."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lamella.base.drawing_origin import NOWHERE, measured_from, origin_figure, reported_from
from lamella.base.errors import InputError
from lamella.base.progress import Progress, Report, silent
from lamella.project.tables import FormFoundTable, MeshTable, Project
from lamella.stages.keys import keys
from lamella.stages.memory import Memory
from lamella.stages.surface.warnings import order_warning
from lamella.surface.closed_forms.kinds import CLOSED_FORMS
from lamella.surface.surface import Surface

if TYPE_CHECKING:
    from lamella.surface.boundary.curve import Loop
    from lamella.surface.element.surface import ElementSurface
    from lamella.surface.form_finding.followed_film import FollowedFilm
    from lamella.surface.from_mesh.fit_options import FitOptions
    from lamella.surface.from_mesh.raw_mesh import RawMesh

# the way that a mesh of varying mean curvature has
KEEP = (
    'to keep the mesh\'s own surface write mean_curvature = "varying", and under [network] kind = "principal" (lines '
    "of principal curvature) or a normal_curvature"
)


def make_surface(
    project: Project, folder: str | Path = Path(), progress: Progress = silent, memory: Memory | None = None
) -> Surface[Any]:
    """The surface a project describes.

    Parameters
    ----------
    project : Project
    folder : str or Path
        Where the files a project names are looked for: the folder of the project file.
    progress : callable
        Is told of the steps where a surface has to be found.
    memory : Memory, optional
        One that follows takes a film from the last one that was made with it.

    Raises
    ------
    InputError
        No such surface.

    Examples
    --------
    >>> import lamella
    >>> project = lamella.parse_project({"surface": {"kind": "cylinder", "radius": 2.0, "height": [0.0, 3.0]}})
    >>> lamella.make_surface(project)
    Cylinder(mean curvature 0.25 1/m, 37.7 m2)
    """
    table, folder = project.surface, Path(folder)
    if not isinstance(table, FormFoundTable | MeshTable):
        with keys("surface"):
            return CLOSED_FORMS[table.kind](**table.model_dump(exclude={"kind"}))
    too_low = order_warning(table.order, table.tolerance, table.most_nodes)
    if too_low:
        progress(Report.step(too_low))
    try:
        if isinstance(table, FormFoundTable):
            progress(Report.step("finding the surface between its curves"))
            return film_of_table(table, folder, progress, memory, angle=project.network.angle)
        progress(Report.step("reading the mesh"))
        return surface_of_mesh_table(table, folder, progress)
    except InputError as error:
        if too_low and error.where == "surface.tolerance":
            raise InputError(error.message, f"write order = 3 or 4, or {error.remedy}", error.where) from None
        raise


def film_of_table(
    table: FormFoundTable,
    folder: Path,
    progress: Progress = silent,
    memory: Memory | None = None,
    *,
    angle: float = 90.0,
) -> ElementSurface:
    """The film in the boundary of a table, see `make_surface`; with a memory that follows, from the last one.

    With an angle other than 90 degrees the surface on which lamellas cross at that.
    """
    # heavy, and closed forms do without
    from lamella.stages.surface.boundary_of_tables import boundary_loops, with_origin
    from lamella.surface.boundary.corner_cost import corner_cost
    from lamella.surface.form_finding.find import find_film, notes_on, remarks_on

    table = with_origin(table, folder)
    with reported_from(table.origin or NOWHERE):
        if table.origin:
            progress(Report.step(measured_from(table.origin)))
        loops = boundary_loops(table, folder)
        remarks = remarks_on(loops)
        for remark in (*remarks, corner_cost(loops, table.most_nodes, table.tolerance)):
            if remark:
                progress(Report.step(remark))
        curvature = table.mean_curvature or table.normal_curvature or 0.0
        with keys("surface", loops="surface.boundary", angle="network.angle"):
            if angle != 90:
                from lamella.surface.constant_angle.find_angle import find_angle, notes_on_angle

                bent = find_angle(
                    loops,
                    angle,
                    curvature,
                    order=table.order,
                    tolerance=table.tolerance,
                    most_nodes=table.most_nodes,
                    progress=progress,
                )
                notes = remarks + notes_on_angle(bent)
                return bent.surface("form-found", notes, tolerance=table.tolerance, **origin_figure(table.origin))
            if memory and memory.follow:
                film: FollowedFilm = memory.followed("film", partial(followed_film, table, loops, progress))
                return film.assessed
            found = find_film(
                loops,
                curvature,
                volume=table.volume,
                order=table.order,
                tolerance=table.tolerance,
                branch=table.branch,
                most_nodes=table.most_nodes,
                progress=progress,
            )
        notes = remarks + notes_on(found, given_curvature=table.volume is None)
        return found.surface("form-found", notes, tolerance=table.tolerance, **origin_figure(table.origin))


def followed_film(
    table: FormFoundTable, loops: tuple[Loop, ...], progress: Progress, last: FollowedFilm | None
) -> FollowedFilm:
    """The film of a table from the last one; from nothing where that was another request.

    Parameters
    ----------
    table : FormFoundTable
        With its origin.
    loops : tuple of Loop
        Its boundary.
    progress : callable
    last : FollowedFilm or None

    Raises
    ------
    InputError
        There is no such film, or none was found.
    """
    from lamella.surface.form_finding.followed_film import FilmRequest, FollowedFilm
    from lamella.surface.form_finding.kept_elements import Boundary

    boundary = Boundary(loops, table.mean_curvature or table.normal_curvature or 0.0, table.volume)
    request = FilmRequest(table.order, table.tolerance, table.branch, table.most_nodes)
    origin = table.origin or NOWHERE
    if last is None or (last.request, last.origin) != (request, origin):
        return FollowedFilm.first(boundary, request, origin=origin, progress=progress)
    return last.moved(boundary, progress=progress)


def surface_of_mesh_table(table: MeshTable, folder: Path, progress: Progress = silent) -> ElementSurface:
    """The surface of the mesh that a table names, see `make_surface`."""
    # heavy, and closed forms do without
    from lamella.files.read.mesh import read_mesh
    from lamella.surface.from_mesh.fit_cmc import cmc_surface
    from lamella.surface.from_mesh.fit_options import FitOptions
    from lamella.surface.from_mesh.fit_surface import varying_surface

    with keys("surface", path="surface.file", points="surface.file", faces="surface.file"):
        raw = read_mesh(folder / table.file, table.unit, table.origin)
        if any(raw.origin):
            progress(Report.step(measured_from(raw.origin)))
        varying = table.mean_curvature == "varying"
        options = FitOptions(
            "fit" if table.mean_curvature == "varying" else table.mean_curvature,
            table.corner_angle,
            table.order,
            table.tolerance,
            table.most_nodes,
            table.deviation,
        )
        with reported_from(raw.origin):
            if varying:
                return varying_surface(raw, options, progress)
            with _open_ways(raw, options):
                return cmc_surface(raw, options, progress)


@contextmanager
def _open_ways(raw: RawMesh, options: FitOptions) -> Iterator[None]:
    """Offer to keep the mesh's own surface where that can be; say why not where it is refused too."""
    from lamella.surface.from_mesh.fit_cmc import NotConstantError
    from lamella.surface.from_mesh.fit_surface import varying_surface

    try:
        yield
    except NotConstantError as error:
        try:
            varying_surface(raw, options, silent)
        except InputError as refused:
            raise InputError(
                f'{error.message}; with mean_curvature = "varying" {refused.message}',
                f"{refused.remedy}; or {error.otherwise}",
                refused.where,
            ) from None
        raise InputError(error.message, f"{KEEP}; or {error.otherwise}", error.where) from None
