"""How elements to integrate on lie on the elements of a surface: which there are, before any node is placed.

A layout serves all surfaces on the same elements whose umbilics stay about where they are: the elements' own parts hold
the same places, and rosettes go with the umbilics.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pythoncdt
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from lamella.base.arrays import Booleans, Complexes, Floats, Integers
from lamella.base.vectors import diagonal, lengths
from lamella.network.isothermic.beyond_rim import zeros_beyond_rim
from lamella.network.isothermic.integration_mesh import RIM_CORNER, IntegrationMesh, near_any
from lamella.network.isothermic.tangent_plane import TangentPlane
from lamella.network.isothermic.umbilic_depth import depth_errors
from lamella.network.isothermic.umbilic_patch import PATCH_RINGS, UmbilicPatch, umbilic_patch
from lamella.surface.element.bisect import Parts, bisect, whole
from lamella.surface.element.connectivity import Connectivity, connect
from lamella.surface.element.lagrange import lagrange
from lamella.surface.element.places import Places
from lamella.surface.element.placing import edge_blends
from lamella.surface.element.rim import ElementRim, element_rims
from lamella.surface.element.surface import ElementSurface
from lamella.surface.element.umbilics import SURE, Umbilics, deviator_error
from lamella.surface.points import shape_entries

# of the elements
INTEGRATION_ORDER = 4
# an umbilic this near to the boundary, over the surface's size, or as near as its place is unsure, is on it: no loop
# runs around it, and whether it lies within or beyond is nothing the surface tells
ON_RIM, RIM_SAMPLES = 2e-3, 4000
# radians; the same of a corner of it that turns by this angle: there Q goes like a power that is not whole (that of
# pi / angle - 2 between straight beams, above 0 below a right angle), and elements put a zero next to it
PATCH_SHARP_TURN = 1.2
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
# degrees between the sides of elements next to a rosette, below which it becomes smaller; by these parts of its radius
# on the reference, and where none is small enough the layout does not hold for a surface
GAP_ANGLE_MIN, PATCH_SHARES = 8.0, (1.0, 0.8, 0.6, 0.45)


class LayoutError(ArithmeticError):
    """A layout that does not hold for a surface; the message says why."""


@dataclass(frozen=True)
class _Patch:
    """A rosette, and the elements between it and those around.

    Attributes
    ----------
    umbilic : int
        Row of the umbilic.
    order : int
        Of its zero.
    start, petals, gaps : int
        Where its elements begin, how many are its own, and how many follow between it and the ring.
    axis : int
        A vertex of the ring.
    argument : float
        Of c in D = c z^m + ... where z is real towards that vertex, on the reference, rad.
    circle : Places
        On the reference, where c is measured.
    """

    umbilic: int
    order: int
    start: int
    petals: int
    gaps: int
    axis: int
    argument: float
    circle: Places


@dataclass(frozen=True)
class MeshLayout:
    """Which elements there are to integrate on.

    Attributes
    ----------
    connectivity : Connectivity
    own : (p,) int
        Nodes on parts of the surface's elements.
    places : Places
        Of all nodes (n,) on the surface; of others than these those on the reference.
    loop : (v,) int
        Boundary loop of each vertex, -1 inside.
    umbilics : (z,) int
        Vertex of each umbilic; -1: it lies on the boundary.
    radii : (z,)
        Of the rosettes around them, m.
    patch : (m,) int
        See `IntegrationMesh`.
    patches : tuple
        The rosettes.
    """

    connectivity: Connectivity
    own: Integers
    places: Places
    loop: Integers
    umbilics: Integers
    radii: Floats
    patch: Integers
    patches: tuple[_Patch, ...]

    def _rosette(
        self, patch: _Patch, plane: TangentPlane, leading: complex, positions: Floats, known: bool
    ) -> tuple[UmbilicPatch, float]:
        """A rosette that turns with its umbilic and has room in its ring, and its radius, m.

        Raises
        ------
        LayoutError
        """
        argument, radius = float(np.angle(leading)), float(self.radii[patch.umbilic])
        turns = (patch.argument - _towards(plane, positions[patch.axis], patch.order, argument)) / (2 * np.pi)
        # two wedges further on it is the same rosette, with other numbers
        argument += 2 * np.pi * round(turns)
        for share in PATCH_SHARES if known else (1.0,):
            rose = umbilic_patch(patch.order, argument, share * radius, INTEGRATION_ORDER)
            if not known or _has_room(self.connectivity, patch, rose, plane, positions):
                return rose, share * radius
        raise LayoutError("an umbilic has left its place among the elements")

    def placed(self, surface: ElementSurface, umbilics: Umbilics, *, known: bool = False) -> IntegrationMesh:
        """The elements on a surface.

        Parameters
        ----------
        surface : ElementSurface
            On the elements of the layout.
        umbilics : Umbilics
            Those of the layout, in its order.
        known : bool
            Whether the places of the layout are near those of this surface.

        Raises
        ------
        LayoutError
            An umbilic has left its ring of elements.
        """
        new = self.connectivity
        element, local = self.places.element.copy(), self.places.local.copy()
        positions = np.full((new.node_count, 3), np.nan)
        own = Places(element[self.own], local[self.own])
        positions[self.own] = surface.polynomials.values(own).T
        planes, radii = TangentPlane.of(surface, umbilics), self.radii.copy()
        around = []
        for patch in self.patches:
            plane, radius = planes[patch.umbilic], float(self.radii[patch.umbilic])
            leading, _ = _leading(surface, plane, patch.order, MEASURED * radius, patch.circle if known else None)
            rose, radii[patch.umbilic] = self._rosette(patch, plane, leading, positions, known)
            names, z = _patch_nodes(new, patch, rose, plane, positions)
            start = Places(element[names], local[names]) if known else None
            places, there = plane.up(z, surface, start)
            positions[names], element[names], local[names] = there, places.element, places.local
            around.append((patch, leading, names, z))
        every = Places(element, local)
        frames, mean, deviator = surface.shape_at(every)
        for patch, leading, names, z in around:
            if patch.order == 1:
                # an error moves a simple zero, and only splits those of higher order: nothing between is noise
                continue
            plane = planes[patch.umbilic]
            turn = plane.turn(frames.e_u[names])
            sure = _without_noise(surface, plane, patch.order, leading, z, deviator[names] / turn)
            deviator[names] = sure * turn
        return IntegrationMesh(
            new,
            positions,
            every,
            shape_entries(frames.e_u, frames.e_v, mean, deviator),
            surface.smooth_normal(every),
            self.loop,
            self.umbilics,
            radii,
            self.patch,
            surface.rim_starts,
            _corners(element_rims(new, positions, self.loop[new.rim_nodes[:, 0]])),
        )


def make_integration_mesh(surface: ElementSurface, umbilics: Umbilics) -> IntegrationMesh:
    """Elements with rosettes around the umbilics of a surface."""
    return lay_out(surface, umbilics).placed(surface, umbilics)


def lay_out(surface: ElementSurface, umbilics: Umbilics) -> MeshLayout:
    """Elements with rosettes around the umbilics of a surface, as a layout."""
    connectivity, zeros = surface.connectivity, umbilics.position.reshape(-1, 3)
    inside, radii = _sizes(surface, umbilics)
    parts = bisect(
        whole(connectivity, surface.nodes, surface.rim_loop),
        connectivity,
        surface.nodes,
        _too_large(surface, zeros, radii),
    )
    planes = TangentPlane.of(surface, umbilics)
    kept = np.ones(len(parts.faces), bool)
    faces = [parts.faces]
    at = np.full(len(zeros), -1)
    count = len(parts.points)
    laid: list[tuple[int, int, int, int, float, Places]] = []
    nodes_of_parts = _positions(parts, surface)
    for number in np.flatnonzero(inside).tolist():
        plane, radius = planes[number], float(radii[number])
        hole = _hole(parts, nodes_of_parts, zeros[number], (1 + PATCH_GAP) * radius)
        kept &= ~hole
        order = int(umbilics.orders[number])
        leading, circle = _leading(surface, plane, order, MEASURED * radius)
        argument = float(np.angle(leading))
        rose = umbilic_patch(order, argument, radius, INTEGRATION_ORDER)
        ring = _ring(parts.faces[hole])
        gap = _between(plane.down(parts.points[ring]), rose.vertices[rose.rim])
        names = np.concatenate([ring, count + rose.rim])
        at[number] = count
        faces += [count + rose.faces, names[gap]]
        towards = _towards(plane, parts.points[ring[0]], order, argument)
        laid.append((number, len(rose.faces), len(gap), int(ring[0]), towards, circle))
        count += len(rose.vertices)
    faces[0] = parts.faces[kept]
    used, all_faces = np.unique(np.concatenate(faces), return_inverse=True)
    new = connect(all_faces.reshape(-1, 3), len(used), INTEGRATION_ORDER)
    at[inside] = np.searchsorted(used, at[inside])
    loop = np.concatenate([parts.loop, np.full(count - len(parts.loop), -1)])[used]
    element = np.zeros(new.node_count, np.int64)
    local = np.zeros((new.node_count, 2))
    mine = np.flatnonzero(kept)
    where = parts.places(mine, new.basis.nodes)
    target = new.elements[: len(mine)].ravel()
    element[target], local[target] = where.element, where.local
    start = len(mine)
    patch = np.full(len(new.faces), -1)
    patches = []
    for number, petals, gaps, axis, towards, circle in laid:
        patch[start : start + petals + gaps] = number
        order = int(umbilics.orders[number])
        patches.append(_Patch(number, order, start, petals, gaps, int(np.searchsorted(used, axis)), towards, circle))
        start += petals + gaps
    return MeshLayout(new, np.unique(target), Places(element, local), loop, at, radii, patch, tuple(patches))


def _sizes(surface: ElementSurface, umbilics: Umbilics) -> tuple[Booleans, Floats]:
    """Which umbilics are not on the boundary, (z,), and radii of rosettes around them, m, (z,)."""
    size, zeros = diagonal(surface.nodes), umbilics.position.reshape(-1, 3)
    rims = element_rims(surface.connectivity, surface.nodes, surface.rim_loop)
    along = np.concatenate([rim.at(np.arange(RIM_SAMPLES) / RIM_SAMPLES) for rim in rims])
    to_rim, _ = cKDTree(along).query(zeros)
    inside = to_rim > np.clip(depth_errors(surface), ON_RIM * size, RIM_CORNER * size)
    inside &= ~near_any(zeros, surface.nodes[_corners(rims)], RIM_CORNER * size)
    return inside, np.where(inside, _radii(surface, umbilics, to_rim), ON_RIM * size)


def _too_large(surface: ElementSurface, zeros: Floats, radii: Floats) -> Callable[[Floats, Floats], Booleans]:
    """Which parts are too large beside zeros (z, 3) with rosettes of radii (z,), m, and beside those beyond the rim."""
    least = ON_RIM * diagonal(surface.nodes)
    beyond = zeros_beyond_rim(surface, least)
    centres, around = np.concatenate([zeros, beyond]), np.append(radii, np.full(len(beyond), least))

    def too_large(corners: Floats, longest: Floats) -> Booleans:
        result = np.zeros(len(longest), bool)
        for zero, radius in zip(centres, around, strict=True):
            distance = lengths(corners - zero).min(1)
            result |= (longest > GROWTH * np.maximum(distance, radius)) & (distance < 8 * radius + longest)
        return result

    return too_large


def _towards(plane: TangentPlane, point: Floats, order: int, argument: float) -> float:
    """Argument of c in D = c z^m + ... in the frame whose z is real towards a point (3,), rad."""
    return argument + (order + 2) * float(np.angle(plane.down(point)))


def _corners(rims: tuple[ElementRim, ...]) -> Integers:
    """Vertices at which the rim has a sharp corner, (c,)."""
    return np.concatenate([rim.vertices[rim.turns > PATCH_SHARP_TURN] for rim in rims])


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


def _leading(
    surface: ElementSurface, plane: TangentPlane, order: int, radius: float, start: Places | None = None
) -> tuple[complex, Places]:
    """c in D dz^2 = (c z^m + ...) dz^2 around an umbilic, by the mean over a circle; the places on it."""
    turn = np.exp(2j * np.pi * np.arange(24) / 24)
    places, _ = plane.up(radius * turn, surface, start)
    frames, _, deviator = surface.shape_at(places)
    return complex((deviator / plane.turn(frames.e_u) * turn ** (-order)).mean() / radius**order), places


def _without_noise(
    surface: ElementSurface, plane: TangentPlane, order: int, leading: complex, z: Complexes, of: Complexes
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
    new: Connectivity, patch: _Patch, rose: UmbilicPatch, plane: TangentPlane, positions: Floats
) -> tuple[Integers, Complexes]:
    """Nodes of a rosette and of the gap around it, by number, with their places in the tangent plane."""
    start, petals = patch.start, patch.petals
    z = np.full(new.node_count, np.nan, complex)
    z[new.elements[start : start + petals]] = rose.nodes
    gap = new.elements[start + petals : start + petals + patch.gaps]
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


def _has_room(new: Connectivity, patch: _Patch, rose: UmbilicPatch, plane: TangentPlane, positions: Floats) -> bool:
    """Whether the elements between a rosette and its ring are neither slender nor turned over."""
    z = np.full(new.node_count, np.nan, complex)
    z[new.elements[patch.start : patch.start + patch.petals]] = rose.nodes
    faces = new.faces[patch.start + patch.petals : patch.start + patch.petals + patch.gaps]
    ring = np.isnan(z[faces])
    z[faces[ring]] = plane.down(positions[faces[ring]])
    corners = z[faces]
    sides = np.roll(corners, -1, 1) - corners
    # the turn from one side to the next is what an angle lacks to half a turn; of triangles turned over it is negative
    angle = 180 - np.degrees(np.angle(np.roll(sides, -1, 1) / sides))
    return bool(((angle > GAP_ANGLE_MIN) & (angle < 180)).all())
