"""A surface of elements as lines are traced on it."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from lamella.base.arrays import Complexes, Floats, Integers
from lamella.base.triangle import CORNERS
from lamella.network.charts.charts import ChartSample, RimPlaces
from lamella.surface.element.places import Places
from lamella.surface.element.quadrature import triangle_rule
from lamella.surface.element.rim import element_rims
from lamella.surface.element.surface import ElementSurface

# elements a step may pass, Newton's steps to a place seen from the next element, and what counts as outside of one
CHART_HOPS_MAX, CHART_NEWTON_STEPS, OUTSIDE = 8, 4, 1e-12
# of an element: a place farther outside, with no element beyond, was not settled
UNSETTLED = 1e-6


class ElementCharts:
    """A surface of elements.

    Parameters
    ----------
    surface : ElementSurface
    """

    # of an element
    _STEP = 0.35

    def __init__(self, surface: ElementSurface) -> None:
        self.surface = surface
        self._connectivity = surface.connectivity

    def evaluate(self, where: Places) -> ChartSample:
        there, mean, deviator = self.surface.shape_at(where)
        return ChartSample(there.position, there.normal, there.e_u, there.e_v, mean, deviator, there.to_local)

    def measured(self, where: Places) -> tuple[Floats, Complexes]:
        there = self.surface.measured(where)
        return there.mean_curvature, there.deviator

    def uncertain(self, where: Places) -> Floats:
        return self.surface.uncertain(where)

    def reach(self, where: Places) -> Floats:
        return np.full(len(where), self._STEP)

    def settle(self, where: Places) -> Places:
        element, local = where.element.copy(), where.local.copy()
        neighbours, across = self._connectivity.neighbours, self._connectivity.neighbour_edges
        left = np.arange(len(where))
        for _ in range(CHART_HOPS_MAX):
            barycentric = _barycentric(local[left])
            # the edge opposite a corner begins at the next one
            beyond = neighbours[element[left][:, None], (np.arange(3) + 1) % 3]
            worst = np.where(beyond >= 0, barycentric, np.inf)
            corner = worst.argmin(1)
            rows = np.arange(len(left))
            out = worst[rows, corner] < -OUTSIDE
            left, corner, barycentric = left[out], corner[out], barycentric[out]
            if not len(left):
                break
            edge, rows = (corner + 1) % 3, np.arange(len(left))
            depth = barycentric[rows, corner]
            entered = np.zeros((len(left), 3))
            other = across[element[left], edge]
            # edges of two elements run in opposite directions
            entered[rows, other] = barycentric[rows, (edge + 1) % 3] + depth
            entered[rows, (other + 1) % 3] = barycentric[rows, edge] + depth
            entered[rows, (other + 2) % 3] = -depth
            goal = self.surface.frames(Places(element[left], local[left])).position
            element[left] = neighbours[element[left], edge]
            local[left] = self._nearest(goal, Places(element[left], entered[:, 1:]))
        return Places(element, local)

    def _nearest(self, goal: Floats, where: Places) -> Floats:
        """Local coordinates of the points of charts that are next to points (n, 3), from places nearby."""
        local = where.local
        for _ in range(CHART_NEWTON_STEPS):
            there = self.surface.frames(Places(where.element, local))
            off = goal - there.position
            across = np.stack([(off * there.e_u).sum(1), (off * there.e_v).sum(1)], 1)
            local = local + np.matmul(there.to_local, across[:, :, None])[:, :, 0]
        return local

    def gap(self, where: Places) -> Floats:
        barycentric = _barycentric(where.local)
        inner = self._connectivity.neighbours[where.element[:, None], (np.arange(3) + 1) % 3] >= 0
        settled = np.where(barycentric < -UNSETTLED, barycentric, 1.0)
        return np.asarray(np.where(inner, settled, barycentric).min(1))

    def samples(self) -> tuple[Places, Floats]:
        points, weights = triangle_rule(6)
        m = len(self._connectivity.faces)
        where = Places(np.repeat(np.arange(m), len(points)), np.tile(points, (m, 1)))
        determinant = np.linalg.det(self.surface.frames(where).to_local)
        return where, np.tile(weights, m) / determinant

    @cached_property
    def _rims(self) -> tuple[Integers, Floats, Floats, list[float]]:
        """Of every vertex its loop, its arc length along it and that of the edge from it, m; lengths of the loops."""
        count = int(self._connectivity.faces.max()) + 1
        loop, start, span = np.full(count, -1), np.zeros(count), np.zeros(count)
        lengths = []
        for number, rim in enumerate(element_rims(self._connectivity, self.surface.nodes, self.surface.rim_loop)):
            loop[rim.vertices] = number
            start[rim.vertices] = rim.starts * rim.length
            span[rim.vertices] = np.diff(np.append(rim.starts, 1.0)) * rim.length
            lengths.append(rim.length)
        return loop, start, span, lengths

    def rim_places(self, where: Places) -> RimPlaces:
        where = self._on_rim_elements(where)
        barycentric = _barycentric(where.local)
        beyond = self._connectivity.neighbours[where.element[:, None], (np.arange(3) + 1) % 3]
        edge = (np.where(beyond < 0, barycentric, np.inf).argmin(1) + 1) % 3
        along = CORNERS[(edge + 1) % 3] - CORNERS[edge]
        share = ((where.local - CORNERS[edge]) * along).sum(1) / (along**2).sum(1)
        vertex = self._connectivity.faces[where.element, edge]
        loop, start, span, _ = self._rims
        _, first, second = self.surface.polynomials.jet(where).transpose(0, 2, 1)
        tangent = along[:, :1] * first + along[:, 1:] * second
        tangent /= np.linalg.norm(tangent, axis=1)[:, None]
        return RimPlaces(loop[vertex], start[vertex] + share * span[vertex], tangent)

    def _on_rim_elements(self, where: Places) -> Places:
        """The same places, those at a vertex of the rim in the element whose rim edge begins there."""
        connectivity = self._connectivity
        inside = (connectivity.neighbours[where.element] >= 0).all(1)
        if not inside.any():
            return where
        row = np.full(int(connectivity.faces.max()) + 1, -1)
        row[connectivity.rim_nodes[:, 0]] = np.arange(len(connectivity.rim_elements))
        element, local = where.element.copy(), where.local.copy()
        corner = _barycentric(local[inside]).argmax(1)
        at = row[connectivity.faces[element[inside], corner]]
        element[inside] = np.where(at >= 0, connectivity.rim_elements[at], element[inside])
        local[inside] = np.where((at >= 0)[:, None], CORNERS[connectivity.rim_edges[at]], local[inside])
        return Places(element, local)

    def _around(self, loop: int, count: int) -> Places:
        rim = element_rims(self._connectivity, self.surface.nodes, self.surface.rim_loop)[loop]
        return self.surface.closest(rim.at(np.arange(count) / count))[0]

    def rim_points(self, count: int) -> Places:
        loops = [self._around(loop, count) for loop in range(len(self._rims[3]))]
        return Places(np.concatenate([p.element for p in loops]), np.concatenate([p.local for p in loops]))

    def hole(self, count: int) -> tuple[Places, float] | None:
        lengths = self._rims[3]
        return (self._around(1, count), lengths[1]) if len(lengths) > 1 else None


def _barycentric(local: Floats) -> Floats:
    return np.column_stack([1 - local.sum(1), local])
