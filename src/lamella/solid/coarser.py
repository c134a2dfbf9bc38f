"""Bars along polylines with fewer triangles, for views."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.fabrication.flat import ARC_PARTS, outline_points
from lamella.hardware.shape import Sweep, polygon


def coarser_sweep(sweep: Sweep, share: float) -> Sweep:
    """A bar whose polyline has fewer points and whose arcs have fewer parts.

    Parameters
    ----------
    sweep : Sweep
    share : float
        Largest chord error over how far the cross section reaches from its axis, 0 to 1.

    Returns
    -------
    Sweep
        Its arcs are straight parts; no point of the polyline it was made of, and none of the edges beside it, is
        farther off than the chord error.
    """
    reach = float(np.linalg.norm(outline_points(sweep.outline), axis=1).max())
    chord = share * reach
    kept = _kept(sweep.points, sweep.points + reach * sweep.up, chord, closed=sweep.closed)
    return replace(
        sweep,
        outline=_polygon(sweep.outline, chord),
        holes=tuple(_polygon(hole, chord) for hole in sweep.holes),
        points=sweep.points[kept],
        up=sweep.up[kept],
    )


def _polygon(outline: Floats, chord: float) -> Floats:
    """Straight parts of an outline, as few for each arc as keep the chord error, but two."""
    bulge = np.abs(outline[:, 2])
    arcs = bulge > 0
    if not arcs.any():
        return outline
    across = np.linalg.norm(np.roll(outline[:, :2], -1, axis=0) - outline[:, :2], axis=1)[arcs]
    radius = across * (1 + bulge[arcs] ** 2) / (4 * bulge[arcs])
    # a part that turns by t is off its arc by r (1 - cos(t / 2))
    turn = 2 * np.arccos(np.clip(1 - chord / radius, 0.0, 1.0))
    parts = np.ceil(4 * np.arctan(bulge[arcs]) / np.maximum(turn, np.finfo(float).eps)).max()
    return polygon(outline_points(outline, int(np.clip(parts, 2, ARC_PARTS)))[:-1])


def _kept(points: Floats, edge: Floats, chord: float, *, closed: bool) -> Integers:
    """Every so many points of a polyline and its ends: as few as keep the chord error."""
    last = len(points) - 1
    # what closes needs three corners
    step = max(last // 3 if closed else last, 1)
    while step > 1:
        kept = np.unique(np.append(np.arange(0, last, step), last))
        if max(_off(points, kept), _off(edge, kept)) <= chord:
            return kept
        step = 3 * step // 4
    return np.arange(last + 1)


def _off(points: Floats, kept: Integers) -> float:
    """How far points are off the polyline through some of them, at most."""
    part = np.clip(np.searchsorted(kept, np.arange(len(points)), "right") - 1, 0, len(kept) - 2)
    start, along = points[kept[part]], points[kept[part + 1]] - points[kept[part]]
    square = np.maximum((along**2).sum(1), np.finfo(float).tiny)
    share = np.clip(((points - start) * along).sum(1) / square, 0, 1)
    return float(np.linalg.norm(points - start - share[:, None] * along, axis=1).max())
