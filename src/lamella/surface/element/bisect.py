"""Curved elements cut finer where it is asked for: longest-edge bisection inside the elements they come from.

A part of an element is an element of the same polynomial, so that nothing of the surface changes. An edge is only cut
together with the longest edges of its triangles, which keeps angles bounded (Rivara, Int. J. Numer. Methods Eng. 20
(1984), 745-756, doi:10.1002/nme.1620200412).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.ties import shortened
from lamella.base.triangle import CORNERS
from lamella.base.vectors import lengths
from lamella.surface.element.connectivity import Connectivity
from lamella.surface.element.places import Places

# rounds of cuts; each halves the longest edges of what is too large
BISECT_ROUNDS_MAX = 60


@dataclass(frozen=True)
class Parts:
    """Triangles inside curved elements.

    Attributes
    ----------
    parent : (m,) int
        Element each lies in.
    corners : (m, 3, 2)
        Local coordinates of its corners there.
    faces : (m, 3) int
        Vertices; those of the elements come first.
    points : (v, 3)
        m.
    loop : (v,) int
        Boundary loop of each vertex, -1 inside.
    """

    parent: Integers
    corners: Floats
    faces: Integers
    points: Floats
    loop: Integers

    def places(self, which: Integers, local: Floats) -> Places:
        """Places of local coordinates (k, 2) in each of some parts (n,), part after part."""
        barycentric = np.column_stack([1 - local.sum(1), local])
        inside = np.matmul(barycentric, self.corners[which])
        return Places(np.repeat(self.parent[which], len(local)), inside.reshape(-1, 2))


def whole(connectivity: Connectivity, nodes: Floats, rim_loop: Integers) -> Parts:
    """Every element as the only part of itself."""
    m, vertices = len(connectivity.faces), int(connectivity.faces.max()) + 1
    loop = np.full(vertices, -1)
    loop[connectivity.rim_nodes[:, [0, -1]]] = rim_loop[:, None]
    return Parts(np.arange(m), np.tile(CORNERS, (m, 1, 1)), connectivity.faces, nodes[:vertices], loop)


def bisect(
    parts: Parts, connectivity: Connectivity, nodes: Floats, too_large: Callable[[Floats, Floats], Booleans]
) -> Parts:
    """Cut parts until none is too large.

    Parameters
    ----------
    parts : Parts
    connectivity, nodes
        Of the elements.
    too_large : callable
        Which triangles are, (m,), from their corners (m, 3, 3), m, and longest edges (m,), m.
    """
    for _ in range(BISECT_ROUNDS_MAX):
        corners = parts.points[parts.faces]
        edges = lengths(corners - np.roll(corners, -1, 1))
        marked = too_large(corners, edges.max(1))
        if not marked.any():
            return parts
        parts = _cut(parts, connectivity, nodes, edges, marked)
    raise ValueError(f"elements are still too large after {BISECT_ROUNDS_MAX} rounds of cuts")


def _cut(parts: Parts, connectivity: Connectivity, nodes: Floats, long: Floats, marked: Booleans) -> Parts:
    """Cut the longest edges of marked triangles, and what that asks of their neighbours."""
    faces, vertices = parts.faces, len(parts.points)
    ends = np.stack([faces, np.roll(faces, -1, 1)], 2)
    keys, edge = np.unique((ends.min(2) * vertices + ends.max(2)).ravel(), return_inverse=True)
    edge = edge.reshape(-1, 3)
    # one order of all edges, the same seen from either triangle
    length = np.zeros(len(keys))
    length[edge] = long
    rank = np.empty(len(keys), np.int64)
    rank[np.lexsort((keys, shortened(length)))] = np.arange(len(keys))
    longest = rank[edge].argmax(1)
    rows = np.arange(len(faces))
    chosen = np.zeros(len(keys), bool)
    chosen[edge[marked, longest[marked]]] = True
    while True:
        touched = chosen[edge].any(1)
        wanted = edge[touched, longest[touched]]
        if chosen[wanted].all():
            break
        chosen[wanted] = True
    # the longest edge first in each triangle
    turn = (longest[:, None] + np.arange(3)) % 3
    faces, edge = faces[rows[:, None], turn], edge[rows[:, None], turn]
    local = parts.corners[rows[:, None], turn]
    cut = chosen[edge]
    middle = (local + np.roll(local, -1, 1)) / 2
    number = np.where(chosen, vertices + np.cumsum(chosen) - 1, -1)
    at_edge = number[edge]

    owner, which = np.nonzero(cut)
    points = np.vstack([parts.points, np.empty((int(chosen.sum()), 3))])
    basis = connectivity.basis.basis(middle[owner, which])
    points[at_edge[owner, which]] = np.einsum("nk,nkc->nc", basis, nodes[connectivity.elements[parts.parent[owner]]])
    loop = np.concatenate([parts.loop, np.full(int(chosen.sum()), -1)])
    alone = np.bincount(edge.ravel(), minlength=len(keys))[edge[owner, which]] == 1
    loop[at_edge[owner, which][alone]] = parts.loop[faces[owner, which][alone]]

    # corners 0, 1, 2 and the middles of the edges 0-1, 1-2, 2-0 as 3, 4, 5
    name = np.concatenate([faces, at_edge], 1)
    place = np.concatenate([local, middle], 1)
    # by the edges that are cut: 0-1 counts 1, 1-2 counts 2, 2-0 counts 4
    children = {
        0: [(0, 1, 2)],
        1: [(0, 3, 2), (3, 1, 2)],
        3: [(0, 3, 2), (3, 1, 4), (3, 4, 2)],
        5: [(0, 3, 5), (3, 2, 5), (3, 1, 2)],
        7: [(0, 3, 5), (3, 2, 5), (3, 1, 4), (3, 4, 2)],
    }
    kind = cut @ [1, 2, 4]
    parent, new_corners, new_faces = [], [], []
    for case, triangles in children.items():
        mine = np.flatnonzero(kind == case)
        for triangle in triangles:
            parent.append(parts.parent[mine])
            new_corners.append(place[mine][:, triangle])
            new_faces.append(name[mine][:, triangle])
    return Parts(np.concatenate(parent), np.concatenate(new_corners), np.concatenate(new_faces), points, loop)
