"""Which whole numbers are near does not depend on how a surface is cut."""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from typing import Literal

import numpy as np
import pytest

from lamella import Enneper
from lamella.network.elements.element_network import element_network
from lamella.network.elements.integer_grid_map import IntegerGridMap
from lamella.network.isothermic import seamless_transitions
from lamella.network.isothermic.between_umbilics import between_umbilics, keeps_apart
from lamella.network.isothermic.cut import cut_edges
from lamella.network.isothermic.holonomy import around_vertex, holonomies, tip_vertices, vertex_relations
from lamella.network.isothermic.integer_transitions import IntegerTransitions, _closest, _even, _kernel, _reduced
from lamella.network.isothermic.integration_mesh import IntegrationMesh
from lamella.network.isothermic.isothermic import Isothermic
from lamella.network.isothermic.lattice_origin import lattice_origin
from lamella.network.isothermic.match_transitions import TransitionMatcher
from lamella.network.isothermic.mesh_layout import make_integration_mesh
from lamella.network.isothermic.seamless_transitions import integrate
from lamella.network.network import SEAM, SINGULAR
from lamella.network.pattern import LAMELLAS
from lamella.stages.surface.boundary_of_tables import boundary_loops
from lamella.surface.element.surface import ElementSurface
from lamella.surface.form_finding.find import find_film
from network.adjust.test_adjust import HERE, sketch, table_of
from network.elements.random_boundaries import sketch as random_sketch
from network.elements.test_element_network import elements_on, euler, shaken_grid
from surface.element.exact_elements import on_map
from surface.form_finding.exact_patches import disc

STEP = 0.35


def cut_anew(surface: ElementSurface, monkeypatch: pytest.MonkeyPatch, seed: int) -> Isothermic:
    """Coordinates on a surface whose cut goes other ways: as if its edges had other lengths."""
    umbilics = surface.umbilics
    mesh = make_integration_mesh(surface, umbilics)
    odd = mesh.umbilics[(umbilics.orders % 2 == 1) & (mesh.umbilics >= 0)]
    rng = np.random.default_rng(seed)

    def other_ways(mesh: IntegrationMesh, odd: np.ndarray) -> np.ndarray:
        waves = sum(
            np.sin(mesh.nodes @ rng.normal(0, 8 / np.ptp(mesh.nodes, axis=0)) + rng.uniform(0, 6))[:, None]
            * rng.normal(0, 1.0, 3)
            for _ in range(6)
        )
        return cut_edges(replace(mesh, nodes=mesh.nodes + np.ptp(mesh.nodes) / 8 * waves), rng.permutation(odd))

    with monkeypatch.context() as patch:
        if seed:
            patch.setattr(seamless_transitions, "cut_edges", other_ways)
        return integrate(mesh, odd)


def cells_of(iso: Isothermic) -> np.ndarray:
    return IntegerGridMap.of(iso, lattice_origin(iso, STEP, LAMELLAS), STEP).shifts


@pytest.fixture(scope="module")
def films() -> list[ElementSurface]:
    """An annulus with two umbilics; a free sketch of two holes and seven umbilics, with a hole around which w turns."""
    loops = boundary_loops(table_of(sketch(5)), HERE)
    case = random_sketch(119)
    return [
        find_film(loops, tolerance=5e-2).surface("form-found"),
        find_film(case.loops, case.mean_curvature, tolerance=5e-2).surface("form-found"),
    ]


@pytest.mark.parametrize(("number", "norm"), [(0, "weighted"), (0, "plain"), (1, "plain")])
def test_near_whole_shifts_do_not_depend_on_the_cut(
    films: list[ElementSurface], monkeypatch: pytest.MonkeyPatch, number: int, norm: str
) -> None:
    """The energies of the corrections to the nearest closed nets are properties of the surface."""
    first = cut_anew(films[number], monkeypatch, 0)
    energy = (lambda iso: iso.dirichlet) if norm == "plain" else (lambda iso: iso.gram)
    whole = IntegerTransitions.of(first, energy(first))
    shifts = cells_of(first)
    near = whole.nearest(shifts, 6)
    sizes = [whole.size(one - shifts) for one in near]
    assert np.all(np.diff(sizes) > -1e-9)
    different = 0
    for seed in (1, 2, 3):
        other = cut_anew(films[number], monkeypatch, seed)
        there = IntegerTransitions.of(other, energy(other))
        assert there.basis.shape[0] == whole.basis.shape[0]
        assert np.linalg.det(there.energy) == pytest.approx(np.linalg.det(whole.energy), rel=2e-2)
        here = cells_of(other)
        assert [there.size(one - here) for one in there.nearest(here, 6)] == pytest.approx(sizes, rel=1e-2, abs=1e-4)
        ends = [{tip_vertices(iso.mesh, piece) for piece in iso.transitions} for iso in (first, other)]
        different += ends[0] != ends[1]
        # the same one, named by the other cut's pieces, and back
        for one, size in zip(near, sizes, strict=True):
            named = TransitionMatcher(first, other, there).match(one - shifts, here)
            assert named is not None
            assert there.size(named - here) == pytest.approx(size, rel=1e-2, abs=1e-4)
            back = TransitionMatcher(other, first, whole).match(named - here, shifts)
            assert back is not None
            assert np.abs(back - one).max() < 1e-9
    assert different


@pytest.mark.parametrize("number", [0, 1])
def test_distances_of_umbilics_do_not_depend_on_the_cut(
    films: list[ElementSurface], monkeypatch: pytest.MonkeyPatch, number: int
) -> None:
    """They are integrals of dw from one to the other; and where w is -w + c an umbilic is at c / 2."""
    known: np.ndarray | None = None
    for seed in range(4):
        iso = cut_anew(films[number], monkeypatch, seed)
        shifts = np.array([piece.shift for piece in iso.transitions])
        distances = np.abs(between_umbilics(iso) @ shifts)
        assert len(distances) == len(iso.odd) * (len(iso.odd) - 1) // 2
        order = np.argsort(iso.odd)
        pairs = [(order[p], order[q]) for p in range(len(order)) for q in range(p)]
        rank = [max(p, q) * (max(p, q) - 1) // 2 + min(p, q) for p, q in pairs]
        known = distances[rank] if known is None else known
        assert distances[rank] == pytest.approx(known, rel=2e-2, abs=2e-3)
        for vertex in iso.odd.tolist():
            element, corner = (int(part[0]) for part in np.nonzero(iso.mesh.connectivity.faces == vertex))
            _, twice = around_vertex(iso.mesh, iso.transitions, iso.across, vertex)
            assert abs(iso.value[element, corner] - twice @ shifts / 2) < 1e-6 * np.ptp(iso.value.real)


def test_whole_shifts_that_keep_umbilics_apart() -> None:
    """Two umbilics 0.4 cells apart, and two that are 3 cells apart: the first ones may not be asked to meet."""
    factors, shifts = np.array([[0.5, 0.0], [0.0, 1.0]]), np.array([0.8, 3.0 + 0.1j])
    assert not keeps_apart(factors, shifts, np.array([0.0, 3.0 + 0j]))
    assert keeps_apart(factors, shifts, np.array([2.0, 3.0 + 0j]))
    assert keeps_apart(factors, shifts, np.array([2.0, 0.0 + 0j]))


@pytest.mark.parametrize("number", [0, 1])
def test_nearest_whole_shifts_close_the_net(
    films: list[ElementSurface], monkeypatch: pytest.MonkeyPatch, number: int
) -> None:
    iso = cut_anew(films[number], monkeypatch, 0)
    shifts = cells_of(iso)
    for whole in IntegerTransitions.of(iso, iso.gram).nearest(shifts, 4):
        assert np.array_equal(whole, np.round(whole))
        for factors in vertex_relations(iso.mesh, iso.transitions, iso.across, iso.odd).values():
            assert factors @ whole == 0
        for vertex in iso.odd.tolist():
            sign, factors = around_vertex(iso.mesh, iso.transitions, iso.across, vertex)
            assert sign == -1
            # a half turn about a lattice point
            assert np.array_equal(factors @ whole / 2, np.round(factors @ whole / 2))
    assert len(iso.odd) >= 2


@pytest.mark.parametrize("closing", ["open", "round"])
def test_a_net_around_a_hole_that_was_an_umbilic(closing: Literal["open", "round"]) -> None:
    """Enneper's surface of order 3 without its hexagonal node: the net closes around the hole as around the node.

    w comes back as -w + c, and c / 2 has to be in the middle of a cell or a node, wherever the hole's umbilic may be.
    """
    form = Enneper(3, 0.9, 2.0)
    corners, faces = shaken_grid((0, 2 * np.pi), (0.25, 0.9), 30, 8, around=True)
    _, faces = np.unique(faces, return_inverse=True)
    zeta = corners[..., 1] * np.exp(1j * corners[..., 0])
    faces, zeta = faces.reshape(-1, 3), np.stack([zeta.real, zeta.imag], 2)

    def position(uv: np.ndarray) -> np.ndarray:
        return form.at((uv[..., 0] + 1j * uv[..., 1]).ravel()).position.reshape(*uv.shape[:-1], 3)

    inner = np.linalg.norm(position(np.array([[0.5, 0.0]])))
    surface = on_map(
        position, zeta[:, ::-1], faces[:, ::-1], 4, 0.0, lambda x: (np.linalg.norm(x, axis=1) < inner).astype(np.int64)
    )
    mesh = make_integration_mesh(surface, surface.umbilics)
    iso = integrate(mesh, np.zeros(0, np.int64))
    assert not len(surface.umbilics.orders)
    assert [one.sign for one in holonomies(iso)] == [-1]
    net = element_network(surface, cells=12, closing=closing, minimum_length=0.0)
    assert all(joint.closed and joint.off_cells < 1e-9 for joint in net.joints)
    network = net.network
    assert not (network.node_kinds == SEAM).any()
    assert euler(network) == 0
    # six rays of each family, in turn, where the node was: as many curves of each
    assert sum(name.startswith("A") for name in network.ids) == sum(name.startswith("B") for name in network.ids)


@pytest.mark.parametrize("closing", ["open", "round"])
@pytest.mark.parametrize(("inside", "joints"), [(-0.002, 0), (0.002, 1), (0.005, 1)])
def test_an_umbilic_next_to_the_rim(inside: float, joints: int, closing: Literal["open", "round"]) -> None:
    """Enneper's surface of order 3, trimmed just beyond its node or just before it: no seam and no node."""
    form = Enneper(3, 1.8, 2.0)
    points, faces, _, _ = disc(8)
    surface = elements_on(form, (0.8 * points[:, :2] + [0.8 - inside, 0.0])[faces], faces)
    net = element_network(surface, cells=12, closing=closing, minimum_length=0.0)
    assert len(net.umbilics.orders) == joints
    assert net.on_rim.all()
    assert len(net.joints) == joints
    assert all(joint.closed and joint.off_cells < 1e-9 for joint in net.joints)
    assert not np.isin(net.network.node_kinds, (SEAM, SINGULAR)).any()
    # a disc, but for a face of more than six corners around the umbilic, which takes a bite out of it
    assert euler(net.network) in (1 - len(net.network.faces_left_out), 1)
    assert len(net.network.ids) >= 30


def test_closest_vectors_are_those_of_all() -> None:
    rng = np.random.default_rng(4)
    for d in (1, 2, 4):
        half = rng.normal(size=(d, d))
        energy, wanted = half @ half.T + 0.2 * np.eye(d), rng.normal(0, 3, d)
        found = _closest(np.linalg.cholesky(energy).T, wanted, 5)
        every = np.array(list(product(range(-12, 13), repeat=d)))[:, :]
        cost = np.sort(np.einsum("ni,ij,nj->n", every - wanted, energy, every - wanted))
        assert [one for one, _ in found] == pytest.approx(cost[:5])
        for cost_of_one, x in found:
            assert (x - wanted) @ energy @ (x - wanted) == pytest.approx(cost_of_one)


def test_easiest_whole_shifts_are_those_of_least_effort() -> None:
    """Of all whole shifts around, by the smallest parameters that make up for each."""
    rng = np.random.default_rng(2)
    basis = np.array([[1, 0, 1], [0, 2, 1]])
    whole = IntegerTransitions(np.array([0, 1 + 1j, 0]), basis, np.eye(2))
    rates = (rng.normal(size=(2, 5)) + 1j * rng.normal(size=(2, 5))).T @ basis
    shifts = (rng.normal(size=2) + 1j * rng.normal(size=2)) @ basis + whole.offset
    places = np.array(list(product(range(-6, 7), repeat=4)))
    every = whole.offset + (places[:, :2] + 1j * places[:, 2:]) @ basis
    missed = (every - shifts).T
    parameters = np.linalg.pinv(np.vstack([rates.T.real, rates.T.imag])) @ np.vstack([missed.real, missed.imag])
    best = every[np.argsort((parameters**2).sum(0))[:6]]
    assert np.allclose(np.array(whole.easiest(shifts, rates.T, 6)), best)


def test_lattices_of_whole_vectors() -> None:
    """All whole vectors that meet the conditions, and no others: against a search through a cube."""
    rng = np.random.default_rng(7)
    for _ in range(20):
        conditions = list(rng.integers(-2, 3, (2, 5)))
        even = rng.integers(-2, 3, 5)
        half = rng.normal(size=(5, 5))
        basis, _ = _reduced(_even(_kernel(5, conditions), even), half @ half.T + 0.1 * np.eye(5))
        every = np.array(list(product(range(-3, 4), repeat=5)))
        inside = (every @ np.array(conditions).T == 0).all(1) & (every @ even % 2 == 0)
        coordinates = np.linalg.lstsq(basis.T.astype(float), every.T.astype(float), rcond=None)[0]
        whole = np.abs(coordinates - np.round(coordinates)).max(0, initial=0) < 1e-9
        whole &= np.abs(basis.T @ np.round(coordinates) - every.T).max(0) < 1e-9
        assert np.array_equal(inside, whole)
