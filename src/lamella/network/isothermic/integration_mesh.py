"""Elements to integrate on: those of the surface, with a rosette around each umbilic.

Near an umbilic of order m the isothermic coordinates go like the distance to the power 1 + m / 2. There the surface's
own elements give way to a `lamella.network.isothermic.umbilic_patch`, and are cut finer around it where they are large
beside its size; everywhere else they stay as they are (`lamella.network.isothermic.mesh_layout`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.vectors import diagonal
from lamella.network.isothermic.tangent_plane import TangentPlane
from lamella.surface.element.connectivity import Connectivity
from lamella.surface.element.places import Places
from lamella.surface.element.surface import ElementSurface
from lamella.surface.element.umbilics import Umbilics

# of the surface's size: what is as near to a sharp corner of the rim is at it
RIM_CORNER = 0.015


@dataclass(frozen=True)
class IntegrationMesh:
    """Elements of order 4 on a surface.

    Attributes
    ----------
    connectivity : Connectivity
    nodes : (n, 3)
        m, on the surface.
    places : Places
        Of the nodes on the surface.
    shape : (n, 6)
        Shape operator of the surface at the nodes, 1/m: entries xx, xy, xz, yy, yz, zz.
    normals : (n, 3)
        Unit normals there.
    loop : (v,) int
        Boundary loop of each vertex, -1 inside.
    umbilics : (z,) int
        Vertex of each umbilic; -1: it lies on the boundary.
    radii : (z,)
        Of the rosettes around them, m.
    patch : (m,) int
        Umbilic in whose rosette, or next to it, each element is; -1: it is the surface's own, or a part of one.
    rim_starts : (loops, 3)
        Where each boundary loop begins, m.
    corners : (c,) int
        Vertices at which the rim has a sharp corner.
    """

    connectivity: Connectivity
    nodes: Floats
    places: Places
    shape: Floats
    normals: Floats
    loop: Integers
    umbilics: Integers
    radii: Floats
    patch: Integers
    rim_starts: Floats
    corners: Integers

    def at_corner(self, points: Floats) -> Booleans:
        """Whether points (n, 3) are next to a sharp corner of the rim."""
        return near_any(points, self.nodes[self.corners], RIM_CORNER * diagonal(self.nodes))


def near_any(points: Floats, others: Floats, reach: float) -> Booleans:
    """Which points (n, 3) are nearer than a reach, m, to any of others (k, 3)."""
    if not len(points) or not len(others):
        return np.zeros(len(points), bool)
    return np.asarray(cKDTree(others).query(points)[0] < reach)


def onto_surface(
    mesh: IntegrationMesh, surface: ElementSurface, umbilics: Umbilics, element: Integers, points: Floats
) -> Floats:
    """Points (n, 3) of elements (n,) exactly on the surface, m: those around umbilics are next to it only.

    Their polynomials pass through nodes on the surface, and over edges between its elements.
    """
    result = points.copy()
    patch = mesh.patch[element]
    if not (patch >= 0).any():
        return result
    for number, plane in enumerate(TangentPlane.of(surface, umbilics)):
        mine = np.flatnonzero(patch == number)
        if len(mine):
            result[mine] = plane.up(plane.down(points[mine]), surface)[1]
    return result
