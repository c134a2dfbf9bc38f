"""The median cell edge of a net before it is traced.

A cell edge is l0 / |factor mu|, and there are as many as points of the lattice: what they are is known all over the
surface. A curve that ends on the rim, or at a seam, ends within an edge, anywhere in it, and its last node lies half an
edge before the rim on average.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.network.isothermic.isothermic import Isothermic
from lamella.network.pattern import Pattern
from lamella.surface.element.quadrature import triangle_rule

# parts of an edge in which a curve may end at the rim, all alike
END_PARTS = (np.arange(8) + 0.5) / 8
# rounds in which the pieces at the rim follow the edge
STEP_ROUNDS = 6


@dataclass(frozen=True)
class EdgeSizes:
    """Sizes of the cells of the whole lattice, that is before curves are left out.

    Attributes
    ----------
    area : (n,)
        Of the cell plane, at integration points, times l0^2, m.
    edge : (n,)
        Cell edge there over l0, 1 / sqrt(m).
    ends : (2, r)
        Curves of family A and of family B that end on pieces of the rim, or of a seam, times l0, sqrt(m).
    last_edge : (r,)
        Cell edge there over l0, 1 / sqrt(m).
    """

    area: Floats
    edge: Floats
    ends: Floats
    last_edge: Floats

    @classmethod
    def of(cls, iso: Isothermic, pattern: Pattern, seams: Integers) -> EdgeSizes:
        """On a surface's coordinates; `seams` are the transitions across which the net does not go on, (s,)."""
        mesh, connectivity = iso.mesh, iso.mesh.connectivity
        basis = connectivity.basis
        points, weights = triangle_rule(8)
        x, y = basis.basis(points, 1, 0), basis.basis(points, 0, 1)
        w_x, w_y = iso.value @ x.T, iso.value @ y.T
        factor = abs(pattern.factor)
        area = np.abs(w_x.real * w_y.imag - w_x.imag * w_y.real) * weights * factor**2
        corners = mesh.nodes[connectivity.elements]
        flat = np.linalg.norm(np.cross(np.matmul(x, corners), np.matmul(y, corners)), axis=2) * weights
        edge = np.sqrt(flat / np.maximum(area, 1e-300))
        # the rim, and seams from both sides
        open_ = [iso.transitions[number] for number in seams.tolist()]
        sides = [side for one in open_ for side in ((one.left, one.left_edge), (one.right, one.right_edge))]
        element = np.concatenate([connectivity.rim_elements, *(side[0] for side in sides)])
        local = np.concatenate([connectivity.rim_edges, *(side[1] for side in sides)])
        own = basis.edge_nodes[local]
        along = np.diff(iso.value[element[:, None], own] * pattern.factor, axis=1).ravel()
        chord = np.diff(mesh.nodes[connectivity.elements[element[:, None], own]], axis=1)
        length = np.linalg.norm(chord, axis=2).ravel()
        ends = np.abs(np.stack([along.imag, along.real]))
        return cls(area.ravel(), edge.ravel(), ends, length / np.maximum(np.abs(along), 1e-300))

    def median(self, step: float) -> float:
        """Median cell edge, m, at l0 = step, sqrt(m)."""
        # two edges a lattice point; of a curve's last edges only a part is there
        size = np.concatenate([self.edge, np.outer(END_PARTS, self.last_edge).ravel(), self.last_edge])
        last = self.ends.sum(0) / step
        many = np.concatenate([2 * self.area / step**2, np.tile(last / len(END_PARTS), len(END_PARTS)), -last / 2])
        order = np.argsort(size)
        running = np.maximum.accumulate(np.cumsum(many[order]))
        middle = int(np.searchsorted(running, running[-1] / 2))
        return step * float(size[order][middle])

    def step(self, spacing: float) -> float:
        """l0, sqrt(m), for a median cell edge of spacing, m."""
        # with hardly any ends
        fine = 1e-6 * float(np.sqrt(self.area.sum()))
        step = fine * spacing / self.median(fine)
        for _ in range(STEP_ROUNDS):
            step = step * spacing / self.median(step)
        return float(step)

    def nodes(self, step: float, pattern: Pattern) -> tuple[float, float]:
        """Crossings of the kept curves, and their ends, at l0 = step, sqrt(m)."""
        p, q = pattern.every
        a, b = self.ends.sum(1).tolist()
        return float(self.area.sum()) / (step**2 * p * q), (a / p + b / q) / step
