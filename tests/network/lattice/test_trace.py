"""The network of closed-form surfaces, at parameters drawn afresh.

1. combinatorics: every regular node one A and one B lamella, faces of 3 to 6 nodes, Euler's number; 2. closing and
density; 3. trimming exactly at the rim; 4. Darboux curvatures against section 9's formulas of the surfaces;
5. the integral of sqrt|tg| ds is the same in every cell; 6. singular nodes; 7. what is left out or refused.
"""

import tracemalloc

import numpy as np
import pytest
from scipy.integrate import romb

import lamella
from conftest import KINDS, draw_surface
from lamella import Catenoid, Cylinder, Enneper, Helicoid, InputError, Nodoid, Scherk, Unduloid
from lamella.network.lattice.density import choose_density
from lamella.network.network import BOUNDARY, REGULAR, SINGULAR
from lamella.surface.closed_forms.outline import Ring


def _edges(network):
    owner = network.stop_owner
    inside = owner[1:] == owner[:-1]
    return np.column_stack([network.stop_nodes[:-1][inside], network.stop_nodes[1:][inside]])


def _faces(network):
    return [network.face_nodes[a:b] for a, b in zip(network.face_offsets[:-1], network.face_offsets[1:], strict=True)]


def _check_combinatorics(network, euler):
    # a closed curve comes back to its first node
    at, owner = np.unique(np.column_stack([network.stop_nodes, network.stop_owner]), axis=0).T
    regular = network.node_kinds == REGULAR
    for family in "AB":
        degree = np.bincount(at[network.families[owner] == family], minlength=len(regular))
        assert (degree[regular] == 1).all()
    faces = _faces(network)
    assert all(3 <= len(f) <= 6 for f in faces)
    halves = {(int(p), int(q)) for f in faces for p, q in zip(f, np.roll(f, -1), strict=True)}
    assert len(halves) == sum(map(len, faces))  # no half edge in two faces
    edges = {(int(min(e)), int(max(e))) for e in _edges(network)} | {(min(e), max(e)) for e in halves}
    assert len(network.node_points) - len(edges) + len(faces) == euler
    for face in faces[:: max(1, len(faces) // 200)]:
        points = network.node_points[face] - network.node_points[face].mean(0)
        turn = np.cross(points, np.roll(points, -1, 0)).sum(0)
        assert turn @ network.node_normals[face].sum(0) > 0  # counter-clockwise about n


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(4))
def test_combinatorics(kind, seed):
    rng = np.random.default_rng([seed, 21])
    surface = draw_surface(kind, rng)
    network = lamella.net(surface, cells=int(rng.integers(8, 40)))
    _check_combinatorics(network, 0 if isinstance(surface.outline, Ring) else 1)


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_combinatorics_many(kind):
    for seed in range(60):
        rng = np.random.default_rng([seed, 22])
        surface, cells = draw_surface(kind, rng), int(rng.integers(6, 60))
        if choose_density(surface, cells=cells).estimated_nodes < 6 * cells:
            continue  # a band so low that hardly any lamellas cross
        network = lamella.net(surface, cells=cells)
        _check_combinatorics(network, 0 if isinstance(surface.outline, Ring) else 1)


@pytest.mark.parametrize("cells", [3, 10, 24, 57])
def test_closes_around_the_axis(cells):
    for surface in (Unduloid(0.6, 1.4, (-1, 2)), Nodoid(1, 4, (-0.5, 0.4)), Catenoid(1, (-1, 1)), Cylinder(1, (0, 4))):
        network = lamella.net(surface, cells=cells)
        (period,) = network.periods
        assert abs(period.a_cells) == pytest.approx(cells, abs=1e-9)
        assert abs(period.b_cells) == pytest.approx(cells, abs=1e-9)
        assert (network.families == "A").sum() == (network.families == "B").sum() == cells


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", [0, 1, pytest.param(2, marks=pytest.mark.slow)])
def test_spacing_takes_the_nearest_number_of_cells(kind, seed):
    """No neighbouring number of cells has a median cell edge nearer to what is asked."""
    rng = np.random.default_rng([seed, 33])
    surface = draw_surface(kind, rng)

    def median(cells):
        return np.median(lamella.net(surface, cells=cells, minimum_length=0).cell_edges)

    wanted = float(median(int(rng.integers(20, 32))) * rng.uniform(0.95, 1.05))
    cells = lamella.net(surface, spacing=wanted, minimum_length=0).cells
    miss = {n: abs(median(n) - wanted) for n in (cells - 1, cells, cells + 1)}
    assert miss[cells] <= min(miss.values()) + 1e-12


def test_lamellas_end_exactly_on_the_rim():
    def rim(network):
        return network.node_points[network.node_kinds == BOUNDARY]

    z = rim(lamella.net(Unduloid(0.6, 1.4, (-1.2345, 2.1)), cells=17))[:, 2]
    assert np.minimum(np.abs(z + 1.2345), np.abs(z - 2.1)).max() < 1e-12
    z = rim(lamella.net(Nodoid(1.0, 4.0, (-0.5, 0.31)), cells=17))[:, 2]
    assert np.minimum(np.abs(z + 0.5), np.abs(z - 0.31)).max() < 1e-12
    p = rim(lamella.net(Scherk(1.3, 2.0), cells=21))[:, :2] / 2
    assert np.abs(np.abs(p).max(1) - 1.3).max() < 1e-12
    p = rim(lamella.net(Helicoid(3.0, 0.5, 2.0, 1.1), cells=9))
    r = np.hypot(p[:, 0], p[:, 1])
    turn = p[:, 2] / 3.0
    off = np.min([np.abs(r - 0.5), np.abs(r - 2.0), np.abs(turn), np.abs(turn - 1.1)], 0)
    assert off.max() < 1e-12
    network = lamella.net(Enneper(3, 0.9, 2.0), cells=20)
    where = network.sample_where[np.r_[network.sample_offsets[1:] - 1]]
    assert np.abs(np.abs(where) - 0.9).max() < 1e-12


def test_helicoid_has_whole_cells_between_its_rims():
    network = lamella.net(Helicoid(3.0, 0.5, 2.0, 1.1), cells=9)
    r = np.hypot(*network.node_points[:, :2].T)
    assert np.abs(r - 0.5).min() < 1e-12
    assert len(np.unique(np.round(r, 9))) == 10


def _delaunay_forms(surface, network):
    """tg = -+T/r^2, kg = -+(ln r)_U / (sqrt2 r) along U +- V = const with U increasing."""
    where, tangent = network.sample_where, network.sample_tangents
    p = surface.profile(where.real)
    at = surface.at(where)
    along_u = np.einsum("ij,ij->i", tangent, at.e_u)
    sign = np.sign(along_u * np.einsum("ij,ij->i", tangent, at.e_v))  # -1 along U + V = const
    tg = sign * surface.flux / p.r**2
    kg = sign * np.sign(along_u) * (p.r_u / p.r) / (np.sqrt(2) * p.r)
    return tg, kg


@pytest.mark.parametrize("kind", ["unduloid", "nodoid", "catenoid", "cylinder"])
@pytest.mark.parametrize("seed", range(3))
def test_darboux_curvatures_of_rotational_surfaces(kind, seed):
    """DESIGN section 9, Delaunay and catenoid; kn = H."""
    surface = draw_surface(kind, np.random.default_rng([seed, 41]))
    network = lamella.net(surface, cells=24)
    tg, kg = _delaunay_forms(surface, network)
    scale = np.abs(tg).max()
    kn = network.sample_darboux.kn
    np.testing.assert_allclose(kn, surface.mean_curvature, atol=1e-8 * scale)
    np.testing.assert_allclose(network.sample_darboux.tg, tg, atol=1e-8 * scale)
    np.testing.assert_allclose(network.sample_darboux.kg, kg, atol=1e-8 * scale)


def test_darboux_curvatures_of_minimal_surfaces():
    """Helicoid: rulings kg = 0, helices |kg| = sinh u / (c cosh^2 u); Enneper tg = 2/(1 + r^2)^2."""
    c = 3.0 / (2 * np.pi)
    network = lamella.net(Helicoid(3.0, 0.4, 2.5, 0.8), cells=12)
    u = network.sample_where.real
    kg = np.abs(network.sample_darboux.kg)
    level = np.abs(network.sample_tangents[:, 2]) < 1e-12  # a ruling is horizontal
    assert level.any()
    assert (~level).any()
    np.testing.assert_allclose(kg[level], 0, atol=1e-12)
    np.testing.assert_allclose(kg[~level], (np.sinh(u) / (c * np.cosh(u) ** 2))[~level], rtol=1e-12)
    np.testing.assert_allclose(np.abs(network.sample_darboux.tg), 1 / (c * np.cosh(u) ** 2), rtol=1e-12)
    network = lamella.net(Enneper(2, 1.1), cells=20)
    r = np.abs(network.sample_where)
    np.testing.assert_allclose(np.abs(network.sample_darboux.tg), 2 / (1 + r**2) ** 2, rtol=1e-12)
    assert (
        np.sign(network.sample_darboux.tg)
        == np.repeat(np.where(network.families == "A", 1, -1), np.diff(network.sample_offsets))
    ).all()


@pytest.mark.parametrize("kind", KINDS)
def test_geodesic_curvature_is_the_turn_of_the_written_curve(kind):
    """kg = t'.u by central differences of the tangents: second-order agreement when the net is refined."""
    surface = draw_surface(kind, np.random.default_rng(43))
    if surface.hopf_order:
        surface = Enneper(3, 0.9)

    def miss(cells):
        n = lamella.net(surface, cells=cells)
        sideways = np.cross(n.sample_normals, n.sample_tangents)
        s, t = n.sample_arclengths, n.sample_tangents
        inner = np.flatnonzero((s[1:-1] > s[:-2]) & (s[2:] > s[1:-1])) + 1
        if surface.hopf_order:  # kg grows without bound towards a singular node
            inner = inner[np.abs(n.sample_where[inner]) > 0.4]
        # only where the steps are equal
        step = s[inner + 1] - s[inner]
        inner = inner[np.abs(step - (s[inner] - s[inner - 1])) < 1e-6 * step]
        turn = (t[inner + 1] - t[inner - 1]) / (s[inner + 1] - s[inner - 1])[:, None]
        kg = np.einsum("ij,ij->i", turn, sideways[inner])
        return np.sqrt(np.mean((kg - n.sample_darboux.kg[inner]) ** 2)) / np.abs(n.sample_darboux.tg).max()

    # with fewer cells there are more samples where lamellas turn sharply
    coarse, fine = miss(24), miss(48)
    assert fine < 1e-3
    assert fine < 1e-9 or coarse / fine > 3


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(2))
def test_same_twist_integral_in_every_cell(kind, seed):
    """The integral of sqrt|tg| ds between neighbouring nodes is l0 / sqrt2, to 1e-9 (Romberg on 17 samples a cell)."""
    surface = draw_surface(kind, np.random.default_rng([seed, 44]))
    network = lamella.net(surface, cells=32)
    owner = network.stop_owner
    start = network.sample_offsets[owner] + network.stop_samples
    regular = network.node_kinds[network.stop_nodes] == REGULAR
    whole = np.flatnonzero((owner[1:] == owner[:-1]) & regular[1:] & regular[:-1])
    assert (start[whole + 1] - start[whole] == 16).all()
    index = start[whole][:, None] + np.arange(17)
    root = np.sqrt(np.abs(network.sample_darboux.tg[index]))
    step = np.diff(network.stop_arclengths)[whole] / 16
    integral = romb(root, axis=1) * step
    np.testing.assert_allclose(integral, network.step / np.sqrt(2), rtol=1e-9)
    # samples are equal arcs
    s = network.sample_arclengths[index]
    np.testing.assert_allclose(np.diff(s, axis=1), np.broadcast_to(step[:, None], (len(step), 16)), rtol=1e-9)


@pytest.mark.parametrize("order", [3, 4, 5, 8])
def test_singular_node_in_the_middle(order):
    """A zero of order m has 2 (m + 2) lamella rays, alternately A and B, evenly around; order 3: the hexagonal node."""
    network = lamella.net(Enneper(order, 0.8, 3.0), cells=16)
    (node,) = np.flatnonzero(network.node_kinds == SINGULAR)
    np.testing.assert_allclose(network.node_points[node], 0, atol=1e-15)
    stops = np.flatnonzero(network.stop_nodes == node)
    assert len(stops) == 2 * order
    assert (network.stop_samples[stops] == 0).all()
    owner = network.stop_owner[stops]
    tangents = network.sample_tangents[network.sample_offsets[owner]]
    angle = np.degrees(np.arctan2(tangents[:, 1], tangents[:, 0])) % 360
    turn = np.argsort(angle)
    np.testing.assert_allclose(np.diff(angle[turn]), 180 / order, atol=1e-9)
    letters = network.families[owner][turn]
    assert (letters[1:] != letters[:-1]).all()
    faces = [f for f in _faces(network) if node in f]
    assert len(faces) == 2 * order
    assert all(len(f) == 4 for f in faces)


def test_classical_enneper_has_a_regular_node_or_a_face_in_its_middle():
    even, odd = (lamella.net(Enneper(2, 1.0), cells=c) for c in (20, 21))
    assert np.linalg.norm(even.node_points, axis=1).min() < 1e-12
    assert np.linalg.norm(odd.node_points, axis=1).min() > 1e-3
    assert not (even.node_kinds == SINGULAR).any()


def test_cells_along_the_longest_principal_line():
    """Scherk: the section y = 0 is a principal line from rim to rim; it passes `cells` cells corner to corner."""
    network = lamella.net(Scherk(1.3), cells=20)
    on_line = np.abs(network.node_points[:, 1]) < 1e-12
    assert on_line.sum() == 21


def test_short_lamellas_are_left_out_and_counted():
    everything = lamella.net(Scherk(1.45), cells=30, minimum_length=0)
    some = lamella.net(Scherk(1.45), cells=30, minimum_length=3)
    assert some.left_out > 0
    assert len(some.ids) + some.left_out == len(everything.ids)
    assert some.lengths.min() >= 3 * np.median(some.cell_edges) * 0.9
    _check_combinatorics(some, 1)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"cells": 2}, ("2 cells", "at least 3")),
        ({"cells": 10**6}, ("1,000,000".replace(",", ""), "nodes", "GB", "500,000")),
        ({"spacing": 1e-7}, ("spacing = 1e-07 m", "GB", "at least")),
        ({"spacing": 100.0}, ("spacing = 100 m", "at most")),
        ({"cells": 24, "spacing": 0.1}, ("both",)),
    ],
)
def test_absurd_densities_are_refused_before_any_work(options, words):
    tracemalloc.start()
    with pytest.raises(InputError) as error:
        lamella.net(Unduloid(0.6, 1.4, (-1, 3)), **options)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 20e6
    for word in words:
        assert word in str(error.value)


def test_estimate_of_nodes():
    for kind in KINDS:
        surface = draw_surface(kind, np.random.default_rng(51))
        network = lamella.net(surface, cells=50)
        rim = (network.node_kinds == BOUNDARY).sum()
        assert abs(choose_density(surface, cells=50).estimated_nodes - len(network.node_points)) <= rim


def test_band_too_low_for_a_crossing():
    with pytest.raises(InputError, match="no two lamellas cross"):
        lamella.net(Catenoid(1.0, (0.1, 0.12)), cells=6)


@pytest.mark.parametrize("offset", [sign * 10.0**power for sign in (-1, 1) for power in np.arange(-9, -3.9, 0.25)])
def test_a_crossing_next_to_the_rim_is_one_node(offset):
    """Rims a fraction of a cell off a row of crossings: one boundary node within 1e-6 cells, else two or three."""
    around = np.pi * 2 / 24
    for network in (
        lamella.net(Cylinder(2.0, (0, (12 + offset) * around)), cells=24),
        lamella.net(Catenoid(2.0, (0, (3 + offset) * around)), cells=24),
        lamella.net(
            Helicoid(2 * np.pi, 0.5, 2.0, (np.arcsinh(2) - np.arcsinh(0.5)) / (2 * np.pi) / 8 * (24 + offset)), cells=8
        ),
    ):
        assert network.cell_edges.min() > 0.9e-6 * np.median(network.cell_edges)
        _check_combinatorics(network, 1 if not network.periods else 0)
