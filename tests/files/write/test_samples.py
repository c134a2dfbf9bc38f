"""A small exact net to write: helices at 45 degrees on a cylinder, normals towards its axis."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lamella.base.material import find_material
from lamella.network.network import BOUNDARY, REGULAR, Network
from lamella.strip.lamellas import Lamellas, Section
from lamella.strip.layers import parallel_layers
from lamella.surface.darboux import Darboux
from lamella.surface.mesh import SurfaceMesh

RADIUS = 1.3


def helix(start: float, sense: int, arclengths: NDArray[np.float64]) -> NDArray[np.float64]:
    """Points of a helix at 45 degrees; sense +1 has geodesic torsion > 0."""
    rise = arclengths / np.sqrt(2) / RADIUS
    angle = start + sense * rise
    return RADIUS * np.column_stack((np.cos(angle), np.sin(angle), rise))


def inward(points: NDArray[np.float64]) -> NDArray[np.float64]:
    return -points * [1, 1, 0] / RADIUS


def cylinder_net(cells: int = 6, rows: int = 4, per_cell: int = 8) -> tuple[Network, Lamellas]:
    """Return ``cells`` helices of either sense over ``rows`` crossings; node r * cells + k is on row r."""
    cell = np.sqrt(2) * RADIUS * np.pi / cells
    arclengths = np.linspace(0, rows * cell, rows * per_cell + 1)
    starts = 2 * np.pi * np.arange(cells) / cells
    level, column = np.divmod(np.arange((rows + 1) * cells), cells)
    angle = starts[column] + level * np.pi / cells
    nodes = RADIUS * np.column_stack((np.cos(angle), np.sin(angle), level * np.pi / cells))
    turns = [(start, sense) for sense in (1, -1) for start in starts]
    points = np.vstack([helix(start, sense, arclengths) for start, sense in turns])
    normals = inward(points)
    senses = np.repeat([sense for _, sense in turns], len(arclengths))[:, None]
    tangents = (senses * np.cross([0, 0, 1], -normals) + [0, 0, 1]) / np.sqrt(2)
    up = np.arange(rows + 1)
    stops = [up * cells + k for k in range(cells)]
    stops += [up * cells + (k - up) % cells for k in range(cells)]
    r, k = np.meshgrid(np.arange(rows - 1), np.arange(cells), indexing="ij")
    left = (k - 1) % cells
    quads = np.stack((r * cells + k, (r + 1) * cells + left, (r + 2) * cells + left, (r + 1) * cells + k), -1)
    k = np.arange(cells)
    triangles = np.column_stack((k, cells + k, (k + 1) % cells))
    count, samples, stopping = 2 * cells, len(arclengths), rows + 1
    quads = quads.reshape(-1, 4)
    zero, twist = np.zeros(len(points)), senses[:, 0] * 0.5 / RADIUS
    network = Network(
        mean_curvature=0.5 / RADIUS,
        step=1.0,
        cells=cells,
        periods=(),
        left_out=0,
        node_points=nodes,
        node_normals=inward(nodes),
        node_kinds=np.where((level == 0) | (level == rows), BOUNDARY, REGULAR),
        ids=tuple(f"{family}{k + 1}" for family in "AB" for k in range(cells)),
        families=np.repeat(["A", "B"], cells),
        closed=np.zeros(count, dtype=bool),
        sample_offsets=np.arange(count + 1) * samples,
        sample_points=points,
        sample_normals=normals,
        sample_tangents=tangents,
        sample_darboux=Darboux(zero + 0.5 / RADIUS, zero, twist),
        sample_mean_curvature=zero + 0.5 / RADIUS,
        sample_slopes=zero,
        sample_where=points,
        sample_arclengths=np.tile(arclengths, count),
        stop_offsets=np.arange(count + 1) * stopping,
        stop_nodes=np.concatenate(stops),
        stop_samples=np.tile(up * per_cell, count),
        stop_arclengths=np.tile(arclengths[::per_cell], count),
        face_offsets=np.append(np.arange(len(quads)) * 4, len(quads) * 4 + 3 * np.arange(cells + 1)),
        face_nodes=np.concatenate((quads.ravel(), triangles.ravel())),
        faces_left_out=np.zeros(0, np.int64),
    )
    lamellas = Lamellas(
        network=network,
        material=find_material("1.4301"),
        section=Section(height=0.1, thickness=0.0015),
        stop_stations=network.stop_arclengths,
        layers=parallel_layers(network, Section().layer_offsets, zero, own_lengths=False, cut=False),
        layer=zero,
        net_utilisation=np.zeros(len(network.stop_nodes)),
        developed_lengths=network.lengths,
        bending=zero,
        torsion=zero,
        helix_edge=zero,
        helix_centre=zero,
        restraint=zero,
        von_mises=zero,
        utilisation=zero,
        planarity=zero,
    )
    return network, lamellas


def cylinder_mesh(around: int = 12, up: int = 5) -> SurfaceMesh:
    """Return quads and, in the lowest row, triangles."""
    angle, height = np.meshgrid(2 * np.pi * np.arange(around) / around, np.linspace(0, 2 / 3, up), indexing="ij")
    points = np.column_stack((RADIUS * np.cos(angle.ravel()), RADIUS * np.sin(angle.ravel()), height.ravel()))
    i, j = np.meshgrid(np.arange(around), np.arange(up - 1), indexing="ij")
    a, b = i * up + j, (i + 1) % around * up + j
    quads = np.stack((a, a + 1, b + 1, b), -1)
    low = quads[:, 0]
    triangles = np.vstack((low[:, [0, 1, 2, 2]], low[:, [0, 2, 3, 3]]))
    flat = np.zeros(len(points))
    return SurfaceMesh(
        points=points,
        normals=inward(points),
        faces=np.vstack((triangles, quads[:, 1:].reshape(-1, 4))),
        mean_curvature=flat + 0.5 / RADIUS,
        gaussian_curvature=flat,
        k1=flat + 1 / RADIUS,
        k2=flat,
    )


def test_the_sample_net_holds_together() -> None:
    network, _ = cylinder_net()
    at_stops = network.sample_points[
        np.repeat(network.sample_offsets[:-1], np.diff(network.stop_offsets)) + network.stop_samples
    ]
    np.testing.assert_allclose(at_stops, network.node_points[network.stop_nodes], atol=1e-14)
    a, b = network.node_degrees()
    assert (a == 1).all()
    assert (b == 1).all()
