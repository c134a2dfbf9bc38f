"""What the view shows of a surface."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from lamella.stages.surface.output import SurfaceOutput
from lamella.surface.mesh import SurfaceMesh
from lamella.view.scene.layer import LinesLayer, MeshLayer
from lamella.view.scene.scene import Remark, Shown
from lamella.view.scene.surface_quantities import surface_quantities
from lamella.view.scene.thinning import clusters, distinct_triangles, rim_edges

VERTEX_LIMIT = 30_000
"""Surface vertices in a view."""

COARSE_MESH_POINTS = 7_500
"""Vertices below which the view's mesh of a surface of curved elements is made anew, with `VIEW_SAG`."""

VIEW_SAG = 2.5e-4
"""A quarter of what the files' mesh has, over the diagonal of the bounding box: four times the vertices."""

VEIL = 0.42
"""Opacity of a surface among the strips that stand on it."""


def surface_scene(out: SurfaceOutput, *, alone: bool) -> Iterator[Shown]:
    """The surface, with its rim where nothing stands on it.

    Parameters
    ----------
    out : SurfaceOutput
    alone : bool
        Whether there is no net.
    """
    mesh = _view_mesh(out)
    quantities = surface_quantities(mesh, out.surface.mean_curvature)
    kept, labels = clusters(mesh.points, VERTEX_LIMIT)
    triangles = np.concatenate([mesh.faces[:, [0, 1, 2]], mesh.faces[:, [0, 2, 3]]])
    if len(kept) < len(mesh.points):
        yield Remark(f"Surface drawn with {len(kept):,} of {len(mesh.points):,} vertices; the other files hold all.")
        triangles = labels[triangles]
    triangles = distinct_triangles(triangles, len(kept))
    yield MeshLayer(
        name="surface",
        label="Surface",
        groups=("Surface",),
        material="surface",
        opacity=1.0 if alone else VEIL,
        quantities=tuple(quantity.of(kept) for quantity in quantities.values()),
        # without strips to look at, the surface is what there is to see
        palette="Surface",
        quantity="K" if alone and not quantities["K"].is_constant else "",
        positions=mesh.points[kept],
        normals=mesh.normals[kept],
        faces=triangles,
    )
    edges = rim_edges(triangles)
    if alone and len(edges):
        yield LinesLayer(
            name="rim",
            label="Rim",
            groups=("Surface",),
            positions=mesh.points[kept][edges].reshape(-1, 3),
            offsets=np.arange(0, 2 * len(edges) + 1, 2),
            width=2.0,
        )


def _view_mesh(out: SurfaceOutput) -> SurfaceMesh:
    """Finer than the files' where that is coarse, so that curved rims look curved."""
    # heavy, and closed forms do without
    from lamella.surface.element.surface import ElementSurface

    if isinstance(out.surface, ElementSurface) and len(out.mesh.points) < COARSE_MESH_POINTS:
        return out.surface.mesh(VIEW_SAG)
    return out.mesh
