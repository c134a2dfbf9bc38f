"""Principal nets, curves left out, and cells much larger than others, against the closed forms' own numbers.

Isothermic coordinates: along a principal line mu ds = du or dv, along a lamella mu ds = d(u -+ v) / sqrt2, with
mu^4 = H^2 - K. A net of every n-th curve is therefore the net of an n-fold step.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import jsonschema
import numpy as np
import orjson
import pytest
from scipy.spatial import cKDTree

import lamella
from conftest import KINDS, draw_surface
from lamella import Catenoid, Cylinder, Enneper, Helicoid, InputError, Scherk, Unduloid, compute, parse_project
from lamella.base.material import MATERIALS
from lamella.files.write.network_json import network_bytes, network_schema
from lamella.network.cell_sizes import EDGE_RATIO_MAX, large_cells
from lamella.network.elements.element_network import ElementNetwork, element_network
from lamella.network.network import BOUNDARY, REGULAR, SEAM, SINGULAR, Network
from lamella.network.pattern import Pattern, fitting_cells
from lamella.project.tables import project_schema
from lamella.stages.figure import evaluate
from lamella.stages.network.figures import panel_planarity
from lamella.stages.network.output import NetworkOutput
from lamella.stages.network.stage import NetworkStage
from lamella.stages.pattern_of_table import pattern_of
from lamella.strip.lamellas import Section, make_lamellas
from lamella.surface.closed_forms.outline import Ring
from lamella.surface.form_finding.find import find_film
from network.elements.random_boundaries import sketch
from network.elements.test_element_network import FORMS, euler, from_exact_nodes
from network.lattice.test_trace import _check_combinatorics


def inner(network: Network) -> np.ndarray:
    return network.node_points[network.node_kinds == REGULAR]


def same_points(one: np.ndarray, two: np.ndarray, off: float) -> None:
    """Two sets of points, whatever their order."""
    assert len(one) == len(two)
    distance, at = cKDTree(two).query(one)
    assert distance.max() < off
    assert len(np.unique(at)) == len(two)


def whole_cells(network: Network) -> tuple[np.ndarray, np.ndarray]:
    """Integral of mu ds over each piece of curve between two inner nodes, and whether it is one of family A."""
    owner = network.stop_owner
    first = np.flatnonzero(owner[1:] == owner[:-1])
    kinds = network.node_kinds[network.stop_nodes]
    first = first[(kinds[first] == REGULAR) & (kinds[first + 1] == REGULAR)]
    d = network.sample_darboux
    mu = ((d.kn - network.mean_curvature) ** 2 + d.tg**2) ** 0.25
    totals = []
    for k in first.tolist():
        start = network.sample_offsets[owner[k]]
        piece = slice(start + network.stop_samples[k], start + network.stop_samples[k + 1] + 1)
        s, f = network.sample_arclengths[piece], mu[piece]
        # Simpson's rule: samples are at equal arcs, an even number of pieces a cell
        assert len(f) % 2 == 1
        totals.append((s[-1] - s[0]) / (3 * (len(f) - 1)) * (f[0] + f[-1] + 4 * f[1::2].sum() + 2 * f[2:-1:2].sum()))
    return np.array(totals), network.families[owner[first]] == "A"


# --- curves left out ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("every", [2, 3])
@pytest.mark.parametrize("surface", [Catenoid(1.0, (-1, 1.2)), Unduloid(0.6, 1.4, (-1, 2)), Enneper(3, 0.9)])
def test_every_nth_curve_is_the_net_of_an_nfold_step(surface: Any, every: int) -> None:
    """l0 is whole length / cells, so every n-th of 24 curves are those of 24 / n cells; the origin is the same."""
    thinned = lamella.net(surface, cells=24, every=(every, every))
    coarse = lamella.net(surface, cells=24 // every)
    same_points(thinned.node_points, coarse.node_points, 1e-12)
    assert thinned.ids == coarse.ids
    assert len(thinned.face_nodes) == len(coarse.face_nodes)
    assert len(thinned.periods) == len(coarse.periods)
    for one, two in zip(thinned.periods, coarse.periods, strict=True):
        assert one[1:] == pytest.approx(two[1:])
    # as many samples a cell as ever
    assert len(thinned.sample_points) == len(coarse.sample_points)
    assert thinned.step == pytest.approx(coarse.step / every)


@pytest.mark.parametrize("kind", KINDS)
def test_rectangles_of_any_surface(kind: str) -> None:
    rng = np.random.default_rng([KINDS.index(kind), 71])
    surface = draw_surface(kind, rng)
    full = lamella.net(surface, cells=60, minimum_length=0)
    some = lamella.net(surface, cells=60, every=(3, 2), minimum_length=0)
    _check_combinatorics(some, 0 if isinstance(surface.outline, Ring) else 1)
    size = np.linalg.norm(np.ptp(full.node_points, axis=0))
    distance, _ = cKDTree(inner(full)).query(inner(some))
    assert distance.max() < 1e-11 * size
    total, is_a = whole_cells(some)
    # an A curve runs over two cells to the next B curve that is kept, a B curve over three
    wanted = some.step / np.sqrt(2) * np.where(is_a, 2, 3)
    assert np.abs(total / wanted - 1).max() < 1e-4
    assert np.abs(90 - some.node_angles).max() < 1e-9


def test_periods_count_the_curves_that_are_kept() -> None:
    network = lamella.net(Catenoid(1.0, (-1, 1)), cells=24, every=(2, 3))
    ((_, a, b),) = network.periods
    assert (a, b) == pytest.approx((12, 8))
    assert (network.families == "A").sum() == 12
    assert (network.families == "B").sum() == 8


@pytest.mark.parametrize(
    ("cells", "every", "told", "remedy"),
    [
        (25, 2, "25 around the axis is no multiple of 2", "cells = 24 or 26"),
        (25, (2, 3), "no multiple of 6", "cells = 24 or 30"),
        (4, 2, "4 around the axis leaves 2, at least 3 are needed", "cells = 6"),
    ],
)
def test_a_hole_needs_a_multiple(cells: int, every: Any, told: str, remedy: str) -> None:
    values = {"kind": "catenoid", "neck_radius": 1.0, "height": [-1.0, 1.0]}
    project = parse_project({"surface": values, "network": {"cells": cells, "every": every}})
    with pytest.raises(InputError) as refused:
        compute(project, until="network")
    assert told in refused.value.message
    assert remedy in refused.value.remedy
    assert refused.value.where == "network.cells"


def test_spacing_takes_a_multiple() -> None:
    for spacing in np.linspace(0.1, 0.4, 7):
        network = lamella.net(Catenoid(1.0, (-1, 1)), spacing=float(spacing), every=(3, 2))
        assert network.cells % 6 == 0
        plain = lamella.net(Catenoid(1.0, (-1, 1)), spacing=float(spacing))
        assert abs(network.cells - plain.cells) <= 3 or network.cells == 18


def test_only_the_family_that_is_crossed_needs_a_multiple() -> None:
    """Around the axis principal lines of one family are crossed; those of the other one run around it."""
    network = lamella.net(Catenoid(1.0, (-1, 1)), cells=25, kind="principal", every=(2, 5))
    assert network.periods[0][1:] == pytest.approx((0, 5))
    with pytest.raises(InputError, match="no multiple of 2"):
        lamella.net(Catenoid(1.0, (-1, 1)), cells=25, kind="principal", every=(5, 2))


def test_fitting_cells() -> None:
    assert fitting_cells(25, 1, "x", given=True) == 25
    assert fitting_cells(25, 2, "x", given=False) in (24, 26)
    assert fitting_cells(3, 2, "x", given=False) == 6


@cache
def on_elements(name: str, pattern: Pattern, cells: int = 20) -> ElementNetwork:
    return element_network(FORMS[name]()[1], cells=cells, pattern=pattern)


@pytest.mark.parametrize(
    "pattern", [Pattern("lamellas", (2, 1)), Pattern("principal"), Pattern("principal", (2, 2))], ids=str
)
@pytest.mark.parametrize("name", ["hexagonal node", "eight rays"])
def test_on_elements_as_on_the_closed_form(name: str, pattern: Pattern) -> None:
    """The singular node fixes the lattice; the nodes are the closed form's to 1e-5 of the size."""
    form, _ = FORMS[name]()
    net = on_elements(name, pattern).network
    exact = lamella.net(form, cells=20, kind=pattern.kind, every=pattern.every)
    size = float(np.linalg.norm(np.ptp(exact.node_points, axis=0)))
    off, _ = from_exact_nodes(form, net, net.step)
    assert off.max() < 1e-5 * size
    # a principal net's normal curvature is none of H
    assert not list(on_elements(name, pattern).warnings())
    same_points(inner(net), inner(exact), 5e-5 * size)
    assert (net.node_kinds == SINGULAR).sum() == 1
    assert np.abs(90 - net.node_angles).max() < 0.01
    assert len(net.ids) == len(exact.ids)
    _check_combinatorics(net, 1)


def test_around_a_hole_of_elements() -> None:
    net = on_elements("unduloid", Pattern("lamellas", (2, 2))).network
    assert net.periods[0][1:] == pytest.approx((10, 10), abs=1e-5)
    _check_combinatorics(net, 0)
    with pytest.raises(InputError, match=r"cells = 21 around 'border 1' is no multiple of 2") as refused:
        on_elements("unduloid", Pattern("lamellas", (2, 2)), 21)
    assert "20 or 22" in refused.value.remedy


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(100, 112))
def test_patterns_on_random_films(seed: int) -> None:
    """What holds of every net (tests/network/elements/test_random_networks.py) holds of its patterns."""
    case = sketch(seed)
    try:
        found = find_film(case.loops, case.mean_curvature, tolerance=2e-2, most_nodes=12_000)
    except InputError:
        pytest.skip("no such film")
    surface, loops = found.surface("form-found"), len(case.loops)
    for pattern in (Pattern("principal"), Pattern("principal", (2, 1)), Pattern("lamellas", (2, 2))):
        network = element_network(surface, cells=2 * case.cells, minimum_length=0.0, pattern=pattern).network
        at, owner = np.unique(np.column_stack([network.stop_nodes, network.stop_owner]), axis=0).T
        regular = network.node_kinds == REGULAR
        for family in "AB":
            degree = np.bincount(at[network.families[owner] == family], minlength=len(regular))
            assert (degree[regular] == 1).all()
        if not (network.node_kinds == SEAM).any():
            assert 2 - loops - len(network.faces_left_out) <= euler(network) <= 2 - loops


# --- principal nets -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(2))
def test_principal_combinatorics(kind: str, seed: int) -> None:
    rng = np.random.default_rng([seed, 72])
    surface, cells = draw_surface(kind, rng), int(rng.integers(16, 40))
    network = lamella.net(surface, cells=cells, kind="principal", minimum_length=0)
    _check_combinatorics(network, 0 if isinstance(surface.outline, Ring) else 1)
    scale = max(np.abs(network.sample_darboux.kn).max(), 1e-9)
    assert np.abs(network.sample_darboux.tg).max() < 1e-11 * scale
    assert np.abs(90 - network.node_angles).max() < 1e-9
    total, _ = whole_cells(network)
    assert np.abs(total / network.step - 1).max() < 1e-4
    # A is along the larger principal curvature
    family = np.repeat(network.families, np.diff(network.sample_offsets))
    assert (network.sample_darboux.kn[family == "A"] >= network.mean_curvature - 1e-9 * scale).all()
    assert (network.sample_darboux.kn[family == "B"] <= network.mean_curvature + 1e-9 * scale).all()


def test_principal_lines_of_the_catenoid() -> None:
    """rho = c cosh u: parallels u = 2 pi k / cells and meridians, normal curvatures -+1 / (c cosh^2 u)."""
    c, cells = 1.5, 24
    network = lamella.net(Catenoid(c, (-1.3, 2.1)), cells=cells, kind="principal")
    parallels = network.closed
    assert (network.families == np.where(parallels, "A", "B")).all()
    assert (~parallels).sum() == cells
    heights = [network.sample_points[start, 2] for start in network.sample_offsets[:-1][parallels]]
    step = 2 * np.pi / cells
    low, high = np.ceil(-1.3 / c / step), np.floor(2.1 / c / step)
    assert np.sort(heights) == pytest.approx(c * step * np.arange(low, high + 1), abs=1e-12)
    family = np.repeat(network.families, np.diff(network.sample_offsets))
    wanted = np.where(family == "A", 1, -1) / (c * np.cosh(network.sample_points[:, 2] / c) ** 2)
    assert network.sample_darboux.kn == pytest.approx(wanted, abs=1e-12)
    for k in np.flatnonzero(parallels):
        stops = network.stop_nodes[network.stop_offsets[k] : network.stop_offsets[k + 1]]
        assert stops[0] == stops[-1]
        assert len(stops) == cells + 1
    assert np.abs(np.linalg.norm(network.sample_points[0, :2]) - c * np.cosh(network.sample_points[0, 2] / c)) < 1e-12
    # trapezia between two meridians and two parallels are planar
    assert summary_of(network)["panel_planarity"]["max"] < 1e-13


def test_a_parallel_on_the_rim_is_the_rim() -> None:
    """Height of five cells exactly: the rims are parallels of the net, and panels end there."""
    cells = 24
    height = 5 * 2 * np.pi / cells
    network = lamella.net(Cylinder(1.0, (0.0, height)), cells=cells, kind="principal")
    assert network.closed.sum() == 6
    assert (network.node_kinds == BOUNDARY).sum() == 2 * cells
    _check_combinatorics(network, 0)
    assert len(network.face_offsets) - 1 == 5 * cells


def test_rays_of_a_flat_point() -> None:
    """Around a zero of order m every family has m + 2 principal rays, alternating: index -m / 2 of both fields."""
    for order in (3, 4):
        network = lamella.net(Enneper(order, 0.8, 3.0), cells=16, kind="principal")
        a, b = network.node_degrees()
        (node,) = np.flatnonzero(network.node_kinds == SINGULAR)
        rays = order  # zero of order m = n - 2
        assert (a[node], b[node]) == (rays, rays)
        leaves = network.stop_nodes[network.stop_offsets[:-1]] == node
        directions = network.sample_tangents[network.sample_offsets[:-1][leaves]]
        # at the flat point the tangent plane is z = 0
        angle = np.arctan2(directions[:, 1], directions[:, 0])
        turn = np.argsort(angle)
        assert np.diff(np.sort(angle)) == pytest.approx(np.pi / rays, abs=1e-9)
        families = network.families[leaves][turn]
        assert (families[1:] != families[:-1]).all()


@pytest.mark.parametrize("surface", [Enneper(3, 0.9), Scherk(1.2, 2.0)], ids=["enneper", "scherk"])
def test_principal_panels_are_planar_to_a_higher_order(surface: Any) -> None:
    """Quads of a conjugate net miss planarity by a higher power of their size than those of the lamellas (linear)."""
    sizes = np.array([12, 24, 48])

    def rate(kind: Any) -> float:
        missed = [panel_planarity(lamella.net(surface, cells=int(c), kind=kind, minimum_length=0)) for c in sizes]
        return -float(np.polyfit(np.log(sizes), np.log([m["median"] for m in missed]), 1)[0])

    assert rate("lamellas") == pytest.approx(1, abs=0.1)
    assert rate("principal") > 1.9


def test_principal_lines_end_exactly_on_the_rim() -> None:
    def rim(surface: Any) -> np.ndarray:
        network = lamella.net(surface, cells=21, kind="principal")
        return network.node_points[network.node_kinds == BOUNDARY]

    p = rim(Scherk(1.3, 2.0))[:, :2] / 2
    assert np.abs(np.abs(p).max(1) - 1.3).max() < 1e-12
    p = rim(Helicoid(3.0, 0.5, 2.0, 1.1))
    r, turn = np.hypot(p[:, 0], p[:, 1]), p[:, 2] / 3.0
    assert np.min([np.abs(r - 0.5), np.abs(r - 2.0), np.abs(turn), np.abs(turn - 1.1)], 0).max() < 1e-12


@pytest.mark.parametrize("kind", KINDS)
def test_cells_along_the_longest_principal_line(kind: str) -> None:
    """`cells` counts the same in both kinds of net; the principal one's edges are sqrt2 longer."""
    surface = draw_surface(kind, np.random.default_rng([KINDS.index(kind), 73]))
    principal, lamellas = (lamella.net(surface, cells=40, kind=k) for k in ("principal", "lamellas"))
    assert principal.step == lamellas.step
    ratio = np.median(principal.cell_edges) / np.median(lamellas.cell_edges)
    assert ratio == pytest.approx(np.sqrt(2), rel=0.15)
    wanted = float(np.median(principal.cell_edges))
    assert lamella.net(surface, spacing=wanted, kind="principal").cells == pytest.approx(40, abs=1)


# --- cells much larger than others ----------------------------------------------------------------------------------


def test_large_cells_of_the_catenoid() -> None:
    """A cell edge is about l0 cosh(z) / sqrt2: only where cosh(z) is over four times the median is one told."""
    assert large_cells(lamella.net(Catenoid(1.0, (-0.5, 2.0)), cells=24)) == (0, ())
    network = lamella.net(Catenoid(1.0, (-0.5, 3.2)), cells=24)
    count, places = large_cells(network)
    edges = network.cell_edges
    assert count == (edges > EDGE_RATIO_MAX * np.median(edges)).sum() > 0
    assert places[0].edge == pytest.approx(edges.max())
    assert places[0].ratio == pytest.approx(edges.max() / np.median(edges))
    for place in places:
        assert place.edge == pytest.approx(network.step / np.sqrt(2) * np.cosh(place.point[2]), rel=0.03)
    # unequal families are no large cells
    assert large_cells(lamella.net(Catenoid(1.0, (-0.5, 0.5)), cells=60, every=(6, 1))) == (0, ())


def test_large_cells_are_told_with_place_and_size() -> None:
    surface = {"kind": "catenoid", "neck_radius": 1.0, "height": [-0.5, 3.2]}
    told = compute(parse_project({"surface": surface}), until="network").summary["warnings"]
    (message,) = [line for line in told if "the median" in line]
    assert message.startswith("96 cell edges are over 4 x the median, up to 5.16 x (2.01 m at (")
    surface["height"] = [-0.5, 2.0]
    assert compute(parse_project({"surface": surface}), until="network").summary["warnings"] == []


# --- the project file, the summary, the files -----------------------------------------------------------------------

ENNEPER = {"kind": "enneper", "order": 3, "radius": 0.9, "scale": 4.0}


def test_a_principal_net_ends_the_run() -> None:
    results = compute(parse_project({"surface": ENNEPER, "network": {"kind": "principal", "every": [2, 1]}}))
    assert results.lamellas is None
    (message,) = results.summary["warnings"]
    assert message.startswith("the run ends with the network: a strip normal to the surface along a principal line is")
    told = results.summary["network"]
    assert (told["kind"], told["every"]) == ("principal", [2, 1])
    assert told["normal_curvature_deviation_max"] is None
    assert told["singular_nodes"][0]["rays"] == 6
    # Enneper: k = +-2 / rho^2 of the flat point's surroundings, symmetric
    (low, high), (lower, higher) = told["principal_curvatures"]["A"], told["principal_curvatures"]["B"]
    assert (low, higher) == (0, 0)
    assert high == pytest.approx(-lower, rel=1e-4)
    assert told["geodesic_torsion_max"] < 1e-13
    assert 0 < told["panel_planarity"]["median"] < told["panel_planarity"]["max"] < 0.02


@pytest.mark.parametrize("until", ["lamellas", "fabrication"])
def test_no_strips_on_principal_lines(until: str) -> None:
    project = parse_project({"surface": ENNEPER, "network": {"kind": "principal"}})
    with pytest.raises(InputError) as refused:
        compute(project, until=until)
    assert refused.value.where == "network.kind"
    assert until in refused.value.message
    assert compute(project, until="surface").network is None


def test_strips_are_refused_as_a_function_too() -> None:
    section = Section(0.1, 0.0015, 1, 0.025)
    network = lamella.net(Catenoid(1.0, (-0.5, 0.5)), cells=12, kind="principal")
    with pytest.raises(InputError, match="there are no strips for this net"):
        make_lamellas(network, section, MATERIALS["S355"])


def test_the_files_tell_the_kind() -> None:
    for kind in ("principal", "lamellas"):
        written = orjson.loads(network_bytes(lamella.net(Enneper(3, 0.9), cells=8, kind=kind), name="", version="0"))
        jsonschema.Draft202012Validator(network_schema()).validate(written)
        assert written.get("kind", "lamellas") == kind


@pytest.mark.parametrize("every", [1, 2, [3, 1], [2, 2]])
def test_every_in_the_project_file(every: Any) -> None:
    values = {"surface": ENNEPER, "network": {"every": every}}
    jsonschema.Draft202012Validator(project_schema()).validate(values)
    project = parse_project(values)
    pair = (every, every) if isinstance(every, int) else tuple(every)
    assert pattern_of(project.network) == Pattern("lamellas", pair)
    import tomllib

    assert parse_project(tomllib.loads(project.to_toml())).network == project.network


@pytest.mark.parametrize("every", [0, 101, 1.5, True, "2", [2], [1, 2, 3], [2, 0], [], None])
def test_every_refused(every: Any) -> None:
    if every == [2]:
        every = [[2]]
    with pytest.raises(InputError, match=r"network\.every"):
        parse_project({"surface": ENNEPER, "network": {"every": every}})


def test_adjust_is_not_for_lines_of_other_normal_curvature() -> None:
    with pytest.raises(InputError, match='closing = "adjust" makes the lattice of a net whole') as refused:
        parse_project({"surface": ENNEPER, "network": {"closing": "adjust", "normal_curvature": 0.5}})
    assert refused.value.where == "network.closing"
    for more in ({"kind": "principal"}, {"every": 2}):
        parse_project({"surface": ENNEPER, "network": {"closing": "adjust"} | more})


def summary_of(network: Network) -> dict[str, Any]:
    return evaluate(NetworkStage.figures, NetworkOutput(network, "", None, {}))


def test_summary_of_lamellas_has_no_panels() -> None:
    told = summary_of(lamella.net(Enneper(3, 0.9), cells=8))
    assert (told["kind"], told["every"]) == ("lamellas", [1, 1])
    assert "panel_planarity" not in told
