"""Fitted mean curvature: rates against closed forms, signs, and how far from constant a surface is."""

import numpy as np
import pytest

from lamella import Catenoid, Cylinder, Enneper, Helicoid, InputError, Unduloid
from lamella.surface.from_mesh.edges import find_edges, vertex_areas, vertex_normals
from lamella.surface.from_mesh.mean_curvature_fit import fit_mean_curvature, vertex_curvatures
from surface.from_mesh.meshes import irregular, sphere, torus

CASES = {
    "catenoid": (Catenoid(1.0, (-1, 1)), (-1.0, 0.8), (0.0, 2.5)),
    "cylinder": (Cylinder(1.5, (-1, 1)), (-1.0, 1.0), (0.0, 2.5)),
    "unduloid": (Unduloid(0.5, 1.0, (-1, 1)), (-1.5, 1.3), (0.0, 2.0)),
    "helicoid": (Helicoid(3.0, 0.2, 1.5, 0.5), (0.1, 1.2), (0.0, 2.5)),
    "enneper": (Enneper(2, 0.8, 1.0), (-0.5, 0.5), (-0.4, 0.6)),
}


def sampled(name, n, seed):
    """An irregular mesh with its vertices on a closed form: surface, points, faces, what the surface is there."""
    surface, (u0, u1), (v0, v1) = CASES[name]
    uv, faces = irregular(n, seed)
    at = surface.at(u0 + (u1 - u0) * uv[:, 0] + 1j * (v0 + (v1 - v0) * uv[:, 1]))
    return surface, at.position, faces, at


def graph(height, n=41, seed=0):
    uv, faces = irregular(n, seed)
    return np.column_stack((uv, height(*(uv - 0.5).T))), faces


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("seed", range(3))
def test_mean_curvature_converges_on_irregular_meshes(name, seed):
    errors, deviations, scales = [], [], []
    for n in (13, 25, 49):
        surface, points, faces, at = sampled(name, n, [seed, n])
        fit = fit_mean_curvature(points, faces)
        errors.append(np.sqrt(np.mean((fit.per_vertex - surface.mean_curvature) ** 2)) / fit.scale)
        deviations.append(fit.deviation)
        assert abs(fit.mean_curvature - surface.mean_curvature) < 2 * errors[-1] * fit.scale
        k1, k2 = at.principal_curvatures
        areas = vertex_areas(points, faces)
        scales.append(np.sqrt(np.average((k1**2 + k2**2) / 2, weights=areas)) / fit.scale)
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    assert orders.min() > 1.5, (errors, orders)
    assert deviations[2] < 1e-3
    assert 0.97 < scales[2] < 1.25


@pytest.mark.parametrize("name", CASES)
def test_the_fitted_value_at_ordinary_fineness(name):
    surface, points, faces, _ = sampled(name, 31, 5)
    fit = fit_mean_curvature(points, faces)
    assert abs(fit.mean_curvature - surface.mean_curvature) < 5e-4 * fit.scale
    assert fit.deviation < 2e-3
    assert fit.deviation_max < 0.05


def test_gaussian_curvature_too():
    _, points, faces, at = sampled("catenoid", 41, 1)
    _, gaussian = vertex_curvatures(points, faces)
    k1, k2 = at.principal_curvatures
    assert np.median(np.abs(gaussian - k1 * k2)) < 1e-3


def test_signs():
    points, faces = graph(lambda x, y: x**2 + y**2)
    assert fit_mean_curvature(points, faces).mean_curvature > 1
    assert (vertex_normals(points, faces)[:, 2] > 0).all()
    turned = fit_mean_curvature(points, faces[:, ::-1])
    assert turned.mean_curvature == pytest.approx(-fit_mean_curvature(points, faces).mean_curvature)
    points, faces = sphere(48, 24, 2.5)
    fit = fit_mean_curvature(points, faces)
    assert fit.mean_curvature == pytest.approx(-1 / 2.5, rel=5e-3)
    assert fit.deviation < 5e-3


@pytest.mark.parametrize("factor", [1e-3, 1e3])
def test_size_and_place_do_not_matter(factor):
    _, points, faces, _ = sampled("unduloid", 15, 2)
    one, other = fit_mean_curvature(points, faces), fit_mean_curvature(factor * (points + 7), faces)
    assert other.mean_curvature * factor == pytest.approx(one.mean_curvature, rel=1e-6)
    assert other.deviation == pytest.approx(one.deviation, rel=1e-4)


def test_a_plane_deviates_by_nothing():
    fit = fit_mean_curvature(*graph(lambda x, y: 0.3 * x + 0.1 * y))
    assert abs(fit.mean_curvature) < 1e-9
    assert fit.deviation < 1e-3


def ellipsoid_cap(x, y):
    return np.sqrt(1 - (x / 0.6) ** 2 - (y / 1.5) ** 2)


def paraboloid(x, y):
    return 4 * (x**2 + y**2)


def monkey(x, y):
    return 8 * (x**3 - 3 * x * y**2) + 3 * x * y


def bump(x, y):
    return 0.3 * np.exp(-20 * (x**2 + y**2))


@pytest.mark.parametrize(("height", "least"), [(ellipsoid_cap, 0.15), (paraboloid, 0.15), (bump, 0.3), (monkey, 0.3)])
def test_what_is_not_of_constant_mean_curvature_shows(height, least):
    """The deviation is that of the true H over the surface, and far from that of a constant one."""
    points, faces = graph(height, 61)
    fit = fit_mean_curvature(points, faces)
    assert fit.deviation > least
    # H of the graph by central differences of the formula, independent of the fit.
    x, y, step = *(points[:, :2] - 0.5).T, 1e-4
    f = [[height(x + i * step, y + j * step) for j in (-1, 0, 1)] for i in (-1, 0, 1)]
    fx, fy = (f[2][1] - f[0][1]) / (2 * step), (f[1][2] - f[1][0]) / (2 * step)
    fxx, fyy = (f[2][1] - 2 * f[1][1] + f[0][1]) / step**2, (f[1][2] - 2 * f[1][1] + f[1][0]) / step**2
    fxy = (f[2][2] - f[2][0] - f[0][2] + f[0][0]) / (4 * step**2)
    true = ((1 + fy**2) * fxx - 2 * fx * fy * fxy + (1 + fx**2) * fyy) / (2 * (1 + fx**2 + fy**2) ** 1.5)
    away = np.sort(np.abs(true - fit.mean_curvature) / fit.scale)
    areas = vertex_areas(points, faces)
    order = np.argsort(np.abs(true - fit.mean_curvature))
    kept = np.searchsorted(np.cumsum(areas[order]), 0.9 * areas.sum())
    expected = np.sqrt(np.average(away[:kept] ** 2, weights=areas[order][:kept]))
    assert fit.deviation == pytest.approx(expected, rel=0.05)


def test_a_torus_is_far_from_constant():
    # H = -(1/a + cos v / (1 + a cos v)) / 2 changes sign of its second part from outside to inside.
    fit = fit_mean_curvature(*torus(96, 64, 0.6))
    assert fit.deviation > 0.2
    assert fit.mean_curvature < 0


@pytest.mark.parametrize("name", CASES)
def test_noise_of_a_thousandth_of_an_edge(name):
    surface, points, faces, _ = sampled(name, 31, 7)
    edge = np.median(find_edges(faces).lengths(points))
    noisy = points + 1e-3 * edge * np.random.default_rng(7).normal(size=points.shape)
    fit = fit_mean_curvature(noisy, faces)
    assert abs(fit.mean_curvature - surface.mean_curvature) < 2e-3 * fit.scale
    assert fit.deviation < 0.04


@pytest.mark.parametrize("n", [5, 6, 8])
def test_coarse_meshes(n):
    surface, points, faces, _ = sampled("cylinder", n, 3)
    fit = fit_mean_curvature(points, faces)
    assert fit.mean_curvature == pytest.approx(surface.mean_curvature, rel=0.15)


def test_too_coarse_a_mesh_is_refused():
    _, points, faces, _ = sampled("cylinder", 3, 0)
    with pytest.raises(InputError, match=r"9 vertices; its curvature cannot be read from fewer than 12\n.*to a value"):
        fit_mean_curvature(points, faces)
