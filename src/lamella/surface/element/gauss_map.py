"""Normals of a surface of constant mean curvature from its Gauss map, which is harmonic.

Laplace n = -|A|^2 n, |A|^2 = |grad n|^2, holds on a surface exactly when its mean curvature is constant (Ruh and Vilms,
Trans. Amer. Math. Soc. 149 (1970), 569-573, doi:10.1090/S0002-9947-1970-0259768-5). Solved in the elements' own
polynomials, the normals are an order more accurate than those of the elements, and so are the principal directions.
"""

from __future__ import annotations

import numpy as np

from lamella.base.arrays import Floats
from lamella.base.sparse import packed
from lamella.base.vectors import dots, lengths
from lamella.surface.element.connectivity import Connectivity
from lamella.surface.element.geometry import dirichlet_blocks, smooth_normals, tangents
from lamella.surface.element.quadrature import triangle_rule

# |A|^2 is that of the pass before
PASSES = 2


def harmonic_normals(connectivity: Connectivity, nodes: Floats) -> Floats:
    """Unit normals at the nodes (n, 3) of a surface of constant mean curvature; on the rim the smooth ones."""
    basis = connectivity.basis
    points, weights = triangle_rule(2 * basis.order)
    value, x, y = (basis.basis(points, *d) for d in ((0, 0), (1, 0), (0, 1)))
    blocks, (e, f, g), area = dirichlet_blocks(x, y, *tangents(x, y, nodes[connectivity.elements]), weights)
    normals = smooth_normals(connectivity, nodes)
    inside = connectivity.inner_unknowns >= 0
    pattern = connectivity.inner_pattern
    factor = pattern.factor(pattern.assemble(packed(blocks)))
    held = np.matmul(blocks, np.where(inside[:, None], 0, normals)[connectivity.elements])
    flat = connectivity.elements.ravel()
    for _ in range(PASSES):
        local = normals[connectivity.elements]
        n_x, n_y = np.matmul(x, local), np.matmul(y, local)
        xx, xy, yy = (dots(u, v) for u, v in ((n_x, n_x), (n_x, n_y), (n_y, n_y)))
        # |grad n|^2 times the weighted area element
        bend = (g * xx - 2 * f * xy + e * yy) / area
        parts = np.matmul(value.T, np.matmul(value, local) * bend[..., None]) - held
        right = [
            np.bincount(flat, parts[..., c].ravel(), connectivity.node_count)[inside].astype(np.float64)
            for c in range(3)
        ]
        normals = normals.copy()
        normals[inside] = factor.solve(np.stack(right, 1))
        normals /= lengths(normals)[:, None]
    return normals
