"""Polylines through quad meshes and rings across them, on meshes whose answer is known."""

import itertools

import numpy as np
import pytest

from lamella import Unduloid, quad_mesh
from lamella.projection.polylines import diagonal_ring, polylines
from projection.nets import grid_faces, lamella_patch, rotational_net, spider
from refusals import refused

UNDULOID = Unduloid(0.6, 1.4, (-6.0, 6.0))


def edges_of(lines: tuple[np.ndarray, ...]) -> list[tuple[int, int]]:
    return sorted(tuple(sorted(map(int, pair))) for line in lines for pair in itertools.pairwise(line))


def test_grid() -> None:
    mesh = lamella_patch(UNDULOID, 6, 1.0)
    lines = polylines(mesh)
    rows = {tuple(range(6 * k, 6 * k + 6)) for k in range(6)} | {tuple(range(k, 36, 6)) for k in range(6)}
    assert {tuple(min(line.tolist(), line.tolist()[::-1])) for line in lines} == rows
    assert len(lines) == 12


def test_closed_ones_end_where_they_begin() -> None:
    i, j = (x.ravel() for x in np.meshgrid(np.arange(4), np.arange(7), indexing="ij"))
    mesh = quad_mesh(UNDULOID.at(0.3 * i + 2j * np.pi * j / 7).position, grid_faces(4, 7, True))
    lines = polylines(mesh)
    closed = [line for line in lines if line[0] == line[-1]]
    assert sorted(len(line) for line in closed) == [8] * 4
    assert sorted(len(line) for line in lines) == [4] * 7 + [8] * 4
    assert edges_of(lines) == sorted(map(tuple, np.sort(mesh.edges, axis=1).tolist()))


@pytest.mark.parametrize("valence", [3, 5, 6])
def test_singular_vertices_end_them(valence: int) -> None:
    mesh = quad_mesh(*spider(valence))
    lines = polylines(mesh)
    centre = int(mesh.singular[0])
    assert sum(int(line[0] == centre) + int(line[-1] == centre) for line in lines) == valence
    assert not any(centre in line[1:-1] for line in lines)
    assert edges_of(lines) == sorted(map(tuple, np.sort(mesh.edges, axis=1).tolist()))


def test_ring_of_a_rotational_net_is_a_parallel_circle() -> None:
    mesh = rotational_net(UNDULOID, 12, 9, -4 * np.pi / 12)
    for row in (2, 4):
        ring = diagonal_ring(mesh, 12 * row + 5)
        assert sorted(ring.tolist()) == list(range(12 * row, 12 * row + 12))
        assert ring[0] == 12 * row + 5
        step = np.diff(np.append(ring, ring[0]) % 12) % 12
        assert set(step.tolist()) in ({1}, {11})


def test_ring_refused() -> None:
    mesh = lamella_patch(UNDULOID, 6, 1.0)
    with refused(numbers=(14,)):
        diagonal_ring(mesh, 14)
    with refused(numbers=(0,)):
        diagonal_ring(mesh, 0)
    with refused(numbers=(36, 35)):
        diagonal_ring(mesh, 36)
    n = np.arange(8)
    u, v = (x.ravel() for x in np.meshgrid(2 * np.pi * n / 8, 2 * np.pi * n / 8, indexing="ij"))
    torus = np.column_stack([(3 + np.cos(v)) * np.cos(u), (3 + np.cos(v)) * np.sin(u), np.sin(v)])
    i, j = (x.ravel() for x in np.meshgrid(n, n, indexing="ij"))
    a, b = (i + 1) % 8, (j + 1) % 8
    with refused(numbers=(9,)):
        diagonal_ring(quad_mesh(torus, np.column_stack([8 * i + j, 8 * a + j, 8 * a + b, 8 * i + b])), 9)
