"""A film: curved elements between boundary curves, and how its nodes may move."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Protocol

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.sparse import SingularError, SymmetricPattern, packed
from lamella.base.vectors import diagonal
from lamella.surface.element.connectivity import Connectivity, connect
from lamella.surface.element.geometry import dirichlet_blocks, smooth_normals, tangents
from lamella.surface.element.placing import place_nodes, rim_parameters
from lamella.surface.element.quadrature import triangle_rule
from lamella.surface.remesh.remesh import TriangleMesh


class Slide(Protocol):
    """A part of a loop that slides on a plane (point, normal) or along lines (direction)."""

    @property
    def start(self) -> float:
        """Fraction of the loop where the part begins."""

    @property
    def end(self) -> float:
        """Fraction where it ends, up to 1 more than `start`."""

    @property
    def normal(self) -> Floats | None:
        """Unit normal of the plane, (3,)."""

    @property
    def direction(self) -> Floats | None:
        """Unit direction of the lines, (3,)."""


class Loop(Protocol):
    """A boundary loop, see `lamella.surface.boundary.curve`."""

    @property
    def name(self) -> str:
        """Name in the project."""

    @property
    def length(self) -> float:
        """m."""

    @property
    def corners(self) -> Floats:
        """Parameters of the corners, sorted."""

    @property
    def smooth(self) -> Booleans:
        """Which corners are none to the eye, see `lamella.surface.boundary.curve.Loop`."""

    @property
    def slides(self) -> Sequence[Slide]:
        """Parts that are free to slide."""

    def at(self, t: Floats) -> Floats:
        """Points (n, 3), m."""


@dataclass(frozen=True)
class Film:
    """Curved elements whose boundary nodes are held by loops.

    Attributes
    ----------
    mesh : TriangleMesh
        Flat triangles, their vertices on the film.
    connectivity : Connectivity
    loops : tuple of Loop
    nodes : (n, 3)
        m.
    """

    mesh: TriangleMesh
    connectivity: Connectivity
    loops: tuple[Loop, ...]
    nodes: Floats

    @classmethod
    def on_mesh(cls, mesh: TriangleMesh, loops: Sequence[Loop], order: int) -> Film:
        """Elements of an order on flat triangles, with curved edges along the boundary."""
        connectivity = connect(mesh.faces, len(mesh.points), order)
        nodes = place_nodes(connectivity, mesh.points, mesh.loop, mesh.parameter, loops)
        return cls(mesh, connectivity, tuple(loops), nodes)

    def at(self, nodes: Floats) -> Film:
        """The same elements with other nodes."""
        result = replace(self, nodes=nodes)
        # what hangs on the elements alone is worked out once
        for name in ("unknowns", "pattern", "bordered_pattern", "_sliding"):
            if name in self.__dict__:
                result.__dict__[name] = self.__dict__[name]
        return result

    @cached_property
    def size(self) -> float:
        """Diagonal of the bounding box, m."""
        return diagonal(self.nodes)

    def loop_starts(self) -> Floats:
        """Where the loops begin, (loops, 3), m; of a loop that slides, before it did."""
        return np.concatenate([loop.at(np.zeros(1)) for loop in self.loops])

    def slide_ends(self) -> Floats:
        """Where parts of loops that slide begin and end, (k, 3), m: they stay where they were drawn."""
        ends = [
            loop.at(np.mod([slide.start, slide.end], 1.0))
            for loop in self.loops
            for slide in loop.slides
            if slide.end - slide.start < 1
        ]
        return np.concatenate([np.zeros((0, 3)), *ends])

    @cached_property
    def _sliding(self) -> list[tuple[Integers, Slide]]:
        """Nodes that slide, and on what; the ends of a sliding part are held."""
        result = []
        rim_nodes = self.connectivity.rim_nodes
        t = rim_parameters(self.connectivity, self.mesh.parameter)
        of_loop = self.mesh.loop[rim_nodes[:, 0]]
        for index, loop in enumerate(self.loops):
            mine = of_loop == index
            for slide in loop.slides:
                span = slide.end - slide.start
                along = (t[mine] - slide.start) % 1
                inside = (along > 1e-9) & (along < span - 1e-9) if span < 1 else np.ones(along.shape, bool)
                result.append((np.unique(rim_nodes[mine][inside]), slide))
        return result

    @cached_property
    def unknowns(self) -> Integers:
        """Number of each node's unknown, (n,); -1: held."""
        if not self._sliding:
            return self.connectivity.inner_unknowns
        free = self.connectivity.inner_unknowns >= 0
        for nodes, _ in self._sliding:
            free[nodes] = True
        return np.where(free, np.cumsum(free) - 1, -1)

    @cached_property
    def pattern(self) -> SymmetricPattern:
        """Pattern of the second variation."""
        if not self._sliding:
            return self.connectivity.inner_pattern
        return SymmetricPattern.from_elements(self.unknowns[self.connectivity.elements], int(self.unknowns.max()) + 1)

    @cached_property
    def bordered_pattern(self) -> SymmetricPattern:
        """The same with a multiplier: the mean curvature that goes with a given volume."""
        count = int(self.unknowns.max()) + 1
        return SymmetricPattern.from_elements(self.unknowns[self.connectivity.elements], count, border=1)

    def directions(self) -> Floats:
        """Unit directions in which the nodes move, (n, 3): smooth normals, on sliding rims within their support."""
        normals = smooth_normals(self.connectivity, self.nodes)
        if not self._sliding:
            return normals
        turned = np.zeros_like(normals)
        for nodes, slide in self._sliding:
            if slide.direction is not None:
                along = np.broadcast_to(slide.direction, (len(nodes), 3))
                along = along * np.sign((along * normals[nodes]).sum(1))[:, None]
            else:
                across = np.asarray(slide.normal)
                along = normals[nodes] - (normals[nodes] @ across)[:, None] * across
            length = np.linalg.norm(along, axis=1)
            if length.min(initial=1.0) < 1e-9:
                raise NoFilmError("the film lies flat on what it slides along", self)
            turned[nodes] = along / length[:, None] - normals[nodes]
        # the turn of the rim fades inwards, or the nodes next to it would be overtaken
        directions = normals + _harmonic(self, turned)
        return np.asarray(directions / np.linalg.norm(directions, axis=1)[:, None])


class NoFilmError(ArithmeticError):
    """A search ended without a film.

    Attributes
    ----------
    last : Film or None
        The last film on its way, with sound elements.
    """

    def __init__(self, message: str, last: Film | None = None) -> None:
        super().__init__(message)
        self.last = last


def moved_with_rim(film: Film, nodes: Floats) -> Film:
    """The film with its rim at given places, rows of (n, 3), its inside shifted harmonically with it."""
    shift = np.zeros_like(film.nodes)
    rim = film.connectivity.rim_nodes
    shift[rim] = nodes[rim] - film.nodes[rim]
    return film.at(film.nodes + _harmonic(film, shift))


def harmonic_over_itself(film: Film, mean_curvature: float = 0.0) -> Film:
    """The film whose coordinates solve Laplace x = 2 H n over the given one: smoother, and nearer to that H.

    Without H they are harmonic, and the area falls: Pinkall and Polthier, Experim. Math. 2 (1993), 15-36,
    doi:10.1080/10586458.1993.10504266.
    """
    return film.at(_harmonic(film, film.nodes, mean_curvature))


def _harmonic(film: Film, held: Floats, mean_curvature: float = 0.0) -> Floats:
    """Nodal values (n, 3) of f with Laplace f = 2 H n over a film, those on its boundary as in `held` (n, 3)."""
    connectivity = film.connectivity
    basis = connectivity.basis
    points, weights = triangle_rule(2 * basis.order)
    value, x, y = (basis.basis(points, *d) for d in ((0, 0), (1, 0), (0, 1)))
    a, b = tangents(x, y, film.nodes[connectivity.elements])
    blocks, _, _ = dirichlet_blocks(x, y, a, b, weights)
    free = connectivity.inner_unknowns >= 0
    pull = np.matmul(blocks, np.where(free[:, None], 0, held)[connectivity.elements])
    if mean_curvature:
        pull += 2 * mean_curvature * np.matmul(value.T, np.cross(a, b) * weights[:, None])
    flat = connectivity.elements.ravel()
    right = [-np.bincount(flat, pull[..., c].ravel(), len(free))[free].astype(np.float64) for c in range(3)]
    values = held.copy()
    pattern = connectivity.inner_pattern
    try:
        values[free] = pattern.factor(pattern.assemble(packed(blocks))).solve(np.stack(right, 1))
    except SingularError as error:
        raise NoFilmError(str(error), film) from None
    return values
