"""Elements to integrate on: those of the surface, graded towards its umbilics, which become vertices.

Near an umbilic of order m the isothermic coordinates go like the distance to the power 1 + m / 2; polynomials follow
that only where the elements shrink with the distance.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from lamella.surface.element.connectivity import Connectivity, connect
from lamella.surface.element.lagrange import local_faces
from lamella.surface.element.placing import place_nodes
from lamella.surface.element.remesh import TriangleMesh, remesh
from lamella.surface.element.rim import element_rims
from lamella.surface.element.size_field import SizeField
from lamella.surface.element.surface import ElementSurface
from lamella.surface.element.tangent_planes import TangentPlanes
from lamella.surface.element.umbilics import Umbilics
from lamella.surface.points import Floats

Integers = NDArray[np.int64]

# size of the elements at an umbilic over the surface's, and its growth with the distance
LEAST, GROWTH = 1e-3, 0.25
# an umbilic this near to the boundary, over the surface's size, is on it: no loop runs around it
ON_RIM, RIM_SAMPLES = 2e-3, 2000
# entries of a symmetric matrix that are kept
ROWS, COLUMNS = np.array([0, 0, 0, 1, 1, 2]), np.array([0, 1, 2, 1, 2, 2])
# flat triangles along an element's edge that the new elements start from
FACETS = 2


@dataclass(frozen=True)
class NetMesh:
    """Elements of order 4 on a surface.

    Attributes
    ----------
    connectivity : Connectivity
    nodes : (n, 3)
        m, on the surface.
    shape : (n, 6)
        Shape operator of the surface at the nodes, 1/m: entries xx, xy, xz, yy, yz, zz.
    loop : (v,) int
        Boundary loop of each vertex, -1 inside.
    umbilics : (z,) int
        Vertex of each umbilic; -1: it lies on the boundary.
    """

    connectivity: Connectivity
    nodes: Floats
    shape: Floats
    loop: Integers
    umbilics: Integers


def make_net_mesh(surface: ElementSurface, umbilics: Umbilics) -> NetMesh:
    """Elements graded towards the umbilics of a surface."""
    connectivity = surface.connectivity
    faces = connectivity.faces
    corners = surface.nodes[faces]
    edge = np.linalg.norm(corners - np.roll(corners, 1, 1), axis=2).mean(1)
    size = float(np.linalg.norm(np.ptp(surface.nodes, axis=0)))
    field = SizeField(corners.mean(1), edge)

    def wanted(points: Floats) -> Floats:
        result = field(points)
        for zero in umbilics.position:
            result = np.minimum(result, LEAST * size + GROWTH * np.linalg.norm(points - zero, axis=1))
        return result

    rims = element_rims(connectivity, surface.nodes, surface.rim_loop)
    grid = connect(faces, int(faces.max()) + 1, FACETS)
    points = np.empty((grid.node_count, 3))
    points[grid.elements] = np.matmul(connectivity.basis.basis(grid.basis.nodes), corners_of(surface))
    loop, parameter = np.full(grid.node_count, -1), np.full(grid.node_count, np.nan)
    start = np.full(int(faces.max()) + 1, np.nan)
    for index, rim in enumerate(rims):
        start[rim.vertices] = rim.starts
        loop[grid.rim_nodes[surface.rim_loop == index]] = index
    rim_nodes = grid.rim_nodes
    begin, end = start[rim_nodes[:, 0]], start[rim_nodes[:, -1]]
    parameter[rim_nodes] = (begin[:, None] + ((end - begin) % 1)[:, None] * np.arange(FACETS + 1) / FACETS) % 1
    facets = TriangleMesh(points, grid.elements[:, local_faces(FACETS)].reshape(-1, 3), loop, parameter)
    mesh = remesh(facets, size=wanted, project=TangentPlanes(connectivity, surface.nodes), rims=rims)
    vertices = mesh.points.copy()
    inner = np.flatnonzero(mesh.loop < 0)
    along = np.concatenate([rim.at(np.arange(RIM_SAMPLES) / RIM_SAMPLES) for rim in rims])
    to_rim, _ = cKDTree(along).query(umbilics.position.reshape(-1, 3))
    at = np.full(len(umbilics.orders), -1)
    for number in np.flatnonzero(to_rim > ON_RIM * size).tolist():
        zero = umbilics.position[number]
        at[number] = inner[np.linalg.norm(vertices[inner] - zero, axis=1).argmin()]
        vertices[at[number]] = zero
    new = connect(mesh.faces, len(vertices), 4)
    nodes = place_nodes(new, vertices, mesh.loop, mesh.parameter, rims)
    places, nodes = surface.closest(nodes)
    operator = surface.at(places).shape_operator
    return NetMesh(new, nodes, operator[:, ROWS, COLUMNS], mesh.loop, at)


def corners_of(surface: ElementSurface) -> Floats:
    """Nodes of each element, (m, k, 3)."""
    return surface.nodes[surface.connectivity.elements]
