"""Films found for tests: on irregular elements of one size, in the steps form finding itself takes."""

from __future__ import annotations

import numpy as np

from lamella.surface.element.places import Places
from lamella.surface.element.surface import ElementSurface
from lamella.surface.form_finding.chart import make_chart
from lamella.surface.form_finding.film import Film, harmonic_over_itself
from lamella.surface.form_finding.meshing import start_film, with_sizes
from lamella.surface.form_finding.newton import Equilibrium, FixedH, find_equilibrium
from lamella.surface.form_finding.redistribution import redistributed
from lamella.surface.remesh.remesh import TriangleMesh
from lamella.surface.remesh.size_field import SizeField
from surface.form_finding.exact_patches import ArcLength, circle, disc, ring


def start(loops, order: int) -> Film:
    """The harmonic start."""
    return harmonic_over_itself(start_film(make_chart(loops), tuple(loops), order))


def on_sizes(film: Film, size: float, mean_curvature: float = 0.0, *, stable: bool = True) -> Equilibrium:
    """A film found again on elements of an edge length (m)."""
    even = SizeField(film.nodes[:1], np.array([size]), size)
    film = find_equilibrium(with_sizes(film, even), mean_curvature, FixedH(stable)).film
    return find_equilibrium(redistributed(film, mean_curvature), mean_curvature, FixedH(stable))


def surface(film: Film, mean_curvature: float = 0.0) -> ElementSurface:
    return ElementSurface(
        "found", mean_curvature, film.connectivity, film.nodes, film.mesh.loop[film.connectivity.rim_nodes[:, 0]]
    )


def random_places(film: Film, count: int, seed: int = 0) -> Places:
    """Places drawn evenly over the elements, borders included."""
    rng = np.random.default_rng(seed)
    local = rng.random((count, 2))
    local = np.where((local.sum(1) > 1)[:, None], 1 - local, local)
    return Places(rng.integers(0, len(film.connectivity.elements), count), local)


def order_of(errors, nodes) -> float:
    """Slope of log error against log h, with h = 1 / sqrt(nodes)."""
    return float(-np.polyfit(np.log(np.sqrt(nodes)), np.log(errors), 1)[0])


def tube(profile, heights, around: int, order: int, *, inwards: bool = False) -> Film:
    """Elements on the surface of revolution (r(s), z(s)), exact at their nodes, with crossed diagonals.

    `heights` are the values of s of the rows. Loop 0 is the last row, loop 1 the first; the normal points away from
    the axis or, `inwards`, towards it.
    """
    rows = len(heights)

    def x(angle, s):
        r, z = profile(s)
        return np.stack([r * np.cos(angle), r * np.sin(angle), z], -1)

    i, j = (a.ravel() for a in np.meshgrid(np.arange(around), np.arange(rows - 1), indexing="ij"))
    square = np.stack([np.stack([i + di, j + dj], 1) for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1))], 1)
    crossed = ((i + j) % 2 == 0)[:, None, None]
    corners = np.concatenate(
        [
            np.where(crossed, square[:, [0, 1, 2]], square[:, [0, 1, 3]]),
            np.where(crossed, square[:, [0, 2, 3]], square[:, [1, 2, 3]]),
        ]
    )
    if inwards:
        corners = corners[:, ::-1]
    faces = corners[..., 0] % around * rows + corners[..., 1]
    number = np.arange(around * rows)
    row, angle = number % rows, 2 * np.pi * (number // rows) / around
    mesh = TriangleMesh(
        x(angle, np.asarray(heights)[row]),
        faces,
        np.select([row == rows - 1, row == 0], [0, 1], -1),
        np.where((row == 0) | (row == rows - 1), angle / (2 * np.pi), np.nan),
    )
    ends = [profile(np.asarray(heights)[[k]]) for k in (-1, 0)]
    film = Film.on_mesh(mesh, [ring(float(r[0]), float(z[0])) for r, z in ends], order)
    barycentric = np.column_stack([1 - film.connectivity.basis.nodes.sum(1), film.connectivity.basis.nodes])
    place = np.matmul(
        barycentric, np.stack([2 * np.pi * corners[..., 0] / around, np.asarray(heights)[corners[..., 1]]], -1)
    )
    nodes = np.empty_like(film.nodes)
    nodes[film.connectivity.elements] = x(place[..., 0], place[..., 1])
    return film.at(nodes)


def disc_film(order: int, rings: int, height=lambda r2: 0 * r2) -> Film:
    """Elements over the unit disc, exact at their nodes, at a height over its plane; the normal points up."""
    points, faces, on_rim, parameter = disc(rings)
    film = Film.on_mesh(TriangleMesh(points, faces, np.where(on_rim, 0, -1), parameter), [ArcLength(circle)], order)
    nodes = film.nodes.copy()
    nodes[:, 2] = height((nodes[:, :2] ** 2).sum(1)) - height(np.ones(1))
    return film.at(nodes)
