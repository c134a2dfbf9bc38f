"""Places on curved elements and flat triangles between them, finer along the rim than inside."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.triangle import CORNERS
from lamella.surface.element.connectivity import Connectivity, connect
from lamella.surface.element.lagrange import local_faces
from lamella.surface.element.places import Places

# most parts that a piece of the rim, between two of the element's own, is cut into
MOST_PIECES = 256
# where on a piece its bend is taken
_WITHIN = np.linspace(0, 1, 5)


def sampled_places(
    connectivity: Connectivity, nodes: Floats, parts: int, rim_sag: float = np.inf
) -> tuple[Places, Integers]:
    """Every element's edges cut into `parts`, those on the rim into as many as its own bend asks for.

    The mesh has no T-junctions: rim edges have one triangle, which becomes a fan.

    Parameters
    ----------
    connectivity : Connectivity
    nodes : (n, 3)
        m.
    parts : int
    rim_sag : float
        Largest distance of the rim from its chords, m.

    Returns
    -------
    places : Places
        Shared vertices are there once.
    faces : (f, 3) int
        Counter-clockwise about the normal.
    """
    grid = connect(connectivity.faces, int(connectivity.faces.max()) + 1, parts)
    local, faces = grid.basis.nodes, grid.elements[:, local_faces(parts)].reshape(-1, 3)
    first = np.empty(grid.node_count, np.int64)
    first[grid.elements] = np.arange(grid.elements.size).reshape(grid.elements.shape)
    element, at = first // len(local), local[first % len(local)]
    if not np.isfinite(rim_sag):
        return Places(element, at), faces
    pieces = _pieces(connectivity, nodes, parts, rim_sag)
    split = pieces.ravel() > 1
    rim = grid.rim_nodes
    start, end, count = rim[:, :-1].ravel()[split], rim[:, 1:].ravel()[split], pieces.ravel()[split]
    if not len(count):
        return Places(element, at), faces
    # new vertices along each split edge
    edge = np.repeat(np.arange(len(count)), count - 1)
    step = np.arange(len(edge)) - np.repeat(np.cumsum(count - 1) - (count - 1), count - 1) + 1
    which, piece = np.divmod(np.flatnonzero(split)[edge], parts)
    begin = CORNERS[connectivity.rim_edges[which]]
    along = CORNERS[(connectivity.rim_edges[which] + 1) % 3] - begin
    new_at = begin + ((piece + step / count[edge]) / parts)[:, None] * along
    element = np.concatenate([element, connectivity.rim_elements[which]])
    at = np.concatenate([at, new_at])
    # a triangle with one split edge is a fan about the corner opposite; with more, about its middle
    keys = faces.ravel() * grid.node_count + np.roll(faces, -1, 1).ravel()
    ranked = np.argsort(keys)
    half = ranked[np.searchsorted(keys[ranked], start * grid.node_count + end)]
    face, side = np.divmod(half, 3)
    often = np.bincount(face, minlength=len(faces))
    several = np.flatnonzero(often > 1)
    middle = np.full(len(faces), -1)
    middle[several] = len(element) + np.arange(len(several))
    owner = several // parts**2
    element = np.concatenate([element, owner])
    at = np.concatenate([at, _middles(grid.elements[owner], faces[several], local)])
    apex = np.where(often[face] > 1, middle[face], faces[face, (side + 2) % 3])
    offsets = np.cumsum(count - 1) - (count - 1) + grid.node_count
    fans = _fans(start, end, apex, count, offsets)
    # the other sides of a triangle about its middle
    whole = np.column_stack([faces[several], np.roll(faces[several], -1, 1)])
    left = np.ones((len(faces), 3), bool)
    left[face, side] = False
    rest = [np.column_stack([whole[:, k], whole[:, 3 + k], middle[several]])[left[several, k]] for k in range(3)]
    return Places(element, at), np.concatenate([faces[often == 0], fans, *rest])


def _pieces(connectivity: Connectivity, nodes: Floats, parts: int, rim_sag: float) -> Integers:
    """Parts each piece of the rim's edges has to be cut into, (b, parts).

    Over a step of the parameter a curve c is c_perp'' step^2 / 8 away from its chord, c_perp'' being the part of its
    second derivative across it.
    """
    t = ((np.arange(parts)[:, None] + _WITHIN) / parts).ravel()
    begin = CORNERS[connectivity.rim_edges]
    along = (CORNERS[(connectivity.rim_edges + 1) % 3] - begin)[:, None, :, None]
    local = (begin[:, None] + t[:, None] * along[:, :, :, 0]).reshape(-1, 2)
    corners = nodes[connectivity.elements[connectivity.rim_elements]]
    shape = (len(begin), len(t), -1)
    _, x, y, xx, xy, yy = (
        np.matmul(f.reshape(shape), corners)[:, :, None] for f in connectivity.basis.second_jet(local)
    )
    p, q = along[:, :, :1], along[:, :, 1:]
    first = (p * x + q * y)[:, :, 0]
    second = (p * p * xx + 2 * p * q * xy + q * q * yy)[:, :, 0]
    first /= np.maximum(np.linalg.norm(first, axis=2, keepdims=True), 1e-300)
    second -= (second * first).sum(2, keepdims=True) * first
    bend = np.linalg.norm(second, axis=2).reshape(len(begin), parts, -1).max(2)
    return np.asarray(np.clip(np.ceil(np.sqrt(bend / (8 * rim_sag)) / parts), 1, MOST_PIECES), np.int64)


def _middles(elements: Integers, faces: Integers, local: Floats) -> Floats:
    """Local coordinates of the middles of small triangles in their elements, (t, 2)."""
    index = (elements[:, None, :] == faces[:, :, None]).argmax(2)
    return np.asarray(local[index].mean(1))


def _fans(start: Integers, end: Integers, apex: Integers, count: Integers, offsets: Integers) -> Integers:
    """Triangles from the pieces of each edge to its apex."""
    edge = np.repeat(np.arange(len(count)), count)
    step = np.arange(len(edge)) - np.repeat(np.cumsum(count) - count, count)
    low = np.where(step == 0, start[edge], offsets[edge] + step - 1)
    high = np.where(step == count[edge] - 1, end[edge], offsets[edge] + step)
    return np.column_stack([low, high, apex[edge]])
