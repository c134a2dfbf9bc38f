"""The mean curvature a mesh means, and how far it is from constant."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array, eye_array

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.ties import least_axis
from lamella.base.vectors import diagonal
from lamella.surface.from_mesh.edges import find_edges, vertex_areas, vertex_normals
from lamella.surface.from_mesh.raw_mesh import mesh_error

FIT_NEIGHBOURS = 30
"""Fewest neighbours a quartic with its 15 coefficients should have: three rings around a regular inner vertex."""

SMALL_MESH = 50
COARSE_NEIGHBOURS = 18
"""Three rings are half of a mesh with fewer vertices than `SMALL_MESH`; there a cubic over two rings is better."""

MOST_RINGS = 6
FEWEST_FOR = {15: 22, 10: 14, 6: 0}
"""Coefficients of a quartic, cubic and quadric, and the neighbours each needs; small meshes have no more."""

FIT_SAME_SIDE = 0.2
"""Neighbours whose normals turn away further (cosine) do not lie over the same piece of the tangent plane."""

TRIMMED = 0.9
"""Part of the area the deviation is taken over: one-sided fits at the border are much worse."""

FEWEST_VERTICES = 12
FIT_BLOCK = 4096
FIT_STEADYING = 1e-10
"""Added to the diagonal of the scaled normal equations: a stencil that leaves a coefficient open gets 0 for it."""


@dataclass(frozen=True)
class Fit:
    """Mean curvature of a mesh, for the normals of its faces; k > 0 where the surface bends towards the normal.

    Attributes
    ----------
    mean_curvature : float
        H that fits best, 1/m.
    deviation : float
        Root mean square of |H_v - H| / scale over the better 90 % of the area: 0 on a surface of constant mean
        curvature.
    deviation_max : float
        Largest |H_v - H| / scale at an inner vertex.
    scale : float
        Root mean square of sqrt((k1^2 + k2^2) / 2), 1/m.
    per_vertex : (n,)
        H_v, 1/m.
    """

    mean_curvature: float
    deviation: float
    deviation_max: float
    scale: float
    per_vertex: Floats


def fit_mean_curvature(points: Floats, faces: Integers) -> Fit:
    """Fit H to a clean mesh.

    At each vertex a quartic is fitted to the heights of the vertices around it (three rings, more at the border) over
    the plane of the vertex normal; its second derivatives give H_v and K_v. Without the cubic terms H_v would be wrong
    by the first power of the element size h where the stencil has no symmetry; without the quartic ones H would be
    wrong by h^2 k^2 / 4 everywhere, one per cent at 25 elements around a cylinder, which no averaging removes. H is
    the area-weighted mean over the middle 80 % around the median, of inner vertices if these hold most of the area.

    Parameters
    ----------
    points : (n, 3)
        m.
    faces : (m, 3) int
        Triangles, counter-clockwise about the normal.
    """
    if len(points) < FEWEST_VERTICES:
        raise mesh_error(
            f"the mesh has {len(points)} vertices; its curvature cannot be read from fewer than {FEWEST_VERTICES}",
            "give a finer mesh, or set mean_curvature to a value",
        )
    mean, gaussian = vertex_curvatures(points, faces)
    areas = vertex_areas(points, faces)
    inner = ~find_edges(faces).border_vertices(len(points))
    # One-sided fits bias H where there is nothing on the other side to cancel their error.
    weights = np.where(inner, areas, 0.0) if areas[inner].sum() > 0.5 * areas.sum() else areas
    fitted = _trimmed_mean(mean, weights)
    squares = np.maximum(2 * mean**2 - gaussian, 0)
    size = diagonal(points)
    # A plane has no scale: rounding must not look like deviation.
    scale = max(float(np.sqrt(_trimmed(squares, weights))), 1e-6 / size)
    away = np.abs(mean - fitted) / scale
    deviation = float(np.sqrt(_trimmed(away**2, areas)))
    return Fit(fitted, deviation, float(away[inner].max() if inner.any() else away.max()), scale, mean)


def _trimmed_mean(values: Floats, weights: Floats) -> float:
    """Weighted mean of the 80 % of the weight nearest to the weighted median."""
    order = np.argsort(values, kind="stable")
    summed = np.cumsum(weights[order])
    median = values[order][np.searchsorted(summed, summed[-1] / 2)]
    order = np.argsort(np.abs(values - median), kind="stable")
    summed = np.cumsum(weights[order])
    kept = order[: np.searchsorted(summed, 0.8 * summed[-1]) + 1]
    return float(np.average(values[kept], weights=weights[kept]))


def _trimmed(values: Floats, weights: Floats) -> float:
    """Weighted mean of the lower part `TRIMMED` of values."""
    order = np.argsort(values, kind="stable")
    summed = np.cumsum(weights[order])
    kept = order[: np.searchsorted(summed, TRIMMED * summed[-1]) + 1]
    return float(np.average(values[kept], weights=weights[kept]))


def vertex_curvatures(points: Floats, faces: Integers) -> tuple[Floats, Floats]:
    """Mean (1/m) and Gaussian (1/m^2) curvature at each vertex, (n,) each, one-sided at the border."""
    normals = vertex_normals(points, faces)
    mean, gaussian = np.zeros(len(points)), np.zeros(len(points))
    for vertices, neighbours, present in stencils(faces, len(points)):
        normal = normals[vertices]
        first, second = tangents(normal)
        offset = points[neighbours] - points[vertices][:, None, :]
        same_side = present & (np.einsum("vkj,vj->vk", normals[neighbours], normal) > FIT_SAME_SIDE)
        # A crumpled mesh has no such neighbours; a wild value there shows in the deviation.
        present = np.where(same_side.sum(axis=1, keepdims=True) > min(FEWEST_FOR), same_side, present)
        x, y, z = (np.einsum("vkj,vj->vk", offset, axis) for axis in (first, second, normal))
        distance = np.where(present, np.sqrt(x**2 + y**2), 0)
        # Unit size: the normal equations then are well conditioned.
        size = np.maximum(distance.max(axis=1), np.finfo(float).tiny)[:, None]
        x, y, z = (np.where(present, part, 0) / size for part in (x, y, z))
        weight = np.where(present, 1 / (0.1 + (distance / size) ** 2), 0)
        fewest = int(present.sum(axis=1).min())
        terms = next(terms for terms, needed in FEWEST_FOR.items() if fewest >= needed)
        basis = _monomials(x, y)[:, :, :terms]
        weighted = basis * weight[:, :, None]
        matrix = weighted.transpose(0, 2, 1) @ basis
        trace = np.trace(matrix, axis1=1, axis2=2)[:, None]
        matrix[:, range(terms), range(terms)] += FIT_STEADYING * np.maximum(trace, np.finfo(float).tiny)
        right = weighted.transpose(0, 2, 1) @ z[:, :, None]
        xx, xy, yy, gx, gy = np.linalg.solve(matrix, right)[:, :5, 0].T
        slope = 1 + gx**2 + gy**2
        twice = (1 + gy**2) * xx - 2 * gx * gy * xy + (1 + gx**2) * yy
        mean[vertices] = twice / (2 * slope**1.5) / size[:, 0]
        gaussian[vertices] = (xx * yy - xy**2) / slope**2 / size[:, 0] ** 2
    return mean, gaussian


def _monomials(x: Floats, y: Floats) -> Floats:
    """Terms of a quartic, the second derivatives first, the highest orders last, (v, k, 15)."""
    xx, xy, yy = x * x, x * y, y * y
    terms = (xx / 2, xy, yy / 2, x, y, np.ones_like(x), xx * x, xx * y, x * yy, yy * y)
    return np.stack((*terms, xx * xx, xx * xy, xx * yy, xy * yy, yy * yy), axis=2)


def tangents(normals: Floats) -> tuple[Floats, Floats]:
    """Two unit vectors at right angles to each normal and to one another, (n, 3) each."""
    helper = np.eye(3)[least_axis(normals)]
    first = np.cross(helper, normals)
    first /= np.maximum(np.linalg.norm(first, axis=1, keepdims=True), np.finfo(float).tiny)
    return first, np.cross(normals, first)


def stencils(faces: Integers, count: int, neighbours: int = 0) -> list[tuple[Integers, Integers, Booleans]]:
    """Vertices in blocks (v,), vertices around them (v, k), and which of these are there rather than filling, (v, k).

    A vertex is among those around it; there are as many rings of them as have more than `neighbours`, by default
    `FIT_NEIGHBOURS` or `COARSE_NEIGHBOURS`.
    """
    fewest = neighbours or (FIT_NEIGHBOURS if count >= SMALL_MESH else COARSE_NEIGHBOURS)
    ends = find_edges(faces).ends
    rows, columns = np.concatenate((ends[:, 0], ends[:, 1])), np.concatenate((ends[:, 1], ends[:, 0]))
    ring = csr_array((np.ones(len(rows), dtype=np.int32), (rows, columns)), shape=(count, count))
    ring = csr_array(ring + eye_array(count, dtype=np.int32, format="csr"))
    blocks = []
    todo = np.arange(count)
    reach = ring
    for rings in range(2, MOST_RINGS + 1):
        reach = csr_array(reach @ ring)
        reach.data[:] = 1
        enough = np.diff(reach.indptr) > min(fewest, count - 1)
        if rings == MOST_RINGS:
            enough[:] = True
        if enough.any():
            blocks += _padded(csr_array(reach[enough]), todo[enough])
        todo, reach = todo[~enough], csr_array(reach[~enough])
        if not len(todo):
            break
    return blocks


def _padded(reach: csr_array, vertices: Integers) -> list[tuple[Integers, Integers, Booleans]]:
    """Blocks of rows with similar numbers of entries, filled up to the longest."""
    sizes = np.diff(reach.indptr)
    order = np.argsort(sizes, kind="stable")
    blocks = []
    for begin in range(0, len(order), FIT_BLOCK):
        rows = order[begin : begin + FIT_BLOCK]
        within = np.arange(sizes[rows].max())
        present = within < sizes[rows, None]
        where = np.where(present, reach.indptr[rows, None] + within, 0)
        blocks.append((vertices[rows], reach.indices[where].astype(np.int64), present))
    return blocks
