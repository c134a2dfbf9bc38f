"""Solids between two copies of a flat shape: triangles of the shape with its holes, and the walls along its rims."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import pythoncdt

from lamella.base.arrays import Floats, Integers
from lamella.fabrication.flat import outline_points
from lamella.hardware.item import Item
from lamella.hardware.shape import Prism, Sweep
from lamella.solid.solid import Solid


def shape_triangles(rings: Sequence[Floats]) -> Integers:
    """Triangles of a flat shape between its rings, (f, 3), counter-clockwise.

    Parameters
    ----------
    rings : sequence of (n, 2)
        Corners of its outline and of its holes, not repeated at the end; triangles refer to them one after the other.
    """
    points = np.concatenate(rings)
    edges = []
    start = 0
    for ring in rings:
        index = start + np.arange(len(ring))
        edges.append(np.column_stack([index, np.roll(index, -1)]))
        start += len(ring)
    mesh = pythoncdt.Triangulation(
        pythoncdt.VertexInsertionOrder.AUTO, pythoncdt.IntersectingConstraintEdges.NOT_ALLOWED, 0.0
    )
    mesh.insert_vertices([pythoncdt.V2d(x, y) for x, y in points.tolist()])
    mesh.insert_edges([pythoncdt.Edge(a, b) for a, b in np.concatenate(edges).tolist()])
    mesh.erase_outer_triangles_and_holes()
    return np.asarray(mesh.triangles_array()["vertices"].astype(np.int64))


def between(rings: Sequence[Floats], low: Floats, high: Floats) -> Solid:
    """The solid between two copies of a flat shape.

    Parameters
    ----------
    rings : sequence of (n, 2)
        Outline, counter-clockwise, and holes, clockwise.
    low, high : (v, 3)
        Where the rings' corners, one after the other, lie in either copy, m; seen from `high` the shape is not
        mirrored.
    """
    count = len(low)
    cap = shape_triangles(rings)
    walls = []
    start = 0
    for ring in rings:
        index = start + np.arange(len(ring))
        following = np.roll(index, -1)
        walls.append(np.column_stack([index, following, following + count]))
        walls.append(np.column_stack([index, following + count, index + count]))
        start += len(ring)
    triangles = np.concatenate([cap[:, ::-1], cap + count, *walls])
    return Solid(np.concatenate([low, high]), triangles)


def prism_solid(prism: Prism) -> Solid:
    """A prism in its own axes."""
    rings = [outline_points(prism.outline)[:-1], *(outline_points(hole)[-2::-1] for hole in prism.holes)]
    corners = np.concatenate(rings)
    low, high = (np.column_stack([corners, np.full(len(corners), z)]) for z in (prism.low, prism.high))
    return between(rings, low, high)


def item_solid(item: Item) -> Solid:
    """A piece of hardware in its own axes."""
    return Solid.of([prism_solid(one) if isinstance(one, Prism) else sweep_solid(one) for one in item.shape])


def item_solids(item: Item) -> Iterator[tuple[str, Solid]]:
    """Every piece in its place, with its label."""
    if item.bent:
        for label, bent in zip(item.places.labels, item.bent, strict=True):
            yield label, between(bent.rings, bent.low, bent.high)
        return
    own = item_solid(item)
    for label, vertices in zip(item.places.labels, item.places.world(own.vertices), strict=True):
        yield label, Solid(vertices, own.triangles)


def sweep_solid(sweep: Sweep) -> Solid:
    """A bar along a polyline; its cross sections stand halfway between the pieces that meet."""
    points, closed = sweep.points, sweep.closed
    ahead = np.diff(points, axis=0)
    ahead /= np.linalg.norm(ahead, axis=1)[:, None]
    before = np.concatenate([ahead[-1:] if closed else ahead[:1], ahead])
    behind = np.concatenate([ahead, ahead[:1] if closed else ahead[-1:]])
    along = before + behind
    along /= np.linalg.norm(along, axis=1)[:, None]
    left = np.cross(sweep.up, along)
    left /= np.linalg.norm(left, axis=1)[:, None]
    up = np.cross(along, left)
    # a mitre is longer than the section by 1 / cos of half the turn
    cosine = np.einsum("ij,ij->i", along, before)
    turn = behind - before
    length = np.linalg.norm(turn, axis=1)[:, None]
    side = turn / np.where(length > 0, length, 1.0)
    rings = [outline_points(sweep.outline)[:-1], *(outline_points(hole)[-2::-1] for hole in sweep.holes)]
    section = np.concatenate(rings)
    across = section[:, 0, None] * left[:, None] + section[:, 1, None] * up[:, None]
    across += np.einsum("kvi,ki->kv", across, side)[..., None] * (1 / cosine - 1)[:, None, None] * side[:, None]
    if sweep.cuts is not None:
        for end, normal in zip((0, -1), sweep.cuts, strict=True):
            across[end] -= (across[end] @ normal / (ahead[end] @ normal))[:, None] * ahead[end]
    placed = points[:, None] + across
    count, size = len(points) - closed, len(section)
    triangles = []
    start = 0
    for ring in rings:
        index = start + np.arange(len(ring))
        following = np.roll(index, -1)
        for k in range(len(points) - 1):
            low, high = k * size, (k + 1) % count * size
            triangles.append(np.column_stack([low + index, low + following, high + following]))
            triangles.append(np.column_stack([low + index, high + following, high + index]))
        start += len(ring)
    if not closed:
        cap = shape_triangles(rings)
        triangles += [cap[:, ::-1], cap + (count - 1) * size]
    vertices = placed[:count].reshape(-1, 3)
    return Solid(vertices, np.concatenate(triangles))
