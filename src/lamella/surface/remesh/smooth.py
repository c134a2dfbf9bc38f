"""Move the inner vertices of a mesh that is being remeshed."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.ties import MARGIN
from lamella.base.vectors import crosses, dots, lengths
from lamella.surface.remesh.draft import DRAFT_SHAPE, Draft
from lamella.surface.remesh.topology import area_vectors, shape


def smooth(draft: Draft, step: float = 0.8) -> None:
    """Move inner vertices to the weighted centre of their faces, and back onto the surface."""
    corners = draft.points[draft.faces]
    area, normals = draft.face_normals()
    # Area over size cubed: in balance the spacing of a row of points is then proportional to the size.
    weight = lengths(area) / draft.size[draft.faces].mean(axis=1) ** 3
    goals = np.repeat(corners.mean(axis=1)[:, None], 3, axis=1)
    _move(draft, goals, weight, area, normals, step, DRAFT_SHAPE)


def round_off(draft: Draft, limit: float, step: float = 0.5) -> None:
    """Move inner vertices of faces below a shape to where these would be equilateral; no poor face gets poorer."""
    corners = draft.points[draft.faces]
    area, normals = draft.face_normals()
    start, end = corners[:, [1, 2, 0]], corners[:, [2, 0, 1]]
    inward = crosses(np.broadcast_to(normals[:, None], start.shape), end - start)
    goals = 0.5 * (start + end) + 0.5 * np.sqrt(3.0) * inward
    present = shape(corners, area, normals)
    poor = np.zeros(len(draft.points), dtype=bool)
    poor[draft.faces[present < limit]] = True
    weight = np.where(poor[draft.faces].any(axis=1), (1.02 - np.maximum(present, 0.0)) ** 2, 0.0)
    _move(draft, goals, weight, area, normals, step * poor, limit)


def _move(
    draft: Draft, goals: Floats, weight: Floats, area: Floats, normals: Floats, step: float | Floats, good: float
) -> None:
    """Move inner vertices in the tangent plane to the mean of the goals (m, 3, 3) their faces have for them."""
    corner = draft.faces.ravel()
    count = len(draft.points)
    total = np.bincount(corner, np.repeat(weight, 3), count)
    weighted = goals.reshape(-1, 3) * np.repeat(weight, 3)[:, None]
    sums = [np.bincount(corner, weighted[:, i], count) for i in range(3)]
    way = np.column_stack(sums) / np.where(total > 0, total, 1.0)[:, None] - draft.points
    normal = draft.vertex_normals(area)
    way -= dots(way, normal)[:, None] * normal
    way *= np.broadcast_to(step, count)[:, None]
    inside = np.flatnonzero(~draft.boundary & way.any(axis=1))
    goal = draft.points.copy()
    if inside.size:
        goal[inside] = draft.project(draft.points[inside] + way[inside])
    draft.points = guarded(draft, goal, shape(draft.points[draft.faces], area, normals), normals, good)


def guarded(draft: Draft, goal: Floats, before: Floats, normals: Floats, good: float) -> Floats:
    """Points moved to a goal, but for those that would make a face worse than both `good` and before."""
    points = goal.copy()
    away = np.ones(len(points), dtype=bool)
    while True:
        corners = points[draft.faces]
        after = shape(corners, area_vectors(corners), normals)
        back = np.unique(draft.faces[after < np.minimum(good, before) - MARGIN])
        back = back[away[back]]
        if back.size == 0:
            return points
        points[back] = draft.points[back]
        away[back] = False
