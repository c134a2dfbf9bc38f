"""H of a mesh by the distance of the surface from its vertices: rates, coarse meshes, folds, and what is said of 0."""

import numpy as np
import pytest

from lamella import Catenoid, Cylinder, InputError, Unduloid, make_surface, parse_project
from surface.from_mesh.meshes import disc, irregular, obj_text, triangles

PATCHES = {
    "catenoid": (Catenoid(1.0, (-1, 1)), (-1.0, 0.8), (0.0, 2.5)),
    "cylinder": (Cylinder(1.5, (-1, 1)), (-1.0, 1.0), (0.0, 2.5)),
    "unduloid": (Unduloid(0.5, 1.0, (-1, 1)), (-1.5, 1.3), (0.0, 2.0)),
}


def patch(name, n, seed):
    """An irregular mesh with its vertices on a closed form: points, faces, H."""
    surface, (u0, u1), (v0, v1) = PATCHES[name]
    uv, faces = irregular(n, seed)
    points = surface.at(u0 + (u1 - u0) * uv[:, 0] + 1j * (v0 + (v1 - v0) * uv[:, 1])).position
    return points, faces, surface.mean_curvature


def cap(rings, opening, seed=0):
    """An irregular mesh of a cap of a sphere of radius 2 that opens by an angle (deg) from its top: points, faces."""
    points, faces = disc(rings, 4 * rings)
    rng = np.random.default_rng(seed)
    inner = np.linalg.norm(points, axis=1) < 0.999
    points[inner, :2] += rng.uniform(-0.2, 0.2, (inner.sum(), 2)) / rings
    slope = np.radians(opening) * np.linalg.norm(points[:, :2], axis=1)
    turn = np.arctan2(points[:, 1], points[:, 0])
    return 2 * np.column_stack((np.sin(slope) * np.cos(turn), np.sin(slope) * np.sin(turn), np.cos(slope))), faces


def tube(around, along, radius, height):
    """A surface of revolution in quads, normals away from the axis: points, faces."""
    turn, z = 2 * np.pi * np.arange(around) / around, np.linspace(*height, along + 1)
    r = np.broadcast_to(radius(z), z.shape)[:, None]
    points = np.stack((r * np.cos(turn), r * np.sin(turn), z[:, None] + 0 * turn), -1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(along), np.arange(around), indexing="ij")
    a, b = i * around + j, i * around + (j + 1) % around
    return points, np.stack((a, b, b + around, a + around), -1).reshape(-1, 4)


@pytest.fixture
def adopt(tmp_path):
    def adopt(points, faces, reported=lambda message: None, **keys):
        (tmp_path / "a.obj").write_text(obj_text(points, np.asarray(faces).tolist()))
        surface = {"kind": "mesh", "file": "a.obj", "tolerance": 3e-3} | keys
        return make_surface(parse_project({"name": "x", "surface": surface}), tmp_path, reported)

    return adopt


def error_of(surface, mean_curvature):
    """Of the nearest H, and of the one read from the vertices' curvature, over the curvature scale."""
    scale, reported = surface.figures["curvature_scale"], surface.figures
    return tuple(abs(reported[f"{key}_mean_curvature"] - mean_curvature) / scale for key in ("nearest", "fitted"))


@pytest.mark.parametrize(
    ("name", "seed"),
    [("unduloid", 0)] + [pytest.param(name, seed, marks=pytest.mark.slow) for name in PATCHES for seed in (1, 2)],
)
def test_the_nearest_mean_curvature_converges_on_coarse_irregular_meshes(adopt, name, seed):
    """Vertices are exact: what is left is the border's spline between them, h^4 and better."""
    errors = []
    for n in (7, 13):
        points, faces, mean_curvature = patch(name, n, seed)
        nearest, fitted = error_of(adopt(points, faces), mean_curvature)
        assert nearest < 0.02 * fitted
        errors.append(nearest)
    assert errors[0] < 5e-4
    assert np.log2(errors[0] / errors[1]) / np.log2(12 / 6) > 3


@pytest.mark.parametrize(("around", "along"), [(12, 5), (24, 10)])
def test_a_cylinder_of_few_quads(adopt, around, along):
    """24 x 10 quads: the curvature of the vertices says 2.4 % less."""
    surface = adopt(*tube(around, along, lambda z: 2.0, (0, 4)))
    assert surface.mean_curvature == pytest.approx(-0.25, rel=1e-5)
    assert abs(surface.figures["fitted_mean_curvature"] / -0.25 - 1) > 0.02
    assert surface.figures["distance_max"] < 2e-5
    assert surface.figures["mean_curvature_deviation"] <= 3e-3
    assert not surface.notes


@pytest.mark.parametrize("opening", [60, 90, 140])
def test_caps_up_to_the_fold_of_the_mean_curvature_and_beyond(adopt, opening):
    """A hemisphere has the largest H of its border: there H says nothing of where on the family the mesh is."""
    surface = adopt(*cap(6, opening))
    assert surface.mean_curvature == pytest.approx(-0.5, rel=1e-6)
    assert surface.figures["distance_max"] < 1e-4
    assert surface.figures["stability"] == {60: "stable", 90: "fold", 140: "unstable"}[opening]


def test_a_thin_neck_of_few_quads_is_the_unstable_film(adopt):
    """Its curvature cannot be read from 16 x 8 quads, but its vertices lie on the film."""
    surface = adopt(*tube(16, 8, lambda z: 0.45 * np.cosh(z / 0.45), (-0.8, 0.8)), tolerance=0.02)
    assert surface.figures["fitted_deviation"] > 0.5
    assert surface.mean_curvature == 0
    assert surface.figures["stability"] == "unstable"
    assert surface.figures["distance_max"] < 1e-5


def test_few_vertices_off_any_such_surface_are_refused(adopt):
    points, quads = tube(16, 8, lambda z: 2 - 0.4 * z**4, (-1, 1))
    with pytest.raises(InputError, match="the mesh is not of constant mean curvature"):
        adopt(points, triangles(quads))


def test_that_h_was_taken_as_zero_is_told(adopt):
    nearly = Unduloid(1.0, 2000.0, (-0.8, 0.9)).mesh()  # H = 1 / 2001
    scale = adopt(nearly.points, nearly.faces, mean_curvature=0.0, tolerance=0.02).figures["curvature_scale"]
    surface = adopt(nearly.points, nearly.faces, tolerance=0.02)
    assert surface.mean_curvature == 0
    assert abs(surface.figures["nearest_mean_curvature"]) == pytest.approx(1 / 2001, abs=1e-5 * scale)
    assert any(line.startswith("H taken as 0: the surface nearest") for line in surface.figures["treatment"])
    (warning,) = (note for note in surface.notes if "taken as 0" in note)
    given = float(warning.rpartition("mean_curvature = ")[2].split()[0])
    kept = adopt(nearly.points, nearly.faces, mean_curvature=given, tolerance=0.02)
    assert kept.mean_curvature == given
    assert not any("taken as 0" in note for note in (*kept.notes, *kept.figures["treatment"]))


def test_what_no_mesh_can_tell_from_zero_is_no_warning(adopt):
    surface = adopt(*tube(24, 10, np.cosh, (-0.8, 0.9)))
    assert surface.mean_curvature == 0
    assert abs(surface.figures["nearest_mean_curvature"]) < 1e-4
    assert not any("taken as 0" in note for note in surface.notes)


def test_a_millimetre_of_scatter_costs_no_elements(adopt):
    """A spline through the scattered rims would bend by 0.06/m, and take up to 100,000 nodes to follow."""
    points, faces = tube(48, 20, lambda z: 2.0, (0, 4))
    exact = adopt(points, faces, tolerance=5e-3)
    points = points + 1e-3 * np.random.default_rng(0).normal(size=points.shape)
    surface = adopt(points, faces, tolerance=5e-3)
    assert surface.mean_curvature == pytest.approx(-0.25, rel=1e-3)
    # less than half of how far off the curvature of the vertices is
    assert error_of(surface, -0.25)[0] < 0.5 * error_of(surface, -0.25)[1]
    assert surface.figures["distance_rms"] == pytest.approx(1e-3, rel=0.2)
    assert surface.figures["surface_nodes"] < 4 * exact.figures["surface_nodes"]
    assert sum("scatter by" in line for line in surface.figures["treatment"]) == 2


@pytest.mark.parametrize("n", [12, 60])
def test_crumpled_meshes_are_refused_with_figures_before_elements_are_laid(adopt, n):
    uv, faces = irregular(n)
    points = np.column_stack((4 * uv, 0.8 * np.sin(2 * uv[:, 0]) * np.sin(2 * uv[:, 1])))
    points += 2 / n * np.random.default_rng(0).normal(size=points.shape)
    reported = []
    with pytest.raises(InputError, match=r"H = .* fits best, its vertices are off by 0.\d+ of the curvature scale"):
        adopt(points, faces, reported.append)
    assert not any("laying elements" in line.text for line in reported)
