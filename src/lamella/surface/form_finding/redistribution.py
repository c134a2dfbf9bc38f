"""Elements' nodes moved within a film to where its mean curvature comes out best.

Which places of a surface the nodes of its elements hold is free, but not indifferent: a polynomial through other places
is off by another amount. A shift delta_k of node k within the tangent plane moves the interpolant between the nodes by
sum_k phi_k n . delta_k along the normal n there, which changes its mean curvature by half the Laplacian of that
(do Carmo, Differential Geometry of Curves and Surfaces (1976), section 3.5). The shifts for which the square of H - H0
integrates to the least are a linear problem that couples neighbours alone: conjugate gradients need few steps. The
vertices and the boundary stay.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from scipy.sparse import csc_matrix

from lamella.base.arrays import Floats
from lamella.base.blocks import blocks
from lamella.base.conjugate_gradients import conjugate_gradients
from lamella.base.ties import least_axis
from lamella.base.vectors import crosses, dots, lengths
from lamella.surface.element.geometry import smooth_normals
from lamella.surface.element.lagrange import lagrange
from lamella.surface.element.quadrature import triangle_rule
from lamella.surface.form_finding.adaptivity import away_from_corners
from lamella.surface.form_finding.film import Film

# of the diagonal of the least squares, so that shifts that change next to nothing stay small
REDISTRIBUTION_DAMPING = 0.01
# least diagonal that is damped by its own part, over the median: with 0.01 and less, shifts where there is little bend
# grow from the rounding of the nodes, a thousandfold at each call
FLOOR = 0.05
REDISTRIBUTION_TOLERANCE, REDISTRIBUTION_STEPS_MAX = 1e-2, 60
# longest shift, over the shortest edge of the elements around
SHIFT_MAX = 0.05
# of an element's area, at each of its vertices, where the curvature of a polynomial is farthest off
AT_VERTEX = 0.02
# elements worked on at a time
ELEMENT_BLOCK = 500


def redistributed(film: Film, mean_curvature: float, cosine: float = 0.0) -> Film:
    """The film with the nodes inside its elements and edges moved along the tangent planes.

    Parameters
    ----------
    film : Film
        In equilibrium.
    mean_curvature : float
        H0, 1/m.
    cosine : float
        Where H + cosine |D| is to be H0 (`lamella.surface.constant_angle.relation`).
    """
    connectivity = film.connectivity
    elements, n = connectivity.elements, connectivity.node_count
    normals = smooth_normals(connectivity, film.nodes)
    frames = tangent_frames(film, normals)
    _, weights = check_rule(connectivity.basis.order)
    m, k = len(elements), 2 * (elements.shape[1] - 3)
    matrix, pull = np.empty((m, k, k)), np.empty((m, k))
    for rows in blocks(m, ELEMENT_BLOCK):
        rates, mean, area = variation_of_mean_curvature(film, normals, frames, rows, cosine)
        weighted = rates * (weights * area)[..., None]
        matrix[rows] = np.matmul(weighted.transpose(0, 2, 1), rates)
        pull[rows] = np.matmul((mean - mean_curvature)[:, None], weighted)[:, 0]
    unknowns = (2 * elements[:, 3:, None] + [0, 1]).reshape(m, k)
    gathering = csc_matrix((np.ones(m * k), unknowns.ravel(), np.arange(m * k + 1)), (2 * n, m * k)).tocsr()
    diagonal = gathering @ np.einsum("eii->ei", matrix).ravel()
    free = diagonal > 0
    if not free.any():
        return film
    damping = np.where(free, REDISTRIBUTION_DAMPING * np.maximum(diagonal, FLOOR * np.median(diagonal[free])), 1.0)

    def image_of(shifts: Floats) -> Floats:
        parts = np.matmul(matrix, shifts[unknowns])
        return np.asarray((gathering @ parts.ravel() + damping * shifts[:, 0])[:, None])

    inverse_diagonal = 1 / (diagonal + damping)[:, None]

    def conditioned(shifts: Floats) -> Floats:
        return np.asarray(inverse_diagonal * shifts)

    right = -(gathering @ pull.ravel())[:, None]
    goal = REDISTRIBUTION_TOLERANCE**2 * np.einsum("nc,nc->c", right, conditioned(right))
    solution = conjugate_gradients(image_of, conditioned, right, np.zeros((2 * n, 1)), goal, REDISTRIBUTION_STEPS_MAX)
    shift = np.matmul(frames, solution.reshape(n, 2, 1))[..., 0]
    return film.at(film.nodes + _part(film, lengths(shift))[:, None] * shift)


def tangent_frames(film: Film, normals: Floats) -> Floats:
    """Two unit vectors across the normal at each node (n, 3, 2), in columns; 0 where the node has to stay."""
    first = crosses(normals, np.eye(3)[least_axis(normals)])
    first /= lengths(first)[:, None]
    frames = np.stack([first, crosses(normals, first)], 2)
    frames[: len(film.mesh.points)] = frames[film.connectivity.rim_nodes] = 0
    # of an element that reaches next to a corner of the boundary a part alone is measured
    elements = film.connectivity.elements
    frames[elements[~away_from_corners(film, film.nodes)[elements].all(1)]] = 0
    return frames


@lru_cache
def check_rule(order: int) -> tuple[Floats, Floats]:
    """Places (q, 2) and weights (q,) of the least squares: more of them than an element has shifts."""
    inside, weights = triangle_rule(2 * order)
    return (
        np.concatenate([inside, lagrange(order).nodes[:3]]),
        np.append((1 - 3 * AT_VERTEX) * weights, np.full(3, AT_VERTEX / 2)),
    )


def variation_of_mean_curvature(
    film: Film, normals: Floats, frames: Floats, rows: slice, cosine: float = 0.0
) -> tuple[Floats, Floats, Floats]:
    """Mean curvature at the places of `check_rule`, and its change by shifts of nodes within the surface.

    With a cosine H + cosine |D| takes the place of H, and the sum of second derivatives along the principal directions
    with the weights 1 + cosine and 1 - cosine that of the Laplacian.

    Parameters
    ----------
    film : Film
    normals : (n, 3)
        Smooth unit normals at the nodes.
    frames : (n, 3, 2)
        See `tangent_frames`.
    rows : slice
        Which elements.
    cosine : float

    Returns
    -------
    rates : (r, q, 2 (k - 3))
        Half the Laplacian of phi_k n . t for both t of each node k but the vertices, 1/m^2.
    mean_curvature : (r, q)
        1/m.
    area : (r, q)
        Area element, m^2.
    """
    basis = film.connectivity.basis
    value, *slopes = basis.second_jet(check_rule(basis.order)[0])
    v_1, v_2, v_11, v_12, v_22 = slopes
    elements = film.connectivity.elements[rows]
    x_1, x_2, x_11, x_12, x_22 = (np.matmul(of, film.nodes[elements]) for of in slopes)
    n, n_1, n_2, n_11, n_12, n_22 = (np.matmul(of, normals[elements]) for of in (value, *slopes))
    e, f, g = dots(x_1, x_1), dots(x_1, x_2), dots(x_2, x_2)
    determinant = e * g - f * f
    area = np.sqrt(determinant)
    # Laplace u = g^ab u_ab - along^c u_c, along = g^ab x_ab in the basis x_1, x_2
    g_11, g_12, g_22 = (entry[..., None] for entry in (g / determinant, -f / determinant, e / determinant))
    p_11, p_12, p_22 = g_11, g_12, g_22
    if cosine:
        second = [dots(of, crosses(x_1, x_2))[..., None] / area[..., None] for of in (x_11, x_12, x_22)]
        p_11, p_12, p_22 = _weighted((g_11, g_12, g_22), second, cosine)
    bend = p_11 * x_11 + 2 * p_12 * x_12 + p_22 * x_22
    by_1, by_2 = dots(bend, x_1)[..., None], dots(bend, x_2)[..., None]
    along_1, along_2 = g_11 * by_1 + g_12 * by_2, g_12 * by_1 + g_22 * by_2
    mean_curvature = dots(bend, crosses(x_1, x_2)) / (2 * area)
    # Laplace(phi n) = phi Laplace n + 2 <grad phi, grad n> + n Laplace phi
    laplace_n = p_11 * n_11 + 2 * p_12 * n_12 + p_22 * n_22 - along_1 * n_1 - along_2 * n_2
    laplace_v = p_11 * v_11 + 2 * p_12 * v_12 + p_22 * v_22 - along_1 * v_1 - along_2 * v_2
    grad_1, grad_2 = p_11 * n_1 + p_12 * n_2, p_12 * n_1 + p_22 * n_2
    local = frames[elements[:, 3:]].transpose(0, 2, 1, 3).reshape(len(elements), 3, -1)

    def both(of_node: Floats) -> Floats:
        """For both shifts of each node but the vertices."""
        return np.repeat(of_node[..., 3:], 2, -1)

    rates = both(value) * np.matmul(laplace_n, local) + both(laplace_v) * np.matmul(n, local)
    rates += 2 * (both(v_1) * np.matmul(grad_1, local) + both(v_2) * np.matmul(grad_2, local))
    return rates / 2, mean_curvature, area


def _weighted(inverse: tuple[Floats, ...], second: list[Floats], cosine: float) -> tuple[Floats, ...]:
    """g^ab + cosine (d1^a d1^b - d2^a d2^b) of the principal directions, from g^ab and second fundamental form."""
    g_11, g_12, g_22 = inverse
    l_11, l_12, l_22 = second
    # mixed: g^ac II_cb, then raised
    by_1 = (g_11 * l_11 + g_12 * l_12, g_11 * l_12 + g_12 * l_22)
    by_2 = (g_12 * l_11 + g_22 * l_12, g_12 * l_12 + g_22 * l_22)
    s_11 = by_1[0] * g_11 + by_1[1] * g_12
    s_12 = by_1[0] * g_12 + by_1[1] * g_22
    s_22 = by_2[0] * g_12 + by_2[1] * g_22
    mean = (by_1[0] + by_2[1]) / 2
    gauss = by_1[0] * by_2[1] - by_1[1] * by_2[0]
    size = np.sqrt(np.maximum(mean**2 - gauss, np.finfo(float).tiny))
    return tuple(g + cosine * (s - mean * g) / size for g, s in ((g_11, s_11), (g_12, s_12), (g_22, s_22)))


def _part(film: Film, shift: Floats) -> Floats:
    """Parts (n,) of shifts of some lengths (n,) that leave the elements in shape."""
    corners = film.nodes[film.connectivity.faces]
    edge = lengths(corners - np.roll(corners, 1, 1)).min(1)
    limit = np.full(len(shift), np.inf)
    np.minimum.at(limit, film.connectivity.elements, SHIFT_MAX * edge[:, None])
    return np.asarray(np.minimum(1, limit / np.maximum(shift, 1e-300)))
