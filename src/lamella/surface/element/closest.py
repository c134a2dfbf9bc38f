"""Closest points on a surface of curved elements, in bulk."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from lamella.base.arrays import Floats, Integers
from lamella.base.triangle import CORNERS
from lamella.surface.element.connectivity import Connectivity
from lamella.surface.element.lagrange import subdivision
from lamella.surface.element.places import Places

# samples of each element among which the search starts: this many to an edge
CLOSEST_SAMPLES = 5
CLOSEST_STEPS_MAX = 40
MOST_IDLE = 3
# Newton's steps end below this in local coordinates
CLOSEST_TOLERANCE = 1e-13


class ClosestPoint:
    """A search tree over one surface.

    The nearest of a regular set of samples gives the element to begin with; Newton's method for the stationary
    distance follows, clamped to the triangle and handed on to the neighbour where it wants to leave.

    Parameters
    ----------
    connectivity : Connectivity
    nodes : (n, 3)
    """

    def __init__(self, connectivity: Connectivity, nodes: Floats) -> None:
        self._connectivity, self._nodes = connectivity, nodes

    @cached_property
    def _tree(self) -> cKDTree:
        """The samples of all elements, element by element."""
        basis = self._connectivity.basis.basis(subdivision(CLOSEST_SAMPLES)[0])
        return cKDTree(np.matmul(basis, self._nodes[self._connectivity.elements]).reshape(-1, 3))

    @cached_property
    def _fans(self) -> tuple[Integers, Integers]:
        """Corners 3 e + c of all elements, by vertex, and where each vertex's begin."""
        vertices = self._connectivity.faces.ravel()
        fans = np.argsort(vertices, kind="stable")
        return fans, np.searchsorted(vertices[fans], np.arange(self._connectivity.faces.max() + 2))

    def __call__(self, points: Floats) -> tuple[Places, Floats]:
        """Closest places and their positions.

        Parameters
        ----------
        points : (n, 3)

        Returns
        -------
        places : Places
        position : (n, 3)
            m.
        """
        _, sample = self._tree.query(points)
        local, _ = subdivision(CLOSEST_SAMPLES)
        return self.near(points, Places(sample // len(local), local[sample % len(local)]))

    def near(self, points: Floats, start: Places) -> tuple[Places, Floats]:
        """The same, searched from places that are near: no need of samples."""
        element, local = self._search(points, start.element, start.local)
        # a search that ends in a vertex may have its way on through any element there
        at_vertex = np.flatnonzero(np.column_stack([1 - local.sum(1), local]).max(1) > 1 - 1e-9)
        if len(at_vertex):
            corner = np.column_stack([1 - local.sum(1), local])[at_vertex].argmax(1)
            vertex = self._connectivity.faces[element[at_vertex], corner]
            fans, offsets = self._fans
            first, count = offsets[vertex], np.diff(offsets)[vertex]
            query = np.repeat(np.arange(len(at_vertex)), count)
            fan = fans[np.repeat(first - np.cumsum(count) + count, count) + np.arange(count.sum())]
            tried = points[at_vertex][query]
            beside = CORNERS[fan % 3] * 0.98 + 0.02 / 3
            found, place = self._search(tried, fan // 3, beside)
            distance = np.linalg.norm(self._position(found, place) - tried, axis=1)
            by_query = np.lexsort((distance, query))
            best = by_query[np.searchsorted(query, np.arange(len(at_vertex)))]
            element[at_vertex], local[at_vertex] = found[best], place[best]
        return Places(element, local), self._position(element, local)

    def _search(self, points: Floats, element: Integers, local: Floats) -> tuple[Integers, Floats]:
        """Places of stationary distance, from places to start at."""
        element, local = element.copy(), local.copy()
        active = np.arange(len(points))
        best, idle = np.full(len(points), np.inf), np.zeros(len(points), int)
        for _ in range(CLOSEST_STEPS_MAX):
            moved, leaving = self._step(points[active], element[active], local[active])
            change = np.abs(moved - local[active]).max(1)
            local[active] = moved
            hop = leaving >= 0
            hopping = active[hop]
            across, entered = self._cross(element[hopping], leaving[hop], moved[hop])
            # a hop has to pay, or two elements would hand a point on their ridge to and fro
            distance = np.linalg.norm(self._position(element[hopping], moved[hop]) - points[hopping], axis=1)
            pays = distance < best[hopping] * (1 - 1e-12)
            idle[hopping] = np.where(pays, 0, idle[hopping] + 1)
            goes = (across >= 0) & (idle[hopping] < MOST_IDLE)
            best[hopping] = np.minimum(distance, best[hopping])
            element[hopping[goes]], local[hopping[goes]] = across[goes], entered[goes]
            going = change > CLOSEST_TOLERANCE
            going[np.flatnonzero(hop)[goes]] = True
            active = active[going]
            if not len(active):
                break
        return element, local

    def _position(self, element: Integers, local: Floats) -> Floats:
        basis = self._connectivity.basis.basis(local)
        return np.asarray(np.einsum("nk,nkc->nc", basis, self._nodes[self._connectivity.elements[element]]))

    def _step(self, points: Floats, element: Integers, local: Floats) -> tuple[Floats, Integers]:
        """Newton's step of half the squared distance, cut at the triangle; and the edge it leaves through (-1)."""
        corners = self._nodes[self._connectivity.elements[element]]
        x, a, b, aa, ab, bb = (np.einsum("nk,nkc->nc", f, corners) for f in self._connectivity.basis.second_jet(local))
        off = x - points
        ga, gb = (off * a).sum(1), (off * b).sum(1)
        faa, fab, fbb = (a * a).sum(1), (a * b).sum(1), (b * b).sum(1)
        # the second derivatives while they leave the matrix positive definite, else Gauss-Newton
        haa, hab, hbb = (f + (off * d).sum(1) for f, d in ((faa, aa), (fab, ab), (fbb, bb)))
        sound = (haa > 0.2 * faa) & (haa * hbb - hab**2 > 0.04 * (faa * fbb - fab**2))
        haa, hab, hbb = (np.where(sound, h, f) for h, f in ((haa, faa), (hab, fab), (hbb, fbb)))
        determinant = np.maximum(haa * hbb - hab**2, 1e-300)
        step = -np.stack([(hbb * ga - hab * gb) / determinant, (haa * gb - hab * ga) / determinant], 1)
        clamped, leaving = _clamp(local + step, haa, hab, hbb)
        move = clamped - local
        share = np.minimum(1, 0.7 / np.maximum(np.abs(move).max(1), 1e-300))
        return local + share[:, None] * move, np.where(share < 1, -1, leaving)

    def _cross(self, element: Integers, edge: Integers, local: Floats) -> tuple[Integers, Floats]:
        """The same points seen from across an edge."""
        across = self._connectivity.neighbours[element, edge]
        other = self._connectivity.neighbour_edges[element, edge]
        barycentric = np.column_stack([1 - local.sum(1), local])
        rows = np.arange(len(element))
        share = barycentric[rows, (edge + 1) % 3]
        entered = np.zeros((len(element), 3))
        entered[rows, other], entered[rows, (other + 1) % 3] = share, 1 - share
        return across, entered[:, 1:]


def _clamp(target: Floats, haa: Floats, hab: Floats, hbb: Floats) -> tuple[Floats, Integers]:
    """The point of the triangle nearest to a target in a metric, and the edge it lies on (-1: inside)."""
    inside = (target.min(1) >= 0) & (target.sum(1) <= 1)
    best = target.copy()
    edge = np.full(len(target), -1)
    least = np.where(inside, 0.0, np.inf)
    corners = CORNERS
    for index in range(3):
        start, along = corners[index], corners[(index + 1) % 3] - corners[index]
        off = target - start
        metric_along = (
            haa * along[0] * off[:, 0]
            + hab * (along[0] * off[:, 1] + along[1] * off[:, 0])
            + hbb * along[1] * off[:, 1]
        )
        norm = haa * along[0] ** 2 + 2 * hab * along[0] * along[1] + hbb * along[1] ** 2
        at = start + np.clip(metric_along / norm, 0, 1)[:, None] * along
        d = target - at
        distance = haa * d[:, 0] ** 2 + 2 * hab * d[:, 0] * d[:, 1] + hbb * d[:, 1] ** 2
        nearer = ~inside & (distance < least)
        best[nearer], edge[nearer], least[nearer] = at[nearer], index, distance[nearer]
    return best, edge
