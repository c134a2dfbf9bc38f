"""Position, normal and shape operator inside curved elements, and integrals over them."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_matrix, csr_matrix

from lamella.base.arrays import Floats
from lamella.base.conjugate_gradients import conjugate_gradients
from lamella.base.vectors import crosses, dots, lengths
from lamella.surface.element.connectivity import Connectivity
from lamella.surface.element.quadrature import triangle_rule


def tangents(basis_x: Floats, basis_y: Floats, corners: Floats) -> tuple[Floats, Floats]:
    """Tangent vectors x_1, x_2 (m, q, 3) of elements with nodes (m, k, 3) at places where the basis is (q, k)."""
    return np.matmul(basis_x, corners), np.matmul(basis_y, corners)


def normal_and_area(first: Floats, second: Floats) -> tuple[Floats, Floats]:
    """Unit normal (..., 3) and area element (...) of two tangent vectors."""
    cross = crosses(first, second)
    area = lengths(cross)
    return cross / area[..., None], area


def project_onto_nodes(
    space: Connectivity, points: Floats, weights: Floats, values: Floats, tolerance: float = 1e-10
) -> Floats:
    """Nodal values (n, c) of an L2 projection onto continuous polynomials.

    Parameters
    ----------
    space : Connectivity
        The polynomials.
    points : (q, 2)
        Local coordinates of the integration points.
    weights : (m, q)
        Their weights times the area element, m^2.
    values : (m, q, c)
        What is projected.
    tolerance : float
        L2 norm of the error over that of what is projected.
    """
    basis = space.basis.basis(points)
    c = values.shape[-1]
    gathering = _gathering(space)
    right = gathering @ np.matmul(basis.T, values * weights[..., None]).reshape(-1, c)
    # to begin with: the mean of the elements' own projections
    share = basis.T * weights.mean(0)
    start = gathering @ np.matmul(np.linalg.inv(share @ basis) @ share, values).reshape(-1, c)
    start /= (gathering @ np.ones(gathering.shape[1]))[:, None]
    return from_moments(space, points, weights, right, tolerance, start)


def _gathering(space: Connectivity) -> csr_matrix:
    """Adds up at each node what its elements have there, (n, m k)."""
    m, k = space.elements.shape
    return csc_matrix((np.ones(m * k), space.elements.ravel(), np.arange(m * k + 1)), (space.node_count, m * k)).tocsr()


def from_moments(
    space: Connectivity,
    points: Floats,
    weights: Floats,
    right: Floats,
    tolerance: float = 1e-10,
    start: Floats | None = None,
) -> Floats:
    """Nodal values (n, c) of continuous polynomials with given integrals (n, c) of their products with the basis.

    Conjugate gradients need no factorisation. Each element's own projection, as if its area element were that of all on
    average, added up over the elements that share a node, is next to the inverse of the mass matrix: half a dozen steps
    are enough, however many elements there are.

    Parameters
    ----------
    space, points, weights, tolerance
        See `project_onto_nodes`.
    right : (n, c)
    start : (n, c), optional
        Where to begin.
    """
    basis = space.basis.basis(points)
    (m, k), c = space.elements.shape, right.shape[1]
    gathering = _gathering(space)
    blocks = (weights @ (basis[:, :, None] * basis[:, None, :]).reshape(len(points), -1)).reshape(m, k, k)

    def gathered(parts: Floats) -> Floats:
        return np.asarray(gathering @ parts.reshape(m * k, c))

    def image_of(nodal: Floats) -> Floats:
        """The mass matrix times nodal values, element by element."""
        return gathered(np.matmul(blocks, nodal.take(space.elements, 0)))

    inverse = np.linalg.inv((basis.T * weights.mean(0)) @ basis)
    # the elements' parts at their nodes: by the square roots of their areas, on both sides
    area = weights.sum(1)
    part = 1 / (gathering @ np.repeat(np.sqrt(area / area.mean()), k))[:, None]

    def conditioned(nodal: Floats) -> Floats:
        """Next to the mass matrix's inverse times nodal values."""
        return np.asarray(part * gathered(np.matmul(inverse, (part * nodal).take(space.elements, 0))))

    start = conditioned(right) if start is None else start
    # squares of L2 norms: of the error, and of what is projected
    goal = tolerance**2 * np.abs(np.einsum("nc,nc->c", right, start))
    return conjugate_gradients(image_of, conditioned, right, start, goal)


def smooth_normals(connectivity: Connectivity, nodes: Floats) -> Floats:
    """Unit normals at the nodes, L2-projected: a field as smooth as the surface itself, (n, 3).

    Averaged corner normals would roughen the parametrisation and cost three orders of accuracy.
    """
    points, weights = triangle_rule(max(4, 2 * connectivity.basis.order))
    basis_x, basis_y = (connectivity.basis.basis(points, *d) for d in ((1, 0), (0, 1)))
    normal, area = normal_and_area(*tangents(basis_x, basis_y, nodes[connectivity.elements]))
    projected = project_onto_nodes(connectivity, points, area * weights, normal)
    return np.asarray(projected / lengths(projected)[:, None])


def dirichlet_blocks(
    basis_x: Floats, basis_y: Floats, first: Floats, second: Floats, weights: Floats
) -> tuple[Floats, tuple[Floats, Floats, Floats], Floats]:
    """Integrals of grad phi_i . grad phi_j over each element.

    Parameters
    ----------
    basis_x, basis_y : (q, k)
        Derivatives of the basis at the integration points.
    first, second : (m, q, 3)
        Tangent vectors there.
    weights : (q,)

    Returns
    -------
    blocks : (m, k, k)
    metric : tuple of (m, q)
        E, F, G: first . first, first . second, second . second.
    area : (m, q)
        Area element over the weight: the metric's inverse times the weighted area is (G, -F, E) / area.
    """
    e, f, g = (dots(u, v) for u, v in ((first, first), (first, second), (second, second)))
    area = np.sqrt(np.maximum(e * g - f * f, 1e-12 * e * g)) / weights
    return weighted_dirichlet_blocks(basis_x, basis_y, (e, f, g), area), (e, f, g), area


def weighted_dirichlet_blocks(
    basis_x: Floats, basis_y: Floats, metric: tuple[Floats, Floats, Floats], area: Floats
) -> Floats:
    """Integrals of a weight times grad phi_i . grad phi_j, (m, k, k); the weight divides the area element (m, q)."""
    e, f, g = metric
    q, k = basis_x.shape
    xx, xy, yx, yy = (
        (u[:, :, None] * v[:, None, :]).reshape(q, -1) for u in (basis_x, basis_y) for v in (basis_x, basis_y)
    )
    factors = np.concatenate([g, -f, e], 1) / np.tile(area, 3)
    return np.asarray((factors @ np.concatenate([xx, xy + yx, yy])).reshape(-1, k, k))
