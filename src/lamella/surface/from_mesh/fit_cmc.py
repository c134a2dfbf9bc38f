"""The surface of constant mean curvature that a mesh means."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.drawing_origin import measured_from, origin_figure, told_from
from lamella.base.errors import InputError
from lamella.base.message import Message
from lamella.base.progress import Progress, Report, silent
from lamella.files.read.mesh import read_mesh
from lamella.files.read.raw_mesh import RawMesh
from lamella.surface.boundary import Loop, check_loops
from lamella.surface.element.surface import ElementSurface
from lamella.surface.form_finding.film import Film, harmonic_over_itself
from lamella.surface.form_finding.find import adapted, notes_on
from lamella.surface.form_finding.meshing import on_surface
from lamella.surface.form_finding.newton import Equilibrium, NoFilmError, find_equilibrium
from lamella.surface.from_mesh.clean import CleanMesh, clean
from lamella.surface.from_mesh.edges import face_normals, find_edges, vertex_areas
from lamella.surface.from_mesh.fit_surface import distances, kept_surface
from lamella.surface.from_mesh.mean_curvature_fit import Fit, fit_mean_curvature
from lamella.surface.from_mesh.nearest import nearest_of_family
from lamella.surface.from_mesh.to_elements import as_film, border_loops

if TYPE_CHECKING:
    from lamella.project.tables import MeshTable


# of the curvature scale: an H below it, and below what a mesh can tell, is that of a minimal surface; above the other
# the user is warned of it
MINIMAL, TOLD = 2e-3, 1e-4
# vertices of a mesh whose curvature may be read wrongly for its coarseness alone: the surface itself decides then
COARSE = 400
# 1/m; a radius of a thousand kilometres
LEAST = 1e-9
# mean cosine between neighbouring faces
CRUMPLED = 0.8
# largest distance between mesh and surface, over the size, at which the surface still is what the mesh means
FAR = 0.05
# typical distance between them, over the size, that the user is warned of
OFF = 2e-4
# the way that a mesh of varying mean curvature has
KEEP = (
    'to keep the mesh\'s own surface write mean_curvature = "varying", and under [network] kind = "principal" (lines '
    "of principal curvature) or a normal_curvature"
)


def surface_of_table(table: MeshTable, folder: Path, progress: Progress = silent) -> ElementSurface:
    """The surface of a project's table.

    Parameters
    ----------
    table : MeshTable
    folder : Path
        Where a relative path of the mesh begins.
    progress : callable

    Raises
    ------
    InputError
        The mesh cannot be read, or does not mean a surface of constant mean curvature.
    """
    raw = read_mesh(folder / table.file, table.unit, table.origin)
    if any(raw.origin):
        progress(Report.step(measured_from(raw.origin)))
    with told_from(raw.origin):
        return _meant(raw, table, progress)


def _meant(raw: RawMesh, table: MeshTable, progress: Progress) -> ElementSurface:
    mesh = clean(raw)
    progress(Report.step(f"{raw.source}: {len(mesh.points):,} vertices, {len(mesh.faces):,} triangles"))
    loops, notes = border_loops(mesh, table.corner_angle)
    check_loops(loops)
    if table.mean_curvature == "varying":
        kept = kept_surface(mesh, loops, table, raw.source, notes, progress)
        return replace(kept, figures=kept.figures | origin_figure(raw.origin))
    try:
        return _constant(raw, mesh, loops, notes, table, progress)
    except InputError as error:
        if not error.remedy.startswith(KEEP):
            raise
        raise _with_open_ways(error, mesh, loops, table, raw.source) from None


def _with_open_ways(
    error: InputError, mesh: CleanMesh, loops: tuple[Loop, ...], table: MeshTable, source: str
) -> InputError:
    """An error that offers to keep the mesh's own surface; without that offer where this is refused too."""
    if _crumpled(mesh):
        return InputError(error.message, error.remedy.removeprefix(f"{KEEP}; or "), error.where)
    try:
        kept_surface(mesh, loops, table, source, (), silent)
    except InputError as refused:
        return InputError(
            f'{error.message}; with mean_curvature = "varying" {refused.message}',
            f"{refused.remedy}{error.remedy.removeprefix(KEEP)}",
            refused.where,
        )
    return error


def _constant(
    raw: RawMesh,
    mesh: CleanMesh,
    loops: tuple[Loop, ...],
    notes: tuple[Message, ...],
    table: MeshTable,
    progress: Progress,
) -> ElementSurface:
    """The surface of constant mean curvature that a mesh means."""
    fit = fit_mean_curvature(mesh.points, mesh.faces)
    given = None if table.mean_curvature == "fit" else float(table.mean_curvature)
    progress(
        Report.step(
            f"curvature at the vertices: H = {fit.mean_curvature:.6g} 1/m, off by {fit.deviation:.2g} of the curvature "
            f"scale {fit.scale:.4g} 1/m"
        )
    )
    areas = vertex_areas(mesh.points, mesh.faces)
    first, exact = _coarse(mesh, loops, fit, areas, table, progress)
    nearest = first.mean_curvature
    if given is None:
        first = _without_curvature(first, fit.scale, progress)
        notes += _told_zero(first.mean_curvature, nearest)

    def settled(film: Film) -> Equilibrium:
        if given is not None or not first.mean_curvature:
            return find_equilibrium(film, first.mean_curvature, stable=False, progress=progress)
        # by the volume: at a fold of H there may be no surface of the H of the elements before
        here = find_equilibrium(film, first.mean_curvature, volume=0.0, stable=False, progress=progress)
        return nearest_of_family(here, mesh.points, areas, progress)

    found = adapted(first, settled, table.tolerance, table.most_nodes, first.steps, False, progress)
    mean_curvature = found.equilibrium.mean_curvature
    distance = distances(found.equilibrium.film, mesh.points)
    _refuse_far(distance, found.equilibrium)
    for note in (*mesh.notes, *notes):
        progress(Report.step(note))
    return found.surface(
        "mesh",
        (
            *_doubts(fit, mean_curvature, nearest, given, exact),
            *_told_off(distance, found.equilibrium.film.size, fit),
            *notes_on(found, given_curvature=False),
        ),
        source=raw.source,
        treatment=[*mesh.notes, *notes],
        nearest_mean_curvature=nearest if given is None and not mean_curvature else mean_curvature,
        fitted_mean_curvature=fit.mean_curvature,
        fitted_deviation=fit.deviation,
        distance_max=float(distance.max()),
        distance_rms=float(np.sqrt((distance**2).mean())),
        tolerance=table.tolerance,
        **origin_figure(raw.origin),
    )


def _coarse(
    mesh: CleanMesh, loops: tuple[Loop, ...], fit: Fit, areas: Floats, table: MeshTable, progress: Progress
) -> tuple[Equilibrium, bool]:
    """The surface a mesh means on coarse elements, and whether its vertices lie on it but for their coarseness.

    Raises
    ------
    InputError
        There is none, or the mesh is too far from it.
    """
    free = table.mean_curvature == "fit"
    start = fit.mean_curvature if free else float(table.mean_curvature)
    uneven = fit.deviation > table.deviation
    if uneven and (len(mesh.points) > COARSE or _crumpled(mesh)):
        raise _not_constant(fit, table.deviation)
    progress(Report.step("laying elements on the mesh"))
    try:
        first = _near(_film(mesh, loops, table.order, start), start, free, progress)
    except InputError:
        if uneven:
            raise _not_constant(fit, table.deviation) from None
        raise
    if free:
        first = nearest_of_family(first, mesh.points, areas, progress)
    distance = distances(first.film, mesh.points)
    typical = float(np.sqrt(areas @ distance**2 / areas.sum()))
    progress(Report.step(f"nearest to the vertices: H = {first.mean_curvature:.6g} 1/m, {1000 * typical:.3g} mm off"))
    # vertices off by d change the curvature of edges of length h by up to 8 d / h^2
    edge = float(np.median(find_edges(mesh.faces).lengths(mesh.points)))
    exact = 8 * typical / edge**2 <= table.deviation * fit.scale
    if uneven and not exact:
        raise _not_constant(
            fit, table.deviation, f", about H = {first.mean_curvature:.2g} 1/m and {1000 * typical:.2g} mm off"
        )
    _refuse_far(distance, first)
    return first, exact


def _not_constant(fit: Fit, limit: float, nearest: str = "") -> InputError:
    """The refusal of a mesh whose curvature varies, with words on the nearest surface where it is known."""
    return InputError(
        f"the mesh is not of constant mean curvature: H = {fit.mean_curvature:.4g} 1/m fits best, its vertices are "
        f"off by {fit.deviation:.2g} of the curvature scale {fit.scale:.4g} 1/m (limit {limit:g}, "
        f"largest {fit.deviation_max:.2g})",
        f"{KEEP}; or mend the mesh, or raise deviation to take the nearest surface{nearest}",
        "surface.file",
    )


def _crumpled(mesh: CleanMesh) -> bool:
    """Whether neighbouring faces turn so much that elements cannot be laid on them."""
    normals = face_normals(mesh.points, mesh.faces)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    one, other = (find_edges(mesh.faces).inner_pairs // 3).T
    return bool((normals[one] * normals[other]).sum(1).mean() < CRUMPLED)


def _refuse_far(distance: Floats, here: Equilibrium) -> None:
    size = here.film.size
    if distance.max() > FAR * size:
        raise InputError(
            f"the nearest surface of H = {here.mean_curvature:.4g} 1/m is up to {distance.max():.4g} m away from the "
            f"mesh (limit {FAR * size:.4g} m, {FAR:.0%} of its size): the mesh does not mean it",
            f"{KEEP}; or give another mean_curvature, or mend the mesh",
            "surface.file",
        )


def _told_off(distance: Floats, size: float, fit: Fit) -> tuple[Message, ...]:
    """That the surface is not the mesh."""
    typical = float(np.sqrt((distance**2).mean()))
    if typical <= OFF * size:
        return ()
    return (
        Message(
            "mesh_far",
            f"the surface is not the mesh, but the one of constant mean curvature next to it: vertices lie "
            f"{typical:.2g} m off it (root mean square; up to {distance.max():.2g} m), their curvature varies by "
            f"{fit.deviation:.1%} of the curvature scale",
        ),
    )


def _told_zero(mean_curvature: float, nearest: float) -> tuple[Message, ...]:
    """That H was taken as 0, if it was and is more than rounding."""
    if mean_curvature == nearest or abs(nearest) < LEAST:
        return ()
    return (
        Message(
            "curvature_zero",
            f"H taken as 0: the surface nearest to the mesh has H = {nearest:.4g} 1/m, less than a mesh can tell",
        ),
    )


def _doubts(fit: Fit, mean_curvature: float, nearest: float, given: float | None, exact: bool) -> tuple[Message, ...]:
    """Where the surface is not the one that fits the mesh best."""
    if given is not None:
        if abs(given - fit.mean_curvature) > 0.05 * fit.scale:
            return (
                Message(
                    "curvature_given",
                    f"mean_curvature = {given:g} 1/m is not what the mesh has: {fit.mean_curvature:.4g} 1/m fits best",
                ),
            )
        return ()
    doubts = []
    if not mean_curvature and abs(nearest) > TOLD * fit.scale:
        doubts.append(
            Message(
                "curvature_zero",
                f"mean_curvature is taken as 0: the surface nearest to the mesh has {nearest:.4g} 1/m, "
                f"{abs(nearest) / fit.scale:.1g} of the curvature scale (0 up to {MINIMAL:g}); write mean_curvature = "
                f"{nearest:.6g} to keep it",
            )
        )
    if not exact and abs(nearest - fit.mean_curvature) > 0.05 * fit.scale:
        doubts.append(
            Message(
                "mesh_rough",
                f"the surface nearest to the mesh has H = {nearest:.5g} 1/m, but the curvature at the vertices is "
                f"{fit.mean_curvature:.5g} 1/m: the mesh is rough, or not of constant mean curvature",
            )
        )
    return tuple(doubts)


def _without_curvature(here: Equilibrium, scale: float, progress: Progress) -> Equilibrium:
    """The minimal surface in place of one whose H no mesh can tell from 0; that one where there is none."""
    if abs(here.mean_curvature) > MINIMAL * scale:
        return here
    with suppress(NoFilmError):
        minimal = find_equilibrium(here.film, 0.0, stable=False, progress=progress)
        return replace(minimal, steps=here.steps + minimal.steps)
    return here


def _film(mesh: CleanMesh, loops: tuple[Loop, ...], order: int, mean_curvature: float) -> Film:
    """Coarse elements on a mesh, drawn towards that H."""
    try:
        return harmonic_over_itself(on_surface(as_film(mesh, loops), order), mean_curvature)
    except NoFilmError as error:
        raise InputError(
            f"no elements could be laid on the mesh: {error}",
            "mend the mesh where it overlaps, folds or is very thin",
            "surface.file",
        ) from None


def _near(film: Film, mean_curvature: float, free: bool, progress: Progress) -> Equilibrium:
    """A surface near a film: of that H, or where H is free of the film's volume."""
    reasons = []
    for volume in (0.0, None) if free else (None,):
        try:
            return find_equilibrium(film, mean_curvature, volume=volume, stable=False, progress=progress)
        except NoFilmError as error:
            progress(Report.detail(f"{error}"))
            reasons.append(str(error))
    raise InputError(
        f"no surface of constant mean curvature {mean_curvature:.4g} 1/m was found near the mesh "
        f"({'; '.join(reasons)})",
        "give another mean_curvature (its sign is that of the mesh's normals, see the fit above), or mend the mesh"
        if not free
        else f"{KEEP}; or give mean_curvature, or mend the mesh",
        "surface.mean_curvature",
    )
