"""Elements to integrate on: those of the surface, with a rosette around each umbilic.

Near an umbilic of order m the isothermic coordinates go like the distance to the power 1 + m / 2. There the surface's
own elements give way to a `lamella.network.isothermic.umbilic_patch`, and are cut finer around it where they are large
beside its size; everywhere else they stay as they are.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pythoncdt
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from lamella.base.arrays import Booleans, Complexes, Floats, Integers
from lamella.base.vectors import diagonal, lengths
from lamella.network.isothermic.beyond_rim import zeros_beyond_rim
from lamella.network.isothermic.umbilic_depth import depth_errors
from lamella.network.isothermic.umbilic_patch import PATCH_RINGS, UmbilicPatch, umbilic_patch
from lamella.surface.element.bisect import Parts, bisect, whole
from lamella.surface.element.connectivity import Connectivity, connect
from lamella.surface.element.inverse_map import find_places
from lamella.surface.element.lagrange import lagrange
from lamella.surface.element.places import Places
from lamella.surface.element.placing import edge_blends
from lamella.surface.element.rim import ElementRim, element_rims
from lamella.surface.element.surface import ElementSurface
from lamella.surface.element.umbilics import SURE, Umbilics, deviator_error
from lamella.surface.points import SurfacePoints, shape_entries

# of the elements
INTEGRATION_ORDER = 4
# an umbilic this near to the boundary, over the surface's size, or as near as its place is unsure, is on it: no loop
# runs around it, and whether it lies within or beyond is nothing the surface tells
ON_RIM, RIM_SAMPLES = 2e-3, 4000
# the same of a corner of it that turns by this angle, radians: there Q goes like a power that is not whole (that of
# pi / angle - 2 between straight beams, above 0 below a right angle), and elements put a zero next to it
RIM_CORNER, PATCH_SHARP_TURN = 0.015, 1.2
# radius of a rosette over the distance to the boundary and to the next umbilic
TO_RIM, PATCH_TO_NEXT = 0.5, 0.28
# longest edge of the elements around over the distance from the umbilic
GROWTH = 0.45
# between a rosette and the elements around, over its radius
PATCH_GAP = 0.15
# radii of the circle on which the order's coefficient is measured, over the rosette's
MEASURED = 0.5
# share of the radius from which on a deviator is to be trusted within which the leading term alone counts
INNER = 0.5


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
        return _near(points, self.nodes[self.corners], RIM_CORNER * diagonal(self.nodes))


@dataclass(frozen=True)
class _TangentPlane:
    """The plane at an umbilic as the complex plane; `middles` are those of the surface's elements."""

    places: Places
    at: SurfacePoints
    middles: cKDTree

    @classmethod
    def of(cls, surface: ElementSurface, umbilics: Umbilics) -> list[_TangentPlane]:
        """One for each umbilic."""
        middles = cKDTree(surface.nodes[surface.connectivity.faces].mean(1))
        count = len(umbilics.orders)
        places = [umbilics.places[number : number + 1] for number in range(count)]
        return [cls(place, surface.at(place), middles) for place in places]

    def turn(self, e_u: Floats) -> Complexes:
        """Factor (n,) from deviators in the frame of the plane to those in frames along e_u (n, 3)."""
        along = e_u @ self.at.e_u[0] + 1j * (e_u @ self.at.e_v[0])
        return np.asarray((along / np.abs(along)) ** 2)

    def down(self, points: Floats) -> Complexes:
        """Complex coordinates (...,) of points (..., 3), m."""
        off = points - self.at.position[0]
        return np.asarray(off @ self.at.e_u[0] + 1j * (off @ self.at.e_v[0]))

    def up(self, z: Complexes, surface: ElementSurface) -> tuple[Places, Floats]:
        """Places and points (n, 3) of the surface above z (n,)."""
        axes = np.stack([self.at.e_u[0], self.at.e_v[0]])
        foot = self.at.position[0] + np.stack([z.real, z.imag], 1) @ axes
        start = Places(self.middles.query(foot)[1], np.full((len(z), 2), 1 / 3))
        target = np.stack([z.real, z.imag])

        def coordinates(where: Places) -> Floats:
            jet = surface.polynomials.jet(where)
            jet[0] -= self.at.position[0][:, None]
            return np.asarray(np.matmul(axes, jet))

        places, found = find_places(surface.connectivity, coordinates, start, target, lambda *_: None)
        lost = np.flatnonzero(~found)
        if len(lost):
            # beyond the rim: the nearest place
            nearest, _ = surface.closest(foot[lost])
            places.element[lost], places.local[lost] = nearest.element, nearest.local
        return places, surface.frames(places).position


def make_integration_mesh(surface: ElementSurface, umbilics: Umbilics) -> IntegrationMesh:
    """Elements with rosettes around the umbilics of a surface."""
    connectivity = surface.connectivity
    size = diagonal(surface.nodes)
    rims = element_rims(connectivity, surface.nodes, surface.rim_loop)
    along = np.concatenate([rim.at(np.arange(RIM_SAMPLES) / RIM_SAMPLES) for rim in rims])
    zeros = umbilics.position.reshape(-1, 3)
    to_rim, _ = cKDTree(along).query(zeros)
    inside = to_rim > np.clip(depth_errors(surface), ON_RIM * size, RIM_CORNER * size)
    inside &= ~_near(zeros, surface.nodes[_corners(rims)], RIM_CORNER * size)
    radii = np.where(inside, _radii(surface, umbilics, to_rim), ON_RIM * size)

    beyond = zeros_beyond_rim(surface, ON_RIM * size)
    centres, least = np.concatenate([zeros, beyond]), np.append(radii, np.full(len(beyond), ON_RIM * size))

    def too_large(corners: Floats, longest: Floats) -> Booleans:
        result = np.zeros(len(longest), bool)
        for zero, radius in zip(centres, least, strict=True):
            distance = lengths(corners - zero).min(1)
            result |= (longest > GROWTH * np.maximum(distance, radius)) & (distance < 8 * radius + longest)
        return result

    parts = bisect(whole(connectivity, surface.nodes, surface.rim_loop), connectivity, surface.nodes, too_large)
    planes = _TangentPlane.of(surface, umbilics)
    kept = np.ones(len(parts.faces), bool)
    faces = [parts.faces]
    points = [parts.points]
    at = np.full(len(zeros), -1)
    leading = np.zeros(len(zeros), complex)
    count = len(parts.points)
    patches: list[tuple[int, UmbilicPatch, int, int]] = []
    nodes_of_parts = _positions(parts, surface)
    for number in np.flatnonzero(inside).tolist():
        plane, radius = planes[number], float(radii[number])
        hole = _hole(parts, nodes_of_parts, zeros[number], (1 + PATCH_GAP) * radius)
        kept &= ~hole
        order = int(umbilics.orders[number])
        leading[number] = _leading(surface, plane, order, MEASURED * radius)
        rose = umbilic_patch(order, float(np.angle(leading[number])), radius, INTEGRATION_ORDER)
        ring = _ring(parts.faces[hole])
        gap = _between(plane.down(parts.points[ring]), rose.vertices[rose.rim])
        names = np.concatenate([ring, count + rose.rim])
        at[number] = count
        faces += [count + rose.faces, names[gap]]
        patches.append((number, rose, len(rose.faces), len(gap)))
        points.append(np.full((len(rose.vertices), 3), np.nan))
        count += len(rose.vertices)
    faces[0] = parts.faces[kept]
    used, all_faces = np.unique(np.concatenate(faces), return_inverse=True)
    new = connect(all_faces.reshape(-1, 3), len(used), INTEGRATION_ORDER)
    at[inside] = np.searchsorted(used, at[inside])
    loop = np.concatenate([parts.loop, np.full(count - len(parts.loop), -1)])[used]

    positions = np.full((new.node_count, 3), np.nan)
    element = np.zeros(new.node_count, np.int64)
    local = np.zeros((new.node_count, 2))
    mine = np.flatnonzero(kept)
    where = parts.places(mine, new.basis.nodes)
    target = new.elements[: len(mine)].ravel()
    positions[target] = nodes_of_parts[mine].reshape(-1, 3)
    element[target], local[target] = where.element, where.local
    start = len(mine)
    patch = np.full(len(new.faces), -1)
    around = []
    for number, rose, petals, gaps in patches:
        plane = planes[number]
        patch[start : start + petals + gaps] = number
        names, z = _patch_nodes(new, start, petals, gaps, rose, plane, positions)
        start += petals + gaps
        places, there = plane.up(z, surface)
        positions[names], element[names], local[names] = there, places.element, places.local
        around.append((number, names, z))
    every = Places(element, local)
    frames, mean, deviator = surface.shape_at(every)
    for number, names, z in around:
        plane, order = planes[number], int(umbilics.orders[number])
        if order == 1:
            # an error moves a simple zero, and only splits those of higher order: nothing between is noise
            continue
        turn = plane.turn(frames.e_u[names])
        sure = _without_noise(surface, plane, order, complex(leading[number]), z, deviator[names] / turn)
        deviator[names] = sure * turn
    shape = shape_entries(frames.e_u, frames.e_v, mean, deviator)
    normals = surface.smooth_normal(every)
    corners = _corners(element_rims(new, positions, loop[new.rim_nodes[:, 0]]))
    return IntegrationMesh(new, positions, every, shape, normals, loop, at, radii, patch, surface.rim_starts, corners)


def _corners(rims: tuple[ElementRim, ...]) -> Integers:
    """Vertices at which the rim has a sharp corner, (c,)."""
    return np.concatenate([rim.vertices[rim.turns > PATCH_SHARP_TURN] for rim in rims])


def _near(points: Floats, others: Floats, reach: float) -> Booleans:
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
    for number, plane in enumerate(_TangentPlane.of(surface, umbilics)):
        mine = np.flatnonzero(patch == number)
        if len(mine):
            result[mine] = plane.up(plane.down(points[mine]), surface)[1]
    return result


def _positions(parts: Parts, surface: ElementSurface) -> Floats:
    """Nodes of order `INTEGRATION_ORDER` of every part, (m, k, 3)."""
    nodes = lagrange(INTEGRATION_ORDER).nodes
    where = parts.places(np.arange(len(parts.parent)), nodes)
    return np.ascontiguousarray(surface.polynomials.values(where).T).reshape(len(parts.parent), len(nodes), 3)


def _radii(surface: ElementSurface, umbilics: Umbilics, to_rim: Floats) -> Floats:
    """Radius of the rosette at each umbilic, m."""
    corners = surface.nodes[surface.connectivity.faces[umbilics.places.element]]
    edge = np.linalg.norm(corners - np.roll(corners, 1, 1), axis=2).mean(1)
    radii = np.minimum(PATCH_RINGS * edge, TO_RIM * to_rim)
    if len(radii) > 1:
        apart, _ = cKDTree(umbilics.position).query(umbilics.position, k=2)
        radii = np.minimum(radii, PATCH_TO_NEXT * apart[:, 1])
    return np.asarray(radii)


def _leading(surface: ElementSurface, plane: _TangentPlane, order: int, radius: float) -> complex:
    """c in D dz^2 = (c z^m + ...) dz^2 around an umbilic, by the mean over a circle."""
    turn = np.exp(2j * np.pi * np.arange(24) / 24)
    places, _ = plane.up(radius * turn, surface)
    frames, _, deviator = surface.shape_at(places)
    return complex((deviator / plane.turn(frames.e_u) * turn ** (-order)).mean() / radius**order)


def _without_noise(
    surface: ElementSurface, plane: _TangentPlane, order: int, leading: complex, z: Complexes, of: Complexes
) -> Complexes:
    """Deviators `of` (n,) at z (n,) in the frame of the plane, next to the umbilic replaced by their leading term.

    Nearer to a zero of order m than (error / c)^(1 / m) the deviator is nothing but its error.
    """
    error = float(deviator_error(surface, plane.places.element)[0])
    radius = (SURE * error / abs(leading)) ** (1 / order)
    # cubic from 0 to 1 between both radii
    share = np.clip((np.abs(z) / radius - INNER) / (1 - INNER), 0, 1)
    share = share**2 * (3 - 2 * share)
    return np.asarray(share * of + (1 - share) * leading * z**order)


def _hole(parts: Parts, nodes: Floats, centre: Floats, radius: float) -> Booleans:
    """Parts that reach nearer to a place of the surface than a radius, as one piece without holes."""
    near = lengths(nodes - centre).min(1)
    hole = near < radius
    m = len(parts.faces)
    # only what hangs together with the nearest one: another sheet may pass close by
    corner = np.flatnonzero(np.repeat(hole, 3))
    graph = coo_matrix((np.ones(len(corner)), (corner // 3, parts.faces.ravel()[corner])), (m, len(parts.points)))
    _, group = connected_components(graph @ graph.T, directed=False)
    hole &= group == group[near.argmin()]
    return np.asarray(hole)


def _ring(faces: Integers) -> Integers:
    """Vertices around a piece of triangles, counter-clockwise."""
    ends = np.stack([faces, np.roll(faces, -1, 1)], 2).reshape(-1, 2)
    there = set(map(tuple, ends.tolist()))
    after = {a: b for a, b in there if (b, a) not in there}
    first = min(after)
    ring = [first]
    while (following := after[ring[-1]]) != first:
        ring.append(following)
        if len(ring) > len(after):
            break
    if len(ring) != len(after):
        raise ValueError("the elements around an umbilic are no disc")
    return np.array(ring)


def _between(outer: Complexes, inner: Complexes) -> Integers:
    """Triangles between two polygons, one inside the other, by the numbers of their corners, outer ones first."""
    corners = np.concatenate([outer, inner])
    count = np.arange(len(outer)), len(outer) + np.arange(len(inner))
    edges = np.concatenate([np.column_stack([ring, np.roll(ring, -1)]) for ring in count])
    mesh = pythoncdt.Triangulation(
        pythoncdt.VertexInsertionOrder.AUTO, pythoncdt.IntersectingConstraintEdges.NOT_ALLOWED, 0.0
    )
    mesh.insert_vertices([pythoncdt.V2d(float(z.real), float(z.imag)) for z in corners])
    mesh.insert_edges([pythoncdt.Edge(int(a), int(b)) for a, b in edges.tolist()])
    mesh.erase_outer_triangles_and_holes()
    return np.asarray(mesh.triangles_array()["vertices"].astype(np.int64))


def _patch_nodes(
    new: Connectivity,
    start: int,
    petals: int,
    gaps: int,
    rose: UmbilicPatch,
    plane: _TangentPlane,
    positions: Floats,
) -> tuple[Integers, Complexes]:
    """Nodes of a rosette and of the gap around it, by number, with their places in the tangent plane."""
    z = np.full(new.node_count, np.nan, complex)
    z[new.elements[start : start + petals]] = rose.nodes
    gap = new.elements[start + petals : start + petals + gaps]
    known = ~np.isnan(positions[gap].sum(2))
    z[gap[known]] = plane.down(positions[gap[known]])
    basis = new.basis
    barycentric = np.column_stack([1 - basis.nodes.sum(1), basis.nodes])
    flat = z[gap[:, :3]] @ barycentric.T
    moved = flat.copy()
    for edge, blend in zip(basis.edge_nodes[:, 1:-1], edge_blends(INTEGRATION_ORDER), strict=True):
        shift = z[gap[:, edge]] - flat[:, edge]
        moved += np.where(np.isnan(shift), 0, shift) @ blend.T
    free = np.isnan(z[gap])
    z[gap[free]] = moved[free]
    names = np.unique(np.concatenate([new.elements[start : start + petals].ravel(), gap.ravel()]))
    names = names[np.isnan(positions[names]).any(1)]
    return names, z[names]
