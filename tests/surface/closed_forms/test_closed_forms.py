"""Closed-form surfaces: consistency by convergence rates, and the published formulas.

1. position, frame, shape operator, isothermic coordinates and grad ln mu agree with one another: central
   differences converge at second order. 2. Delaunay's, the catenoid's, helicoid's, Enneper's and Scherk's own
   formulas. 3. limits that have no net are refused with the reason.
"""

import numpy as np
import pytest

import lamella
from conftest import KINDS, draw_places, draw_surface
from lamella import Catenoid, Cylinder, Enneper, Helicoid, InputError, Nodoid, Scherk, Section, Unduloid
from lamella.project.tables import SURFACE_TABLES
from lamella.surface.closed_forms.kinds import CLOSED_FORMS
from lamella.surface.umbilic import refuse_umbilic


def _central(f, h):
    """Derivatives of f(offset) by U and by V."""
    return (f(h) - f(-h)) / (2 * h), (f(1j * h) - f(-1j * h)) / (2 * h)


def _errors(surface, where, h):
    """Largest relative error of every first derivative by central differences of step h."""
    at, metric = surface.at(where), surface.metric(where)
    size = metric.max()
    found = {}
    by_u, by_v = _central(lambda d: surface.at(where + d).position, h)
    found["position"] = (
        max(np.abs(by_u - metric[:, None] * at.e_u).max(), np.abs(by_v - metric[:, None] * at.e_v).max()) / size
    )
    n_u, n_v = _central(lambda d: surface.at(where + d).normal, h)
    s = at.shape_operator
    found["shape operator"] = max(
        np.abs(n_u + metric[:, None] * np.einsum("nij,nj->ni", s, at.e_u)).max(),
        np.abs(n_v + metric[:, None] * np.einsum("nij,nj->ni", s, at.e_v)).max(),
    )
    w_u, _ = _central(lambda d: surface.isothermic(where + d), h)
    found["isothermic"] = np.abs(w_u**2 / (2 * surface.hopf(where)) - 1).max()
    m_u, m_v = _central(lambda d: np.log(surface.at(where + d).mu), h)
    found["grad ln mu"] = np.abs((m_u + 1j * m_v) / metric - at.log_mu_gradient).max() * size
    return found


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(3))
def test_derivatives_converge_at_second_order(kind, seed):
    rng = np.random.default_rng([seed, 11])
    surface = draw_surface(kind, rng)
    where = draw_places(surface, rng)
    coarse, fine = _errors(surface, where, 2e-3), _errors(surface, where, 1e-3)
    for name, error in fine.items():
        assert error < 1e-3, name
        # below 1e-9 rounding hides the rate (the isothermic map of most surfaces is linear)
        assert error < 1e-9 or 3.6 < coarse[name] / error < 4.4, (name, coarse[name], error)


@pytest.mark.parametrize("kind", KINDS)
def test_frame_and_principal_directions(kind):
    rng = np.random.default_rng(5)
    surface = draw_surface(kind, rng)
    at = surface.at(draw_places(surface, rng))
    frame = np.stack([at.e_u, at.e_v, at.normal], 1)
    np.testing.assert_allclose(frame @ frame.transpose(0, 2, 1), np.broadcast_to(np.eye(3), frame.shape), atol=1e-13)
    np.testing.assert_allclose(np.linalg.det(frame), 1, atol=1e-13)
    k1, k2 = at.principal_curvatures
    d1, d2 = at.principal_directions
    assert (k1 >= k2).all()
    scale = np.abs(k1).max()
    np.testing.assert_allclose(np.einsum("nij,nj->ni", at.shape_operator, d1), k1[:, None] * d1, atol=1e-13 * scale)
    np.testing.assert_allclose(np.einsum("nij,nj->ni", at.shape_operator, d2), k2[:, None] * d2, atol=1e-13 * scale)
    np.testing.assert_allclose(np.cross(d1, d2), at.normal, atol=1e-13)
    np.testing.assert_allclose((k1 + k2) / 2, surface.mean_curvature, atol=1e-13 * scale)


@pytest.mark.parametrize("kind", KINDS)
def test_isothermic_coordinates_invert(kind):
    rng = np.random.default_rng(6)
    surface = draw_surface(kind, rng)
    where = draw_places(surface, rng)
    if surface.hopf_order:
        where = np.abs(where) * np.exp(1j * np.angle(where) / 4)  # one branch of the root
    np.testing.assert_allclose(surface.from_isothermic(surface.isothermic(where)), where, atol=1e-12)


def test_delaunay_radii_heights_and_curvature():
    """Unduloid r_M + r_m = 1/H, r_M r_m = T/H; nodoid r_M - r_m = 1/H, r_M r_m = -T/H (Delaunay 1841)."""
    unduloid = Unduloid(0.6, 1.4, (-4, 8))
    assert unduloid.mean_curvature == pytest.approx(0.5)
    u = np.array([0.0, unduloid.period / 2, unduloid.period])
    profile = unduloid.profile(u)
    np.testing.assert_allclose(profile.r, [0.6, 1.4, 0.6], atol=1e-14)
    # length of a meridian's half period is half the ellipse arc: r_M E(m) + T K(m) / (r_M H) for its height
    from scipy.special import ellipe, ellipk

    m = 1 - (0.6 / 1.4) ** 2
    half = unduloid.flux * ellipk(m) / (1.4 * 0.5) + 1.4 * ellipe(m)
    np.testing.assert_allclose(profile.z, [0, half, 2 * half], atol=1e-13)
    nodoid = Nodoid(0.5, 1.6, (-0.2, 0.2))
    assert nodoid.mean_curvature == pytest.approx(1 / 1.1)
    assert nodoid.flux == pytest.approx(-0.5 * 1.6 / 1.1)


@pytest.mark.parametrize(
    "surface", [Unduloid(0.3, 1.7, (-5, 11)), Nodoid(0.5, 1.6, (-0.3, 0.3)), Catenoid(0.7, (-1, 2))]
)
def test_flux_and_arc_length_of_the_meridian(surface):
    """r_U^2 + z_U^2 = r^2 and the first integral z_U = H r^2 + T (force balance of a soap film)."""
    u = np.linspace(surface.outline.start, surface.outline.end, 101)
    p = surface.profile(u)
    np.testing.assert_allclose(p.r_u**2 + p.z_u**2, p.r**2, rtol=1e-12)
    np.testing.assert_allclose(p.z_u, surface.mean_curvature * p.r**2 + surface.flux, rtol=1e-12)
    ends = surface.profile(np.array([surface.outline.start, surface.outline.end])).z
    assert {round(z, 9) for z in ends} == {round(z, 9) for z in _heights(surface)}


def _heights(surface):
    return {"unduloid": (-5, 11), "nodoid": (-0.3, 0.3), "catenoid": (-1, 2)}[surface.kind]


def test_normals_point_as_promised():
    """Unduloid towards the axis, nodoid away from it at its neck, catenoid u x v, Scherk upwards."""
    start = np.array([0j])
    assert Unduloid(1, 2, (-1, 1)).at(start).normal[0] == pytest.approx([-1, 0, 0])
    assert Nodoid(1, 2, (-0.1, 0.1)).at(start).normal[0] == pytest.approx([1, 0, 0])
    assert Catenoid(1, (-1, 1)).at(start).normal[0] == pytest.approx([-1, 0, 0])
    assert Scherk(1.0).at(start).normal[0] == pytest.approx([0, 0, 1])
    assert Enneper(2, 1).at(start).normal[0] == pytest.approx([0, 0, -1])


def test_classical_positions():
    """Enneper (u - u^3/3 + u v^2, -v - u^2 v + v^3/3, u^2 - v^2); Scherk z = ln(cos y / cos x); helicoid."""
    rng = np.random.default_rng(2)
    u, v = rng.uniform(-0.8, 0.8, (2, 50))
    x = Enneper(2, 1.2).at(u + 1j * v).position
    np.testing.assert_allclose(
        x, np.column_stack([u - u**3 / 3 + u * v**2, -v - u**2 * v + v**3 / 3, u**2 - v**2]), atol=1e-14
    )
    surface = Scherk(1.4, 2.0)
    x = surface.at(u + 1j * v).position / 2
    np.testing.assert_allclose(x[:, 2], np.log(np.cos(x[:, 1]) / np.cos(x[:, 0])), atol=1e-13)
    c = 4.0 / (2 * np.pi)
    x = Helicoid(4.0, 0.0, 5.0, 1.0).at(u + 1j * v).position
    np.testing.assert_allclose(x, c * np.column_stack([np.sinh(u) * np.cos(v), np.sinh(u) * np.sin(v), v]), atol=1e-14)
    mirrored = Helicoid(-4.0, 0.0, 5.0, 1.0).at(u + 1j * v).position
    np.testing.assert_allclose(mirrored, x * [1, 1, -1], atol=1e-14)


def test_largest_torsion_of_the_classical_surfaces():
    """|tg| = sqrt(H^2 - K): catenoid 1/(c cosh^2 u), Enneper 2/(1 + r^2)^2, Scherk 1 at its saddle."""
    u = np.linspace(-1, 1, 9) + 0.3j
    np.testing.assert_allclose(
        np.abs(Catenoid(0.7, (-1, 1)).at(u).deviator), 1 / (0.7 * np.cosh(u.real) ** 2), rtol=1e-13
    )
    np.testing.assert_allclose(np.abs(Enneper(2, 1.5).at(u).deviator), 2 / (1 + np.abs(u) ** 2) ** 2, rtol=1e-13)
    assert np.abs(Scherk(1.0).at(np.array([0j])).deviator)[0] == pytest.approx(1)
    np.testing.assert_allclose(np.abs(Cylinder(2.0, (0, 1)).at(u).deviator), 0.25, rtol=1e-13)


def test_equal_radii_are_a_cylinder():
    rng = np.random.default_rng(8)
    u, v = rng.uniform(-1, 1, (2, 30))
    where = u + 1j * v
    unduloid, cylinder = Unduloid(1.3, 1.3, (-2, 2)), Cylinder(1.3, (-2, 2))
    assert unduloid.mean_curvature == pytest.approx(cylinder.mean_curvature)
    np.testing.assert_allclose(unduloid.at(where).position, cylinder.at(where).position, atol=1e-13)


def test_areas():
    """Catenoid pi c^2 (U + sinh U cosh U) between its ends; cylinder 2 pi R h; Enneper pi (R^2 + R^4 + R^6/3)."""

    def half(u):
        return np.pi * 0.7**2 * (u + np.sinh(u) * np.cosh(u))

    assert Catenoid(0.7, (-1, 2)).area() == pytest.approx(half(2 / 0.7) + half(1 / 0.7), rel=1e-12)
    assert Cylinder(1.5, (1, 4)).area() == pytest.approx(2 * np.pi * 1.5 * 3, rel=1e-12)
    r = 1.3
    assert Enneper(2, r, 2.0).area() == pytest.approx(4 * np.pi * (r**2 + r**4 + r**6 / 3), rel=1e-12)


@pytest.mark.parametrize("kind", KINDS)
def test_mesh_lies_on_the_surface_and_its_area_converges(kind):
    surface = draw_surface(kind, np.random.default_rng(9))

    def miss(tolerance):
        mesh = surface.mesh(tolerance)
        p, f = mesh.points, mesh.faces
        cross = np.cross(p[f[:, 2]] - p[f[:, 0]], p[f[:, 3]] - p[f[:, 1]])
        first = np.cross(p[f[:, 1]] - p[f[:, 0]], p[f[:, 2]] - p[f[:, 0]])
        assert (np.einsum("ij,ij->i", first, mesh.normals[f[:, 0]]) > 0).all()  # counter-clockwise about n
        return abs(np.linalg.norm(cross, axis=1).sum() / 2 / surface.area() - 1)

    # the sag is the square of the edge: a quarter of it halves the edge and quarters the area error
    assert miss(5e-5) < 1e-3
    assert 2.5 < miss(1e-4) / miss(2.5e-5) < 6


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Unduloid(1e-5, 1.0, (-1, 1)), ("spheres", "umbilic", "1e-05")),
        (lambda: Nodoid(1e-5, 1.0, (-1, 1)), ("spheres", "umbilic")),
        (lambda: Unduloid(2.0, 1.0, (-1, 1)), ("2 m", "1 m", "swap")),
        (lambda: Nodoid(1.0, 1.0, (-1, 1)), ("not below",)),
        (lambda: Catenoid(1.0, (1.0, -1.0)), ("(1, -1)", "below")),
        (lambda: Catenoid(0.0, (-1.0, 1.0)), ("neck_radius = 0.0", "above 0")),
        (lambda: Cylinder(float("nan"), (-1.0, 1.0)), ("radius = nan",)),
        (lambda: Helicoid(0.0, 1.0, 2.0, 1.0), ("pitch = 0.0",)),
        (lambda: Helicoid(1.0, 3.0, 2.0, 1.0), ("inner_radius = 3 m", "2 m")),
        (lambda: Enneper(1, 1.0), ("order = 1",)),
        (lambda: Scherk(2.0), ("extent = 2", "1.5708")),
        (lambda: Section(marks="relaxd"), ("relaxd", "relaxed")),  # type: ignore[arg-type]
        (lambda: Section(height=0.001, thickness=0.1), ("0.1 m", "0.001 m")),
        (lambda: lamella.net(Cylinder(1.0, (0, 2)), cells=24.5), ("24.5", "whole")),  # type: ignore[arg-type]
        (lambda: lamella.net(Cylinder(1.0, (0, 2)), spacing=float("nan")), ("nan",)),
        (lambda: lamella.net(Cylinder(1.0, (0, 2)), spacing=0.0), ("0.0",)),
        (lambda: Nodoid(0.5, 1.6, (-0.1, 0.4)), ("0.4 m", "fold", "0.315034")),
    ],
)
def test_refusals_say_why(make, words):
    with pytest.raises(InputError) as error:
        make()
    for word in words:
        assert word in str(error.value)


@pytest.mark.parametrize(
    ("surface", "word"),
    [
        (Unduloid(0.0005, 1.0, (0.9, 1.05)), "sphere of radius 1"),  # around a bulge
        (Helicoid(1e-9, 1.0, 2.0, 1.0), "flat"),
        (Enneper(2, 1e-7), "flat"),
    ],
    ids=["bulge", "flat helicoid", "speck"],
)
def test_pieces_that_are_spheres_or_planes(surface, word):
    with pytest.raises(InputError) as error:
        refuse_umbilic(surface)
    assert word in str(error.value)
    assert "umbilic" in str(error.value)


@pytest.mark.parametrize(
    "surface", [Nodoid(0.5, 600, (-0.5, 0.5)), Unduloid(0.9, 1000, (-1, 1)), Unduloid(0.01, 1.0, (0.9, 1.05))]
)
def test_pieces_that_are_none(surface):
    """A slightly inflated catenoid is a good surface however large its bulges far away are."""
    refuse_umbilic(surface)
    where = np.linspace(surface.outline.start, surface.outline.end, 20) + 0.3j
    assert surface.measured_mean_curvature(where) == pytest.approx(surface.mean_curvature, abs=1e-7)


@pytest.mark.parametrize("kind", KINDS)
def test_mean_curvature_from_positions_and_normals(kind):
    """Fourth order in the step; the summary's figure is this one, not the formula's own H."""
    rng = np.random.default_rng(17)
    surface = draw_surface(kind, rng)
    where = draw_places(surface, rng)
    scale = np.abs(surface.at(where).principal_curvatures[0]).max()

    def miss(step):
        return np.abs(surface.measured_mean_curvature(where, step) - surface.mean_curvature).max() / scale

    assert miss(1e-3) < 1e-9
    assert miss(1e-2) < 1e-11 or 12 < miss(2e-2) / miss(1e-2) < 20


def test_each_has_a_table_of_its_own_in_the_project_file() -> None:
    assert set(CLOSED_FORMS) == set(SURFACE_TABLES) - {"form-found", "mesh"}
