"""Nets whose vertex stars lie on spheres or planes and whose polylines cross at a given angle."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import get_args

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.result import Result
from lamella.base.sparse import Backend
from lamella.projection.constraints.curved_star import CurvedStar
from lamella.projection.constraints.unit_length import UnitLength
from lamella.projection.problems.crossing import AngleForm, crossing
from lamella.projection.problems.star_radius import find_radius, star_curvature
from lamella.projection.quad_mesh import QuadMesh, collapsed
from lamella.projection.report import Iteration, Solution
from lamella.projection.smoothing import smoothed
from lamella.projection.solve import solve
from lamella.projection.unknowns import Block
from lamella.projection.vertex_normals import smoothed_normals

# a radius known worse than this share of itself is ill-determined
ACCURACY = 0.01
# least radius of the spheres in edges: below, neighbours would be on the other side of the sphere
LEAST_RADIUS = 2.0


@dataclass(frozen=True, eq=False, repr=False)
class StarNet(Result):
    """A net with spherical or planar vertex stars.

    Attributes
    ----------
    mesh : QuadMesh
        Vertices in their order, faces as they came.
    radius : float
        Of the spheres, m; infinite: planes.
    radius_uncertainty : float
        Standard deviation of the radius, m, with the noise of the given vertices, see `find_radius`; 0: it was given.
    normals : (s, 3)
        Of the stars of `mesh.inner`, towards the centres.
    solution : Solution
        How it was reached, with the radius.
    """

    mesh: QuadMesh
    radius: float
    radius_uncertainty: float
    normals: Floats
    solution: Solution

    def _line(self) -> str:
        return f"{self.mesh}, radius {self.radius:.6g} m, {self.solution.verdict}"

    @property
    def ill_determined(self) -> bool:
        """Whether the net says too little about the radius: other radii do with about the same vertices."""
        return not self.radius_uncertainty <= ACCURACY * self.radius


def star_net(
    mesh: QuadMesh,
    radius: float | None,
    *,
    angle: float = 90.0,
    form: AngleForm = "circles",
    iterations: int = 100,
    tolerance: float = 1e-10,
    on_iteration: Callable[[Iteration], None] | None = None,
    backend: Backend | None = None,
) -> StarNet:
    """Move a net's vertices as little as needed until stars are spherical and polylines cross at the angle.

    Noise is filtered out first (`smoothed`): stars fitted to noise would lead anywhere. Inside the net these are three
    conditions on the three coordinates of a vertex, at singular vertices none: with a free boundary they hold together
    to rounding.

    Parameters
    ----------
    mesh : QuadMesh
    radius : float or None
        Of the spheres, m; infinite: planes; None: one for all stars, to be found.
    angle : float
        Between the polylines of both families (`QuadMesh.families`), degrees; it or its supplement, whichever is
        nearer to the net.
    form : "circles", "chords" or "faces"
        How the angle is measured, see `AngleForm`.
    iterations, tolerance, on_iteration, backend
        See `solve`.

    Raises
    ------
    InputError
        No inner vertices; a radius or an angle out of range; for angles other than 90, no two families of polylines.
    """
    _check(mesh, radius, angle, form)
    given, origin = mesh, mesh.vertices.mean(0)
    # far from the origin rounding is larger than the tolerance
    mesh = given.at(given.vertices - origin)
    edge, inner = mesh.mean_edge, mesh.inner
    start = smoothed(mesh, backend=backend)
    doubt = 0.0
    if radius is None:
        found = find_radius(
            mesh,
            start,
            angle,
            form,
            iterations=iterations,
            tolerance=tolerance,
            on_iteration=on_iteration,
            backend=backend,
        )
        radius, doubt = max(found.radius, LEAST_RADIUS * edge), found.uncertainty
    neighbours = mesh.stars(inner)
    normals = smoothed_normals(start)[inner]
    # towards the centres
    if star_curvature(start.vertices, inner, neighbours, normals) < 0:
        normals = -normals
    more, angles = crossing(start, angle, form)
    solution = solve(
        [Block("vertices", start.vertices, edge, mesh.vertices), Block("normals", normals), *more],
        [
            CurvedStar(name="stars", centres=inner, neighbours=neighbours, curvature=1 / radius, edge=edge),
            UnitLength(name="unit normals", block="normals", index=np.arange(len(inner))),
            *angles,
        ],
        iterations=iterations,
        tolerance=tolerance,
        on_iteration=on_iteration,
        backend=backend,
    )
    net = mesh.at(solution.values["vertices"] + origin)
    solution = replace(solution, values={**solution.values, "vertices": net.vertices})
    if collapsed(given, net):
        solution = replace(solution, verdict="collapsed")
    return StarNet(net, radius, doubt, solution.values["normals"], solution)


def require_radius(mesh: QuadMesh, radius: float) -> None:
    """Raise `InputError` for spheres on which a star has no room."""
    if not radius >= LEAST_RADIUS * mesh.mean_edge:
        raise InputError(
            f"radius = {radius:g} m is below {LEAST_RADIUS:g} mean edges of {mesh.mean_edge:.4g} m",
            "give the radius in the unit of the mesh, or refine the mesh; infinite: planes",
        )


def _check(mesh: QuadMesh, radius: float | None, angle: float, form: str) -> None:
    if not len(mesh.inner):
        raise InputError(
            "the mesh has no inner vertex with four neighbours: nothing to make spherical", "use a larger quad mesh"
        )
    if radius is not None:
        require_radius(mesh, radius)
    if not 10 <= angle <= 170:
        raise InputError(f"angle = {angle:g} degrees", "between 10 and 170 degrees")
    if form not in get_args(AngleForm):
        raise InputError(f"form = {form!r}", f"one of {', '.join(get_args(AngleForm))}")
    if form == "faces" and angle != 90:
        raise InputError(
            f'form = "faces" measures right angles only, angle = {angle:g} degrees', 'use "circles" or "chords"'
        )
    a, b = mesh.vertices[mesh.edges].swapaxes(0, 1)
    flat = np.flatnonzero((a == b).all(1))
    if len(flat):
        i, j = mesh.edges[flat[0]]
        raise InputError(f"vertices {i} and {j} of an edge are in one place", "merge them, or move one")
