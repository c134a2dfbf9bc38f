"""Straightening: from a principal mesh to an isothermic one to a net of lamellas (paper, Figure 6)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.errors import InputError
from lamella.base.result import Result
from lamella.base.sparse import Backend
from lamella.projection.constraint import Constraint
from lamella.projection.constraints.closeness import Closeness
from lamella.projection.constraints.conformal import Conformal
from lamella.projection.constraints.edge_alignment import EdgeAlignment
from lamella.projection.constraints.fairness import fairness
from lamella.projection.foot_points import DirectedSurface
from lamella.projection.quad_mesh import QuadMesh, collapsed, quad_mesh
from lamella.projection.report import Iteration, Solution
from lamella.projection.solve import solve
from lamella.projection.unknowns import Block

# of the mean edge: a vertex farther from its foot point is beyond the surface's border
BEYOND = 0.1
# weight of third differences at the start and per iteration
STRAIGHTEN_FAIRNESS, STRAIGHTEN_FADE = 0.1, 0.3


@dataclass(frozen=True, eq=False, repr=False)
class Straightened(Result):
    """The three meshes of the paper's Figure 6 but the first, which was given.

    Attributes
    ----------
    isothermic : QuadMesh
        M1: faces as square as they can be, edges along principal directions, vertices on the surface.
    lamellas : QuadMesh
        M2: its vertices are the middles of M1's edges, moved onto the surface; its polylines have constant normal
        curvature.
    circles : (n,)
        Radii l_i of the circles about M1's vertices, m.
    solution : Solution
        The remainder by constraint: "on the surface", "principal directions", "square faces".
    """

    isothermic: QuadMesh
    lamellas: QuadMesh
    circles: Floats
    solution: Solution

    def _line(self) -> str:
        return f"isothermic {self.isothermic}, lamellas {self.lamellas}, {self.solution.verdict}"


def straighten(
    mesh: QuadMesh,
    surface: DirectedSurface,
    *,
    iterations: int = 100,
    tolerance: float = 1e-8,
    on_iteration: Callable[[Iteration], None] | None = None,
    backend: Backend | None = None,
) -> Straightened:
    """Let a principal mesh slide along principal directions until its faces are squares; join their middles.

    Closeness (1), alignment (2) and conformality (2, less the circle) are four conditions on the three coordinates of
    a vertex. Symmetric meshes meet them all; on others a remainder stays, small where the edges are, told by
    constraint.

    Parameters
    ----------
    mesh : QuadMesh
        M0, about along principal directions. Its boundary is free to slide over the surface, which therefore should
        go on beyond it.
    surface : DirectedSurface
        Of constant mean curvature, see `lamella.projection.foot_points.foot_surface`.
    iterations, tolerance, on_iteration, backend
        See `solve`.

    Raises
    ------
    InputError
        A mesh of a single face.

    Examples
    --------
    >>> import lamella, numpy as np
    >>> surface = lamella.Catenoid(2.0, (-2.0, 2.0))
    >>> U, V = np.mgrid[0:5, 0:5].reshape(2, -1) / 5 - 0.4
    >>> k = np.arange(25).reshape(5, 5)
    >>> faces = np.stack([k[:-1, :-1], k[1:, :-1], k[1:, 1:], k[:-1, 1:]], -1).reshape(-1, 4)
    >>> mesh = lamella.quad_mesh(surface.at(U + 1j * V).position, faces)
    >>> lamella.straighten(mesh, lamella.foot_surface(surface)).solution.verdict
    'solved'
    """
    if len(mesh.faces) < 2:
        raise InputError("the mesh has a single face: its middles make no net", "use a larger mesh")
    edge, everywhere = mesh.mean_edge, np.arange(len(mesh.vertices))
    hard: list[Constraint] = [
        Closeness(name="on the surface", index=everywhere, surface=surface, edge=edge),
        EdgeAlignment(name="principal directions", edges=mesh.edges, surface=surface, edge=edge),
        Conformal(name="square faces", edges=mesh.edges, edge=edge),
    ]
    # half the mean of the edges at each vertex
    length = np.linalg.norm(np.diff(mesh.vertices[mesh.edges], axis=1)[:, 0], axis=1)
    total = np.bincount(mesh.edges.ravel(), np.repeat(length, 2), len(mesh.vertices))
    circles = total / np.maximum(2 * mesh.valence, 1)
    solution = solve(
        [Block("vertices", mesh.vertices, edge), Block("circles", circles, edge)],
        [*hard, *fairness(mesh, 3, weight=STRAIGHTEN_FAIRNESS, fade=STRAIGHTEN_FADE)],
        iterations=iterations,
        tolerance=tolerance,
        on_iteration=on_iteration,
        backend=backend,
    )
    isothermic = mesh.at(solution.values["vertices"])
    # closeness counts across the surface only
    away = np.linalg.norm(isothermic.vertices - surface.foot(isothermic.vertices).position, axis=1)
    if collapsed(mesh, isothermic):
        solution = replace(solution, verdict="collapsed")
    elif away.max() > BEYOND * edge:
        solution = replace(solution, verdict="left the surface")
    middles = edge_middles(isothermic)
    return Straightened(
        isothermic,
        middles.at(surface.foot(middles.vertices).position),
        solution.values["circles"][:, 0],
        solution,
    )


def edge_middles(mesh: QuadMesh) -> QuadMesh:
    """The mesh of the middles of all edges: a quad in each face and one around each inner vertex of valence 4.

    Around vertices of another valence the middles form another polygon, which is left open.
    """
    around = mesh.edge_of[mesh.spokes(mesh.inner)]
    faces = np.concatenate([mesh.edge_of.reshape(-1, 4), around])
    return quad_mesh(mesh.vertices[mesh.edges].mean(1), faces)
