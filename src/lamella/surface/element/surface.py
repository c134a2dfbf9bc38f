"""A surface of curved elements: the same questions as a closed form answers."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lamella.base.arrays import Complexes, Floats, Integers
from lamella.base.drawing_origin import NOWHERE, Origin
from lamella.base.message import Message
from lamella.base.result import Shown
from lamella.base.vectors import diagonal, dots, images, lengths, symmetric
from lamella.surface.element.closest import ClosestPoint
from lamella.surface.element.connectivity import Connectivity, connect
from lamella.surface.element.curvature import ElementFrames, ElementPoints, element_points, frames
from lamella.surface.element.edge_basis import edge_rule, edge_slopes, edge_values
from lamella.surface.element.gauss_map import harmonic_normals
from lamella.surface.element.geometry import normal_and_area, project_onto_nodes, tangents
from lamella.surface.element.places import Places
from lamella.surface.element.polynomials import Polynomials
from lamella.surface.element.quadrature import triangle_rule
from lamella.surface.element.sampling import sampled_places
from lamella.surface.element.umbilics import Umbilics, find_umbilics
from lamella.surface.mesh import SurfaceMesh
from lamella.surface.points import SurfacePoints
from lamella.surface.umbilic import umbilic_reason

# order of continuous fields from second derivatives of positions, by that of the elements
SMOOTHED_ORDER = {2: 1, 3: 2, 4: 3}
# most parts an element's edge is cut into for files and pictures
EDGE_PARTS_DRAWN_MAX = 64
MOST_TRIANGLES = 400_000
# of a mesh's tolerance, the sag of its rim
RIM_SHARE = 0.25
# 1/m^4, of H^2 - K squared: at an umbilic itself the slopes of ln mu have no bound
LEAST_SQUARE = 1e-200


@dataclass(frozen=True, eq=False, repr=False)
class ElementSurface(Shown):
    """A surface of Lagrange triangles of order 2 to 4.

    Places are `Places`: elements with local coordinates. Position and normal are those of the elements. The shape
    operator is -dn of the harmonic Gauss map (`lamella.surface.element.gauss_map`) with the surface's own H, as
    continuous polynomials: no jump of the principal directions between elements. `measured_mean_curvature` is of the
    elements' second derivatives and knows nothing of that.

    Attributes
    ----------
    kind : str
        Name in a project file.
    mean_curvature : float
        H the surface stands for, 1/m, for the normal of counter-clockwise elements.
    connectivity : Connectivity
    nodes : (n, 3)
        m.
    figures : dict
        What `describe` tells.
    notes : tuple of Message
        What `warnings` tells.
    rim_loop : (b,) int
        Boundary loop of each boundary edge of the connectivity.
    loop_starts : (loops, 3), optional
        Where each boundary loop begins, m: what a net is numbered from. By itself with the first of its elements.
    slide_ends : (k, 3), optional
        Where parts of the boundary that slide begin and end, m.

    Examples
    --------
    >>> import lamella
    >>> disc = lamella.film([lamella.circle((0, 0, 0), 1.0)], tolerance=0.02)
    >>> print(f"{disc.area():.4f} m2, {disc.describe()['stability']}")
    3.1416 m2, stable
    """

    kind: str
    mean_curvature: float
    connectivity: Connectivity
    nodes: Floats
    rim_loop: Integers
    figures: dict[str, Any] = field(default_factory=dict)
    notes: tuple[Message, ...] = ()
    loop_starts: Floats | None = None
    slide_ends: Floats | None = None

    def has_lattice(self, normal_curvature: float | None = None) -> bool:
        """See `lamella.surface.surface.Surface.has_lattice`."""
        return normal_curvature in (None, self.mean_curvature)

    @property
    def has_boundary_curves(self) -> bool:
        """Whether the surface was found between curves: their corners can be rounded, and they can be adjusted."""
        return self.kind == "form-found"

    def _line(self) -> str:
        connectivity = self.connectivity
        return (
            f"{self.kind}: mean curvature {self.mean_curvature:.6g} 1/m, {len(connectivity.elements):,} elements "
            f"of order {connectivity.basis.order}, {len(self.nodes):,} nodes"
        )

    @property
    def origin(self) -> Origin:
        """Point of the drawing that nodes are measured from, m."""
        origin: Origin = self.figures.get("origin", NOWHERE)
        return origin

    def uncertain(self, places: Places) -> Floats:
        """How far normal curvatures at n places may be off those of the surface that is meant, 1/m, (n,)."""
        return np.zeros(len(places))

    @cached_property
    def rim_starts(self) -> Floats:
        """Where each boundary loop begins, (loops, 3), m."""
        if self.loop_starts is not None:
            return self.loop_starts
        _, first = np.unique(self.rim_loop, return_index=True)
        return np.asarray(self.nodes[self.connectivity.rim_nodes[first, 0]])

    @cached_property
    def _corners(self) -> Floats:
        return self.nodes[self.connectivity.elements]

    @cached_property
    def gauss_map(self) -> Floats:
        """Normals of the harmonic Gauss map at the nodes, (n, 3)."""
        return harmonic_normals(self.connectivity, self.nodes)

    @cached_property
    def polynomials(self) -> Polynomials:
        """The position on each element, m."""
        return Polynomials.through(self.connectivity.basis, self._corners)

    @cached_property
    def _smooth_space(self) -> Connectivity:
        """Polynomials of continuous fields from second derivatives of positions."""
        connectivity = self.connectivity
        return connect(connectivity.faces, int(connectivity.faces.max()) + 1, SMOOTHED_ORDER[connectivity.basis.order])

    @property
    def _shape_space(self) -> Connectivity:
        """Polynomials of the continuous shape operator.

        The elements' own: with those of the normals' derivatives, one order less, a net's periods are four times as
        far off.
        """
        return self.connectivity

    @cached_property
    def _smoothed(self) -> tuple[Polynomials, Polynomials]:
        """The continuous shape operator (xx, xy, xz, yy, yz, zz), 1/m, and H^2 - K, 1/m^2."""
        points, weights = triangle_rule(2 * self.connectivity.basis.order)
        x_1, x_2 = tangents(*self._slopes(points), self._corners)
        m, q = x_1.shape[:2]
        there = frames(np.empty((m * q, 0)), x_1.reshape(-1, 3), x_2.reshape(-1, 3))
        normals = self.gauss_map[self.connectivity.elements]
        n_x, n_y = (np.matmul(slope, normals).reshape(-1, 3) for slope in self._slopes(points))
        # S = -dn along both axes of the frame
        along = there.to_local
        n_u = along[:, 0, 0, None] * n_x + along[:, 1, 0, None] * n_y
        n_v = along[:, 0, 1, None] * n_x + along[:, 1, 1, None] * n_y
        s_uu, s_vv = -dots(n_u, there.e_u), -dots(n_v, there.e_v)
        s_uv = -(dots(n_u, there.e_v) + dots(n_v, there.e_u)) / 2
        mean, half = self._mean(s_uu, s_vv), (s_uu - s_vv) / 2
        shape = symmetric(there.e_u, there.e_v, mean + half, s_uv, mean - half)
        # the area element is 1 / det(to_local)
        area = 1 / (along[:, 0, 0] * along[:, 1, 1]).reshape(m, q)
        values = np.concatenate([shape, (half**2 + s_uv**2)[:, None]], 1).reshape(m, q, 7)
        space = self._shape_space
        nodal = project_onto_nodes(space, points, area * weights, values)
        both = Polynomials.through(space.basis, nodal[space.elements])
        return both[:6], both[6:]

    @cached_property
    def _smoothed_mean_curvature(self) -> Polynomials:
        """The continuous H from positions alone, 1/m."""
        points, weights = triangle_rule(2 * self.connectivity.basis.order)
        measured = element_points(self.connectivity, self._corners, points, False).mean_curvature
        _, area = normal_and_area(*tangents(*self._slopes(points), self._corners))
        space = self._smooth_space
        nodal = project_onto_nodes(space, points, area * weights, measured.reshape(*area.shape, 1))
        return Polynomials.through(space.basis, nodal[space.elements])

    def _slopes(self, local: Floats) -> tuple[Floats, Floats]:
        basis = self.connectivity.basis
        return basis.basis(local, 1, 0), basis.basis(local, 0, 1)

    def shape_at(self, where: Places) -> tuple[ElementFrames, Floats, Complexes]:
        """Frames, mean curvature H (n,) and deviator (n,), 1/m, at n places, see `SurfacePoints`."""
        there = self.frames(where)
        return there, *self._shape(there, self._smoothed[0].values(where))

    def shape_everywhere(self, local: Floats) -> tuple[Floats, Complexes]:
        """Mean curvature H and deviator at the same local coordinates (q, 2) of every element, (m q,) each, 1/m."""
        return self._shape(self.frames_everywhere(local), self._smoothed[0].everywhere(local))

    def _shape(self, there: ElementFrames, smooth: Floats) -> tuple[Floats, Complexes]:
        """Mean curvature and deviator (n,) from the smoothed shape operator (6, n)."""
        u, v = images(smooth.T, there.e_u), images(smooth.T, there.e_v)
        uu, vv = dots(u, there.e_u), dots(v, there.e_v)
        return self._mean(uu, vv), (uu - vv) / 2 - 1j * dots(u, there.e_v)

    def _mean(self, uu: Floats, vv: Floats) -> Floats:
        """H from the shape operator's entries: the surface's own."""
        return np.full(uu.shape, float(self.mean_curvature))

    def at(self, where: Places) -> SurfacePoints:
        """Everything about n places, in one evaluation."""
        shape, square = self._smoothed
        _, by_x, by_y = square.jet(where)[:, 0]
        return self._points(self.frames(where), shape.values(where), by_x, by_y)

    def at_everywhere(self, local: Floats) -> SurfacePoints:
        """The points at the same local coordinates (q, 2) of every element, element by element: sooner than by `at`."""
        shape, square = self._smoothed
        by_x, by_y = (square.everywhere(local, *d)[0] for d in ((1, 0), (0, 1)))
        return self._points(self.frames_everywhere(local), shape.everywhere(local), by_x, by_y)

    def _points(self, there: ElementFrames, smooth: Floats, by_x: Floats, by_y: Floats) -> SurfacePoints:
        """Points with the smoothed shape operator (6, n) and the slopes (n,) of H^2 - K."""
        mean, deviator = self._shape(there, smooth)
        square = np.maximum(deviator.real**2 + deviator.imag**2, LEAST_SQUARE)
        along = there.to_local[:, 0] * by_x[:, None] + there.to_local[:, 1] * by_y[:, None]
        return SurfacePoints(
            there.position,
            there.e_u,
            there.e_v,
            there.normal,
            mean,
            deviator,
            (along[:, 0] + 1j * along[:, 1]) / (4 * square),
        )

    def frames(self, where: Places) -> ElementFrames:
        """Position and frame at n places."""
        return frames(*np.ascontiguousarray(self.polynomials.jet(where).transpose(0, 2, 1)))

    def frames_everywhere(self, local: Floats) -> ElementFrames:
        """The same at local coordinates (q, 2) of every element, element by element."""
        jet = (self.polynomials.everywhere(local, *d) for d in ((0, 0), (1, 0), (0, 1)))
        return frames(*(np.ascontiguousarray(part.T) for part in jet))

    def smooth_normal(self, where: Places) -> Floats:
        """Unit normal of the harmonic Gauss map at n places, (n, 3): it does not jump between elements."""
        nodal = self.gauss_map[self.connectivity.elements]
        normal = Polynomials.through(self.connectivity.basis, nodal).values(where).T
        return np.asarray(normal / lengths(normal)[:, None])

    def measured(self, where: Places) -> ElementPoints:
        """Position, frame and unsmoothed shape operator at n places."""
        return element_points(self.connectivity, self._corners[where.element], where.local, True)

    def measured_mean_curvature(self, where: Places) -> Floats:
        """H at n places from positions alone, 1/m, (n,)."""
        return self.measured(where).mean_curvature

    def smoothed_mean_curvature(self, where: Places) -> Floats:
        """`measured_mean_curvature` by L2 projection on continuous polynomials, 1/m, (n,): H of files and pictures."""
        return np.asarray(self._smoothed_mean_curvature.values(where)[0])

    def check_places(self) -> Places:
        """Twelve places inside every element."""
        return Places.everywhere(len(self._corners), triangle_rule(6)[0])

    def check_points(self) -> SurfacePoints:
        """Everything about these places."""
        return self.at_everywhere(triangle_rule(6)[0])

    @cached_property
    def _search(self) -> ClosestPoint:
        return ClosestPoint(self.connectivity, self.nodes)

    def closest(self, points: ArrayLike) -> tuple[Places, Floats]:
        """Closest places to points (n, 3), and their positions (n, 3), m."""
        return self._search(np.asarray(points, np.float64))

    def closest_near(self, points: Floats, start: Places) -> tuple[Places, Floats]:
        """The same, searched from places (n,) that are near."""
        return self._search.near(points, start)

    def area(self) -> float:
        """m^2."""
        points, weights = triangle_rule(2 * self.connectivity.basis.order)
        _, area = normal_and_area(*tangents(*self._slopes(points), self._corners))
        return float((area * weights).sum())

    def volume(self) -> float:
        """Volume between the surface and lids over its boundary loops, m^3; positive where the normal points out of it.

        The lid of a loop is the cone from the loop's centroid: flat where the loop is.
        """
        basis = self.connectivity.basis
        points, weights = triangle_rule(3 * basis.order - 2 + basis.order % 2)
        middle = self.nodes.mean(0)
        position = np.matmul(basis.basis(points), self._corners - middle)
        cross = np.cross(*tangents(*self._slopes(points), self._corners))
        total = float(((position * cross).sum(2) * weights).sum() / 3)
        rule, weight = edge_rule(basis.order)
        value, slope = edge_values(basis.order, rule), edge_slopes(basis.order, rule)
        along = self.nodes[self.connectivity.rim_nodes] - middle
        for loop in np.unique(self.rim_loop):
            edges = along[self.rim_loop == loop]
            curve, step = np.matmul(value, edges), np.matmul(slope, edges)
            length = np.linalg.norm(step, axis=2) * weight
            centroid = (curve * length[..., None]).sum((0, 1)) / length.sum()
            # the lid runs against the surface's sense: its rim is traversed backwards
            total -= float(((np.cross(curve, step) @ centroid) * weight).sum() / 6)
        return total

    def mesh(self, tolerance: float = 1e-3) -> SurfaceMesh:
        """The surface sampled for files and pictures.

        Parameters
        ----------
        tolerance : float
            Largest distance of the faces from the surface over the diagonal of the bounding box, as far as
            `MOST_TRIANGLES` allow; along the rim, which is what is seen, a quarter of it.
        """
        size = diagonal(self.nodes)
        middle = self.measured(Places(np.arange(len(self._corners)), np.full((len(self._corners), 2), 1 / 3)))
        bend = np.abs(middle.mean_curvature) + np.abs(middle.deviator)
        edges = np.linalg.norm(self._corners[:, :3] - np.roll(self._corners[:, :3], -1, 1), axis=2).max(1)
        # an edge of length l over a curvature k sags by k l^2 / 8
        parts = np.ceil(np.sqrt(np.percentile(bend * edges**2, 99) / (8 * tolerance * size)))
        most = int(np.clip(np.sqrt(MOST_TRIANGLES / len(self._corners)), 1, EDGE_PARTS_DRAWN_MAX))
        parts = int(np.clip(parts, 1, most))
        mesh = self.subdivided(parts, RIM_SHARE * tolerance * size)
        left = mesh.sag() / (tolerance * size)
        if left > 1 and parts < most:
            # at a corner curvatures may have no bound: twice as fine at most
            parts = int(np.clip(np.ceil(parts * np.sqrt(left)), parts + 1, min(2 * parts, most)))
            mesh = self.subdivided(parts, RIM_SHARE * tolerance * size)
        return mesh

    def subdivided(self, parts: int, rim_sag: float = np.inf) -> SurfaceMesh:
        """Every element's edges cut into `parts`, those on the rim finer where their sag (m) asks for it."""
        place, faces = sampled_places(self.connectivity, self.nodes, parts, rim_sag)
        at = self.at(place)
        measured = self.smoothed_mean_curvature(place)
        k1, k2 = at.principal_curvatures
        return SurfaceMesh(
            at.position,
            at.normal,
            np.column_stack([faces, faces[:, 2]]),
            measured,
            k1 * k2,
            k1,
            k2,
        )

    @cached_property
    def umbilics(self) -> Umbilics:
        """Zeros of the trace-free shape operator; none are searched on spheres and planes, where all points are."""
        return find_umbilics(self)

    def singular_orders(self) -> tuple[int, ...]:
        """Orders of the umbilics."""
        if umbilic_reason(self.check_points()):
            return ()
        return tuple(self.umbilics.orders.tolist())

    def describe(self) -> dict[str, Any]:
        """Further figures for the summary."""
        return dict(self.figures)

    def warnings(self) -> tuple[Message, ...]:
        """What a user should know about this surface before building it."""
        return self.notes
