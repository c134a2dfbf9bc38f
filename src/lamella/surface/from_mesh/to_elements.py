"""A mesh as flat elements, its borders on smooth loops."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.message import Message
from lamella.base.wording import loop_names
from lamella.surface.boundary import Loop, check_loops, make_loop
from lamella.surface.boundary.smooth_polyline import through_points
from lamella.surface.form_finding.film import Film
from lamella.surface.from_mesh.border import BorderCurve, border_curves
from lamella.surface.from_mesh.clean import CleanMesh
from lamella.surface.remesh.remesh import TriangleMesh

# a border of more vertices is thinned: noise between neighbours would make its curve rough
MOST_BORDER_POINTS = 240
# samples of a border's curve between two of its vertices
EDGE_SAMPLES = 24
# Newton's steps from the nearest sample to a vertex's foot point on its curve
FOOT_STEPS = 6


def border_loops(mesh: CleanMesh, corner_angle: float) -> tuple[tuple[Loop, ...], tuple[Message, ...]]:
    """Smooth loops through the borders of a mesh, with their corners, and what was done to them."""
    curves = border_curves(mesh, corner_angle, MOST_BORDER_POINTS)
    loops = tuple(_loop(curve, name) for curve, name in zip(curves, loop_names(len(mesh.borders)), strict=True))
    return loops, tuple(note for curve in curves for note in curve.notes)


def checked_loops(mesh: CleanMesh, corner_angle: float) -> tuple[tuple[Loop, ...], tuple[Message, ...]]:
    """`border_loops`, refused where they are no boundary of a surface.

    Raises
    ------
    InputError
    """
    loops, notes = border_loops(mesh, corner_angle)
    try:
        check_loops(loops)
    except InputError as error:
        raise InputError(error.message, error.remedy, "faces") from None
    return loops, notes


def _loop(curve: BorderCurve, name: str) -> Loop:
    return make_loop(name, through_points(curve.points, curve.corner, "faces"), where="faces")


def as_film(mesh: CleanMesh, loops: tuple[Loop, ...]) -> Film:
    """The mesh's triangles as flat elements, its borders on their loops."""
    of_loop = np.full(len(mesh.points), -1)
    parameter = np.full(len(mesh.points), np.nan)
    for index, (border, loop) in enumerate(zip(mesh.borders, loops, strict=True)):
        of_loop[border] = index
        parameter[border] = _parameters(mesh.points[border], loop)
    return Film.on_mesh(TriangleMesh(mesh.points, mesh.faces, of_loop, parameter), loops, 1)


def _parameters(points: Floats, loop: Loop) -> Floats:
    """Increasing parameters of border vertices on their loop."""
    fine = np.arange(EDGE_SAMPLES * len(points)) / (EDGE_SAMPLES * len(points))
    _, near = cKDTree(loop.at(fine)).query(points)
    t = fine[near]
    # to the foot point itself: a vertex on the curve stays where it is
    for _ in range(FOOT_STEPS):
        step = ((points - loop.at(t)) * loop.tangent(t)).sum(1) / loop.length
        t = t + np.clip(step, -1 / len(fine), 1 / len(fine))
    t = np.unwrap(t, period=1.0)
    if t[-1] < t[0]:
        raise InputError("a border runs against its own curve", "mend the mesh's border", "faces")
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
