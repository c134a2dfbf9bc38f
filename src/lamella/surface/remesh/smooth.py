"""Move the inner vertices of a mesh that is being remeshed."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Booleans, Floats
from lamella.base.ties import MARGIN
from lamella.base.vectors import crosses, dots, lengths
from lamella.surface.remesh.draft import DRAFT_SHAPE, Draft, FaceShapes
from lamella.surface.remesh.kernel import kernel
from lamella.surface.remesh.topology import area_vectors, shape


def smooth(draft: Draft, step: float = 0.8) -> None:
    """Move inner vertices to the weighted centre of their faces, and back onto the surface."""
    faces = draft.face_shapes()
    way = _ways(draft, faces, -1.0, step)
    if way is None:
        # Area over size cubed: in balance the spacing of a row of points is then proportional to the size.
        mean = draft.size[draft.faces].mean(axis=1)
        weight = lengths(faces.area) / (mean * mean * mean)
        goals = np.repeat(draft.points[draft.faces].mean(axis=1)[:, None], 3, axis=1)
        way = _mean_way(draft, goals, weight, faces) * step
    _move(draft, way, faces, DRAFT_SHAPE)


def round_off(draft: Draft, limit: float, step: float = 0.5) -> None:
    """Move inner vertices of faces below a shape to where these would be equilateral; no poor face gets poorer."""
    faces = draft.face_shapes()
    way = _ways(draft, faces, limit, step)
    if way is None:
        corners = draft.points[draft.faces]
        start, end = corners[:, [1, 2, 0]], corners[:, [2, 0, 1]]
        inward = crosses(np.broadcast_to(faces.normals[:, None], start.shape), end - start)
        goals = 0.5 * (start + end) + 0.5 * np.sqrt(3.0) * inward
        poor = np.zeros(len(draft.points), dtype=bool)
        poor[draft.faces[faces.shape < limit]] = True
        weight = np.where(poor[draft.faces].any(axis=1), (1.02 - np.maximum(faces.shape, 0.0)) ** 2, 0.0)
        way = _mean_way(draft, goals, weight, faces) * (step * poor)[:, None]
    _move(draft, way, faces, limit)


def _ways(draft: Draft, faces: FaceShapes, limit: float, step: float) -> Floats | None:
    """The ways (n, 3) of `smooth` (a limit below 0) or of `round_off` by the compiled kernel, where there is one."""
    fast = kernel()
    if not fast:
        return None
    n = len(draft.points)
    way, normal = np.empty((2, n, 3))
    given = draft.points, draft.faces, draft.size, *faces, limit, step
    fast.call("ways", n, len(draft.faces), *given, way, np.empty(n), normal, np.empty(n, bool))
    return way


def _mean_way(draft: Draft, goals: Floats, weight: Floats, faces: FaceShapes) -> Floats:
    """Way in the tangent plane to the mean of the goals (m, 3, 3) that its faces have for a vertex, (n, 3)."""
    corner = draft.faces.ravel()
    count = len(draft.points)
    total = np.bincount(corner, np.repeat(weight, 3), count)
    weighted = goals.reshape(-1, 3) * np.repeat(weight, 3)[:, None]
    sums = [np.bincount(corner, weighted[:, i], count) for i in range(3)]
    way = np.column_stack(sums) / np.where(total > 0, total, 1.0)[:, None] - draft.points
    normal = draft.vertex_normals(faces.area)
    way -= dots(way, normal)[:, None] * normal
    return way


def _move(draft: Draft, way: Floats, faces: FaceShapes, good: float) -> None:
    """Move inner vertices by ways (n, 3), where no face gets worse than both `good` and before."""
    inside = np.flatnonzero(~draft.boundary & way.any(axis=1))
    goal = draft.points.copy()
    if inside.size:
        goal[inside] = draft.project(draft.points[inside] + way[inside])
    draft.points, _ = guarded(draft, goal, faces, good)


def guarded(
    draft: Draft, goal: Floats, faces: FaceShapes, good: float, moves: Booleans | None = None
) -> tuple[Floats, Booleans]:
    """Points moved to a goal (n, 3), but for those that would make a face worse than both `good` and before.

    Parameters
    ----------
    draft, goal
    faces : FaceShapes
        Of the draft as it is.
    good : float
    moves : (n,) bool, optional
        Which points may be held back, all if not given.

    Returns
    -------
    points : (n, 3)
    away : (n,) bool
        Which of those that may be held back were not.
    """
    points = goal.copy()
    away = np.ones(len(points), dtype=bool) if moves is None else moves.copy()
    fast = kernel()
    if fast:
        given = draft.points, draft.faces, faces.shape, faces.normals, good, MARGIN
        fast.call("guarded", len(points), len(draft.faces), *given, points, away, np.empty(len(points), bool))
        return points, away
    while True:
        corners = points[draft.faces]
        after = shape(corners, area_vectors(corners), faces.normals)
        back = np.unique(draft.faces[after < np.minimum(good, faces.shape) - MARGIN])
        back = back[away[back]]
        if back.size == 0:
            return points, away
        points[back] = draft.points[back]
        away[back] = False
