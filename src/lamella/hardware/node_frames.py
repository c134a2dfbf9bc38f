"""Where two lamellas cross: place, axes and angle of every such node, and the surface's shape around it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lamella.base.arrays import Floats, Integers
from lamella.hardware.item import Places
from lamella.network.network import Network
from lamella.strip.lamellas import Lamellas, crossings


@dataclass(frozen=True, eq=False)
class NodeFrames:
    """The nodes where one A lamella is joined with one B lamella.

    In a node's frame x runs along the A lamella, z along the surface normal n and y along n x t. There the surface is
    z = (kn x^2 + 2 tg x y + across y^2) / 2, up to third order.

    Attributes
    ----------
    nodes : (q,) int
        Indices into the network's nodes.
    origins : (q, 3)
        m.
    axes : (q, 3, 3)
        Rows: x, y, z.
    angles : (q,)
        From the A to the B lamella about the normal, rad, between 0 and pi.
    tangents_b : (q, 3)
        Unit tangent of the B lamella, on the side of positive y.
    kn, tg, across : (q,)
        Normal curvature and geodesic torsion of the A lamella and normal curvature across it, 1/m.
    kg : (q,)
        The larger geodesic curvature of both lamellas, without sign, 1/m.
    stop_a, stop_b : (q,) int
        Stops of the two lamellas at the node.
    """

    nodes: Integers
    origins: Floats
    axes: Floats
    angles: Floats
    tangents_b: Floats
    kn: Floats
    tg: Floats
    across: Floats
    kg: Floats
    stop_a: Integers
    stop_b: Integers

    @classmethod
    def of(cls, network: Network) -> NodeFrames:
        """The frames of a network's crossings."""
        at_node = crossings(network)[network.stop_nodes]
        sample = network.sample_offsets[network.stop_owner] + network.stop_samples
        is_a = network.families[network.stop_owner] == "A"
        stop = np.full((2, len(network.node_points)), -1)
        for row, member in enumerate((is_a, ~is_a)):
            # a closed lamella comes back to its first node: its first stop counts
            stops = np.flatnonzero(member & at_node)[::-1]
            stop[row, network.stop_nodes[stops]] = stops
        nodes = np.flatnonzero((stop >= 0).all(0))
        stop_a, stop_b = stop[:, nodes]
        normal = network.node_normals[nodes]
        x = _in_plane(network.sample_tangents[sample[stop_a]], normal)
        y = np.cross(normal, x)
        b = _in_plane(network.sample_tangents[sample[stop_b]], normal)
        b = b * np.where(np.einsum("ij,ij->i", b, y) < 0, -1.0, 1.0)[:, None]
        angles = np.arctan2(np.einsum("ij,ij->i", b, y), np.einsum("ij,ij->i", b, x))
        kn, kg, tg = (values[sample[stop_a]] for values in network.sample_darboux)
        kg_b = network.sample_darboux.kg[sample[stop_b]]
        across = 2 * network.sample_mean_curvature[sample[stop_a]] - kn
        axes = np.stack([x, y, normal], axis=1)
        bend = np.maximum(np.abs(kg), np.abs(kg_b))
        return cls(nodes, network.node_points[nodes], axes, angles, b, kn, tg, across, bend, stop_a, stop_b)

    def __len__(self) -> int:
        return len(self.nodes)

    @property
    def least_angle(self) -> float:
        """Smallest angle between lamellas at any node, rad; a right angle without nodes."""
        return float(np.minimum(self.angles, np.pi - self.angles).min(initial=np.pi / 2))

    @property
    def labels(self) -> tuple[str, ...]:
        """ "node 12"."""
        return tuple(f"node {node}" for node in self.nodes.tolist())

    @property
    def above(self) -> Places:
        """Frames on the node's axis, z upwards, x along A."""
        return Places(self.origins, self.axes, self.labels)

    @property
    def below(self) -> Places:
        """Frames turned over, z downwards, x along B: A is at the same angle from it as B is from A seen from above."""
        normal = self.axes[:, 2]
        axes = np.stack([self.tangents_b, np.cross(-normal, self.tangents_b), -normal], axis=1)
        return Places(self.origins, axes, self.labels)

    def height(self, x: Floats, y: Floats) -> Floats:
        """Height of the surface over the tangent plane at (v,) places in the node's axes, (q, v), m."""
        bilinear = self.kn[:, None] * x**2 + 2 * self.tg[:, None] * x * y + self.across[:, None] * y**2
        return np.asarray(bilinear / 2)

    def layer_distances(self, lamellas: Lamellas) -> tuple[Floats, Floats]:
        """Distances of the A and of the B lamella's layers from their centre lines, (layers, q) each, m."""
        network = lamellas.network
        sample = network.sample_offsets[network.stop_owner] + network.stop_samples
        distances = lamellas.layers.distances
        return distances[:, sample[self.stop_a]], distances[:, sample[self.stop_b]]


def _in_plane(vectors: Floats, normals: Floats) -> Floats:
    """Unit vectors (q, 3) of what vectors have in the planes of unit normals."""
    flat = vectors - np.einsum("ij,ij->i", vectors, normals)[:, None] * normals
    return np.asarray(flat / np.linalg.norm(flat, axis=1)[:, None])
