"""How much the vertices of a mesh may scatter: what was done to them, and what is too much."""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.errors import InputError
from lamella.base.message import Message
from lamella.surface.from_mesh.edges import vertex_normals
from lamella.surface.from_mesh.vertex_fits import disagreement, fit_vertices
from lamella.surface.from_mesh.vertex_noise import READING, Smoothed, without_scatter

# of the curvature scale: what scatter leaves open at half of the vertices; with more, even signs are unknown
FIT_OPEN = 1.0
# of that limit, what a scatter that is offered may leave open in each of some draws; halvings until one does
SCATTER_ENOUGH, DRAWS, SCATTER_HALVINGS_MAX = 0.7, 3, 6


def moved_by_scatter(smoothed: Smoothed, given: Floats, border: Booleans) -> Message:
    """What was done to vertices that scatter."""
    move = 1000 * np.linalg.norm(smoothed.points - given, axis=1)
    rim = float(move[border].max(initial=0))
    return Message(
        "mesh_scatter",
        f"its vertices scatter by {1000 * smoothed.scatter:.2g} mm (standard deviation) about a smooth surface; that "
        f"was taken, which moves vertices by up to {move.max():.2g} mm ({np.sqrt((move**2).mean()):.2g} mm root mean "
        f"square), " + (f"those of the border by up to {rim:.2g} mm" if rim else "none of the border"),
    )


def too_scattered(smoothed: Smoothed, faces: Integers, border: Booleans, error: float, scale: float) -> InputError:
    """The refusal of a mesh whose vertices scatter too much, with the scatter that would do."""
    enough = _endurable(smoothed, faces, border, scale)
    return InputError(
        f"the mesh is too rough to tell a curvature: its vertices scatter by {1000 * smoothed.scatter:.2g} mm "
        f"(standard deviation) about a smooth surface, which leaves normal curvatures open by {error:.2g} of the "
        f"curvature scale {scale:.4g} 1/m at half of them (limit {FIT_OPEN:g})",
        f"with these edges vertices have to be known to {1000 * enough:.2g} mm (standard deviation)"
        if enough
        else "give a finer mesh: with these edges no scatter is small enough",
        "faces",
    )


def _endurable(smoothed: Smoothed, faces: Integers, border: Booleans, scale: float) -> float:
    """A scatter of the same mesh that leaves half of its curvatures open by less than the limit, m; 0: there is none.

    By draws, since what is left open does not go with the scatter in proportion: more of it is smoothed more.
    """
    normals = vertex_normals(smoothed.points, faces)
    for scatter in smoothed.scatter * np.cumprod(np.full(SCATTER_HALVINGS_MAX, 0.5)):
        for seed in range(DRAWS):
            noise = scatter * np.random.default_rng(seed).normal(size=(len(normals), 1))
            points = smoothed.points + noise * normals
            found = without_scatter(points, faces, border)
            if found is None:
                errors = disagreement(fit_vertices(points, faces), faces)
            else:
                errors = disagreement(fit_vertices(found.points, faces, READING), faces, 1.0) + found.curvature_error
            if np.median(errors) > SCATTER_ENOUGH * FIT_OPEN * scale:
                break
        else:
            return float(scatter)
    return 0.0
