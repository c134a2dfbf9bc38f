"""Solids of developable strips: closed, of the right volume, their faces a parallel surface of the middle one."""

from __future__ import annotations

import numpy as np
import pytest
from manifold3d import Manifold, Mesh

import lamella
from lamella import Section
from lamella.strip.developable_solids import DevelopableSolid, developable_solids
from lamella.strip.developable_strips import developable_strips

THICKNESS, HEIGHT = 0.002, 0.05


def made(layers: int, cells: int = 8) -> tuple[lamella.Lamellas, list[DevelopableSolid]]:
    # far from the waist, where strips of the height exist
    net = lamella.net(lamella.Catenoid(1.2, (0.8, 2.0)), cells=cells)
    strips = net.strips(Section(HEIGHT, THICKNESS, layers, 0.02))
    return strips, list(developable_solids(strips, developable_strips(strips)))


def test_solids_are_closed_and_as_large_as_their_flat_strips() -> None:
    lamellas, solids = made(1)
    network = lamellas.network
    assert len(solids) == len(network.ids)
    for one in solids:
        solid = Manifold(Mesh(one.vertices.astype(np.float32), one.triangles.astype(np.uint32)))
        assert solid.status().name == "NoError"
        length = np.ptp(network.sample_arclengths[one.samples])
        # rulings lean: what one edge has more, the other one has less
        assert solid.volume() == pytest.approx(HEIGHT * THICKNESS * length, rel=1e-3)


def test_layers_are_parallel_surfaces() -> None:
    """Normals of a layer's face are u at either edge of a ruling; errors fall with the square of the step."""
    worst = []
    for cells in (8, 16):
        lamellas, solids = made(2, cells)
        network = lamellas.network
        assert len(solids) == 2 * len(network.ids)
        off = 0.0
        for one in solids:
            low, high = one.vertices[0::4], one.vertices[1::4]
            u = np.cross(network.sample_normals[one.samples], network.sample_tangents[one.samples])
            for edge in (low, high):
                normal = np.cross((high - low)[1:-1], edge[2:] - edge[:-2])
                normal /= np.linalg.norm(normal, axis=1)[:, None]
                off = max(off, float(np.linalg.norm(np.cross(normal, u[1:-1]), axis=1).max()))
            # as thick as they should be
            assert np.einsum("ij,ij->i", one.vertices[2::4] - low, u) == pytest.approx(THICKNESS, rel=1e-12)
        worst.append(off)
    assert worst[0] < 0.01
    assert worst[1] < 0.3 * worst[0]
