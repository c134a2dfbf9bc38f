"""Sampling a closed-form surface as a mesh, and its area."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lamella.surface.closed_form import ClosedForm
from lamella.surface.mesh import SurfaceMesh
from lamella.surface.outline import Disc, Rectangle, Ring, Square
from lamella.surface.points import Complexes
from lamella.surface.scherk import Scherk

Integers = NDArray[np.int64]


def _grid_faces(rows: int, columns: int, wrap: bool) -> Integers:
    """Quads of a rows x columns grid of vertices (row-major: U by rows, V by columns), closed in V if `wrap`."""
    i, j = np.meshgrid(np.arange(rows - 1), np.arange(columns if wrap else columns - 1), indexing="ij")
    k = (j + 1) % columns
    return np.stack([i * columns + j, (i + 1) * columns + j, (i + 1) * columns + k, i * columns + k], -1).reshape(-1, 4)


def places(surface: ClosedForm, rows: int, columns: int) -> tuple[Complexes, Integers]:
    """A grid of places over the outline and its faces.

    Returns
    -------
    where : (n,) complex
    faces : (f, 4) int
        Counter-clockwise in (U, V); triangles repeat the last index.
    """
    outline = surface.outline
    if isinstance(outline, Ring):
        u = np.linspace(outline.start, outline.end, rows)
        v = np.arange(columns) * (2 * np.pi / columns)
        return (u[:, None] + 1j * v).ravel(), _grid_faces(rows, columns, True)
    if isinstance(outline, Rectangle):
        u = np.linspace(0, outline.width, rows)
        v = np.linspace(0, outline.height, columns)
        return (outline.corner + u[:, None] + 1j * v).ravel(), _grid_faces(rows, columns, False)
    if isinstance(outline, Square):
        assert isinstance(surface, Scherk)
        line = np.linspace(-outline.half_side, outline.half_side, rows)
        x, y = np.meshgrid(line, np.linspace(-outline.half_side, outline.half_side, columns), indexing="ij")
        return surface.from_gudermannian(x.ravel(), y.ravel()), _grid_faces(rows, columns, False)
    assert isinstance(outline, Disc)
    r = np.linspace(0, outline.radius, rows)[1:]
    v = np.arange(columns) * (2 * np.pi / columns)
    rings = (r[:, None] * np.exp(1j * v)).ravel()
    j = np.arange(columns)
    fan = np.stack([np.zeros_like(j), 1 + j, 1 + (j + 1) % columns, 1 + (j + 1) % columns], -1)
    return np.r_[0, rings], np.vstack([fan, 1 + _grid_faces(rows - 1, columns, True)])


def surface_mesh(surface: ClosedForm, tolerance: float = 1e-3, limit: int = 400) -> SurfaceMesh:
    """Mesh of a closed-form surface whose chords miss it by about `tolerance` times its size.

    Parameters
    ----------
    surface : ClosedForm
    tolerance : float
        Sag of the longest mesh edges over the diagonal of the bounding box.
    limit : int
        Most vertices along either parameter.
    """
    where, _ = places(surface, 33, 33)
    rough = surface.at(where)
    points = rough.position
    size = float(np.linalg.norm(np.ptp(points, axis=0)))
    k1, k2 = rough.principal_curvatures
    curvature = float(max(np.abs(k1).max(), np.abs(k2).max()))
    edge = np.sqrt(8 * tolerance * size / curvature)
    grid = points[-33 * 33 :] if len(points) >= 33 * 33 else points[1:]
    grid = grid.reshape(-1, 33, 3)
    long_u = np.linalg.norm(np.diff(grid, axis=0), axis=2).sum(0).max()
    long_v = np.linalg.norm(np.diff(grid, axis=1, append=grid[:, :1]), axis=2).sum(1).max()
    rows, columns = (int(np.clip(np.ceil(long / edge), 24, limit)) for long in (long_u, long_v))
    # a multiple of 4, so that bodies of revolution have their full width along x and y
    where, faces = places(surface, rows, 4 * -(-columns // 4))
    at = surface.at(where)
    k1, k2 = at.principal_curvatures
    return SurfaceMesh(at.position, at.normal, faces, at.mean_curvature, k1 * k2, k1, k2)


def measured_mean_curvature(surface: ClosedForm, where: Complexes, step: float = 1e-3) -> NDArray[np.float64]:
    """H from positions and normals alone: minus half the divergence of n, by central differences of fourth order.

    Parameters
    ----------
    surface : ClosedForm
    where : (n,) complex
        Places; the surface is evaluated up to 2 `step` beyond them.

    Returns
    -------
    (n,)
        1/m.
    """

    def difference(direction: complex) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        near, far = ([surface.at(where + sign * k * step * direction) for sign in (1, -1)] for k in (1, 2))
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


def area(surface: ClosedForm, panels: int = 24) -> float:
    """Area, m^2: Gauss-Legendre quadrature of lambda^2 (12 points a panel in each parameter)."""
    x, weight = np.polynomial.legendre.leggauss(12)
    x, weight = (x + 1) / 2, weight / 2

    def rule(start: float, end: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        edges = np.linspace(start, end, panels + 1)
        width = edges[1] - edges[0]
        return (edges[:-1, None] + width * x).ravel(), np.tile(weight * width, panels)

    outline = surface.outline
    if isinstance(outline, Ring):
        u, wu = rule(outline.start, outline.end)
        return float(2 * np.pi * (wu * surface.metric(u.astype(complex)) ** 2).sum())
    if isinstance(outline, Rectangle):
        u, wu = rule(outline.corner.real, outline.corner.real + outline.width)
        return float(outline.height * (wu * surface.metric(u.astype(complex)) ** 2).sum())
    if isinstance(outline, Disc):
        r, wr = rule(0, outline.radius)
        return float(2 * np.pi * (wr * r * surface.metric(r.astype(complex)) ** 2).sum())
    assert isinstance(surface, Scherk)
    line, w = rule(-outline.half_side, outline.half_side)
    x_, y_ = (a.ravel() for a in np.meshgrid(line, line, indexing="ij"))
    # area element of (X, Y): sqrt(1 - tanh^2 X tanh^2 Y)
    element = np.sqrt(1 - (np.tanh(x_) * np.tanh(y_)) ** 2)
    return float(surface.scale**2 * (np.outer(w, w).ravel() * element).sum())
