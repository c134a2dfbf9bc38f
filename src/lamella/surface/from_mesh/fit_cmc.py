"""The surface of constant mean curvature that a mesh means."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from lamella.base.arrays import Floats
from lamella.base.drawing_origin import origin_figure
from lamella.base.errors import InputError
from lamella.base.message import Message
from lamella.base.progress import Progress, Report, silent
from lamella.surface.boundary import Loop
from lamella.surface.element.surface import ElementSurface
from lamella.surface.form_finding.film import Film, harmonic_over_itself
from lamella.surface.form_finding.find import adapted, notes_on
from lamella.surface.form_finding.meshing import on_surface
from lamella.surface.form_finding.newton import Equilibrium, FixedH, NoFilmError, Volume, find_equilibrium
from lamella.surface.from_mesh.clean import CleanMesh, clean
from lamella.surface.from_mesh.edges import face_normals, find_edges, vertex_areas
from lamella.surface.from_mesh.fit_options import FitOptions
from lamella.surface.from_mesh.fit_surface import distances
from lamella.surface.from_mesh.mean_curvature_fit import Fit, fit_mean_curvature
from lamella.surface.from_mesh.nearest import nearest_of_family
from lamella.surface.from_mesh.raw_mesh import RawMesh, mesh_of_arrays
from lamella.surface.from_mesh.to_elements import as_film, checked_loops

# of the curvature scale: an H below it, and below what a mesh can tell, is that of a minimal surface; above the other
# the user is warned of it
MINIMAL, REPORTED = 2e-3, 1e-4
# vertices of a mesh whose curvature may be read wrongly for its coarseness alone: the surface itself decides then
COARSE_VERTICES = 400
# 1/m; a radius of a thousand kilometres
CURVATURE_MIN = 1e-9
# mean cosine between neighbouring faces
CRUMPLED = 0.8
# largest distance between mesh and surface, over the size, at which the surface still is what the mesh means
DEVIATION_MAX = 0.05
# typical distance between them, over the size, that the user is warned of
FIT_OFF = 2e-4


class NotConstantError(InputError):
    """A mesh that means no surface of constant mean curvature, while its own surface may do (`fit_surface`).

    Parameters
    ----------
    message, where : str
        See `InputError`.
    otherwise : str
        What to change where the mesh's own surface is not wanted.
    """

    def __init__(self, message: str, otherwise: str, where: str) -> None:
        super().__init__(message, f"take the mesh's own surface (fit_surface); or {otherwise}", where)
        self.otherwise = otherwise


def fit_cmc(
    points: ArrayLike,
    faces: ArrayLike,
    *,
    mean_curvature: Literal["fit"] | float = "fit",
    corner_angle: float = 40.0,
    order: int = 4,
    tolerance: float = 2e-3,
    most_nodes: int = 100_000,
    deviation: float = 0.1,
    progress: Progress = silent,
) -> ElementSurface:
    """The surface of constant mean curvature that a mesh means, its border kept.

    Parameters
    ----------
    points : (n, 3)
        m.
    faces : (m, 3) or (m, 4) int
        Triangles or quads, counter-clockwise about the normal.
    mean_curvature, corner_angle, order, tolerance, most_nodes, deviation
        See `FitOptions`.
    progress : callable

    Raises
    ------
    InputError
        No disc with holes, or one that does not mean a surface of constant mean curvature.

    Examples
    --------
    >>> import lamella
    >>> mesh = lamella.Catenoid(2.0, (-1.0, 1.0)).mesh(0.02)
    >>> surface = lamella.fit_cmc(mesh.points, mesh.faces, tolerance=0.02)
    >>> abs(surface.mean_curvature) < 1e-3
    True
    """
    options = FitOptions(mean_curvature, corner_angle, order, tolerance, most_nodes, deviation)
    return cmc_surface(mesh_of_arrays(points, faces), options, progress)


def cmc_surface(raw: RawMesh, options: FitOptions, progress: Progress = silent) -> ElementSurface:
    """`fit_cmc` of a mesh from a file."""
    mesh = clean(raw)
    progress(Report.step(f"{raw.source}: {len(mesh.points):,} vertices, {len(mesh.faces):,} triangles"))
    loops, notes = checked_loops(mesh, options.corner_angle)
    try:
        return _constant(raw, mesh, loops, notes, options, progress)
    except NotConstantError as error:
        if _crumpled(mesh):
            raise InputError(error.message, error.otherwise, error.where) from None
        raise


def _constant(
    raw: RawMesh,
    mesh: CleanMesh,
    loops: tuple[Loop, ...],
    notes: tuple[Message, ...],
    options: FitOptions,
    progress: Progress,
) -> ElementSurface:
    """The surface of constant mean curvature that a mesh means."""
    fit = fit_mean_curvature(mesh.points, mesh.faces)
    given = None if options.mean_curvature == "fit" else float(options.mean_curvature)
    progress(
        Report.step(
            f"curvature at the vertices: H = {fit.mean_curvature:.6g} 1/m, off by {fit.deviation:.2g} of the curvature "
            f"scale {fit.scale:.4g} 1/m"
        )
    )
    areas = vertex_areas(mesh.points, mesh.faces)
    first, exact = _coarse(mesh, loops, fit, areas, options, progress)
    nearest = first.mean_curvature
    if given is None:
        first = _without_curvature(first, fit.scale, progress)
        notes += _reported_zero(first.mean_curvature, nearest)

    def settled(film: Film) -> Equilibrium:
        if given is not None or not first.mean_curvature:
            return find_equilibrium(film, first.mean_curvature, FixedH(stable=False), progress=progress)
        # by the volume: at a fold of H there may be no surface of the H of the elements before
        here = find_equilibrium(film, first.mean_curvature, Volume(0.0), progress=progress)
        return nearest_of_family(here, mesh.points, areas, progress)

    found = adapted(first, settled, options.tolerance, options.most_nodes, first.steps, False, progress)
    mean_curvature = found.equilibrium.mean_curvature
    distance = distances(found.equilibrium.film, mesh.points)
    _refuse_far(distance, found.equilibrium)
    for note in (*mesh.notes, *notes):
        progress(Report.step(note))
    return found.surface(
        "mesh",
        (
            *_doubts(fit, mean_curvature, nearest, given, exact),
            *_reported_off(distance, found.equilibrium.film.size, fit),
            *notes_on(found, given_curvature=False),
        ),
        source=raw.source,
        treatment=[*mesh.notes, *notes],
        nearest_mean_curvature=nearest if given is None and not mean_curvature else mean_curvature,
        fitted_mean_curvature=fit.mean_curvature,
        fitted_deviation=fit.deviation,
        distance_max=float(distance.max()),
        distance_rms=float(np.sqrt((distance**2).mean())),
        tolerance=options.tolerance,
        **origin_figure(raw.origin),
    )


def _coarse(
    mesh: CleanMesh, loops: tuple[Loop, ...], fit: Fit, areas: Floats, options: FitOptions, progress: Progress
) -> tuple[Equilibrium, bool]:
    """The surface a mesh means on coarse elements, and whether its vertices lie on it but for their coarseness.

    Raises
    ------
    InputError
        There is none, or the mesh is too far from it.
    """
    free = options.mean_curvature == "fit"
    start = fit.mean_curvature if free else float(options.mean_curvature)
    uneven = fit.deviation > options.deviation
    if uneven and (len(mesh.points) > COARSE_VERTICES or _crumpled(mesh)):
        raise _not_constant(fit, options.deviation)
    progress(Report.step("laying elements on the mesh"))
    try:
        first = _near(_film(mesh, loops, options.order, start), start, free, progress)
    except InputError:
        if uneven:
            raise _not_constant(fit, options.deviation) from None
        raise
    if free:
        first = nearest_of_family(first, mesh.points, areas, progress)
    distance = distances(first.film, mesh.points)
    typical = float(np.sqrt(areas @ distance**2 / areas.sum()))
    progress(Report.step(f"nearest to the vertices: H = {first.mean_curvature:.6g} 1/m, {1000 * typical:.3g} mm off"))
    # vertices off by d change the curvature of edges of length h by up to 8 d / h^2
    edge = float(np.median(find_edges(mesh.faces).lengths(mesh.points)))
    exact = 8 * typical / edge**2 <= options.deviation * fit.scale
    if uneven and not exact:
        raise _not_constant(
            fit, options.deviation, f", about H = {first.mean_curvature:.2g} 1/m and {1000 * typical:.2g} mm off"
        )
    _refuse_far(distance, first)
    return first, exact


def _not_constant(fit: Fit, limit: float, nearest: str = "") -> InputError:
    """The refusal of a mesh whose curvature varies, with words on the nearest surface where it is known."""
    return NotConstantError(
        f"the mesh is not of constant mean curvature: H = {fit.mean_curvature:.4g} 1/m fits best, its vertices are "
        f"off by {fit.deviation:.2g} of the curvature scale {fit.scale:.4g} 1/m (limit {limit:g}, "
        f"largest {fit.deviation_max:.2g})",
        f"mend the mesh, or raise deviation to take the nearest surface{nearest}",
        "faces",
    )


def _crumpled(mesh: CleanMesh) -> bool:
    """Whether neighbouring faces turn so much that elements cannot be laid on them."""
    normals = face_normals(mesh.points, mesh.faces)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    one, other = (find_edges(mesh.faces).inner_pairs // 3).T
    return bool((normals[one] * normals[other]).sum(1).mean() < CRUMPLED)


def _refuse_far(distance: Floats, here: Equilibrium) -> None:
    size = here.film.size
    if distance.max() > DEVIATION_MAX * size:
        raise NotConstantError(
            f"the nearest surface of H = {here.mean_curvature:.4g} 1/m is up to {distance.max():.4g} m away from the "
            f"mesh (limit {DEVIATION_MAX * size:.4g} m, {DEVIATION_MAX:.0%} of its size): the mesh does not mean it",
            "give another mean_curvature, or mend the mesh",
            "faces",
        )


def _reported_off(distance: Floats, size: float, fit: Fit) -> tuple[Message, ...]:
    """That the surface is not the mesh."""
    typical = float(np.sqrt((distance**2).mean()))
    if typical <= FIT_OFF * size:
        return ()
    return (
        Message(
            "mesh_far",
            f"the surface is not the mesh, but the one of constant mean curvature next to it: vertices lie "
            f"{typical:.2g} m off it (root mean square; up to {distance.max():.2g} m), their curvature varies by "
            f"{fit.deviation:.1%} of the curvature scale",
        ),
    )


def _reported_zero(mean_curvature: float, nearest: float) -> tuple[Message, ...]:
    """That H was taken as 0, if it was and is more than rounding."""
    if mean_curvature == nearest or abs(nearest) < CURVATURE_MIN:
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
    if not mean_curvature and abs(nearest) > REPORTED * fit.scale:
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
        minimal = find_equilibrium(here.film, 0.0, FixedH(stable=False), progress=progress)
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
            "faces",
        ) from None


def _near(film: Film, mean_curvature: float, free: bool, progress: Progress) -> Equilibrium:
    """A surface near a film: of that H, or where H is free of the film's volume."""
    reasons = []
    fixed = FixedH(stable=False)
    for condition in (Volume(0.0), fixed) if free else (fixed,):
        try:
            return find_equilibrium(film, mean_curvature, condition, progress=progress)
        except NoFilmError as error:
            progress(Report.detail(f"{error}"))
            reasons.append(str(error))
    message = (
        f"no surface of constant mean curvature {mean_curvature:.4g} 1/m was found near the mesh ({'; '.join(reasons)})"
    )
    if free:
        raise NotConstantError(message, "give mean_curvature, or mend the mesh", "mean_curvature")
    raise InputError(
        message,
        "give another mean_curvature (its sign is that of the mesh's normals, see the fit above), or mend the mesh",
        "mean_curvature",
    )
