"""How closed forms are sampled as meshes and measured; ask the surface itself (`lamella.surface.surface`)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from lamella.base.arrays import Complexes, Floats, Integers
from lamella.base.vectors import diagonal
from lamella.surface.closed_forms.outline import Disc, Outline, Rectangle, Ring
from lamella.surface.mesh import SurfaceMesh
from lamella.surface.points import SurfacePoints

# most vertices of a mesh along either parameter
MOST_LINES = 1000


def grid_faces(rows: int, columns: int, wrap: bool) -> Integers:
    """Quads of a rows x columns grid of vertices (row-major: U by rows, V by columns), closed in V if `wrap`."""
    i, j = np.meshgrid(np.arange(rows - 1), np.arange(columns if wrap else columns - 1), indexing="ij")
    k = (j + 1) % columns
    return np.stack([i * columns + j, (i + 1) * columns + j, (i + 1) * columns + k, i * columns + k], -1).reshape(-1, 4)


def grid(outline: Outline, rows: int, columns: int) -> tuple[Complexes, Integers]:
    """A grid of places over an outline and its faces (Scherk's square has a grid of its own).

    Returns
    -------
    where : (n,) complex
    faces : (f, 4) int
        Counter-clockwise in (U, V); triangles repeat the last index.
    """
    if isinstance(outline, Ring):
        u = np.linspace(outline.start, outline.end, rows)
        v = np.arange(columns) * (2 * np.pi / columns)
        return (u[:, None] + 1j * v).ravel(), grid_faces(rows, columns, True)
    if isinstance(outline, Rectangle):
        u = np.linspace(0, outline.width, rows)
        v = np.linspace(0, outline.height, columns)
        return (outline.corner + u[:, None] + 1j * v).ravel(), grid_faces(rows, columns, False)
    assert isinstance(outline, Disc)
    r = np.linspace(0, outline.radius, rows)[1:]
    v = np.arange(columns) * (2 * np.pi / columns)
    rings = (r[:, None] * np.exp(1j * v)).ravel()
    j = np.arange(columns)
    fan = np.stack([np.zeros_like(j), 1 + j, 1 + (j + 1) % columns, 1 + (j + 1) % columns], -1)
    return np.r_[0, rings], np.vstack([fan, 1 + grid_faces(rows - 1, columns, True)])


def surface_mesh(
    places: Callable[[int, int], tuple[Complexes, Integers]], at: Callable[[Complexes], SurfacePoints], tolerance: float
) -> SurfaceMesh:
    """Mesh of a closed form, see `lamella.surface.closed_forms.closed_form.ClosedForm.mesh`."""
    where, _ = places(33, 33)
    rough = at(where)
    points = rough.position
    size = diagonal(points)
    k1, k2 = rough.principal_curvatures
    curvature = float(max(np.abs(k1).max(), np.abs(k2).max()))
    edge = np.sqrt(8 * tolerance * size / curvature)
    lines = (points[-33 * 33 :] if len(points) >= 33 * 33 else points[1:]).reshape(-1, 33, 3)
    long_u = np.linalg.norm(np.diff(lines, axis=0), axis=2).sum(0).max()
    long_v = np.linalg.norm(np.diff(lines, axis=1, append=lines[:, :1]), axis=2).sum(1).max()
    for _ in range(3):
        rows, columns = (int(np.clip(np.ceil(long / edge), 24, MOST_LINES)) for long in (long_u, long_v))
        # a multiple of 4, so that bodies of revolution have their full width along x and y
        where, faces = places(rows, 4 * -(-columns // 4))
        there = at(where)
        k1, k2 = there.principal_curvatures
        mesh = SurfaceMesh(there.position, there.normal, faces, there.mean_curvature, k1 * k2, k1, k2)
        left = mesh.sag() / (tolerance * size)
        if left <= 1 or min(rows, columns) == MOST_LINES:
            break
        edge /= 1.02 * np.sqrt(left)
    return mesh


def measured_mean_curvature(at: Callable[[Complexes], SurfacePoints], where: Complexes, step: float) -> Floats:
    """H from positions and normals alone: minus half the divergence of n, by central differences of fourth order.

    Parameters
    ----------
    at : callable
        The points of places.
    where : (n,) complex
        Places; the surface is evaluated up to 2 `step` beyond them.
    step : float
        In parameters.

    Returns
    -------
    (n,)
        1/m.
    """

    def difference(direction: complex) -> tuple[Floats, Floats]:
        near, far = ([at(where + sign * k * step * direction) for sign in (1, -1)] for k in (1, 2))
        position, normal = (
            (8 * (getattr(near[0], name) - getattr(near[1], name)) - getattr(far[0], name) + getattr(far[1], name))
            / (12 * step)
            for name in ("position", "normal")
        )
        return position, normal

    (x_u, n_u), (x_v, n_v) = difference(1), difference(1j)
    e, f, g = (np.einsum("ij,ij->i", a, b) for a, b in ((x_u, x_u), (x_u, x_v), (x_v, x_v)))
    l, m, n = (-np.einsum("ij,ij->i", a, b) for a, b in ((x_u, n_u), (x_u, n_v), (x_v, n_v)))  # noqa: E741
    return np.asarray((e * n - 2 * f * m + g * l) / (2 * (e * g - f**2)))


def quadrature(start: float, end: float, panels: int = 24) -> tuple[Floats, Floats]:
    """Places and weights of Gauss-Legendre quadrature, 12 points a panel."""
    x, weight = np.polynomial.legendre.leggauss(12)
    x, weight = (x + 1) / 2, weight / 2
    edges = np.linspace(start, end, panels + 1)
    width = edges[1] - edges[0]
    return (edges[:-1, None] + width * x).ravel(), np.tile(weight * width, panels)


def area(outline: Outline, metric: Callable[[Complexes], Floats]) -> float:
    """Area, m^2: quadrature of lambda^2, which varies along one parameter only (Scherk's has a formula of its own)."""
    if isinstance(outline, Ring):
        u, wu = quadrature(outline.start, outline.end)
        return float(2 * np.pi * (wu * metric(u.astype(complex)) ** 2).sum())
    if isinstance(outline, Rectangle):
        u, wu = quadrature(outline.corner.real, outline.corner.real + outline.width)
        return float(outline.height * (wu * metric(u.astype(complex)) ** 2).sum())
    assert isinstance(outline, Disc)
    r, wr = quadrature(0, outline.radius)
    return float(2 * np.pi * (wr * r * metric(r.astype(complex)) ** 2).sum())
