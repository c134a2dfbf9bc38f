"""Vertices that scatter about a smooth surface: how much, and where they are without it.

Polynomials around each vertex miss a smooth surface by a power of their reach, and vertices that scatter by the scatter
itself, however many of them there are. So a scatter is what wider fits miss no more than narrow ones. A scatter of s
at edges of length h bends the surface by up to 8 s / h^2; the mean over n vertices within a reach of R leaves some
10 s / (R^2 sqrt(n)).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lamella.surface.imported.edges import Booleans, vertex_areas, vertex_normals
from lamella.surface.imported.raw_mesh import Floats, Integers
from lamella.surface.imported.vertex_fits import EXPONENTS, local_heights, solved

NARROW, WIDER = 30, (60, 100)
"""Neighbours of the fits that say what scatters, and of those that may take it away."""

ALIKE = 1.4
"""What a wide fit misses over what a narrow one does, at most, where it misses scatter alone. For a smooth surface it
is (wide / narrow)^(5/2): 5.6 with twice the neighbours."""


class Smoothed(NamedTuple):
    """Vertices without their scatter.

    Attributes
    ----------
    points : (v, 3)
        m.
    scatter : float
        Root mean square across the surface, m.
    move : float
        Largest move, m.
    """

    points: Floats
    scatter: float
    move: float


def without_scatter(points: Floats, faces: Integers, held: Booleans) -> Smoothed | None:
    """Vertices (v, 3) moved along their normals onto the widest fits that miss scatter alone; None: there is none.

    Parameters
    ----------
    points, faces
        A clean mesh, m.
    held : (v,) bool
        Vertices that stay: those of the border.
    """
    normals = vertex_normals(points, faces)
    areas = np.where(held, 0.0, vertex_areas(points, faces))
    if not areas.sum() > 0 or len(points) < 2 * max(WIDER):
        return None
    _, missed = _heights(points, faces, normals, NARROW)
    narrow = float(np.sqrt(areas @ missed**2 / areas.sum()))
    best = None
    for neighbours in WIDER:
        height, missed = _heights(points, faces, normals, neighbours)
        if float(np.sqrt(areas @ missed**2 / areas.sum())) > ALIKE * narrow:
            break
        best = height
    if best is None:
        return None
    best = np.where(held, 0.0, best)
    return Smoothed(points + best[:, None] * normals, narrow, float(np.abs(best).max()))


def _heights(points: Floats, faces: Integers, normals: Floats, neighbours: int) -> tuple[Floats, Floats]:
    """Height of the fit over each vertex, and root mean square of what it misses around it, m, (v,) each."""
    height, missed = np.zeros(len(points)), np.zeros(len(points))
    for block in local_heights(points, faces, normals, neighbours):
        weight = block.present.astype(float)
        basis = block.x[..., None] ** EXPONENTS[:, 0] * block.y[..., None] ** EXPONENTS[:, 1]
        basis = np.concatenate([np.ones((*block.x.shape, 1)), basis], axis=2)
        found = solved(basis, weight, block.z, block.present)
        off = np.where(block.present, block.z - np.einsum("vkt,vt->vk", basis[:, :, : found.shape[1]], found), 0)
        free = np.maximum(block.present.sum(axis=1) - found.shape[1], 1)
        missed[block.vertices] = np.sqrt((off**2).sum(axis=1) / free) * block.reach
        height[block.vertices] = found[:, 0] * block.reach
    return height, missed
