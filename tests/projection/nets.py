"""Nets on closed forms, with known answers."""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp

from lamella import Enneper
from lamella.projection.quad_mesh import QuadMesh, quad_mesh
from lamella.surface.closed_forms.closed_form import ClosedForm


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


def weingarten_patch(opening: float, bend: float, count: int, span: float) -> QuadMesh:
    """Rotational net with constant node angle (DESIGN section 9), count x count nodes.

    Lamellas at +-phi to the meridian, opening = 2 phi degrees, normal curvature `bend`: with A = cos^2 phi and rho the
    radius, k_par = bend + C rho^(-1/A) and sin psi = rho k_par, psi the meridian's slope; C puts the neck at rho = 1.
    Along T = int ds / rho lamellas are V +- T tan phi = const.
    """
    phi = np.radians(opening / 2)
    power = 1 / np.cos(phi) ** 2
    c = 1 - bend

    def along(_: float, state: np.ndarray) -> list[float]:
        rho, _z, psi = state
        turn = rho * bend + c * (1 - power) * rho ** (1 - power)
        return [rho * np.cos(psi), rho * np.sin(psi), turn]

    i, j = (x.ravel() for x in np.meshgrid(np.arange(count), np.arange(count), indexing="ij"))
    step = span / (count - 1)
    levels = np.arange(-(count - 1), count) * step / 2 / np.tan(phi)
    found = []
    for side in (levels[levels >= 0], levels[levels <= 0][::-1]):
        start = [1.0, 0.0, np.pi / 2]
        found.append(solve_ivp(along, (0, side[-1]), start, "DOP853", side, rtol=1e-13, atol=1e-14).y)
    rho, z, _ = np.concatenate([found[1][:, :0:-1], found[0]], 1)[:, i + j]
    turn = (i - j) * step / 2
    return quad_mesh(np.column_stack([rho * np.cos(turn), rho * np.sin(turn), z]), grid_faces(count, count))


def rotational_net(surface: ClosedForm, around: int, rows: int, start: float = 0.0) -> QuadMesh:
    """Lamellas once around a surface of revolution: row k has `around` nodes, at U = start + k pi / around.

    Rows follow one another at half a step, so quads stand on a corner and rows run along their diagonals.
    """
    k, j = (x.ravel() for x in np.meshgrid(np.arange(rows), np.arange(around), indexing="ij"))
    where = start + k * np.pi / around + 1j * (2 * j + k % 2) * np.pi / around
    k, j = (x.ravel() for x in np.meshgrid(np.arange(rows - 2), np.arange(around), indexing="ij"))
    right, left = (j + k % 2) % around, (j - 1 + k % 2) % around
    faces = np.column_stack([k * around + j, (k + 1) * around + right, (k + 2) * around + j, (k + 1) * around + left])
    return quad_mesh(surface.at(where).position, faces)
