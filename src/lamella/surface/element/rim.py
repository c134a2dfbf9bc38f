"""The boundary of a surface of curved elements as closed curves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.surface.element.connectivity import Connectivity
from lamella.surface.element.edge_basis import edge_rule, edge_slopes, edge_values

# a turn between neighbouring edges above this is a corner of the boundary, rad
CORNER = 0.02
# corners that turn by more than this, rad, may concentrate the curvature of a film
SHARP_TURN = 0.35
# around such a corner, of the size: within the first an error counts over the curvature there, within the second, which
# elements do not resolve, not at all
CORNER_PART, CORNER_CORE = 0.03, 0.003
# places along an edge among which the nearest one is looked for, and how often again between its neighbours
NEAREST_PLACES, NEAREST_ROUNDS = 17, 8


@dataclass(frozen=True)
class ElementRim:
    """One boundary loop, the surface to its left, parametrised by the fraction of its length.

    Attributes
    ----------
    length : float
        m.
    corners : (c,)
        Parameters of corners, sorted.
    vertices : (b,) int
        Vertices along the loop.
    starts : (b,)
        Their parameters; the first is 0.
    turns : (b,)
        Angle between the edges before and after each, radians.
    """

    length: float
    corners: Floats
    vertices: Integers
    starts: Floats
    turns: Floats
    _spans: Floats
    _nodes: Floats

    def at(self, t: Floats) -> Floats:
        """Points (n, 3), m."""
        t = np.asarray(t, float) % 1
        edge = np.clip(np.searchsorted(self.starts, t, side="right") - 1, 0, len(self.starts) - 1)
        share = np.clip((t - self.starts[edge]) / self._spans[edge], 0, 1)
        basis = edge_values(self._nodes.shape[1] - 1, share)
        return np.asarray(np.einsum("nk,nkc->nc", basis, self._nodes[edge]))

    def place_of(self, point: Floats) -> float:
        """Parameter of the point of the loop that is nearest to a point (3,)."""
        edge, share = nearest_on_edges(self._nodes, point)
        return float(self.starts[edge] + share * self._spans[edge])


def element_rims(connectivity: Connectivity, nodes: Floats, rim_loop: Integers) -> tuple[ElementRim, ...]:
    """Boundary loops of elements with nodes (n, 3), by the numbers in `rim_loop` (b,)."""
    p = connectivity.basis.order
    gauss, weight = edge_rule(p)
    slopes, ends = edge_slopes(p, gauss), edge_slopes(p, np.array([0.0, 1.0]))
    rim_nodes = connectivity.rim_nodes
    rims = []
    for loop in range(int(rim_loop.max()) + 1):
        edges = rim_nodes[rim_loop == loop]
        after = {int(a): k for k, a in enumerate(edges[:, 0])}
        order = [0]
        while len(order) < len(edges):
            order.append(after[int(edges[order[-1], -1])])
        edges = edges[order]
        along = nodes[edges]
        speed = np.linalg.norm(np.matmul(slopes, along), axis=2)
        lengths = (speed * weight).sum(1)
        spans = lengths / lengths.sum()
        starts = np.concatenate([[0.0], np.cumsum(spans)[:-1]])
        leaving = np.einsum("k,bkc->bc", ends[0], along)
        arriving = np.roll(np.einsum("k,bkc->bc", ends[1], along), 1, 0)
        cosine = (leaving * arriving).sum(1) / (np.linalg.norm(leaving, axis=1) * np.linalg.norm(arriving, axis=1))
        turns = np.arccos(np.clip(cosine, -1, 1))
        corners = starts[turns > CORNER]
        rims.append(ElementRim(float(lengths.sum()), corners, edges[:, 0], starts, turns, spans, along))
    return tuple(rims)


def nearest_on_edges(edges: Floats, point: Floats) -> tuple[int, float]:
    """Curved edge, and share of its parameter, where edges with nodes (b, p + 1, 3) come nearest to a point (3,)."""
    order = edges.shape[1] - 1
    shares = np.linspace(0, 1, NEAREST_PLACES)
    apart = ((edge_values(order, shares) @ edges - point) ** 2).sum(2)
    edge, at = (int(k) for k in np.unravel_index(apart.argmin(), apart.shape))
    for _ in range(NEAREST_ROUNDS):
        shares = np.linspace(shares[max(at - 1, 0)], shares[min(at + 1, NEAREST_PLACES - 1)], NEAREST_PLACES)
        at = int(((edge_values(order, shares) @ edges[edge] - point) ** 2).sum(1).argmin())
    return edge, float(shares[at])


def rim_marks(connectivity: Connectivity, nodes: Floats, rim_loop: Integers, start: Floats, shares: Floats) -> Floats:
    """Points (n, 3) of the outer loop at shares (n,) of its length from a point of it (3,) on, m."""
    rim = element_rims(connectivity, nodes, rim_loop)[0]
    return rim.at(rim.place_of(start) + shares)
