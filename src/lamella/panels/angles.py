"""Angles of panels: at their corners, and between neighbours across a common side."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.panels.polygons import Polygons


def corner_angles(points: Floats, polygons: Polygons) -> Floats:
    """Angle between the two sides at each corner, with points (n, 3) at the nodes, degrees, (e,)."""
    following = polygons.following()
    here, after = points[polygons.nodes], points[polygons.nodes[following]]
    onwards = after - here
    back = np.empty_like(onwards)
    back[following] = -onwards
    across = np.linalg.norm(np.cross(onwards, back), axis=1)
    return np.asarray(np.degrees(np.arctan2(across, np.einsum("ij,ij->i", onwards, back))))


def sides_across(polygons: Polygons) -> Integers:
    """For the side that begins at each corner the one that runs back along it, by the corner it begins at, (e,).

    -1 where there is no polygon across.
    """
    tails, heads = polygons.nodes, polygons.nodes[polygons.following()]
    size = int(tails.max(initial=0)) + 1
    keys = tails * size + heads
    order = np.argsort(keys, kind="stable")
    at = np.minimum(np.searchsorted(keys[order], heads * size + tails), len(keys) - 1)
    return np.asarray(np.where(keys[order][at] == heads * size + tails, order[at], -1))


def kink_angles(points: Floats, polygons: Polygons, normals: Floats, across: Integers) -> Floats:
    """Angle between the planes on either side, degrees, (e,): positive on a ridge seen from the normals' side.

    Parameters
    ----------
    points : (n, 3)
        At the nodes, m.
    polygons : Polygons
    normals : (e, 3)
        Unit normals of the planes at each side.
    across : (e,) int
        As `sides_across` gives it; the angle is nan where there is none.
    """
    along = points[polygons.nodes[polygons.following()]] - points[polygons.nodes]
    along = along / np.maximum(np.linalg.norm(along, axis=1), np.finfo(float).tiny)[:, None]
    other = normals[np.maximum(across, 0)]
    sine = np.einsum("ij,ij->i", np.cross(normals, other), along)
    angle = np.degrees(np.arctan2(sine, np.einsum("ij,ij->i", normals, other)))
    return np.where(across >= 0, angle, np.nan)
