"""A quad mesh that was optimised, and what can be told of one before."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from lamella.base.arrays import Floats
from lamella.projection.quad_mesh import QuadMesh
from lamella.projection.report import Solution


@dataclass(frozen=True)
class Optimised:
    """A result.

    Attributes
    ----------
    mesh : QuadMesh
        Vertices and faces in the order they were given; of "planar": the strips.
    same : bool
        Whether it has the vertices that were given.
    lamellas : QuadMesh or None
        Of "straighten": M2.
    solutions : tuple of Solution
        In the order they were reached; the last one is that of `mesh`.
    reported : dict
        What the problem says besides, for JSON.
    remarks : tuple of str
        What the user should know.
    faces : name to (f,)
        More figures of faces.
    """

    mesh: QuadMesh
    solutions: tuple[Solution, ...]
    same: bool = True
    lamellas: QuadMesh | None = None
    reported: dict[str, Any] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()
    faces: dict[str, Floats] = field(default_factory=dict)

    @property
    def solved(self) -> bool:
        """Whether all conditions hold in the end, whatever was met on the way."""
        return self.solutions[-1].solved


def about_mesh(mesh: QuadMesh) -> dict[str, Any]:
    """What was given: sizes, and its singular vertices of valence 3, 5, 6 and more by their number."""
    rim = mesh.on_boundary
    # a vertex of the boundary ends polylines unless it has three neighbours, or two in a corner
    return {
        "vertices": len(mesh.vertices),
        "faces": len(mesh.faces),
        "mean_edge": mesh.mean_edge,
        "inner_regular_vertices": len(mesh.inner),
        "boundary_vertices": int(rim.sum()),
        "corners": np.flatnonzero(rim & (mesh.face_count == 1)).tolist(),
        "singular_vertices": [{"vertex": int(k), "valence": int(mesh.valence[k])} for k in mesh.singular],
    }
