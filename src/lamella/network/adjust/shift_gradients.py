"""How sums over the forms sqrt(D) dz of a surface change with the nodes of its elements: one pass for all parameters.

The shifts of isothermic coordinates, and how near umbilics are to the rim, are such sums. Their derivatives by the
nodes are found backwards, from the sums to the nodes (the adjoint, or reverse, way: A. Griewank and A. Walther,
Evaluating Derivatives (2008), chapter 3): through the forms at the integration points, the shape operator S = -dn at
the nodes of the integration mesh, and the normals n, which turn by dn = -grad u . n where nodes move by u. Each
smoothing, an L2 projection, is its own transpose. So whatever the number of parameters, the cost is that of as many
sums as there are.
"""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix

from lamella.base.arrays import Complexes, Floats
from lamella.base.blocks import blocks
from lamella.base.vectors import dots, images
from lamella.network.isothermic.isothermic import Isothermic
from lamella.network.isothermic.poisson import Poisson
from lamella.network.isothermic.umbilic_depth import UmbilicDepths
from lamella.surface.element.geometry import from_moments, normal_and_area, tangents
from lamella.surface.element.places import Places
from lamella.surface.element.quadrature import triangle_rule
from lamella.surface.element.surface import ElementSurface

Number = TypeVar("Number", np.float64, np.complex128)

# rows and columns of the entries of a symmetric matrix, and how often each is in it
_ROWS, _COLUMNS, _TWICE = np.array([0, 0, 0, 1, 1, 2]), np.array([0, 1, 2, 1, 2, 2]), np.array([1.0, 2, 2, 1, 2, 1])
# of the projections: rates need no more
PROJECTED = 1e-4
# elements worked on at a time: their tables stay in the processor's cache
GRADIENT_BLOCK = 64


def shift_gradients(surface: ElementSurface, iso: Isothermic) -> Complexes:
    """Derivatives of the integrals that shifts are found from, by the nodes of a surface.

    Parameters
    ----------
    surface : ElementSurface
    iso : Isothermic
        On it.

    Returns
    -------
    (t, n, 3) complex
        Of the sums that `Poisson.quadratic` has as right side, 1/sqrt(m).
    """
    by_position, by_shape = _by_integration_nodes(iso)
    found = _by_nodes(
        surface,
        iso.mesh.places,
        np.concatenate([by_position.real, by_position.imag]),
        np.concatenate([by_shape.real, by_shape.imag]),
    )
    count = len(by_position)
    return np.asarray(found[:count] + 1j * found[count:])


def depth_gradients(surface: ElementSurface, depths: UmbilicDepths) -> Floats:
    """Derivatives of the places of umbilics, inwards from the rim's nearest node, by a surface's nodes, (z, n, 3)."""
    count = len(depths.depth)
    frame = surface.frames(depths.places)
    # of the deviator (uu - vv) / 2 - i uv; its frame may turn as it will where it is nought
    real = (_product(frame.e_u, frame.e_u) - _product(frame.e_v, frame.e_v)) / 2
    imaginary = -_product(frame.e_u, frame.e_v)
    by_position, by_shape = np.zeros((count, count, 3)), np.zeros((count, count, 6))
    own = np.arange(count)
    by_position[own, own] = depths.inwards
    by_shape[own, own] = depths.by_deviator[:, :1] * real + depths.by_deviator[:, 1:] * imaginary
    if not count:
        return np.zeros((0, *surface.nodes.shape))
    return _by_nodes(surface, depths.places, by_position, by_shape)


def _product(one: Floats, other: Floats) -> Floats:
    """Derivatives of one . S other by the entries of symmetric matrices S, (..., 6)."""
    both = one[..., _ROWS] * other[..., _COLUMNS] + one[..., _COLUMNS] * other[..., _ROWS]
    return np.asarray(both * (_TWICE / 2))


def _by_integration_nodes(iso: Isothermic) -> tuple[Complexes, Complexes]:
    """Derivatives by position (t, N, 3) and shape operator (t, N, 6) at the nodes of the integration mesh."""
    connectivity = iso.mesh.connectivity
    system = iso.plain.weighted()
    m, k = connectivity.elements.shape
    count, n = len(iso.moves), connectivity.node_count
    own = np.empty((count, m, k, 9), complex)
    for some in blocks(m, GRADIENT_BLOCK):
        own[:, some, :, :3], own[:, some, :, 3:] = _of_elements(iso, system, some)
    gathering = csr_matrix((np.ones(m * k), (connectivity.elements.ravel(), np.arange(m * k))), (n, m * k))
    total = np.array([gathering @ part.reshape(m * k, 9) for part in own]).reshape(count, n, 9)
    return total[..., :3], total[..., 3:]


def _of_elements(iso: Isothermic, system: Poisson, some: slice) -> tuple[Complexes, Complexes]:
    """The same at the own nodes of some elements, (t, e, k, 3) and (t, e, k, 6)."""
    mesh, x, y = iso.mesh, system.x, system.y
    basis = mesh.connectivity.basis
    value = basis.basis(triangle_rule(2 * basis.order)[0])
    elements = mesh.connectivity.elements[some]
    a, b = tangents(x, y, mesh.nodes[elements])
    shape = np.matmul(value, mesh.shape[elements])
    s_a, s_b = images(shape, a), images(shape, b)
    # the sums are of form_a times one of these, and of form_b times the other
    e, f, g = metric = (system.metric[0][some], system.metric[1][some], system.metric[2][some])
    w_x, w_y = iso.moves[:, some] @ x.T, iso.moves[:, some] @ y.T
    by_a, by_b = (g * w_x - f * w_y) / system.area[some], (e * w_y - f * w_x) / system.area[some]
    rates = _rates_of_forms(system.form_a[some], metric, dots(a, s_a), dots(a, s_b), dots(b, s_b))
    by_aa, by_ab, by_bb, by_e, by_f, by_g = (
        by_a * of_a + by_b * of_b for of_a, of_b in zip(rates[0], rates[1], strict=True)
    )
    gradient_a = _rows(by_e, 2 * a) + _rows(by_f, b) + _rows(by_aa, 2 * s_a) + _rows(by_ab, s_b)
    gradient_b = _rows(by_f, a) + _rows(by_g, 2 * b) + _rows(by_ab, s_a) + _rows(by_bb, 2 * s_b)
    of_shape = _rows(by_aa, _product(a, a)) + _rows(by_ab, _product(a, b)) + _rows(by_bb, _product(b, b))
    return np.matmul(x.T, gradient_a) + np.matmul(y.T, gradient_b), np.matmul(value.T, of_shape)


def _rows(factor: NDArray[Number], rows: Floats) -> NDArray[Number]:
    """Rows (m, q, c) times factors (t, m, q), (t, m, q, c)."""
    return factor[..., None] * rows


def _rates_of_forms(
    form_a: Complexes, metric: tuple[Floats, Floats, Floats], aa: Floats, ab: Floats, bb: Floats
) -> tuple[list[Complexes], list[Complexes]]:
    """Derivatives of both forms (m, q) by a . S a, a . S b, b . S b and by e, f, g.

    With A the area element, r = f / A, s = e / A and w = (1 + i r) a - i s b, which is isotropic,
    form_a^2 = w . S w / 2 and form_b = form_a (r + i) / s.
    """
    e, f, g = metric
    area = np.sqrt(np.maximum(e * g - f * f, 1e-12 * e * g))
    r, s = f / area, e / area
    one = 1 + 1j * r
    half = 1 / (2 * form_a)
    by_r, by_s = half * (1j * one * aa + s * ab), half * (-1j * one * ab - s * bb)
    of_a = [half * one**2 / 2, half * (-1j * one * s), half * (-(s**2) / 2)]
    ratio = (r + 1j) / s
    of_b = [ratio * rate for rate in of_a]
    r_e, r_f, r_g = -f * g / (2 * area**3), e * g / area**3, -f * e / (2 * area**3)
    s_e, s_f, s_g = 1 / area - e * g / (2 * area**3), e * f / area**3, -(e**2) / (2 * area**3)
    for r_, s_ in ((r_e, s_e), (r_f, s_f), (r_g, s_g)):
        of_a.append(by_r * r_ + by_s * s_)
        of_b.append(ratio * of_a[-1] + form_a / s * (r_ - ratio * s_))
    return of_a, of_b


def _by_nodes(surface: ElementSurface, places: Places, by_position: Floats, by_shape: Floats) -> Floats:
    """Derivatives (c, n, 3) by the nodes of a surface, from those by position (c, N, 3) and shape operator (c, N, 6) at
    N places of it."""
    connectivity = surface.connectivity
    basis, elements = connectivity.basis, connectivity.elements
    (m, k), n, count = elements.shape, connectivity.node_count, len(by_position)
    spread = csr_matrix(
        (basis.basis(places.local).ravel(), elements[places.element].ravel(), np.arange(len(places) + 1) * k),
        (len(places), n),
    ).T.tocsr()
    direct = spread @ by_position.transpose(1, 0, 2).reshape(len(places), -1)
    moments = spread @ by_shape.transpose(1, 0, 2).reshape(len(places), -1)
    points, weights = triangle_rule(2 * basis.order)
    value, x, y = (basis.basis(points, *d) for d in ((0, 0), (1, 0), (0, 1)))
    x_1, x_2 = tangents(x, y, surface.nodes[elements])
    normal, area = normal_and_area(x_1, x_2)
    weight = area * weights
    # vectors of the tangent plane whose products with x_1, x_2 are 1 and 0
    one, other = np.cross(x_2, normal) / area[..., None], np.cross(normal, x_1) / area[..., None]
    gathering = csr_matrix((np.ones(m * k), (elements.ravel(), np.arange(m * k))), (n, m * k))

    def gathered(parts: Floats) -> Floats:
        """Sums (n, 3 c) at the nodes of what elements have there, (c, m, k, 3)."""
        return np.asarray(gathering @ parts.transpose(1, 2, 0, 3).reshape(m * k, -1))

    def at_points(nodal: Floats, width: int) -> Floats:
        """Values (c, m, q, w) at the integration points of nodal ones, (n, c w)."""
        there = np.matmul(value, nodal[elements])
        return np.asarray(there.reshape(m, len(points), count, width).transpose(2, 0, 1, 3))

    # S is projected from -(n_1 one + n_2 other), n_1 and n_2 the derivatives of the normals
    entries = at_points(from_moments(connectivity, points, weight, moments, PROJECTED), 6) / _TWICE
    entries = _trace_free(entries * weight[..., None], normal)
    pull_1, pull_2 = images(entries, one), images(entries, other)
    by_normal = gathered(-np.matmul(x.T, pull_1) - np.matmul(y.T, pull_2))
    turns = surface.gauss_map[elements]
    n_1, n_2 = np.matmul(x, turns), np.matmul(y, turns)
    # and one, other change by -(one . dx_1) one - (one . dx_2) other, -(other . dx_1) one - (other . dx_2) other
    gradient_1 = _rows(dots(pull_1, n_1), one) + _rows(dots(pull_1, n_2), other)
    gradient_2 = _rows(dots(pull_2, n_1), one) + _rows(dots(pull_2, n_2), other)
    # normals turn by -(one (n . dx_1) + other (n . dx_2))
    slope = at_points(from_moments(connectivity, points, weight, by_normal, PROJECTED), 3) * weight[..., None]
    gradient_1 = gradient_1 - _rows(dots(slope, one), normal)
    gradient_2 = gradient_2 - _rows(dots(slope, other), normal)
    total = direct + gathered(np.matmul(x.T, gradient_1) + np.matmul(y.T, gradient_2))
    return np.asarray(total.reshape(n, count, 3).transpose(1, 0, 2))


def _trace_free(entries: Floats, normal: Floats) -> Floats:
    """The trace-free part in tangent planes, with unit normals (m, q, 3), of symmetric matrices (c, m, q, 6)."""
    across = images(entries, normal)
    both = dots(across, normal)
    half = (entries[..., 0] + entries[..., 3] + entries[..., 5] - both) / 2
    square = normal[..., _ROWS] * normal[..., _COLUMNS]
    mixed = across[..., _ROWS] * normal[..., _COLUMNS] + normal[..., _ROWS] * across[..., _COLUMNS]
    identity = np.array([1.0, 0, 0, 1, 0, 1])
    return np.asarray(entries - mixed + (both + half)[..., None] * square - half[..., None] * identity)
