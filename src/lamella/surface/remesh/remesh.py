"""Isotropic triangles on a surface with boundary, graded by a size field.

The accuracy of curved elements hangs on the straight triangles they are built on: these have to be close to
equilateral, follow the wanted size smoothly, and touch the boundary with one edge at most, since a curved boundary
edge bends its whole element. `remesh` brings any triangle mesh of the surface there by local operations, so that the
topology is that of the start whatever the shapes are.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.ties import VERTEX_BITS, grid_of, rounded
from lamella.base.vectors import crosses, lengths
from lamella.surface.remesh import rim
from lamella.surface.remesh.collapse import collapse_short, collapse_thin
from lamella.surface.remesh.draft import Draft
from lamella.surface.remesh.flip import flip
from lamella.surface.remesh.rim import Plan, Rim
from lamella.surface.remesh.smooth import round_off, smooth
from lamella.surface.remesh.split import split_long
from lamella.surface.remesh.topology import Topology, connect

__all__ = ["Rim", "TriangleMesh", "remesh"]

REFINE, COARSEN = 12, 40  # passes in a round; each is a set of operations that do not touch
FOLDED = 0.05  # shape of faces below which an edge is collapsed in a round
THIN, ROUND = 0.72, 0.8  # the same after the last round, and below which vertices are moved
BROKEN_SHAPE = 0.01  # shape of a result that is no mesh of the surface
RUNAWAY = 10.0  # times as many triangles as the sizes ask for
EXTRA = 40  # further passes a boundary gets to come to its final vertices
TOO_LONG = 1.45  # in units of the wanted length, of the result's edges: smoothing and flips stretch some beyond LONGEST


@dataclass(frozen=True)
class TriangleMesh:
    """Straight triangles on a surface, with the place of their boundary vertices on the boundary curves.

    Attributes
    ----------
    points : (n, 3)
        Vertices (m).
    faces : (m, 3) int
        Vertices of the triangles, all turning the same way.
    loop : (n,) int
        Boundary loop of a vertex, -1 inside.
    parameter : (n,)
        Boundary parameter in [0, 1) on the loop, a fraction of its arc length; nan inside.
    """

    points: Floats
    faces: Integers
    loop: Integers
    parameter: Floats


def remesh(
    mesh: TriangleMesh,
    *,
    size: Callable[[Floats], Floats],
    project: Callable[[Floats], Floats],
    rims: Sequence[Rim],
    rounds: int = 8,
) -> TriangleMesh:
    """Replace the triangles of a surface by well-shaped ones of a wanted size.

    The boundary gets its vertices from the size along its curve alone: each edge between two corners spans the same
    integral of ds/size. The inside follows by splits, collapses, flips and smoothing. The result has the topology and
    orientation of the start and is the same at every call.

    Parameters
    ----------
    mesh : TriangleMesh
        The start, of any shape and fineness. Its boundary vertices are put on the curves by their parameters.
    size : callable
        Wanted edge length (m), shape (k,), at points (k, 3) (m) on or near the surface. It should change by less than
        about 0.4 m a metre, or no mesh can follow it.
    project : callable
        Closest points of the surface, (k, 3), of points (k, 3) near it.
    rims : sequence of Rim
        Curves of the boundary loops 0, 1, ...
    rounds : int
        Rounds of operations.

    Returns
    -------
    TriangleMesh
        Boundary vertices lie exactly on their curves at their parameters, and every corner is a vertex with its exact
        parameter. An inner edge joins two boundary vertices only across a sharp corner (below 75 degrees) or where the
        surface is narrower than 0.7 sizes.

    Raises
    ------
    ValueError
        If the start is no oriented manifold, if its boundary does not run along the loops in the order of the
        parameters, if a loop could not be brought to its vertices, or if triangles of the result lie folded: a start in
        which some of the triangles are turned over is mostly mended, one with many is not.
    """
    draft, plans = _start(mesh, size, project, rims)
    most = np.inf
    rim.insert_knots(draft, plans)
    for number in range(rounds):
        early, late = number < rounds // 2, number >= rounds - 3
        draft.size = np.array(size(draft.points))
        if number == 0:
            most = RUNAWAY * _expected(draft)
        for _ in range(REFINE):
            if len(draft.faces) > most:
                raise ValueError(f"more than {most:,.0f} triangles, and no end: the start is folded over itself")
            count = rim.split(draft, plans)
            if count:
                _delaunay(draft, bridges=True)
            count += split_long(draft, look_inside=early)
            if count == 0:
                break
            flip(draft, by_valence=False)
        for _ in range(COARSEN):
            if rim.collapse(draft, plans, careful=not late) + collapse_short(draft) == 0:
                break
        collapse_thin(draft, FOLDED)
        if number < rounds - 2:
            flip(draft, by_valence=True)
            smooth(draft)
        _delaunay(draft)
        rim.spread(draft, plans, careful=not late)
        smooth(draft)
        smooth(draft)
        smooth(draft)
        _delaunay(draft)
    _finish_boundary(draft, plans)
    for _ in range(4):
        collapse_thin(draft, THIN)
        for _ in range(3):
            round_off(draft, ROUND)
        _delaunay(draft)
        draft.size = np.array(size(draft.points))
        split_long(draft, look_inside=False, longest=TOO_LONG)
    folded = int(np.sum(draft.face_shapes().shape < BROKEN_SHAPE))
    if folded:
        raise ValueError(
            f"{folded} triangles are folded over or flat after remeshing: the start is folded, or too coarse "
            "for its curved boundary"
        )
    return _result(draft, plans)


def _expected(draft: Draft) -> float:
    """Number of equilateral triangles of the wanted sizes that cover the surface."""
    a, b, c = (draft.points[draft.faces[:, k]] for k in range(3))
    area = lengths(crosses(b - a, c - a)) / 2
    size = draft.size[draft.faces].mean(1)
    return float((area / (np.sqrt(3) / 4 * size**2)).sum()) + len(draft.faces)


def _delaunay(draft: Draft, bridges: bool = False) -> None:
    for _ in range(4):
        if flip(draft, by_valence=False, bridges=bridges) == 0:
            break


def _finish_boundary(draft: Draft, plans: Sequence[Plan]) -> None:
    """Bring loops to their vertices that the rounds have left on the way."""
    for _ in range(EXTRA):
        if rim.done(draft, plans):
            return
        rim.split(draft, plans)
        rim.collapse(draft, plans, careful=False)
        split_long(draft, look_inside=False)
        collapse_short(draft)
        rim.spread(draft, plans, careful=False)
        smooth(draft)
        _delaunay(draft)
    raise ValueError(
        "a boundary loop could not be brought to the wanted number of edges: the surface is narrower there than an edge"
    )


def _start(
    mesh: TriangleMesh,
    size: Callable[[Floats], Floats],
    project: Callable[[Floats], Floats],
    rims: Sequence[Rim],
) -> tuple[Draft, list[Plan]]:
    """A draft that shares nothing with the mesh, and a plan for each loop."""
    topology = connect(np.asarray(mesh.faces, dtype=np.int64), len(mesh.points))
    loop = np.asarray(mesh.loop, dtype=np.int64).copy()
    plans: list[Plan] = []
    station = np.full(loop.size, np.nan)
    points = np.array(mesh.points, dtype=np.float64)
    for which, curve in enumerate(rims):
        mine = np.flatnonzero(loop == which)
        if mine.size == 0:
            raise ValueError(f"no vertex of the mesh lies on boundary loop {which}")
        # rounded, 0 and a last bit less than 1 are the same place
        first = (rounded(mesh.parameter[mine], rim.CORNER_PARAMETER) % 1.0).argmin()
        one = rim.plan(curve, float(mesh.parameter[mine][first]), size)
        station[mine] = one.station(mesh.parameter[mine])
        points[mine] = curve.at(mesh.parameter[mine])
        plans.append(one)
    fixed = np.zeros(loop.size, dtype=bool)
    # A copy: the draft changes its sizes, and the field may hand out an array of its own.
    sizes = np.array(size(points))
    grid = grid_of(float(sizes.min()), VERTEX_BITS)
    points = rounded(points, grid)
    draft = Draft(points, topology.faces.copy(), loop, station, fixed, sizes, size, project, grid)
    _require_loops(draft, topology, plans)
    return draft, plans


def _require_loops(draft: Draft, topology: Topology, plans: Sequence[Plan]) -> None:
    rim = topology.ends[~topology.inner]
    on_rim = np.zeros(len(draft.points), dtype=bool)
    on_rim[rim] = True
    if not np.array_equal(on_rim, (draft.loop >= 0) & (draft.loop < len(plans))):
        raise ValueError("the vertices with a loop are not those on the boundary of the mesh, or a loop has no curve")
    if np.any(topology.valence == 0):
        raise ValueError("a vertex of the mesh belongs to no triangle")
    pairs = np.sort(rim, axis=1)
    for which, _ in enumerate(plans):
        mine = np.flatnonzero(draft.loop == which)
        ring = mine[np.argsort(draft.station[mine], kind="stable")]
        wanted = np.sort(np.column_stack([ring, np.roll(ring, -1)]), axis=1)
        have = pairs[draft.loop[pairs[:, 0]] == which]
        if have.shape != wanted.shape or not np.array_equal(np.unique(have, axis=0), np.unique(wanted, axis=0)):
            raise ValueError(f"the boundary of the mesh does not run along loop {which} in the order of its parameters")


def _result(draft: Draft, plans: Sequence[Plan]) -> TriangleMesh:
    rim = np.flatnonzero(draft.boundary)
    parameter = np.full(len(draft.points), np.nan)
    points = np.asarray(draft.nearest(draft.points))
    for which, one in enumerate(plans):
        mine = rim[draft.loop[rim] == which]
        parameter[mine] = one.parameter(draft.station[mine])
        points[mine] = one.rim.at(parameter[mine])
    return TriangleMesh(points, draft.faces, draft.loop, parameter)
