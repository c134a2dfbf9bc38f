"""Figures of a net vertex by vertex and face by face, measured on its vertices alone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats
from lamella.projection.quad_mesh import QuadMesh
from lamella.projection.star_measures import circle_angles, star_spheres
from lamella.strip.planarity import planarity_score

# stars whose sphere is larger than this many mean edges are planes as far as double precision can tell
PLANE_RADIUS = 1e7


@dataclass(frozen=True)
class MeshFigures:
    """What can be measured on a net.

    Attributes
    ----------
    vertices : name to (n,)
        NaN at vertices without a star of four neighbours: on the boundary, and singular ones.
        "star_sphericity", "star_planarity": root mean square distance of a vertex and its neighbours from their best
        sphere, and plane, m. "star_curvature": 1 / radius of the sphere, 1/m, positive where its centre is on the
        side from which faces are counter-clockwise. "star_radius": m, NaN for planes. "angle": between both
        polylines, degrees. "moved": distance from where the vertex was, m, if that is known.
    faces : name to (f,)
        "planarity": distance of the diagonals over their mean length (paper, section 2.3).
    """

    vertices: dict[str, Floats]
    faces: dict[str, Floats]

    def summary(self) -> dict[str, dict[str, float]]:
        """Least, median and largest of each figure that has values."""
        found = {}
        for name, values in (*self.vertices.items(), *self.faces.items()):
            known = values[np.isfinite(values)]
            if len(known):
                found[name] = {
                    "least": float(known.min()),
                    "median": float(np.median(known)),
                    "largest": float(known.max()),
                }
        return found


def mesh_figures(mesh: QuadMesh, before: QuadMesh | None = None) -> MeshFigures:
    """Measure a net; with `before`, the same net elsewhere, also how far vertices have moved."""
    count, inner = len(mesh.vertices), mesh.inner
    names = ("star_sphericity", "star_planarity", "star_curvature", "star_radius", "angle")
    vertices = {name: np.full(count, np.nan) for name in names}
    if len(inner):
        stars = star_spheres(mesh, inner)
        bend = np.abs(stars.curvature)
        radius = np.where(bend * mesh.mean_edge * PLANE_RADIUS > 1, 1 / np.where(bend > 0, bend, 1), np.nan)
        measured = (stars.deviation, stars.planarity, stars.curvature, radius, circle_angles(mesh, inner))
        for name, values in zip(names, measured, strict=True):
            vertices[name][inner] = values
    if before is not None:
        vertices["moved"] = np.linalg.norm(mesh.vertices - before.vertices, axis=1)
    v1, v2, v3, v4 = mesh.vertices[mesh.faces].swapaxes(0, 1)
    return MeshFigures(vertices, {"planarity": planarity_score(v1, v2, v3, v4)})
