"""What the peers start from: an even triangle mesh of the unit disc, mapped harmonically onto a boundary curve."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu


def disc(rings: int) -> tuple[Any, Any, int]:
    """Vertices (n, 2), counter-clockwise triangles (m, 3) and how many of the last vertices lie on the rim.

    Ring k has 6 k vertices, so all edges are of about one length.
    """
    angle = [np.arange(max(6 * k, 1)) * 2 * np.pi / max(6 * k, 1) for k in range(rings + 1)]
    vertices = np.concatenate([k / rings * np.column_stack([np.cos(t), np.sin(t)]) for k, t in enumerate(angle)])
    first = np.r_[0, 1 + 3 * np.arange(rings) * (np.arange(rings) + 1)]
    triangles = []
    for k in range(1, rings + 1):
        inner, outer = max(6 * (k - 1), 1), 6 * k
        i = np.arange(6 * k)
        # one triangle with each outer edge, one with each inner edge
        side, step = np.divmod(i, k)
        below = first[k - 1] + (side * (k - 1) + step) % inner
        triangles.append(np.column_stack([first[k] + i, first[k] + (i + 1) % outer, below]))
        has = step > 0
        before = first[k - 1] + (side * (k - 1) + step - 1) % inner
        triangles.append(np.column_stack([first[k] + i, below, before])[has])
    return vertices, np.concatenate(triangles), 6 * rings


def along(curve: Any, count: int) -> Any:
    """That many points at equal arc length of a closed curve given by many points (n, d)."""
    closed = np.vstack([curve, curve[:1]])
    arc = np.r_[0, np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))]
    at = np.arange(count) * arc[-1] / count
    return np.column_stack([np.interp(at, arc, x) for x in closed.T])


def harmonic(vertices: Any, triangles: Any, rim: Any) -> Any:
    """The map that is harmonic inside (cotangent weights) and takes the last vertices to the points of the rim."""
    matrix = cotangents(vertices, triangles)
    inner = len(vertices) - len(rim)
    mapped = np.empty((len(vertices), rim.shape[1]))
    mapped[inner:] = rim
    mapped[:inner] = splu(matrix[:inner, :inner].tocsc()).solve(-(matrix[:inner, inner:] @ rim))
    return mapped


def cotangents(vertices: Any, triangles: Any) -> Any:
    """Stiffness matrix of linear triangles in the plane or in space."""
    corners = vertices[triangles]
    sides = corners[:, [2, 0, 1]] - corners[:, [1, 2, 0]]
    product = np.einsum("eia,eja->eij", sides, sides)
    double_area = np.sqrt(product[:, 0, 0] * product[:, 1, 1] - product[:, 0, 1] ** 2)
    blocks = product / (2 * double_area[:, None, None])
    i, j = np.repeat(triangles, 3, 1).ravel(), np.tile(triangles, 3).ravel()
    return coo_matrix((blocks.ravel(), (i, j)), (len(vertices),) * 2).tocsr()
