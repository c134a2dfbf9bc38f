"""Where the boundary's nodes of a film go when its loops change: always from the loops they were made for.

Vertices keep their fraction of the loop; where the loop has corners, their fraction of the way from one corner to the
next, so that each corner stays at its vertex. Corners lie where two pieces of the curve join: a loop of as many pieces
has the same ones.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.surface.boundary.curve import Loop
from lamella.surface.element.placing import rim_parameters
from lamella.surface.form_finding.film import Film
from lamella.surface.remesh.remesh import TriangleMesh


class NotKeptError(ArithmeticError):
    """Elements that do not hold for a changed boundary; the message says why."""


def carried_parameters(mesh: TriangleMesh, before: Sequence[Loop], after: Sequence[Loop]) -> Floats:
    """Parameters of vertices (v,) on changed loops; nan inside.

    Parameters
    ----------
    mesh : TriangleMesh
        Its parameters are those on the loops `before`.
    before, after : sequence of Loop

    Raises
    ------
    NotKeptError
        Loops that have other corners, or slide.
    """
    if len(before) != len(after):
        raise NotKeptError(f"the boundary has {len(after)} loops, not {len(before)}")
    result = mesh.parameter.copy()
    for index, (old, new) in enumerate(zip(before, after, strict=True)):
        if old.slides or new.slides:
            raise NotKeptError(f"the loop {new.name!r} slides")
        if old is new:
            continue
        mine = mesh.loop == index
        result[mine] = _carried(old, new, result[mine])
    return result


def _carried(old: Loop, new: Loop, t: Floats) -> Floats:
    """Parameters (n,) of one loop on a changed one."""
    first, second = _corners(old, new)
    if not len(first):
        return t
    order = np.argsort(first)
    first, second = first[order], second[order]
    # from the first corner on, once around
    begin, end = np.append(first, first[0] + 1), np.append(second, second[0] + 1)
    if (np.diff(end) <= 0).any():
        raise NotKeptError(f"the corners of the loop {new.name!r} come in another order")
    return np.asarray(np.interp((t - begin[0]) % 1 + begin[0], begin, end) % 1)


def _corners(old: Loop, new: Loop) -> tuple[Floats, Floats]:
    """Where the corners (c,) of one loop are, and where they are on a changed one."""
    if old.course.pieces.count == new.course.pieces.count:
        at, there = _joints_of(old), _joints_of(new)
        fresh = np.setdiff1d(there[~new.smooth], at)
        if len(fresh):
            raise NotKeptError(f"the loop {new.name!r} has a corner where it had none")
        return old.corners, np.asarray(new.course.joints / new.length)[at]
    if len(old.corners) != len(new.corners):
        raise NotKeptError(f"the loop {new.name!r} has {len(new.corners)} corners, not {len(old.corners)}")
    return old.corners, new.corners


def _joints_of(loop: Loop) -> Integers:
    """At which joint of its pieces each corner of a loop is, (c,)."""
    joints = np.append(loop.course.joints / loop.length, 1.0)
    return np.asarray(np.abs(joints - loop.corners[:, None]).argmin(1) % loop.course.pieces.count)


def rim_places(film: Film, loops: Sequence[Loop], parameter: Floats) -> Floats:
    """Points (b, order + 1, 3) of the nodes along each boundary edge on changed loops, m.

    Parameters
    ----------
    film : Film
    loops : sequence of Loop
    parameter : (v,)
        Of the vertices, see `carried_parameters`.
    """
    of_loop = film.mesh.loop[film.connectivity.rim_nodes[:, 0]]
    t = rim_parameters(film.connectivity, parameter)
    points = np.empty((*t.shape, 3))
    for index, loop in enumerate(loops):
        mine = of_loop == index
        points[mine] = loop.at(t[mine])
    return points
