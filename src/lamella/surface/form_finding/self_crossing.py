"""Whether a surface passes through itself, and where.

Newton's method knows nothing of it: a film in a boundary that winds may cross itself as Enneper's surface does. The
elements are cut into flat facets; surfaces that cross have an edge of a facet that pierces another facet. Pairs of
edges and facets are found by two trees of boxes, gone down side by side a level at a time.
"""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.surface.form_finding.film import Film
from lamella.surface.form_finding.meshing import facets

# facets along the edge of an element
FACET_PARTS = 2
# of an edge's length and of a facet's height: what is nearer to the rim of either is none of it
RIM_MARGIN = 1e-9


def self_crossing(film: Film) -> Floats | None:
    """Points (n, 3) where a film passes through itself, m, or None."""
    mesh = facets(film, FACET_PARTS)
    points, faces = mesh.points, mesh.faces
    sides = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), 1)
    edges = np.unique(sides, axis=0)
    edge, face = _overlapping(points[edges], points[faces])
    apart = (edges[edge][:, :, None] != faces[face][:, None, :]).all((1, 2))
    edge, face = edge[apart], face[apart]
    start, end = points[edges[edge, 0]], points[edges[edge, 1]]
    a, b, c = (points[faces[face, k]] for k in range(3))
    # Moeller and Trumbore, J. Graphics Tools 2 (1997), 21-28
    way, one, other = end - start, b - a, c - a
    across = np.cross(way, other)
    volume = (one * across).sum(1)
    volume = np.where(np.abs(volume) < 1e-300, np.nan, volume)
    off = start - a
    u = (off * across).sum(1) / volume
    beside = np.cross(off, one)
    v = (way * beside).sum(1) / volume
    share = (other * beside).sum(1) / volume
    inside = (np.minimum(np.minimum(u, v), 1 - u - v) > RIM_MARGIN) & (np.abs(share - 0.5) < 0.5 - RIM_MARGIN)
    if not inside.any():
        return None
    return np.asarray(start[inside] + share[inside, None] * way[inside])


def _overlapping(first: Floats, second: Floats) -> tuple[Integers, Integers]:
    """Pairs of simplices, of vertices (n, k, 3) and (m, l, 3), whose boxes overlap."""
    depth = int(np.ceil(np.log2(max(len(first), len(second), 2))))
    (order_a, boxes_a), (order_b, boxes_b) = _tree(first, depth), _tree(second, depth)
    a = b = np.zeros(1, np.int64)
    for (low_a, high_a), (low_b, high_b) in zip(boxes_a, boxes_b, strict=True):
        meet = ((low_a[a] <= high_b[b]) & (low_b[b] <= high_a[a])).all(1)
        a, b = a[meet], b[meet]
        if len(low_a) < 2**depth:
            a, b = np.concatenate([2 * a, 2 * a, 2 * a + 1, 2 * a + 1]), np.tile(np.concatenate([2 * b, 2 * b + 1]), 2)
    return order_a[a], order_b[b]


def _tree(corners: Floats, depth: int) -> tuple[Integers, list[tuple[Floats, Floats]]]:
    """Order of the leaves, and the boxes (low, high) of every level from the root; missing leaves are empty boxes."""
    count = 2**depth
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    low[: len(corners)], high[: len(corners)] = corners.min(1), corners.max(1)
    middle = np.full((count, 3), np.inf)
    middle[: len(corners)] = low[: len(corners)] + high[: len(corners)]
    order = np.arange(count)[None]
    while order.shape[1] > 1:
        places = middle[order]
        finite = np.isfinite(places)
        extent = np.where(finite, places, -np.inf).max(1) - np.where(finite, places, np.inf).min(1)
        axis = np.argmax(extent, axis=1)
        along = np.take_along_axis(places, axis[:, None, None], 2)[..., 0]
        order = np.take_along_axis(order, np.argsort(along, axis=1, kind="stable"), 1).reshape(2 * len(order), -1)
    order = order.ravel()
    levels = [(low[order], high[order])]
    while len(levels[0][0]) > 1:
        low, high = levels[0]
        levels.insert(0, (np.minimum(low[::2], low[1::2]), np.maximum(high[::2], high[1::2])))
    return order, levels
