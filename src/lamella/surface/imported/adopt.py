"""The surface of constant mean curvature that a mesh means."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

from lamella.errors import InputError
from lamella.surface.boundary import Loop, check_loops, make_loop
from lamella.surface.boundary.joining import join_in_order
from lamella.surface.boundary.splines import closed_spline, open_spline
from lamella.surface.element.closest import ClosestPoint
from lamella.surface.element.remesh import TriangleMesh
from lamella.surface.element.surface import ElementSurface
from lamella.surface.found.film import Film, harmonic_over_itself
from lamella.surface.found.find import adapted, notes_on
from lamella.surface.found.meshing import on_surface
from lamella.surface.found.newton import Equilibrium, NoFilmError, find_equilibrium
from lamella.surface.imported.border import BorderCurve, border_curves
from lamella.surface.imported.clean import CleanMesh, clean
from lamella.surface.imported.fit import Fit, fit_mean_curvature
from lamella.surface.imported.raw_mesh import Floats
from lamella.surface.imported.read_mesh import read_mesh

if TYPE_CHECKING:
    from lamella.project import MeshTable

Progress = Callable[[str], None]

# a border of more vertices is thinned: noise between neighbours would make its curve rough
MOST_BORDER_POINTS = 240
# samples of a border's curve between two of its vertices
SAMPLES = 24
# of the curvature scale: a best fit below it, and below what a mesh can tell, is that of a minimal surface
MINIMAL = 2e-3
# largest distance between mesh and surface, over the size, at which the surface still is what the mesh means
FAR = 0.05


def _silent(message: str) -> None:
    """Tell nobody."""


def surface_of_table(table: MeshTable, folder: Path, progress: Progress = _silent) -> ElementSurface:
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
    raw = read_mesh(folder / table.file, table.unit)
    mesh = clean(raw)
    progress(f"  {raw.source}: {len(mesh.points):,} vertices, {len(mesh.faces):,} triangles")
    loops, notes = border_loops(mesh, table.corner_angle)
    check_loops(loops)
    fit = fit_mean_curvature(mesh.points, mesh.faces)
    given = None if table.mean_curvature == "fit" else float(table.mean_curvature)
    progress(
        f"  best-fit H = {fit.mean_curvature:.6g} 1/m, off by {fit.deviation:.2g} of the curvature scale "
        f"{fit.scale:.4g} 1/m"
    )
    if fit.deviation > table.deviation:
        raise InputError(
            f"the mesh is not of constant mean curvature: H = {fit.mean_curvature:.4g} 1/m fits best, its vertices are "
            f"off by {fit.deviation:.2g} of the curvature scale {fit.scale:.4g} 1/m (limit {table.deviation:g}, "
            f"largest {fit.deviation_max:.2g})",
            f"mend the mesh, or raise deviation to take the nearest surface of H = {fit.mean_curvature:.4g} 1/m",
            "surface.file",
        )
    mean_curvature = given
    if mean_curvature is None:
        mean_curvature = fit.mean_curvature if abs(fit.mean_curvature) > MINIMAL * fit.scale else 0.0
    try:
        film = harmonic_over_itself(on_surface(_as_film(mesh, loops), table.order), mean_curvature)
    except NoFilmError as error:
        raise InputError(
            f"no elements could be laid on the mesh: {error}",
            "mend the mesh where it overlaps, folds or is very thin",
            "surface.file",
        ) from None
    first = _nearest(film, mean_curvature, given is None, progress)

    def settled(film: Film) -> Equilibrium:
        return find_equilibrium(film, first.mean_curvature, stable=False, detail=progress)

    found = adapted(first, settled, table.tolerance, table.most_nodes, first.steps, False, progress)
    film = found.equilibrium.film
    _, position = ClosestPoint(film.connectivity, film.nodes)(mesh.points)
    distance = np.linalg.norm(position - mesh.points, axis=1)
    if distance.max() > FAR * film.size:
        raise InputError(
            f"the nearest surface of H = {first.mean_curvature:.4g} 1/m is up to {distance.max():.4g} m away from the "
            f"mesh (limit {FAR * film.size:.4g} m, {FAR:.0%} of its size): the mesh does not mean it",
            "give another mean_curvature, or mend the mesh",
            "surface.file",
        )
    for note in (*mesh.notes, *notes):
        progress(f"  {note}")
    return found.surface(
        "mesh",
        (*_doubts(fit, first.mean_curvature, given), *notes_on(found)),
        source=raw.source,
        treatment=[*mesh.notes, *notes],
        fitted_mean_curvature=fit.mean_curvature,
        fitted_deviation=fit.deviation,
        distance_max=float(distance.max()),
        distance_rms=float(np.sqrt((distance**2).mean())),
        tolerance=table.tolerance,
    )


def _doubts(fit: Fit, mean_curvature: float, given: float | None) -> tuple[str, ...]:
    """Where the surface is not the one that fits the mesh best."""
    if given is None and abs(mean_curvature - fit.mean_curvature) > 0.02 * fit.scale:
        return (
            f"no surface of the best-fit H = {fit.mean_curvature:.5g} 1/m was reached; that of the mesh's volume has "
            f"H = {mean_curvature:.5g} 1/m",
        )
    if given is not None and abs(given - fit.mean_curvature) > 0.05 * fit.scale:
        return (f"mean_curvature = {given:g} 1/m is not what the mesh has: {fit.mean_curvature:.4g} 1/m fits best",)
    return ()


def _nearest(film: Film, mean_curvature: float, free: bool, progress: Progress) -> Equilibrium:
    """The surface of that H near a film; where there is none and H is free, that of the film's volume."""
    try:
        return find_equilibrium(film, mean_curvature, stable=False, detail=progress)
    except NoFilmError as error:
        progress(f"    at the best-fit H: {error}")
        reason = str(error)
    if free:
        try:
            return find_equilibrium(film, mean_curvature, volume=0.0, stable=False, detail=progress)
        except NoFilmError as error:
            reason = str(error)
    raise InputError(
        f"no surface of constant mean curvature {mean_curvature:.4g} 1/m was found near the mesh ({reason})",
        "give mean_curvature, or mend the mesh",
        "surface.mean_curvature",
    )


def border_loops(mesh: CleanMesh, corner_angle: float) -> tuple[tuple[Loop, ...], tuple[str, ...]]:
    """Smooth loops through the borders of a mesh, with their corners, and what was done to them."""
    loops: list[Loop] = []
    notes: list[str] = []
    for index, border in enumerate(mesh.borders):
        points = mesh.points[border]
        spacing = None
        if len(border) > MOST_BORDER_POINTS:
            length = np.linalg.norm(np.roll(points, -1, 0) - points, axis=1).sum()
            spacing = float(length) / MOST_BORDER_POINTS
        curve = border_curves(CleanMesh(mesh.points, mesh.faces, (border,), ()), corner_angle, spacing)[0]
        notes += curve.notes
        loops.append(_loop(curve, f"border {index}" if index else "border"))
    return tuple(loops), tuple(notes)


def _loop(curve: BorderCurve, name: str) -> Loop:
    where = "surface.file"
    corners = np.flatnonzero(curve.corner)
    if not len(corners):
        return make_loop(name, closed_spline(curve.points, where=where), where=where)
    points = np.roll(curve.points, -corners[0], axis=0)
    cuts = np.append(corners - corners[0], len(points))
    closed = np.vstack([points, points[:1]])
    parts = [open_spline(closed[a : b + 1], where=where) for a, b in pairwise(cuts)]
    names = [f"{name}, side {k + 1}" for k in range(len(parts))]
    return make_loop(name, join_in_order(parts, names, where), where=where)


def _as_film(mesh: CleanMesh, loops: tuple[Loop, ...]) -> Film:
    """The mesh's triangles as flat elements, its borders on their loops."""
    of_loop = np.full(len(mesh.points), -1)
    parameter = np.full(len(mesh.points), np.nan)
    for index, (border, loop) in enumerate(zip(mesh.borders, loops, strict=True)):
        of_loop[border] = index
        parameter[border] = _parameters(mesh.points[border], loop)
    return Film.on_mesh(TriangleMesh(mesh.points, mesh.faces, of_loop, parameter), loops, 1)


def _parameters(points: Floats, loop: Loop) -> Floats:
    """Increasing parameters of border vertices on their loop."""
    fine = np.arange(SAMPLES * len(points)) / (SAMPLES * len(points))
    _, near = cKDTree(loop.at(fine)).query(points)
    t = np.unwrap(fine[near], period=1.0)
    if t[-1] < t[0]:
        raise InputError("a border runs against its own curve", "mend the mesh's border", "surface.file")
    # where the curve passes near itself, or was smoothed, a vertex may be out of order: it goes between its neighbours
    step = np.linalg.norm(np.roll(points, -1, 0) - points, axis=1)
    guess = t[0] + np.concatenate([[0], np.cumsum(step)[:-1]]) / step.sum()
    off = np.abs(t - guess - np.round(t - guess)) > 0.05
    t = np.where(off, guess, guess + (t - guess) - np.round(t - guess))
    ahead = np.maximum.accumulate(t)
    good = t >= ahead
    index = np.arange(len(t))
    good[1:] &= np.diff(ahead) > 0
    t = np.interp(index, np.append(index[good], len(t)), np.append(t[good], t[0] + 1))
    return np.asarray(t % 1)
