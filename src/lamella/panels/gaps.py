"""Outlines moved inwards by half a gap, so that neighbouring panels are a gap apart."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers

LEAST_SIDE = 1e-3
"""m; a panel that would have a shorter side is left out."""


def inset(corner: Floats, normals: Floats | None, distance: float) -> Floats:
    """Corners moved inwards, with all sides by the same distance.

    Parameters
    ----------
    corner : (q, n, 2) or (q, n, 3)
        Counter-clockwise, m.
    normals : (q, n, 3) or None
        Unit normals at the sides, in space.
    distance : float
        m.
    """
    along = np.roll(corner, -1, axis=1) - corner
    along = along / np.maximum(np.linalg.norm(along, axis=2), np.finfo(float).tiny)[:, :, None]
    if normals is None:
        inwards = np.stack([-along[..., 1], along[..., 0]], axis=2)
    else:
        inwards = np.cross(normals, along)
        inwards = inwards / np.linalg.norm(inwards, axis=2)[:, :, None]
    before = np.roll(inwards, 1, axis=1)
    cosine = np.einsum("qni,qni->qn", inwards, before)
    return np.asarray(corner + distance * (inwards + before) / np.maximum(1 + cosine, 1e-9)[:, :, None])


def has_room(corner: Floats, distance: float) -> Booleans:
    """Whether every side of polygons (q, n, d) that are moved inwards keeps its direction and some length, (q,)."""
    return np.asarray(_left(corner, distance).min(axis=1) >= LEAST_SIDE)


def shortest_side(corner: Floats, distance: float) -> Integers:
    """The side of each polygon (q, n, d) that is left shortest when all are moved inwards, (q,)."""
    # to a micrometre: the first of equal ones
    return np.asarray(np.round(_left(corner, distance), 6).argmin(axis=1))


def largest_distance(corner: Floats) -> float:
    """The largest distance by which all of some polygons (q, n, d) can be moved inwards, m; 0 where there is none."""
    sides, shrink = _sides(corner)
    with np.errstate(divide="ignore"):
        most = np.where(shrink > 0, (sides - LEAST_SIDE) / shrink, np.inf)
    return max(float(most.min(initial=np.inf)), 0.0)


def _left(corner: Floats, distance: float) -> Floats:
    sides, shrink = _sides(corner)
    return sides - distance * shrink


def _sides(corner: Floats) -> tuple[Floats, Floats]:
    """Lengths of the sides, and by how much each loses of it for each metre inwards, (q, n) each."""
    along = np.roll(corner, -1, axis=1) - corner
    sides = np.linalg.norm(along, axis=2)
    unit = along / np.maximum(sides, np.finfo(float).tiny)[:, :, None]
    # tan of half the turning at each corner: the cotangent of half its angle
    cosine = np.clip(np.einsum("qni,qni->qn", unit, np.roll(unit, 1, axis=1)), -1, 1)
    half = np.sqrt((1 - cosine) / np.maximum(1 + cosine, 1e-12))
    return sides, half + np.roll(half, -1, axis=1)
