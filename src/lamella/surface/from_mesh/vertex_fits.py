"""Polynomials through the vertices of a smooth mesh, one around each, and elements blended from them.

Around a vertex the surface is the graph of a quartic over the plane of the vertex normal, exactly through the vertex
and by weighted least squares near those around it. On a smooth surface with edges of length h it is off by h^5, its
curvature by h^3 (Cazals and Pouget, Comput. Aided Geom. Des. 22 (2005), 121-146, doi:10.1016/j.cagd.2004.09.004). In
each triangle the three graphs of its corners are blended, so that vertices stay where they are and neighbours share
their edges.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.surface.boundary import Loop
from lamella.surface.element.placing import edge_blends
from lamella.surface.form_finding.film import Film
from lamella.surface.from_mesh.edges import find_edges, vertex_normals
from lamella.surface.from_mesh.mean_curvature_fit import FIT_SAME_SIDE, stencils, tangents

EXPONENTS = np.array([(i, n - i) for n in range(1, 5) for i in range(n, -1, -1)])
"""Powers of x and y in a quartic without constant, by degree."""

TERMS = {4: 14, 3: 9, 2: 5, 1: 2}
"""Number of terms up to a degree."""

NEIGHBOURS_PER_TERM = 1.5
"""A fit with fewer conditions follows single vertices."""

FIT_NEAR, FIT_FALL = 0.01, 5
"""Weights fall like (FIT_NEAR + (distance / reach)^2)^-FIT_FALL: the first ring is met nearly, the outer ones say
what it leaves open. On coarse meshes that is a third of the error of even weights."""

NEWTON = 4
"""Steps to a graph; quadratic from within the sagitta of an edge."""

LEAST_RISE = 0.01
"""Of directions from a graph, per length: flatter ones meet it where it says nothing."""

ONE_SIDED = 3.0
"""What fits with all their vertices on one side err by over what they disagree by: measured up to 2.2, on a torus."""

STEADYING = 1e-12
"""Added to the diagonal of the scaled normal equations: a stencil that leaves a coefficient open gets 0 for it."""


@dataclass(frozen=True)
class VertexFits:
    """Graphs around the vertices.

    Attributes
    ----------
    points, first, second, normal : (v, 3)
        Vertices, m, and their frames.
    coefficients : (v, 14)
        Of the terms of `EXPONENTS` of x / reach, y / reach; m.
    reach : (v,)
        m.
    """

    points: Floats
    first: Floats
    second: Floats
    normal: Floats
    coefficients: Floats
    reach: Floats

    def along(self, vertex: Integers, start: Floats, direction: Floats) -> Floats:
        """How far points (n, 3) are from the graphs of vertices (n,) along unit directions (n, 3), m, (n,)."""
        t = np.zeros(len(start))
        first, second, normal = self.first[vertex], self.second[vertex], self.normal[vertex]
        c, reach = self.coefficients[vertex], self.reach[vertex]
        i, j = EXPONENTS.T
        step = np.stack([(direction * axis).sum(1) for axis in (first, second, normal)])
        for _ in range(NEWTON):
            off = start + t[:, None] * direction - self.points[vertex]
            x, y = self._plan(vertex, off)
            z = (off * normal).sum(1)
            graph = (_powers(x, y) * c).sum(1)
            zx = (i * x[:, None] ** np.maximum(i - 1, 0) * y[:, None] ** j * c).sum(1) / reach
            zy = (j * x[:, None] ** i * y[:, None] ** np.maximum(j - 1, 0) * c).sum(1) / reach
            rise = step[2] - zx * step[0] - zy * step[1]
            rise = np.where(np.abs(rise) < LEAST_RISE, np.copysign(LEAST_RISE, rise), rise)
            # where a graph is met nowhere near, as between the sides of a slit, steps must not run off
            t -= np.clip((z - graph) / rise, -reach, reach)
        return t

    def second_forms(self, vertex: Integers, there: Floats) -> Floats:
        """Second fundamental forms of the graphs of vertices (n,) above or below points (n, 3), in space, (n, 3, 3)."""
        x, y = self._plan(vertex, there - self.points[vertex])
        c, reach = self.coefficients[vertex], self.reach[vertex]
        i, j = EXPONENTS.T

        def derivative(a: int, b: int) -> Floats:
            factor = np.array([_falling(k, a) * _falling(m, b) for k, m in EXPONENTS], float)
            values = factor * x[:, None] ** np.maximum(i - a, 0) * y[:, None] ** np.maximum(j - b, 0)
            return np.asarray((values * c).sum(1) / reach ** (a + b))

        zx, zy = derivative(1, 0)[:, None], derivative(0, 1)[:, None]
        first, second, normal = self.first[vertex], self.second[vertex], self.normal[vertex]
        # tangents of the graph, and covectors that undo them
        u, v = first + zx * normal, second + zy * normal
        unit = np.cross(u, v)
        area = (unit**2).sum(1)[:, None]
        du, dv = np.cross(v, unit) / area, np.cross(unit, u) / area
        hessian = np.array([[derivative(2, 0), derivative(1, 1)], [derivative(1, 1), derivative(0, 2)]])
        hessian = hessian / np.sqrt(area[:, 0])
        duals = np.array([du, dv])
        return np.asarray(np.einsum("abn,anc,bnd->ncd", hessian, duals, duals))

    def _plan(self, vertex: Integers, off: Floats) -> tuple[Floats, Floats]:
        reach = self.reach[vertex]
        return (off * self.first[vertex]).sum(1) / reach, (off * self.second[vertex]).sum(1) / reach


def _falling(n: int, k: int) -> int:
    """n (n - 1) ... of k factors."""
    return int(np.prod([n - r for r in range(k)])) if k else 1


def _powers(x: Floats, y: Floats) -> Floats:
    return np.asarray(x[..., None] ** EXPONENTS[:, 0] * y[..., None] ** EXPONENTS[:, 1])


def fit_vertices(points: Floats, faces: Integers, degree: int = 4) -> VertexFits:
    """Fit a graph of a degree, at most, through and around each vertex (v, 3) of a clean mesh."""
    normals = vertex_normals(points, faces)
    first, second = tangents(normals)
    coefficients, reach = np.zeros((len(points), len(EXPONENTS))), np.ones(len(points))
    for block in local_heights(points, faces, normals, 0):
        others = block.present & (block.neighbours != block.vertices[:, None])
        weight = np.where(others, 1 / (FIT_NEAR + block.x**2 + block.y**2) ** FIT_FALL, 0)
        found = solved(_powers(block.x, block.y)[:, :, : TERMS[degree]], weight, block.z, others)
        coefficients[block.vertices, : found.shape[1]] = found * block.reach[:, None]
        reach[block.vertices] = block.reach
    return VertexFits(points, first, second, normals, coefficients, reach)


class Heights(NamedTuple):
    """Vertices (v,) and those around them (v, k): heights over the planes of their normals; lengths over `reach`."""

    vertices: Integers
    neighbours: Integers
    present: Booleans
    reach: Floats
    x: Floats
    y: Floats
    z: Floats


def local_heights(points: Floats, faces: Integers, normals: Floats, neighbours: int) -> Iterator[Heights]:
    """Heights of vertices around each, over the plane of its normal; see `fit.stencils`."""
    first, second = tangents(normals)
    for vertices, around, present in stencils(faces, len(points), neighbours):
        offset = points[around] - points[vertices][:, None, :]
        present = present & (np.einsum("vkj,vj->vk", normals[around], normals[vertices]) > FIT_SAME_SIDE)
        x, y, z = (np.einsum("vkj,vj->vk", offset, axis[vertices]) for axis in (first, second, normals))
        away = np.hypot(x, y)
        reach = np.where(present, away, 0).max(axis=1)
        # a vertex of which all neighbours lie on another side, at the end of a slit say: a plane, over their distance
        reach = np.where(reach > 0, reach, np.maximum(away.max(axis=1), np.linalg.norm(offset, axis=2).max(axis=1)))
        x, y, z = (np.where(present, part, 0) / reach[:, None] for part in (x, y, z))
        yield Heights(vertices, around, present, reach, x, y, z)


def solved(basis: Floats, weight: Floats, z: Floats, present: Booleans) -> Floats:
    """Coefficients (v, terms) of the nearest polynomials, of as high a degree as the vertices there (v, k) can say."""
    fewest = int(present.sum(axis=1).min())
    known = (count for count in TERMS.values() if count <= basis.shape[2] and fewest >= NEIGHBOURS_PER_TERM * count)
    terms = next(known, TERMS[1])
    basis = basis[:, :, :terms]
    weighted = basis * weight[:, :, None]
    matrix = weighted.transpose(0, 2, 1) @ basis
    trace = np.trace(matrix, axis1=1, axis2=2)[:, None]
    matrix[:, range(terms), range(terms)] += STEADYING * np.maximum(trace, np.finfo(float).tiny)
    return np.asarray(np.linalg.solve(matrix, weighted.transpose(0, 2, 1) @ z[:, :, None])[:, :, 0])


def disagreement(fits: VertexFits, faces: Integers, one_sided: float = ONE_SIDED) -> Floats:
    """Largest difference of curvature at each vertex between its graph and those of its neighbours, 1/m, (v,).

    Times `one_sided` on the border, where neighbours err alike.
    """
    edges = find_edges(faces)
    ends = edges.ends
    here, other = np.concatenate([ends, ends[:, ::-1]]).T
    at = fits.points[here]
    off = fits.second_forms(other, at) - fits.second_forms(here, at)
    # the largest normal curvature of the difference is its norm at most
    size = np.linalg.norm(off, axis=(1, 2))
    result = np.zeros(len(fits.points))
    np.maximum.at(result, here, size)
    return np.where(edges.border_vertices(len(result)), one_sided * result, result)


def through_vertices(flat: Film, loops: tuple[Loop, ...], fits: VertexFits, order: int) -> Film:
    """Elements of an order on the triangles of a mesh, through its vertices, their rim on the loops."""
    film = Film.on_mesh(replace(flat.mesh, points=fits.points), loops, order)
    connectivity = film.connectivity
    local = connectivity.basis.nodes
    share = np.column_stack([1 - local.sum(1), local]) ** 2
    share /= share.sum(1)[:, None]
    start = film.nodes[connectivity.elements]
    count, k = connectivity.elements.shape
    barycentric = np.column_stack([1 - local.sum(1), local])
    direction = np.einsum("ki,mic->mkc", barycentric, fits.normal[connectivity.faces])
    direction /= np.linalg.norm(direction, axis=2)[:, :, None]
    flat_start, flat_direction = start.reshape(-1, 3), direction.reshape(-1, 3)
    height = np.zeros((count, k))
    for corner in range(3):
        vertex = np.repeat(connectivity.faces[:, corner], k)
        height += share[:, corner] * fits.along(vertex, flat_start, flat_direction).reshape(count, k)
    placed = start + height[:, :, None] * direction
    # the rim is the loop's; what the graphs miss of it fades into the element
    element, edge = connectivity.rim_elements, connectivity.rim_edges
    inner = connectivity.basis.edge_nodes[edge][:, 1:-1]
    rim = connectivity.rim_nodes[:, 1:-1]
    shift = film.nodes[rim] - placed[element[:, None], inner]
    np.add.at(placed, element, np.einsum("bki,bic->bkc", edge_blends(order)[edge], shift))
    nodes = film.nodes.copy()
    nodes[connectivity.elements] = placed
    nodes[connectivity.rim_nodes] = film.nodes[connectivity.rim_nodes]
    return film.at(nodes)
