"""The mesh that is being remeshed, and the limits the operations on it share."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.ties import rounded
from lamella.base.vectors import dots, lengths
from lamella.surface.remesh.kernel import kernel
from lamella.surface.remesh.topology import Topology, area_vectors, connect, shape, unit

SPLIT_LENGTH, COLLAPSE_LENGTH = (
    4.0 / 3.0,
    4.0 / 5.0,
)  # in units of the wanted length; the half of a split edge is not collapsed
DRAFT_SHAPE = 0.35  # shape above which an operation may make a triangle worse
BEND = 0.5  # cosine of the angle between two faces above which they count as one piece of surface
EAR = np.deg2rad(75.01)  # a corner sharper than this, which no design draws, is one triangle with two boundary edges
BRIDGE = 0.7  # an inner edge between boundary vertices longer than this many sizes gets a vertex in its middle


class FaceShapes(NamedTuple):
    """Faces of a draft.

    Attributes
    ----------
    area : (m, 3)
        Area vectors, m^2.
    normals : (m, 3)
        Unit normals; a face turned over takes that of its surroundings.
    shape : (m,)
        See `lamella.surface.remesh.topology.shape`.
    """

    area: Floats
    normals: Floats
    shape: Floats


@dataclass
class Draft:
    """The mesh at work.

    Attributes
    ----------
    points : (n, 3)
        Vertices (m).
    faces : (m, 3) int
        Triangles.
    loop : (n,) int
        Boundary loop of a vertex, -1 inside.
    station : (n,)
        Place along the loop in edges of the final boundary; nan inside.
    fixed : (n,) bool
        Boundary vertices that neither move nor vanish.
    size : (n,)
        Wanted edge length (m).
    size_at, nearest : callable
        Size field and closest point of the surface.
    grid : float
        That points are rounded to (m), so that the same start gives the same mesh on every machine.
    """

    points: Floats
    faces: Integers
    loop: Integers
    station: Floats
    fixed: Booleans
    size: Floats
    size_at: Callable[[Floats], Floats]
    nearest: Callable[[Floats], Floats]
    grid: float
    _known: Topology | None = None

    def topology(self) -> Topology:
        """That of the present faces, made anew where these have changed: an operation replaces them."""
        if self._known is None or self._known.faces is not self.faces or self._known.vertices != len(self.points):
            self._known = connect(self.faces, len(self.points))
        return self._known

    @property
    def boundary(self) -> Booleans:
        return self.loop >= 0

    def project(self, points: Floats) -> Floats:
        """Points (k, 3) brought back to the surface, on the grid."""
        return rounded(self.nearest(points), self.grid)

    def append(self, points: Floats, loop: Integers, station: Floats) -> None:
        """More vertices, which no face uses yet."""
        self.points = np.concatenate([self.points, points])
        self.loop = np.concatenate([self.loop, loop])
        self.station = np.concatenate([self.station, station])
        self.fixed = np.concatenate([self.fixed, np.zeros(len(points), dtype=bool)])
        self.size = np.concatenate([self.size, self.size_at(points)])

    def merge(self, removed: Integers, kept: Integers) -> None:
        """Replace vertices by others and drop the faces that vanish."""
        into = np.arange(len(self.points))
        into[removed] = kept
        faces = into[self.faces]
        lost = np.any(faces == faces[:, [1, 2, 0]], axis=1)
        stays = np.ones(len(self.points), dtype=bool)
        stays[removed] = False
        self.faces = (np.cumsum(stays) - 1)[faces[~lost]]
        self.points, self.loop, self.station = self.points[stays], self.loop[stays], self.station[stays]
        self.fixed, self.size = self.fixed[stays], self.size[stays]

    def face_shapes(self) -> FaceShapes:
        """Measured now."""
        fast = kernel()
        if fast:
            n, m = len(self.points), len(self.faces)
            area, normals = np.empty((2, m, 3))
            shapes, room = np.empty(m), np.empty((n, 3))
            fast.call("face_shapes", n, m, self.points, self.faces, BEND, area, normals, shapes, room)
            return FaceShapes(area, normals, shapes)
        area = area_vectors(self.points[self.faces])
        at_vertices = self.vertex_normals(area)
        around = unit(at_vertices[self.faces].sum(axis=1))
        own = unit(area)
        normals = np.where((dots(own, around) > BEND)[:, None], own, around)
        return FaceShapes(area, normals, shape(self.points[self.faces], area, normals))

    def vertex_normals(self, area: Floats) -> Floats:
        """Unit normals at the vertices from the area vectors of the faces, (n, 3)."""
        corner = self.faces.ravel()
        weights = np.repeat(area, 3, axis=0)
        total = [np.bincount(corner, weights[:, i], len(self.points)) for i in range(3)]
        return unit(np.column_stack(total))


def narrow(draft: Draft, one: Integers, other: Integers) -> Booleans:
    """Pairs of boundary vertices so close that an edge between them is better than a vertex, (k,)."""
    across = draft.points[one] - draft.points[other]
    near: Booleans = lengths(across) < BRIDGE * 0.5 * (draft.size[one] + draft.size[other])
    return near


def edge_lengths(points: Floats, ends: Integers) -> Floats:
    return lengths(points[ends[:, 1]] - points[ends[:, 0]])
