"""Closed meshes cut by a plane: the part behind it, and the cross section."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.solid.solid import Solid

OFF_PLANE = 1e-9
"""m: corners nearer to the plane count as lying behind it, this far: no triangle lies in it."""


def part_behind(solid: Solid, point: Floats, normal: Floats) -> Solid:
    """What of a mesh lies behind a plane; open where it was cut.

    Parameters
    ----------
    solid : Solid
    point, normal : (3,)
        A point of the plane, m, and its unit normal, which points away from what is kept.
    """
    heights = _heights(solid, point, normal)
    above = heights > 0
    inside = ~above[solid.triangles]
    count = inside.sum(axis=1)
    if (count == 3).all():
        return solid
    alone, pair = (_turned(solid.triangles[count == n], inside[count == n], single=n == 1) for n in (1, 2))
    # cut edges from the first corner, which is alone on its side; a cut edge has one new vertex for both its triangles
    edges = np.concatenate([alone[:, :2], alone[:, ::2], pair[:, :2], pair[:, ::2]])
    unique, which = np.unique(np.sort(edges, axis=1), axis=0, return_inverse=True)
    first, second, third, fourth = np.split(
        len(solid.vertices) + which.ravel(), np.cumsum([len(alone), len(alone), len(pair)])
    )
    kept = [
        solid.triangles[count == 3],
        np.column_stack([alone[:, 0], first, second]),
        np.column_stack([third, pair[:, 1], pair[:, 2]]),
        np.column_stack([third, pair[:, 2], fourth]),
    ]
    vertices = np.concatenate([solid.vertices, _crossing(solid.vertices, heights, *unique.T)])
    return Solid(vertices, np.concatenate(kept))


def cross_section(solid: Solid, point: Floats, normal: Floats) -> list[Floats]:
    """Closed polygons (n, 3) in which a plane cuts a closed mesh, m.

    Seen against the normal outer ones are counter-clockwise, those of holes clockwise.

    Parameters
    ----------
    solid : Solid
    point, normal : (3,)
        A point of the plane, m, and its unit normal.
    """
    heights = _heights(solid, point, normal)
    above = heights[solid.triangles] > 0
    count = above.sum(axis=1)
    cut = (count == 1) | (count == 2)
    # each cut triangle goes from the edge where its border comes up through the plane to that where it goes down
    corners, up = solid.triangles[cut], above[cut]
    following, then = np.roll(corners, -1, axis=1), np.roll(up, -1, axis=1)
    rises, falls = np.argmax(~up & then, axis=1), np.argmax(up & ~then, axis=1)
    rows = np.arange(len(corners))
    rising = np.stack([corners[rows, rises], following[rows, rises]], axis=1)
    falling = np.stack([following[rows, falls], corners[rows, falls]], axis=1)
    size = len(solid.vertices)
    begin, end = rising[:, 0] * size + rising[:, 1], falling[:, 0] * size + falling[:, 1]
    loops = _loops(falling, dict(zip(end.tolist(), begin.tolist(), strict=True)), size)
    return [_crossing(solid.vertices, heights, *loop.T) for loop in loops]


def _heights(solid: Solid, point: Floats, normal: Floats) -> Floats:
    """Of the vertices over the plane, m; none lies in it."""
    heights = (solid.vertices - point) @ normal
    return np.asarray(np.where(np.abs(heights) < OFF_PLANE, -OFF_PLANE, heights))


def _turned(triangles: Integers, inside: np.ndarray, *, single: bool) -> Integers:
    """Triangles turned so that the corner that is alone on its side comes first."""
    alone = np.argmax(inside == single, axis=1)
    return np.asarray(np.take_along_axis(triangles, (alone[:, None] + np.arange(3)) % 3, axis=1))


def _crossing(vertices: Floats, heights: Floats, start: Integers, end: Integers) -> Floats:
    """Where edges go through the plane, (n, 3), m."""
    share = heights[start] / (heights[start] - heights[end])
    return np.asarray(vertices[start] + share[:, None] * (vertices[end] - vertices[start]))


def _loops(edges: Integers, following: dict[int, int], size: int) -> list[Integers]:
    """Closed chains of cut edges, each as rows of two vertices."""
    left = dict(following)
    loops = []
    for first in (edges[:, 0] * size + edges[:, 1]).tolist():
        if first not in left:
            continue
        chain, at = [first], left.pop(first)
        while at != first:
            chain.append(at)
            at = left.pop(at)
        keys = np.array(chain)
        loops.append(np.column_stack([keys // size, keys % size]))
    return loops
