"""The radius of spherical vertex stars that a net itself suggests, and how well it knows it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.sparse import Backend
from lamella.base.vectors import diagonal
from lamella.projection.constraints.curved_star import CurvedStar
from lamella.projection.constraints.fixed import Fixed
from lamella.projection.constraints.shared_length import SharedLength
from lamella.projection.determination import uncertainty
from lamella.projection.problems.crossing import AngleForm, crossing
from lamella.projection.quad_mesh import QuadMesh
from lamella.projection.report import Iteration
from lamella.projection.solve import solve
from lamella.projection.unknowns import Block, dot
from lamella.projection.vertex_normals import smoothed_normals

# weight of the given vertices and its fade: while it lasts the radius follows the whole net; a heavier one pulls the
# net off its constraints, and the way back through its softest modes is long
RADIUS_STAY, RADIUS_FADE = 0.01, 0.3
# largest radius to look for, in sizes of the mesh: a flatter net is a plane, whose radius nothing determines
STAR_RADIUS_MAX = 1e3


@dataclass(frozen=True)
class StarRadius:
    """A radius with its standard deviation, m; infinite: the net does not determine it."""

    radius: float
    uncertainty: float


def find_radius(
    mesh: QuadMesh,
    start: QuadMesh,
    angle: float,
    form: AngleForm,
    *,
    iterations: int,
    tolerance: float,
    on_iteration: Callable[[Iteration], None] | None = None,
    backend: Backend | None = None,
) -> StarRadius:
    """Radius of the nearest net with spherical stars of one radius and the given angle.

    Nearest to the vertices given: with noise of equal size on all coordinates that is the most likely radius. Its
    uncertainty follows from the noise, the moves over the square root of what the constraints take away (3 conditions
    a star, less the radius), and from how much a net has to move for another radius (`uncertainty`).

    Parameters
    ----------
    mesh, start : QuadMesh
        As given, and without its noise.
    angle, form
        See `crossing`.
    iterations, tolerance, on_iteration, backend
        See `solve`.
    """
    edge, inner, neighbours = mesh.mean_edge, mesh.inner, mesh.stars(mesh.inner)
    normals = smoothed_normals(start)[inner]
    bend = star_curvature(start.vertices, inner, neighbours, normals)
    size = diagonal(mesh.vertices)
    if abs(bend) * STAR_RADIUS_MAX * size < 1:
        return StarRadius(STAR_RADIUS_MAX * size, np.inf)
    radius = 1 / abs(bend)
    more, angles = crossing(start, angle, form)
    blocks = [
        Block("vertices", start.vertices, edge, mesh.vertices),
        Block("normals", np.copysign(1, bend) * normals),
        Block("share", np.array([1.0])),
        *more,
    ]
    stars = (
        CurvedStar(name="stars", centres=inner, neighbours=neighbours, curvature=1 / radius, edge=edge),
        SharedLength(name="one radius", block="normals", length="share", index=np.arange(len(inner))),
    )
    stay = Fixed(
        name="given vertices",
        index=np.arange(len(mesh.vertices)),
        points=mesh.vertices,
        edge=edge,
        weight=RADIUS_STAY,
        fade=RADIUS_FADE,
        hard=False,
    )
    solution = solve(
        blocks,
        [*stars, *angles, stay],
        iterations=iterations,
        tolerance=tolerance,
        on_iteration=on_iteration,
        backend=backend,
    )
    found = radius * abs(float(solution.values["share"][0, 0]))
    if not solution.solved:
        return StarRadius(found, np.inf)
    taken = max(3 * len(inner) - 1, 1)
    noise = solution.last.drift["vertices"] * np.sqrt(mesh.vertices.size / taken)
    ended = [Block(block.name, solution.values[block.name], block.scale) for block in blocks]
    doubt = uncertainty(ended, [*stars, *angles], "share", "vertices", noise, backend=backend)
    return StarRadius(found, radius * doubt)


def star_curvature(vertices: Floats, middles: Integers, neighbours: Integers, normals: Floats) -> float:
    """Curvature k that fits n . d = k |d|^2 / 2 best over all legs d of all stars, 1/m."""
    count = neighbours.shape[1]
    d = (vertices[neighbours] - vertices[middles][:, None]).reshape(-1, 3)
    square = dot(d, d)[:, 0]
    height = dot(d, np.repeat(normals, count, axis=0))[:, 0]
    return float(2 * (height * square).sum() / (square * square).sum())
