"""What of a net's surface and of its boundary belongs to each node.

A face is divided among its corners: from a corner to the middles of its two sides and to the middle of all corners.
The vector area of such a piece is half the cross product of its diagonals. Pieces of a face add up to its own vector
area, so that areas in plan are those of the faces' outlines exactly; on a smooth surface all converge with the square
of the edges.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.base.vectors import crosses, lengths
from lamella.network.network import Network
from lamella.structure.actions.rim_edges import face_sides


@dataclass(frozen=True, eq=False)
class TributaryAreas:
    """Areas that belong to nodes.

    Attributes
    ----------
    true : (n,)
        Of the surface, m2.
    vectors : (n, 3)
        Vector areas, along the normals, m2: their component along a direction is the area as seen along it, where the
        surface does not fold over itself there.
    pieces : (s, 3)
        Vector areas of the pieces of faces, m2.
    owner : (s,) int
        Nodes that pieces belong to.
    """

    true: Floats
    vectors: Floats
    pieces: Floats
    owner: Integers

    def seen_along(self, direction: Floats) -> Floats:
        """Area as it is seen along a unit vector, m2, (n,); of both sides of the surface."""
        return np.asarray(np.bincount(self.owner, np.abs(self.pieces @ direction), len(self.true)), float)


def tributary_areas(network: Network) -> TributaryAreas:
    """Share of every node in the faces around it."""
    count = len(network.node_points)
    tails, heads = face_sides(network)
    points = network.node_points
    middles = (points[tails] + points[heads]) / 2
    offsets = network.face_offsets
    sizes = np.diff(offsets)
    centres = np.add.reduceat(points[tails], offsets[:-1]) / sizes[:, None] if len(sizes) else np.zeros((0, 3))
    face = np.repeat(np.arange(len(sizes)), sizes)
    before = np.arange(-1, len(tails) - 1)
    before[offsets[:-1]] = offsets[1:] - 1
    pieces = crosses(centres[face] - points[tails], middles[before] - middles) / 2
    vectors = np.column_stack([np.bincount(tails, part, count) for part in pieces.T])
    true = np.asarray(np.bincount(tails, lengths(pieces), count), float)
    return TributaryAreas(true, np.asarray(vectors, float), pieces, tails)


def tributary_lengths(network: Network, edges: Integers) -> Floats:
    """Length that belongs to each node of edges (e, 2): half of those it is an end of, m, (n,)."""
    points = network.node_points
    half = lengths(points[edges[:, 1]] - points[edges[:, 0]]) / 2
    return np.asarray(np.bincount(edges.ravel(), np.repeat(half, 2), len(points)), float)
