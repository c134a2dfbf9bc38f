"""Nets whose vertex stars lie on spheres or planes and whose polylines cross at a given angle."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from lamella.errors import InputError
from lamella.projection.constraint import Constraint
from lamella.projection.constraints.circle_angle import CircleAngle
from lamella.projection.constraints.curved_star import CurvedStar
from lamella.projection.constraints.equal_diagonals import EqualDiagonals
from lamella.projection.constraints.node_angle import NodeAngle
from lamella.projection.constraints.right_angle import RightAngle
from lamella.projection.constraints.spherical_star import SphericalStar
from lamella.projection.constraints.unit_length import UnitLength
from lamella.projection.determination import uncertainty
from lamella.projection.quad_mesh import QuadMesh
from lamella.projection.report import Iteration, Solution
from lamella.projection.smoothing import smoothed
from lamella.projection.solve import solve
from lamella.projection.unknowns import Block, Floats, Integers, dot
from lamella.projection.vertex_normals import smoothed_normals
from lamella.sparse import Backend

RightAngleForm = Literal["circles", "chords", "faces"]
"""Where a right angle between polylines is measured: three answers that differ by O(e^2).

circles
    At the vertices, between the circles through previous, own and next vertex (`CircleAngle`).
chords
    At the vertices, between the chords of opposite neighbours (`RightAngle`).
faces
    In the faces, between the lines that join the middles of opposite sides (`EqualDiagonals`).
"""

# a radius known worse than this share of itself is ill-determined
ACCURACY = 0.01
# least radius of the spheres in edges: below, neighbours would be on the other side of the sphere
LEAST_RADIUS = 2.0


@dataclass(frozen=True)
class StarNet:
    """A net with spherical or planar vertex stars.

    Attributes
    ----------
    mesh : QuadMesh
        Vertices in their order, faces as they came.
    radius : float
        Of the spheres, m; infinite: planes.
    radius_uncertainty : float
        Standard deviation of the radius, m, if the given vertices are as uncertain as they had to move; 0: it was
        given.
    normals : (s, 3)
        Of the stars of `mesh.inner`, towards the centres.
    solution : Solution
        How it was reached.
    """

    mesh: QuadMesh
    radius: float
    radius_uncertainty: float
    normals: Floats
    solution: Solution

    @property
    def ill_determined(self) -> bool:
        """Whether the net says too little about the radius: other radii do with about the same vertices."""
        return not self.radius_uncertainty <= ACCURACY * self.radius


def star_net(
    mesh: QuadMesh,
    radius: float | None,
    *,
    angle: float = 90.0,
    form: RightAngleForm = "circles",
    iterations: int = 50,
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
        How a right angle is measured, see `RightAngleForm`; other angles are between chords.
    iterations, tolerance, on_iteration, backend
        See `solve`.

    Raises
    ------
    InputError
        No inner vertices; a radius or an angle out of range; for angles other than 90, no two families of polylines.
    """
    edge, inner = mesh.mean_edge, mesh.inner
    _check(mesh, radius, angle, form)
    start = smoothed(mesh, backend=backend)
    normals = smoothed_normals(start)[inner]
    neighbours = mesh.stars(inner)
    bend = star_curvature(start.vertices, inner, neighbours, normals)
    # towards the centres
    if bend < 0:
        normals, bend = -normals, -bend
    blocks = [Block("vertices", start.vertices, edge, mesh.vertices)]
    found: list[Constraint] = []
    if radius is None:
        guess = 1 / max(bend, 1e-3 / _size(mesh))
        blocks += [
            Block("centres", start.vertices[inner] + guess * normals, guess),
            Block("radii", np.array([guess]), guess),
        ]
        found.append(
            SphericalStar(
                name="stars",
                middles=inner,
                neighbours=neighbours,
                radius_of=np.zeros(len(inner), np.int64),
                size=guess,
                edge=edge,
            )
        )
    else:
        blocks.append(Block("normals", normals))
        found += [
            CurvedStar(name="stars", centres=inner, neighbours=neighbours, curvature=1 / radius, edge=edge),
            UnitLength(name="unit normals", block="normals", index=np.arange(len(inner))),
        ]
    if angle == 90:
        found.append(_right_angle(mesh, form))
    else:
        stars = ordered_stars(mesh)
        v = start.vertices[stars]
        chords = np.stack([np.linalg.norm(v[:, j] - v[:, j + 2], axis=1) for j in (0, 1)], 1)
        blocks.append(Block("chords", chords, edge))
        # acute in one family is obtuse in the other: which of both the net has already
        met = dot(v[:, 0] - v[:, 2], v[:, 1] - v[:, 3]).mean()
        angle = angle if met * np.cos(np.radians(angle)) >= 0 else 180 - angle
        found.append(NodeAngle(name="angle", stars=stars, angle=angle, edge=edge))
    solution = solve(
        blocks,
        found,
        iterations=iterations,
        tolerance=tolerance,
        on_iteration=on_iteration,
        backend=backend,
    )
    at = solution.values
    doubt = 0.0
    if radius is None:
        radius = abs(float(at["radii"][0, 0]))
        normals = (at["centres"] - at["vertices"][inner]) / radius
        ended = [Block(b.name, at[b.name], b.scale) for b in blocks]
        moved = solution.last.drift["vertices"]
        known = solution.solved
        doubt = uncertainty(ended, found, "radii", "vertices", moved, backend=backend) if known else np.inf
    else:
        normals = at["normals"]
    return StarNet(mesh.at(at["vertices"]), radius, doubt, normals, solution)


def _right_angle(mesh: QuadMesh, form: RightAngleForm) -> Constraint:
    if form == "faces":
        # around a singular vertex corners share a full turn in other parts than quarters
        regular = ~np.isin(mesh.faces, mesh.singular).any(1)
        return EqualDiagonals(name="right angle", faces=mesh.faces[regular], edge=mesh.mean_edge)
    stars = mesh.stars(mesh.inner)
    if form == "chords":
        return RightAngle(name="right angle", stars=stars, edge=mesh.mean_edge)
    return CircleAngle(name="right angle", middles=mesh.inner, stars=stars, edge=mesh.mean_edge)


def star_curvature(vertices: Floats, middles: Integers, neighbours: Integers, normals: Floats) -> float:
    """Curvature k that fits n . d = k |d|^2 / 2 best over all legs d of all stars, 1/m."""
    count = neighbours.shape[1]
    d = (vertices[neighbours] - vertices[middles][:, None]).reshape(-1, 3)
    square = dot(d, d)[:, 0]
    height = dot(d, np.repeat(normals, count, axis=0))[:, 0]
    return float(2 * (height * square).sum() / (square * square).sum())


def ordered_stars(mesh: QuadMesh) -> Integers:
    """Stars of the regular inner vertices that begin with a neighbour along the first family."""
    stars, families = mesh.stars(mesh.inner), mesh.families
    second = families[mesh.leaving(mesh.inner)] == 1
    return np.where(second[:, None], np.roll(stars, 1, axis=1), stars)


def _size(mesh: QuadMesh) -> float:
    """Diagonal of the bounding box, m."""
    return float(np.linalg.norm(np.ptp(mesh.vertices, axis=0)))


def _check(mesh: QuadMesh, radius: float | None, angle: float, form: str) -> None:
    if not len(mesh.inner):
        raise InputError(
            "the mesh has no inner vertex with four neighbours: nothing to make spherical", "use a larger quad mesh"
        )
    if radius is not None and not radius >= LEAST_RADIUS * mesh.mean_edge:
        raise InputError(
            f"radius = {radius:g} m is below {LEAST_RADIUS:g} mean edges of {mesh.mean_edge:.4g} m",
            "give the radius in the unit of the mesh, or refine the mesh; infinite: planes",
        )
    if not 10 <= angle <= 170:
        raise InputError(f"angle = {angle:g} degrees", "between 10 and 170 degrees")
    if form not in get_args(RightAngleForm):
        raise InputError(f"form = {form!r}", f"one of {', '.join(get_args(RightAngleForm))}")
