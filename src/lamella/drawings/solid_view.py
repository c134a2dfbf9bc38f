"""Solids drawn as they are seen: nearer ones over those behind them, edges where a surface turns."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.drawings.clipping import between_uprights
from lamella.drawings.page import Page
from lamella.drawings.view import View
from lamella.solid.plane_cuts import cross_section, part_behind
from lamella.solid.solid import Solid

CREASE = np.cos(np.radians(40.0))
"""Faces that turn by more show an edge; a hexagon does, the facets of a round bar do not."""
WHITE, CUT = 1.0, 0.72
"""Greys of what is seen and of what is cut."""


def draw_seen(page: Page, view: View, solids: Sequence[Solid], pen: str = "thin") -> None:
    """Draw solids, those farthest away first.

    Parameters
    ----------
    page : Page
    view : View
        Of points in space; what is nearer lies towards right x up.
    solids : sequence of Solid
    pen : str
        Of their edges.
    """
    towards = np.cross(*view.axes)
    near = [float((solid.vertices @ towards).max()) for solid in solids]
    for k in np.argsort(np.round(near, 9), kind="stable").tolist():
        _draw_one(page, view, solids[k], towards, pen)


def draw_section(
    page: Page, view: View, seen: Sequence[Solid], cut: Sequence[Solid], point: Floats, reach: float
) -> None:
    """Draw what lies behind a plane across the view, and what the plane cuts in grey.

    Parameters
    ----------
    page : Page
    view : View
    seen : sequence of Solid
        May be open.
    cut : sequence of Solid
        Closed.
    point : (3,)
        Of the plane, m.
    reach : float
        How far from it to the right and to the left a cut is shown, m.
    """
    towards = np.cross(*view.axes)
    behind = [part_behind(solid, point, towards) for solid in seen]
    draw_seen(page, view, [solid for solid in behind if len(solid.triangles)])
    middle, away = float(view.place(point)[0]), reach * view.mm
    for solid in cut:
        placed = [view.place(loop) for loop in cross_section(solid, point, towards)]
        rings = [ring for ring in (between_uprights(one, middle - away, middle + away) for one in placed) if len(ring)]
        if rings:
            page.shape(rings, CUT)
            for ring in rings:
                page.line(ring, "medium", closed=True)


def within(solid: Solid, centre: Floats, axes: Floats, reach: Floats) -> Solid:
    """What of a solid lies in a box, open where it was cut.

    Parameters
    ----------
    solid : Solid
    centre : (3,)
        m.
    axes : (3, 3)
        Rows: unit vectors along the box's edges.
    reach : (3,)
        Half of the box's size, m; infinite where it has no end.
    """
    for axis, length in zip(axes, reach.tolist(), strict=True):
        if length == np.inf:
            continue
        for way in (axis, -axis):
            if not len(solid.triangles):
                return solid
            solid = part_behind(solid, centre + length * way, way)
    return solid


def _draw_one(page: Page, view: View, solid: Solid, towards: Floats, pen: str) -> None:
    a, b, c = np.moveaxis(solid.vertices[solid.triangles], 1, 0)
    normals = np.cross(b - a, c - a)
    length = np.linalg.norm(normals, axis=1)
    facing = normals @ towards > 1e-6 * np.maximum(length, 1e-300)
    triangles = solid.triangles[facing]
    if not len(triangles):
        return
    units = normals[facing] / length[facing, None]
    edges = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1).reshape(-1, 2)
    owner = np.repeat(np.arange(len(triangles)), 3)
    low, high = edges.min(axis=1), edges.max(axis=1)
    key = low * len(solid.vertices) + high
    order = np.argsort(key, kind="stable")
    same = key[order][1:] == key[order][:-1]
    first, second = order[:-1][same], order[1:][same]
    creased = np.einsum("ij,ij->i", units[owner[first]], units[owner[second]]) < CREASE
    alone = np.ones(len(key), bool)
    alone[first] = alone[second] = False
    placed = view.place(solid.vertices)
    rings = [placed[loop] for loop in _rings(edges[alone])]
    if rings:
        page.shape(rings, WHITE, even_odd=False)
        for ring in rings:
            page.line(ring, pen, closed=True)
    for edge in edges[first[creased]].tolist():
        page.line(placed[edge], pen)


def _rings(edges: Integers) -> list[Integers]:
    """Closed chains of directed edges; where several go on from a corner, the first one does."""
    following: dict[int, list[int]] = {}
    for start, end in edges.tolist():
        following.setdefault(start, []).append(end)
    rings = []
    for start in edges[:, 0].tolist():
        while following.get(start):
            ring, at = [start], following[start].pop(0)
            while at != start and following.get(at):
                ring.append(at)
                at = following[at].pop(0)
            rings.append(np.array(ring))
    return rings
