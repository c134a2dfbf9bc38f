"""Nets that are bent without stretching: edge lengths and vertex stars kept, one ring driven (paper, Figure 8)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from lamella.base.arrays import Floats, Integers
from lamella.base.errors import InputError
from lamella.base.result import Result
from lamella.base.sparse import Backend
from lamella.projection.constraint import Constraint
from lamella.projection.constraints.curved_star import CurvedStar
from lamella.projection.constraints.edge_length import EdgeLength
from lamella.projection.constraints.fairness import fairness
from lamella.projection.constraints.unit_length import UnitLength
from lamella.projection.problems.star_net import require_radius
from lamella.projection.quad_mesh import QuadMesh
from lamella.projection.report import Iteration, Solution
from lamella.projection.solve import solve
from lamella.projection.star_measures import circle_angles, star_spheres
from lamella.projection.unknowns import Block
from lamella.projection.vertex_normals import smoothed_normals

# change of the ring's size from one state to the next
STEP = 0.02
# weight of third differences and its fade: corners of the rim hang on two edges and would turn about them
DEFORM_FAIRNESS, DEFORM_FADE = 0.03, 0.1
# last digits of coordinates that lengths and stars of a net can be off by
COORDINATE_DIGITS = 4.0


@dataclass(frozen=True, eq=False, repr=False)
class DeformedState(Result):
    """One state on the way.

    Attributes
    ----------
    share : float
        Size of the ring over that at the start.
    mesh : QuadMesh
    solution : Solution
        Its last record is the remainder by constraint: "edges", "stars", "ring", in edges.
    angle_change : (s,)
        Of the angle between both polylines at the vertices `mesh.inner` since the start, degrees.
    """

    share: float
    mesh: QuadMesh
    solution: Solution
    angle_change: Floats

    def _line(self) -> str:
        return f"share {self.share:.4g}, {self.mesh}, {self.solution.verdict}"


def deform(
    mesh: QuadMesh,
    ring: ArrayLike,
    share: float,
    *,
    radius: float | None = None,
    closed: bool = True,
    step: float = STEP,
    iterations: int = 50,
    tolerance: float = 1e-10,
    on_iteration: Callable[[Iteration], None] | None = None,
    backend: Backend | None = None,
) -> tuple[DeformedState, ...]:
    """Drive the size of a ring while edges keep their lengths and stars their spheres.

    These are four conditions on the three coordinates of a vertex: nets with symmetry (rotational ones) meet them
    all, on others each state has the least remainder, told by constraint.

    Parameters
    ----------
    mesh : QuadMesh
        Deformed from here; lengths are kept as they are.
    ring : (k,) int
        Vertices in order, no two neighbours joined by an edge: a horizontal circle of a rotational net runs across
        the diagonals of its quads. Distances to the next and the next but one vertex shrink or grow alike, so the
        ring keeps its shape.
    share : float
        Size of the ring at the end over that at the start: 0.8 for 20 % less.
    radius : float, optional
        Of the stars' spheres, m, infinite: planes. Default: the median of the mesh.
    closed : bool
        Whether the last vertex is next to the first.
    step : float
        Most change of the share from one state to the next.
    iterations, tolerance, on_iteration, backend
        See `solve`, for each state.

    Returns
    -------
    tuple of DeformedState
        From the start, share 1, to the end. The way ends early at a state whose equations break off or that uses up
        its iterations.

    Raises
    ------
    InputError
        A ring with too few vertices, with one twice or with an edge; a share, a step or a radius out of range.

    Examples
    --------
    >>> import lamella, numpy as np
    >>> turn, row = np.mgrid[0:12, 0:5].reshape(2, -1)
    >>> angle, z = (turn + row / 2) * np.pi / 6, 0.5 * row
    >>> points = np.stack([3 * np.cos(angle), 3 * np.sin(angle), z], 1)
    >>> k = np.arange(60).reshape(12, 5)
    >>> right = np.roll(k, -1, 0)
    >>> faces = np.stack([k[:, 1:-1], right[:, :-2], right[:, 1:-1], k[:, 2:]], -1).reshape(-1, 4)
    >>> states = lamella.deform(lamella.quad_mesh(points, faces), k[:, 2], 0.95)
    >>> print(len(states), round(states[-1].share, 2))
    4 0.95
    """
    vertices = np.asarray(ring)
    _check(mesh, vertices, share, step)
    if radius is not None:
        require_radius(mesh, radius)
    # far from the origin rounding is larger than the tolerance: what is given is known to its last digit only
    tolerance = max(tolerance, COORDINATE_DIGITS * float(np.spacing(np.abs(mesh.vertices).max())) / mesh.mean_edge)
    origin = mesh.vertices.mean(0)
    mesh = mesh.at(mesh.vertices - origin)
    edge, inner, stars = mesh.mean_edge, mesh.inner, mesh.stars(mesh.inner)
    pairs = _pairs(vertices.astype(np.int64), closed)
    normals = smoothed_normals(mesh)[inner]
    bend = float(np.median(star_spheres(mesh, inner).curvature))
    if bend < 0:
        normals, bend = -normals, -bend
    curvature = bend if radius is None else 1 / radius
    before = circle_angles(mesh, inner)
    states: list[DeformedState] = []
    fair = fairness(mesh, 3, weight=DEFORM_FAIRNESS, fade=DEFORM_FADE)
    current = mesh.vertices
    for now in np.linspace(1.0, share, 1 + int(np.ceil(abs(share - 1) / step - 1e-9))):
        constraints: list[Constraint] = [
            EdgeLength(name="edges", edges=mesh.edges, lengths=_lengths(mesh.vertices, mesh.edges), edge=edge),
            CurvedStar(name="stars", centres=inner, neighbours=stars, curvature=curvature, edge=edge),
            UnitLength(name="unit normals", block="normals", index=np.arange(len(inner))),
            EdgeLength(name="ring", edges=pairs, lengths=float(now) * _lengths(mesh.vertices, pairs), edge=edge),
        ]
        solution = solve(
            [Block("vertices", current, edge), Block("normals", normals)],
            [*constraints, *(fair if states else ())],  # nothing is to move at the start
            iterations=iterations,
            tolerance=tolerance,
            on_iteration=on_iteration,
            backend=backend,
        )
        current, normals = solution.values["vertices"], solution.values["normals"]
        moved = mesh.at(current + origin)
        solution = replace(solution, values={**solution.values, "vertices": moved.vertices})
        states.append(DeformedState(float(now), moved, solution, circle_angles(moved, inner) - before))
        if solution.verdict in ("broken off", "iterations used up"):
            break
    return tuple(states)


def _pairs(ring: Integers, closed: bool) -> Integers:
    """Each vertex with the next and the next but one, (m, 2)."""
    found = []
    for ahead in (1, 2):
        pairs = np.column_stack([ring, np.roll(ring, -ahead)])
        found.append(pairs if closed else pairs[:-ahead])
    return np.unique(np.sort(np.concatenate(found), axis=1), axis=0)


def _lengths(vertices: Floats, pairs: Integers) -> Floats:
    return np.asarray(np.linalg.norm(vertices[pairs[:, 1]] - vertices[pairs[:, 0]], axis=1))


def _check(mesh: QuadMesh, ring: Integers, share: float, step: float) -> None:
    if ring.ndim != 1 or len(ring) < 3 or not np.issubdtype(ring.dtype, np.integer):
        raise InputError(f"ring has shape {ring.shape} and type {ring.dtype}", "at least three vertex indices in order")
    if ring.min() < 0 or ring.max() >= len(mesh.vertices):
        raise InputError(
            f"ring names vertex {ring.min() if ring.min() < 0 else ring.max()}",
            f"indices run from 0 to {len(mesh.vertices) - 1}",
        )
    if len(np.unique(ring)) < len(ring):
        raise InputError("ring has a vertex twice", "list each vertex once; a closed ring closes by itself")
    count = len(mesh.vertices)
    known = np.sort(mesh.edges, axis=1) @ [count, 1]
    joined = np.flatnonzero(np.isin(np.sort(np.column_stack([ring[:-1], ring[1:]]), axis=1) @ [count, 1], known))
    if len(joined):
        raise InputError(
            f"ring vertices {ring[joined[0]]} and {ring[joined[0] + 1]} are joined by an edge, whose length is kept",
            "choose a ring across the diagonals of the quads",
        )
    if not 0.05 <= share <= 5:
        raise InputError(f"share = {share!r} is out of range", "between 0.05 and 5; 0.8 for a ring 20 % smaller")
    if not 1e-4 <= step <= 1:
        raise InputError(f"step = {step!r} is out of range", "between 0.0001 and 1")
    if not len(mesh.inner):
        raise InputError("the mesh has no inner vertex with four neighbours", "use a larger quad mesh")
