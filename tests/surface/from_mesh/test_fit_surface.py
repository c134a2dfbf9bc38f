"""Smooth meshes kept as they are: vertices stay, errors fall with the mesh, reported errors bound the true ones."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial import Delaunay

from lamella import parse_project
from lamella.base.arrays import Floats
from lamella.stages.surface.surface_of_table import surface_of_mesh_table
from lamella.surface.element.varying import VaryingSurface

Graph = Callable[[Floats, Floats], Floats]


def cubic_saddle(x: Floats, y: Floats) -> Floats:
    return 0.2 * (x**2 - y**2) + 0.05 * (x**3 - 2 * x * y**2)


def wave(x: Floats, y: Floats) -> Floats:
    return 0.5 * np.sin(0.9 * x) * np.cos(0.7 * y) + 0.1 * x * y


def torus(x: Floats, y: Floats) -> Floats:
    """Inside of a tube of radius 2 about a circle of radius 5: K < 0 on one side, K > 0 on the other."""
    return np.sqrt(4 - (np.hypot(x + 5.3, y) - 5) ** 2)


def ellipsoid(x: Floats, y: Floats) -> Floats:
    return 2.5 * np.sqrt(1 - (x / 4) ** 2 - (y / 3) ** 2)


GRAPHS = {graph.__name__: graph for graph in (cubic_saddle, wave, torus, ellipsoid)}


def sampled(graph: Graph, count: int, size: float = 1.5, seed: int = 1) -> tuple[Floats, NDArray[np.int64]]:
    """Exact points of a graph over an irregular triangulation of a square."""
    t = np.linspace(-1, 1, count)
    x, y = np.meshgrid(t, t, indexing="ij")
    inner = (np.abs(x) < 1 - 1e-9) & (np.abs(y) < 1 - 1e-9)
    shift = np.random.default_rng(seed).uniform(-0.3, 0.3, (2, count, count)) * inner * 2 / (count - 1)
    plan = np.stack([(x + shift[0]).ravel(), (y + shift[1]).ravel()], axis=1)
    faces = Delaunay(plan).simplices.astype(np.int64)
    a, b = plan[faces[:, 1]] - plan[faces[:, 0]], plan[faces[:, 2]] - plan[faces[:, 0]]
    area = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    faces = np.where((area < 0)[:, None], faces[:, ::-1], faces)[np.abs(area) > 1e-9]
    return np.column_stack([size * plan, graph(*(size * plan).T)]), faces


def kept(folder: Path, points: Floats, faces: NDArray[np.int64]) -> VaryingSurface:
    text = "".join(f"v {x:.17g} {y:.17g} {z:.17g}\n" for x, y, z in points.tolist())
    text += "".join(f"f {a} {b} {c}\n" for a, b, c in (faces + 1).tolist())
    (folder / "m.obj").write_text(text)
    table = {"kind": "mesh", "file": "m.obj", "unit": "m", "mean_curvature": "varying"}
    surface = surface_of_mesh_table(parse_project({"surface": table}).surface, folder)  # type: ignore[arg-type]
    assert isinstance(surface, VaryingSurface)
    return surface


def true_form(graph: Graph, x: Floats, y: Floats) -> Floats:
    """Second fundamental form of a graph in space for the normal upwards, (n, 3, 3), by central differences."""
    h = 1e-4
    f = {(i, j): graph(x + i * h, y + j * h) for i in (-1, 0, 1) for j in (-1, 0, 1)}
    zx, zy = (f[1, 0] - f[-1, 0]) / (2 * h), (f[0, 1] - f[0, -1]) / (2 * h)
    xx, yy = (f[1, 0] - 2 * f[0, 0] + f[-1, 0]) / h**2, (f[0, 1] - 2 * f[0, 0] + f[0, -1]) / h**2
    xy = (f[1, 1] - f[1, -1] - f[-1, 1] + f[-1, -1]) / (4 * h**2)
    one, zero = np.ones_like(x), np.zeros_like(x)
    u, v = np.stack([one, zero, zx], 1), np.stack([zero, one, zy], 1)
    n = np.cross(u, v)
    square = (n**2).sum(1)[:, None]
    dual = np.array([np.cross(v, n) / square, np.cross(n, u) / square])
    hessian = np.array([[xx, xy], [xy, yy]]) / np.sqrt(square[:, 0])
    return np.asarray(np.einsum("abn,anc,bnd->ncd", hessian, dual, dual))


def errors(surface: VaryingSurface, graph: Graph) -> tuple[Floats, Floats, Floats]:
    """Largest error of a normal curvature at each check place, what is reported there, and the heights' errors."""
    places = surface.check_places()
    there = surface.measured(places)
    mean, d = there.mean_curvature, there.deviator
    own = np.array([[mean + d.real, -d.imag], [-d.imag, mean - d.real]])
    axes = np.array([there.e_u, there.e_v])
    position = surface.at(places).position
    exact = np.einsum("anc,ncd,bnd->nab", axes, true_form(graph, position[:, 0], position[:, 1]), axes)
    off = np.abs(np.linalg.eigvalsh(own.transpose(2, 0, 1) - exact)).max(1)
    return off, surface.uncertain(places), np.abs(position[:, 2] - graph(position[:, 0], position[:, 1]))


@pytest.mark.parametrize("name", GRAPHS)
def test_the_reported_error_of_normal_curvature_bounds_the_true_one(tmp_path: Path, name: str) -> None:
    """The error that is reported of a fitted mesh is above the true one, and of its order."""
    graph = GRAPHS[name]
    for count in (9, 15):
        off, reported, _ = errors(kept(tmp_path, *sampled(graph, count)), graph)
        assert np.mean(off <= reported) > 0.95
        assert np.percentile(off, 95) <= np.percentile(reported, 95)
        assert off.max() <= reported.max()
        # and is of its order: no more than what is ten times too much in the middle of the samples
        assert np.median(reported) < 10 * np.median(off)


@pytest.mark.parametrize("name", ["wave", "torus"])
def test_smooth_meshes_converge_and_their_vertices_stay(tmp_path: Path, name: str) -> None:
    """Heights with h^4, curvatures with h^2 at least, whose fits reach h^5 and h^3 (Cazals and Pouget 2005)."""
    graph = GRAPHS[name]
    found = []
    for count in (9, 18):
        points, faces = sampled(graph, count)
        surface = kept(tmp_path, points, faces)
        assert surface.describe()["distance_max"] < 1e-9
        off, _, height = errors(surface, graph)
        found.append((np.median(off), np.sqrt((height**2).mean())))
    (off, height), (finer_off, finer_height) = found
    ratio = np.log(17 / 8)
    assert np.log(off / finer_off) / ratio > 2
    assert np.log(height / finer_height) / ratio > 3


def test_a_coarse_quad_mesh_of_a_smooth_half_ring(tmp_path: Path) -> None:
    """Seven rows of quads over a wave across the ring, three waves along its inner rim: accepted, vertices kept."""
    rows, columns = 9, 25
    t, angle = np.meshgrid(np.linspace(0, 1, rows), np.linspace(0, np.pi, columns), indexing="ij")
    radius = 5 + 0.5 * np.cos(4 * angle) * (1 - t) + 7 * t
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), 2.5 * np.sin(2.6 * t + 0.3)], -1).reshape(-1, 3)
    k = np.arange(rows * columns).reshape(rows, columns)
    quads = np.stack([k[:-1, :-1], k[1:, :-1], k[1:, 1:], k[:-1, 1:]], -1).reshape(-1, 4)
    faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    surface = kept(tmp_path, points, faces)
    assert surface.describe()["distance_max"] < 1e-9
    assert surface.describe()["curvature_jump"] < 0.1


def test_scatter_of_a_centimetre_on_metre_edges_is_smoothed(tmp_path: Path) -> None:
    def roof(x: Floats, y: Floats) -> Floats:
        return np.asarray(0.04 * (x**2 - y**2) + 0.3 * np.sin(0.2 * x))

    points, faces = sampled(roof, 17, size=8.0)
    rng = np.random.default_rng(5)
    border = (np.abs(points[:, :2]) > 8 - 1e-9).any(1)
    points[:, 2] += 0.01 * rng.normal(size=len(points)) * ~border
    surface = kept(tmp_path, points, faces)
    assert any("scatter by" in note for note in surface.describe()["treatment"])
    off, reported, height = errors(surface, roof)
    # vertices taken as they are leave a normal curvature of the order of 8 x 0.01 / 1 = 0.08/m
    assert np.median(off) < 0.012
    assert np.sqrt((height**2).mean()) < 0.01
    assert np.mean(off <= reported) > 0.9
