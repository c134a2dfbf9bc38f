"""Corners of the rim: what a film does in them, and the figures of a net next to them.

Where straight sides meet at the angle b, measured on the surface, its Hopf differential is c / w dw^2 in the half plane
w onto which it is mapped with the corner in 0, and the distance from the corner goes like w^(b / pi). So the curvature
goes like r^(pi / b - 2), unbounded for b above 90 degrees, and the net's coordinates like r^(pi / 2 b): in them the
corner is a square one, whatever b (Dierkes, Hildebrandt and Tromba, Regularity of Minimal Surfaces (2010), chapter 3,
doi:10.1007/978-3-642-11700-8). Bent sides add a part that is bounded, but for a logarithm at 90 degrees. At a corner
that is reflex in plan a film is mostly turned over: its angle is the one below 180 degrees, and its curvature
concentrates around the corner instead of in it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from lamella.base.arrays import Booleans, Floats, Integers
from lamella.base.triangle import CORNERS
from lamella.base.vectors import crosses, diagonal, dots, lengths
from lamella.base.wording import rounded
from lamella.network.network import REGULAR, Network
from lamella.surface.boundary.fillets import LEAST_TURN, LEFT, tangent_length
from lamella.surface.element.connectivity import Connectivity
from lamella.surface.element.geometry import tangents
from lamella.surface.element.rim import CORNER_CORE, CORNER_PART, SHARP_TURN, element_rims
from lamella.surface.element.surface import ElementSurface

# of the size: points nearer to each other are one
SAME_POINT = 1e-6


@dataclass(frozen=True)
class RimCorners:
    """Sharp corners of a surface's rim.

    Attributes
    ----------
    points : (c, 3)
        m.
    angles : (c,)
        Between the sides, measured on the surface, radians.
    radii : (c,)
        What is next to a corner, m.
    cores : (c,)
        Within which the elements do not follow the curvature, m.
    fillets : (c,)
        Largest `corner_radius` of the corner's loop, m.
    loops : (c,) int
        Number of the corner's loop.
    sliding : (c,) bool
        Whether a part that slides begins or ends there: such a corner has no fillet.
    """

    points: Floats
    angles: Floats
    radii: Floats
    cores: Floats
    fillets: Floats
    loops: Integers
    sliding: Booleans

    @classmethod
    def of(cls, surface: ElementSurface) -> RimCorners:
        """Those of a surface."""
        connectivity, nodes = surface.connectivity, surface.nodes
        size = diagonal(nodes)
        rows: list[tuple[Floats, ...]] = []
        for loop, rim in enumerate(element_rims(connectivity, nodes, surface.rim_loop)):
            turned = np.flatnonzero(rim.turns > LEAST_TURN)
            arc = rim.starts[turned] * rim.length
            gap = np.diff(np.append(arc, arc[:1] + rim.length))
            sharp = rim.turns[turned] > SHARP_TURN
            radius = np.minimum(CORNER_PART * min(size, rim.length), np.minimum(gap, np.roll(gap, 1)) / 4)[sharp]
            vertices = rim.vertices[turned][sharp]
            most = np.full(len(vertices), _largest_fillet(rim.turns[turned], gap))
            rows.append(
                (
                    nodes[vertices],
                    _angles(connectivity, nodes, vertices),
                    radius,
                    CORNER_CORE / CORNER_PART * radius,
                    most,
                    np.full(len(vertices), loop),
                )
            )
        columns = [np.concatenate(column) for column in zip(*rows, strict=True)]
        ends = np.zeros((0, 3)) if surface.slide_ends is None else surface.slide_ends
        away = np.linalg.norm(columns[0][:, None] - ends, axis=2)
        return cls(*[*columns, (away < SAME_POINT * size).any(1)])

    def nearest(self, point: Floats, reach: float) -> int:
        """The corner within reach, m, of a point (3,); -1: there is none."""
        if not len(self.points):
            return -1
        away = lengths(self.points - point) - np.maximum(self.radii, reach)
        return int(away.argmin()) if away.min() < 0 else -1

    def fillet(self, corner: int, edge: float) -> float:
        """A `corner_radius` that spreads a corner over a cell with edges of a length, m, where the loop has room."""
        return rounded(min(edge, float(self.fillets[corner])), up=False, digits=2)

    def within(self, points: Floats, radii: Floats) -> Integers:
        """The corner within whose radius, (c,) m, each point (n, 3) is; -1: of none."""
        result = np.full(len(points), -1)
        for corner, (place, radius) in enumerate(zip(self.points, radii, strict=True)):
            result[lengths(points - place) <= radius] = corner
        return result

    def rows(self, network: Network, kn: Floats, angles: Floats) -> list[dict[str, Any]]:
        """What each corner is, with the worst figures of a net next to it; none where nothing of the net is.

        Parameters
        ----------
        network : Network
        kn : (k,)
            What the normal curvature is off at its samples, 1/m.
        angles : (..., n)
            Angles at its regular nodes, deg, the worst one counts.
        """
        of_sample = self.within(network.sample_points, self.radii)
        nodes = network.node_points[network.node_kinds == REGULAR]
        of_node, off = self.within(nodes, self.radii), np.abs(90 - angles).reshape(-1, len(nodes)).max(0)
        stops = network.node_points[network.stop_nodes]
        owner = network.stop_owner
        inner = owner[1:] == owner[:-1]
        of_edge = self.within(((stops[1:] + stops[:-1]) / 2)[inner], self.radii)
        return [
            {
                "point": self.points[corner].tolist(),
                "angle_deg": round(float(np.degrees(self.angles[corner])), 4),
                # 0 at 90 degrees, but for rounding
                "curvature_exponent": round(float(np.pi / self.angles[corner] - 2), 6) + 0.0,
                "radius": float(self.radii[corner]),
                "unresolved_radius": float(self.cores[corner]),
                "normal_curvature_deviation_max": _worst(kn, of_sample == corner),
                "geodesic_torsion_max": _worst(np.abs(network.sample_darboux.tg), of_sample == corner),
                "node_angle_deviation_max_deg": _worst(off, of_node == corner),
                "cell_edge_min": _least(network.cell_edges, of_edge == corner),
            }
            for corner in range(len(self.points))
        ]


def _worst(values: Floats, there: Booleans) -> float | None:
    return float(values[there].max()) if there.any() else None


def _least(values: Floats, there: Booleans) -> float | None:
    return float(values[there].min()) if there.any() else None


def _largest_fillet(turns: Floats, gaps: Floats) -> float:
    """Largest corner radius of a loop, m, by the turns at its corners and the sides behind them, (c,)."""
    if not len(turns):
        return np.inf
    reach = np.array([tangent_length(turn) for turn in turns.tolist()])
    return float(((1 - LEFT) * gaps / (reach + np.roll(reach, -1))).min())


def _angles(connectivity: Connectivity, nodes: Floats, vertices: Sequence[int] | Integers) -> Floats:
    """Angle of the surface around vertices of its rim, radians, (c,)."""
    basis = connectivity.basis
    corners = CORNERS
    element, corner = np.nonzero(np.isin(connectivity.faces, vertices))
    x, y = tangents(basis.basis(corners, 1, 0), basis.basis(corners, 0, 1), nodes[connectivity.elements[element]])
    rows = np.arange(len(element))
    x, y = x[rows, corner], y[rows, corner]
    # along both edges that leave the corner
    first = np.where((corner == 0)[:, None], x, np.where((corner == 1)[:, None], y - x, -y))
    second = np.where((corner == 0)[:, None], y, np.where((corner == 1)[:, None], -x, x - y))
    angle = np.arctan2(lengths(crosses(first, second)), dots(first, second))
    total = np.bincount(connectivity.faces[element, corner], angle, len(nodes))
    return np.asarray(total[np.asarray(vertices, np.int64)])
