"""How far corners of a panel are from lying in a plane.

The plane of a polygon has the direction of its vector area and goes halfway between its highest and lowest corner; for
a quad it is parallel to both diagonals and halfway between them. A panel is out of plane by the distance between its
highest and lowest corner, for a quad that of its diagonals. Four corners of a surface z = tg x y, an l apart, are out
of plane by l^2 tg / 2, and the fourth is off the plane of the other three by l^2 tg: by that a plate held at three
corners has to be pulled at the fourth to be bent cold.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.ties import MARGIN
from lamella.panels.polygons import Polygons


@dataclass(frozen=True, eq=False)
class Planes:
    """The planes of polygons.

    Attributes
    ----------
    origins : (p, 3)
        Mean of the corners, moved onto the plane, m.
    axes : (p, 3, 3)
        Rows: x along the projected first side, y, and the normal z.
    heights : (e,)
        Of the corners over the plane, m.
    areas : (p,)
        Size of the vector area, that of the projection onto the plane, m2.
    out_of_plane : (p,)
        Highest less lowest corner, m.
    warps : (p,)
        Distance of a corner of a quad from the plane of the three others, the harmonic mean of its four corners', m; 0
        for triangles, and nan where there are more than four corners.
    """

    origins: Floats
    axes: Floats
    heights: Floats
    areas: Floats
    out_of_plane: Floats
    warps: Floats


def planes_of(points: Floats, polygons: Polygons) -> Planes:
    """The planes of polygons with points (n, 3) at the nodes, m."""
    count = len(polygons)
    origins, axes = np.zeros((count, 3)), np.zeros((count, 3, 3))
    heights, areas = np.zeros(len(polygons.nodes)), np.zeros(count)
    spread, warps = np.zeros(count), np.full(count, np.nan)
    for some, at in polygons.by_size():
        corner = points[polygons.nodes[at]]
        middle = corner.mean(axis=1)
        around = corner - middle[:, None]
        vector = np.cross(around, np.roll(around, -1, axis=1)).sum(axis=1) / 2
        size = np.linalg.norm(vector, axis=1)
        normal = vector / np.maximum(size, np.finfo(float).tiny)[:, None]
        height = np.einsum("pni,pi->pn", around, normal)
        level = (height.max(axis=1) + height.min(axis=1)) / 2
        side = corner[:, 1] - corner[:, 0]
        x = side - np.einsum("pi,pi->p", side, normal)[:, None] * normal
        x /= np.linalg.norm(x, axis=1)[:, None]
        origins[some], axes[some] = middle + level[:, None] * normal, np.stack([x, np.cross(normal, x), normal], axis=1)
        heights[at], areas[some] = height - level[:, None], size
        spread[some] = height.max(axis=1) - height.min(axis=1)
        if at.shape[1] <= 4:
            warps[some] = _warp(corner)
    return Planes(origins, axes, heights, areas, spread, warps)


def _warp(corner: Floats) -> Floats:
    """Mean distance of a corner from the plane of the three others, of corners (q, 3 or 4, 3), (q,) m."""
    if corner.shape[1] == 3:
        return np.zeros(len(corner))
    a, b, c, d = corner.transpose(1, 0, 2)
    volume = np.abs(np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a))
    # twice the areas of the four triangles of three corners
    faces = [np.linalg.norm(np.cross(q - p, r - p), axis=1) for p, q, r in ((a, b, c), (b, c, d), (c, d, a), (d, a, b))]
    return np.asarray(volume / np.maximum(np.mean(faces, axis=0), np.finfo(float).tiny))


def shorter_diagonal(corner: Floats) -> Integers:
    """For quads (q, 4, 3) 1 where the diagonal from corner 1 is the shorter one by more than rounding, else 0, (q,)."""
    first, second = (np.linalg.norm(corner[:, k] - corner[:, k + 2], axis=1) for k in (0, 1))
    return np.asarray(second < first * (1 - MARGIN), np.int64)
