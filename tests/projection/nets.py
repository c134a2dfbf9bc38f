"""Nets on closed forms, with known answers."""

from __future__ import annotations

import numpy as np

from lamella import Enneper
from lamella.projection.quad_mesh import QuadMesh, quad_mesh
from lamella.surface.closed_form import ClosedForm


def grid_faces(rows: int, columns: int, closed: bool = False) -> np.ndarray:
    """Quads of a grid, row by row; closed: the last column is next to the first."""
    i, j = np.meshgrid(np.arange(rows - 1), np.arange(columns if closed else columns - 1), indexing="ij")
    k = (j + 1) % columns
    return np.stack([i * columns + j, (i + 1) * columns + j, (i + 1) * columns + k, i * columns + k], -1).reshape(-1, 4)


def lamella_patch(surface: ClosedForm, count: int, span: float, centre: complex = 0j) -> QuadMesh:
    """count x count nodes on lines U + V and U - V = const of a surface of revolution: a net of lamellas."""
    steps = (np.arange(count) - (count - 1) / 2) * span / (count - 1)
    p, q = (x.ravel() for x in np.meshgrid(steps, steps, indexing="ij"))
    where = centre + (p + q) / 2 + 1j * (p - q) / 2
    faces = grid_faces(count, count)
    at = surface.at(where)
    mesh = quad_mesh(at.position, faces)
    corners = mesh.vertices[mesh.faces]
    across = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    # counter-clockwise about the surface's normal
    return mesh if (across * at.normal[faces[:, 0]]).sum() > 0 else quad_mesh(at.position, faces[:, ::-1])


def noisy(mesh: QuadMesh, share: float, seed: int) -> QuadMesh:
    """Gaussian noise of a share of the mean edge on every coordinate."""
    noise = np.random.default_rng(seed).normal(size=mesh.vertices.shape)
    return mesh.at(mesh.vertices + share * mesh.mean_edge * noise)


def spider(valence: int, rings: int = 3) -> tuple[np.ndarray, np.ndarray]:
    """A flat quad mesh around one vertex of given valence: as many square sectors as it has neighbours."""
    n = rings + 1
    i, j = (x.ravel() for x in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    points, faces = [], []
    for sector in range(valence):
        first, second = (2 * np.pi * (sector + s) / valence for s in (0, 1))
        a, b = np.array([np.cos(first), np.sin(first)]), np.array([np.cos(second), np.sin(second)])
        points.append(i[:, None] * a + j[:, None] * b)
        faces.append(grid_faces(n, n) + sector * n * n)
    flat = np.concatenate(points)
    unique, index = np.unique(np.round(flat, 9), axis=0, return_inverse=True)
    return np.column_stack([unique, np.zeros(len(unique))]), index.ravel()[np.concatenate(faces)]


def hexagonal_net(surface: Enneper, rings: int, reach: float) -> QuadMesh:
    """Lamellas of Enneper's surface of order 3 around its hexagonal node: six sectors of rings x rings cells.

    A cell of the isothermic lattice w at 45 degrees to (u, v) has its place at zeta = w^(2/3), turned by sectors.
    """
    n = rings + 1
    i, j = (x.ravel() for x in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    w = (i + 1j * j) * np.exp(0.25j * np.pi) * reach / rings
    where = np.concatenate([np.abs(w) ** (2 / 3) * np.exp(1j * (2 * np.angle(w) + s * np.pi) / 3) for s in range(6)])
    faces = np.concatenate([grid_faces(n, n) + s * n * n for s in range(6)])
    key = np.round(np.column_stack([where.real, where.imag]), 9)
    _, first, index = np.unique(key, axis=0, return_index=True, return_inverse=True)
    return quad_mesh(surface.at(where[first]).position, index.ravel()[faces])
