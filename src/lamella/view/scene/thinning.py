"""Fewer vertices, samples and nodes where a page would be too heavy, with what matters kept."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats, Integers


def clusters(points: Floats, limit: int) -> tuple[Integers, Integers]:
    """One vertex for each occupied cell of a cubic grid, and each vertex's place among those.

    Parameters
    ----------
    points : (n, 3)
    limit : int
        Of vertices; up to it all are kept.
    """
    if len(points) <= limit:
        identity = np.arange(len(points))
        return identity, identity
    low, span = points.min(axis=0), float(np.ptp(points, axis=0).max())
    size = span / np.sqrt(limit)
    while True:
        cells = np.floor((points - low) / size).astype(np.int64)
        side = int(cells.max()) + 1
        keys = (cells[:, 0] * side + cells[:, 1]) * side + cells[:, 2]
        _, first, labels = np.unique(keys, return_index=True, return_inverse=True)
        if len(first) <= limit:
            return first, labels
        size *= max(1.02, np.sqrt(len(first) / limit))


def distinct_triangles(triangles: Integers, count: int) -> Integers:
    """Triangles (f, 3) of `count` vertices without those that have no area and repeated ones; the winding stays."""
    a, b, c = triangles.T
    triangles = triangles[(a != b) & (b != c) & (c != a)]
    if not len(triangles):
        return triangles
    turn = np.argmin(triangles, axis=1)[:, None]
    turned = np.take_along_axis(triangles, (turn + np.arange(3)) % 3, axis=1)
    _, first = np.unique((turned[:, 0] * count + turned[:, 1]) * count + turned[:, 2], return_index=True)
    return np.asarray(turned[np.sort(first)], dtype=np.int64)


def stop_stride(count: int, limit: int) -> int:
    """One of how many nodes of a lamella is kept."""
    return max(-(-count // limit), 1)


def kept_stops(offsets: Integers, limit: int) -> Integers:
    """Indices of all stops, or of every so many of each lamella with its ends."""
    within = np.arange(offsets[-1]) - np.repeat(offsets[:-1], np.diff(offsets))
    keep = within % stop_stride(int(offsets[-1]), limit) == 0
    keep[offsets[1:] - 1] = True
    return np.flatnonzero(keep)


def kept_samples(offsets: Integers, stops: Integers, limit: int) -> Integers:
    """Indices of all samples, or of every so many of each lamella with its ends and some stops.

    Parameters
    ----------
    offsets : (m + 1,) int
        Where the samples of each lamella begin.
    stops : (q,) int
        Samples that are kept.
    limit : int
        Of samples.
    """
    total = int(offsets[-1])
    if total <= limit:
        return np.arange(total)
    stride = -(-total // max(limit - len(stops), 1))
    within = np.arange(total) - np.repeat(offsets[:-1], np.diff(offsets))
    keep = within % stride == 0
    keep[stops] = True
    keep[offsets[1:] - 1] = True
    return np.flatnonzero(keep)


def rim_edges(faces: Integers) -> Integers:
    """Edges (e, 2) of one triangle only, as the triangles (f, 3) run, in the order of their first vertices."""
    pairs = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    count = int(faces.max(initial=0)) + 1
    own, back = pairs[:, 0] * count + pairs[:, 1], pairs[:, 1] * count + pairs[:, 0]
    open_edges = pairs[~np.isin(own, back)]
    return np.asarray(open_edges[np.lexsort((open_edges[:, 1], open_edges[:, 0]))], dtype=np.int64)
