"""Elements split along lines that pass them: the same surface, with edges on the lines.

Parts are straight in their element's own local coordinates, so that all polynomials on it are theirs as well.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pythoncdt
from numpy.typing import NDArray

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.triangle import CORNERS
from lamella.network.isothermic.integration_mesh import IntegrationMesh
from lamella.network.isothermic.straight_cuts import CrossedError
from lamella.network.isothermic.straight_walk import FlatTriangles, share_of_edge
from lamella.network.isothermic.tight_lines import Course
from lamella.surface.element.connectivity import connect
from lamella.surface.element.lagrange import EDGES
from lamella.surface.element.places import Places
from lamella.surface.element.surface import ElementSurface

# a place of a line inside an element is one of its vertices where it is as far as this from the edges
SPLIT_INSIDE = 0.08


@dataclass(frozen=True)
class Split:
    """Elements with their parts instead of those that lines pass.

    Attributes
    ----------
    mesh : IntegrationMesh
    parent : (m,) int
        The element that each is, or is part of.
    corners : (m, 3, 2)
        Local coordinates of its corners there.
    cut : (m, 3) bool
        Local edges that lie on the lines.
    """

    mesh: IntegrationMesh
    parent: Integers
    corners: Floats
    cut: Booleans

    def restricted(self, values: NDArray[np.inexact]) -> NDArray[np.inexact]:
        """Values (..., m, k) at the nodes of the parts, of polynomials with values (..., m', k) on whole elements."""
        basis = self.mesh.connectivity.basis
        result = values[..., self.parent, :].copy()
        part = np.flatnonzero((self.corners != CORNERS).any((1, 2)))
        local = _inside(self.corners[part], basis.nodes)
        shapes = basis.basis(local.reshape(-1, 2)).reshape(len(part), len(basis.nodes), -1)
        result[..., part, :] = np.einsum("pnk,...pk->...pn", shapes, values[..., self.parent[part], :])
        return result

    def inherited(self, of_edges: Integers) -> Integers:
        """What is known of the elements' edges (m', 3), of those of the parts on them, (m, 3); 0 inside."""
        barycentric = np.concatenate([1 - self.corners.sum(2, keepdims=True), self.corners], 2)
        result = np.zeros((len(self.parent), 3), of_edges.dtype)
        for local, ends in enumerate(EDGES):
            for edge in range(3):
                # an edge is where the third coordinate is 0
                on = (barycentric[:, ends, (edge + 2) % 3] == 0).all(1)
                result[on, local] = of_edges[self.parent[on], edge]
        return result


@dataclass
class _Vertices:
    """New vertices as they are made; those on edges have one number from both sides."""

    first: int
    on_edges: dict[tuple[int, int, int], tuple[int, float]]
    loops: list[int]

    def new(self, loop: int) -> int:
        self.loops.append(loop)
        return self.first + len(self.loops) - 1


def split_elements(flat: FlatTriangles, courses: list[Course], surface: ElementSurface) -> Split:
    """The elements with edges along lines.

    Raises
    ------
    CrossedError
        Lines cross each other, or touch.
    """
    mesh = flat.iso.mesh
    faces = mesh.connectivity.faces
    vertices = _Vertices(len(mesh.loop), {}, [])
    inner: dict[int, dict[int, tuple[float, float]]] = {}
    pieces: dict[int, list[tuple[int, int]]] = {}
    on_edge: dict[tuple[int, int], list[tuple[float, int]]] = {}
    for course in courses:
        _add(flat, course, vertices, inner, pieces, on_edge)
    touched = sorted(pieces)
    kept = np.ones(len(faces), bool)
    kept[touched] = False
    parents, corners, new_faces = [np.flatnonzero(kept)], [np.tile(CORNERS, (kept.sum(), 1, 1))], [faces[kept]]
    for element in touched:
        edges = [sorted(on_edge.get((element, edge), [])) for edge in range(3)]
        names, local = _outline(faces[element], edges)
        own = inner.get(element, {})
        local_of = np.array([*local, *own.values()])
        name = np.array([*names, *own])
        triangles = _triangulated(local_of, len(names), _numbered(name, pieces[element]))
        parents.append(np.full(len(triangles), element))
        corners.append(local_of[triangles])
        new_faces.append(name[triangles])
    parent, corner = np.concatenate(parents), np.concatenate(corners)
    face = np.concatenate(new_faces)
    on_lines = np.array(sorted({(min(a, b), max(a, b)) for some in pieces.values() for a, b in some}))
    count = vertices.first + len(vertices.loops)
    ends = np.stack([face[:, edge] for edge in EDGES], 1)
    cut = np.isin(ends.min(2) * count + ends.max(2), on_lines @ [count, 1])
    split = Split(mesh, parent, corner, cut)
    return replace(split, mesh=_fields(split, face, np.append(mesh.loop, vertices.loops), surface))


def _add(
    flat: FlatTriangles,
    course: Course,
    vertices: _Vertices,
    inner: dict[int, dict[int, tuple[float, float]]],
    pieces: dict[int, list[tuple[int, int]]],
    on_edge: dict[tuple[int, int], list[tuple[float, int]]],
) -> None:
    """A line's vertices on the edges of elements and inside, and its pieces in each element."""
    connectivity = flat.iso.mesh.connectivity
    barycentric = np.column_stack([1 - course.local.sum(1), course.local])
    before = course.begin if course.begin >= 0 else -1
    waiting: list[tuple[float, tuple[float, float]]] = []
    for k, (here, edge) in enumerate(zip(course.element.tolist(), course.edge.tolist(), strict=True)):
        x, y = course.local[k].tolist()
        if edge < 0:
            waiting.append((float(barycentric[k].min()), (x, y)))
            continue
        share = share_of_edge(course.local[k], edge)
        other, back = int(connectivity.neighbours[here, edge]), int(connectivity.neighbour_edges[here, edge])
        loop = -1 if other >= 0 else -1 - (course.end if k else course.begin)
        vertex = vertices.new(loop)
        on_edge.setdefault((here, edge), []).append((share, vertex))
        if other >= 0:
            on_edge.setdefault((other, back), []).append((1 - share, vertex))
        if before >= 0:
            before = _inwards(here, before, waiting, vertices, inner, pieces)
            pieces.setdefault(here, []).append((before, vertex))
        before, waiting = vertex, []


def _inwards(
    element: int,
    before: int,
    waiting: list[tuple[float, tuple[float, float]]],
    vertices: _Vertices,
    inner: dict[int, dict[int, tuple[float, float]]],
    pieces: dict[int, list[tuple[int, int]]],
) -> int:
    """A vertex of the line inside an element, where it is farthest from the edges; from where the line goes on."""
    if not waiting or max(waiting)[0] < SPLIT_INSIDE:
        return before
    vertex = vertices.new(-1)
    inner.setdefault(element, {})[vertex] = max(waiting)[1]
    pieces.setdefault(element, []).append((before, vertex))
    return vertex


def _outline(corners: Integers, edges: list[list[tuple[float, int]]]) -> tuple[list[int], list[tuple[float, float]]]:
    """Vertices around an element with those on its edges, and their local coordinates."""
    names: list[int] = []
    local: list[tuple[float, float]] = []
    for edge, passed in enumerate(edges):
        names.append(int(corners[edge]))
        local.append((float(CORNERS[edge, 0]), float(CORNERS[edge, 1])))
        for share, vertex in passed:
            names.append(vertex)
            # exactly on the edge: one coordinate is 0, or both sum to 1
            local.append([(share, 0.0), (1 - share, share), (0.0, 1 - share)][edge])
    return names, local


def _numbered(names: Integers, pieces: list[tuple[int, int]]) -> list[tuple[int, int]]:
    number = {name: index for index, name in enumerate(names.tolist())}
    return [(number[a], number[b]) for a, b in pieces]


def _triangulated(points: Floats, outline: int, lines: list[tuple[int, int]]) -> Integers:
    """Triangles, counter-clockwise, of a polygon of the first points with given edges inside."""
    mesh = pythoncdt.Triangulation(
        pythoncdt.VertexInsertionOrder.AUTO, pythoncdt.IntersectingConstraintEdges.NOT_ALLOWED, 0.0
    )
    mesh.insert_vertices([pythoncdt.V2d(x, y) for x, y in points.tolist()])
    around = [(k, (k + 1) % outline) for k in range(outline)]
    try:
        mesh.insert_edges([pythoncdt.Edge(a, b) for a, b in {tuple(sorted(pair)) for pair in (*around, *lines)}])
    except RuntimeError as error:
        raise CrossedError("straight lines cross each other in an element") from error
    mesh.erase_outer_triangles_and_holes()
    return np.asarray(mesh.triangles_array()["vertices"].astype(np.int64))


def _inside(corners: Floats, local: Floats) -> Floats:
    """Local coordinates (q, 2) of parts with corners (p, 3, 2) in their elements, (p, q, 2)."""
    barycentric = np.column_stack([1 - local.sum(1), local])
    return np.asarray(barycentric @ corners)


def _fields(split: Split, faces: Integers, loop: Integers, surface: ElementSurface) -> IntegrationMesh:
    """The mesh of the parts."""
    old = split.mesh
    bare = replace(
        old,
        connectivity=connect(faces, len(loop), old.connectivity.basis.order),
        loop=loop,
        patch=old.patch[split.parent],
    )
    return fields_of_parts(split, bare, old, surface)


def fields_of_parts(
    split: Split, parts: IntegrationMesh, old: IntegrationMesh, surface: ElementSurface, *, known: bool = False
) -> IntegrationMesh:
    """The mesh of the parts on a surface.

    Parameters
    ----------
    split : Split
    parts : IntegrationMesh
        The parts, on whatever surface.
    old : IntegrationMesh
        The whole elements on this one.
    surface : ElementSurface
    known : bool
        Whether the places of `parts` are near those on this surface.
    """
    new = parts.connectivity
    values = np.column_stack([old.nodes, old.shape, old.normals])
    nodal = np.empty((new.node_count, values.shape[1]))
    nodal[new.elements] = np.moveaxis(split.restricted(values[old.connectivity.elements].transpose(2, 0, 1)), 0, 2)
    # the numbers of places are handed on where elements are whole, and looked for elsewhere
    whole = (split.corners == CORNERS).all((1, 2))
    element, local = np.zeros(new.node_count, np.int64), np.full((new.node_count, 2), np.nan)
    there = new.elements[whole].ravel()
    source = old.connectivity.elements[split.parent[whole]].ravel()
    element[there], local[there] = old.places.element[source], old.places.local[source]
    nodes, normals = nodal[:, :3], nodal[:, 9:12]
    lost = np.flatnonzero(np.isnan(local[:, 0]))
    nearest, _ = surface.closest_near(nodes[lost], parts.places[lost]) if known else surface.closest(nodes[lost])
    element[lost], local[lost] = nearest.element, nearest.local
    return replace(
        parts,
        nodes=nodes,
        places=Places(element, local),
        shape=nodal[:, 3:9],
        normals=normals,
        rim_starts=old.rim_starts,
    )
